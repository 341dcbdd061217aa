"""The ordered set is a set, and iterates in insertion order."""

from __future__ import annotations

import copy
import pickle

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cfepy.interpreter.syntax_trees import compiled, parsed
from cfepy.nodes.node_sources import code_of_file
from cfepy.nodes.ordered_sets import SET_NAME, OrderedSet, with_ordered_sets

items = st.lists(st.integers(0, 9), max_size=8)


def unique(values):
    return list(dict.fromkeys(values))


@given(items, items)
def test_algebra_agrees_with_set_and_keeps_order(left, right):
    a, b = OrderedSet(left), OrderedSet(right)
    assert a | b == set(left) | set(right)
    assert list(a | b) == unique(left + right)
    assert list(a & b) == [x for x in unique(left) if x in right]
    assert list(a - b) == [x for x in unique(left) if x not in right]
    assert list(a ^ b) == [x for x in unique(left) if x not in right] + [x for x in unique(right) if x not in left]
    assert set(left) - b == set(left) - set(right)
    assert (a <= b, a < b, a == b, a.isdisjoint(b)) == (
        set(left) <= set(right),
        set(left) < set(right),
        set(left) == set(right),
        set(left).isdisjoint(right),
    )


@given(items, items)
def test_changes_in_place(left, right):
    for name in ("update", "intersection_update", "difference_update", "symmetric_difference_update"):
        mine, plain = OrderedSet(left), set(left)
        getattr(mine, name)(right)
        getattr(plain, name)(right)
        assert mine == plain
        assert sorted(mine) == sorted(plain)
        assert len(mine) == len(plain)


@given(items)
def test_pop_removes_the_oldest(values):
    mine = OrderedSet(values)
    assert [mine.pop() for _ in range(len(mine))] == unique(values)
    with pytest.raises(KeyError, match="pop from an empty set"):
        mine.pop()


def test_operators_in_place_and_removal():
    mine = OrderedSet("cab")
    mine |= {"d"}
    mine -= {"a"}
    mine &= OrderedSet("bcd")
    mine ^= {"b"}
    mine.discard("nothing")
    with pytest.raises(KeyError):
        mine.remove("nothing")
    assert list(mine) == ["c", "d"]
    mine.remove("c")
    assert repr(mine) == "{'d'}"
    assert repr(OrderedSet()) == "set()"
    with pytest.raises(TypeError):
        mine |= ["list"]


def test_copies_and_instances():
    mine = OrderedSet("cab")
    assert list(pickle.loads(pickle.dumps(mine))) == list(copy.copy(mine)) == list(copy.deepcopy(mine)) == list("cab")
    assert isinstance(set(), OrderedSet)
    assert isinstance(mine, set)
    assert not isinstance(frozenset(), OrderedSet)


def test_set_displays_become_ordered():
    source = "a = {'c', 'a', 'b'}\nb = {x for x in 'zyx'}\nc = 'a' in {'a', 'b'}\n"
    names = {SET_NAME: OrderedSet}
    exec(compiled(with_ordered_sets(parsed(source)), "node.py"), names)
    assert list(names["a"]) == ["c", "a", "b"]
    assert list(names["b"]) == ["z", "y", "x"]
    assert names["c"] is True


def test_errors_keep_their_line(tmp_path):
    file = tmp_path / "node.py"
    file.write_text("x = 1\ny = = 2\n", encoding="utf-8")
    with pytest.raises(SyntaxError) as caught:
        code_of_file(str(file), True, "node.py")
    assert (caught.value.filename, caught.value.lineno) == ("node.py", 2)
