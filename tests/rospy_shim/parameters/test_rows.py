"""Parameters as text and in rows: exact types, any name, and only changed values are written."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rospy_shim.parameters import rows as rows_module
from rospy_shim.parameters.rows import ParameterRows, ParametersFull
from rospy_shim.parameters.table import FREE, count_rows, pack, records, rows_for, tree_of, unpack
from rospy_shim.parameters.tree import ParameterTree
from rospy_shim.parameters.values import DateTime, leaf_names, leaves_of, parts_of, text_of, value_of, written
from rospy_shim.types.exceptions import ROSException

SCALARS = st.one_of(
    st.booleans(),
    st.integers(-(2**31), 2**31 - 1),
    st.floats(allow_nan=False),
    st.text(max_size=120),
    st.binary(max_size=60),
    st.datetimes().map(lambda when: DateTime(f"{when:%Y%m%dT%H:%M:%S}".rjust(17, "0"))),
)
NAMES = st.one_of(st.sampled_from(["a", "b", "c", "rate", "n" * 60]), st.text(max_size=3))
VALUES = st.recursive(
    SCALARS, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(NAMES, inner, max_size=3), max_leaves=6
)
KEYS = st.lists(st.sampled_from(["a", "b", "c"]), min_size=1, max_size=3).map("/".join)


def same(first: Any, second: Any) -> bool:
    """Equal, and of the same types."""
    if type(first) is not type(second):
        return False
    if isinstance(first, dict):
        return first.keys() == second.keys() and all(same(first[key], second[key]) for key in first)
    if isinstance(first, list):
        return len(first) == len(second) and all(map(same, first, second))
    return bool(first == second)


@given(VALUES)
def test_text_represents_the_exact_value(value: Any) -> None:
    text = text_of(value)
    assert text.isascii()
    assert "\n" not in text
    assert same(value_of(text), value)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (10, "10"),
        (10.0, "10.0"),
        (True, "true"),
        ("hello world", "hello world"),
        ("10", '"10"'),
        ("", '""'),
        (" x", '" x"'),
        ("[a]", '"[a]"'),
        ("ä\n", '"\\u00e4\\n"'),
        (b"hello", '{"!!binary": "aGVsbG8="}'),
        ({"!!binary": "a"}, '{"!!map": {"!!binary": "a"}}'),
        ({}, "{}"),
        (math.inf, "Infinity"),
    ],
)
def test_values_have_the_expected_text(value: Any, text: str) -> None:
    assert text_of(value) == text
    assert same(value_of(text), value)


@pytest.mark.parametrize("text", ["[1", "null", "[null]", "3000000000", '{"!!binary": 3}', '{"!!binary": "?"}', '"'])
def test_invalid_texts_are_refused(text: str) -> None:
    with pytest.raises(ValueError, match=r"null|bits|base 64|JSON"):
        value_of(text)


@given(st.lists(st.text(max_size=8), min_size=1, max_size=3))
def test_any_name_can_be_written(parts: list[str]) -> None:
    name = "".join(f"/{written(part)}" for part in parts)
    assert name.isascii()
    assert name.isprintable()
    assert " " not in name
    assert parts_of(name) == parts


@given(st.dictionaries(NAMES, VALUES, max_size=4))
def test_tree_is_restored_from_its_rows(tree: dict[str, Any]) -> None:
    rows = [row for name, text in leaves_of("", tree) for row in rows_for(name, text)]
    problems: list[str] = []
    found, _ = tree_of(unpack(b"".join(map(pack, rows))), problems)
    assert problems == []
    assert same(found, tree)


@settings(max_examples=60)
@given(st.lists(st.tuples(KEYS, st.none() | VALUES), max_size=12), st.integers(4, 40))
def test_rows_follow_the_tree_after_any_changes(steps: list[tuple[str, Any]], count: int) -> None:
    tree, rows = ParameterTree(), ParameterRows([FREE] * count, {})
    tree.keep_in(rows, bool, {})
    written_rows = list(rows.rows)
    for key, value in steps:
        before = list(rows.rows)
        try:
            if value is None:
                tree.delete(key)
            else:
                tree.set(key, value)
        except (KeyError, ParametersFull):
            assert rows.rows == before
        for index in rows.changed:
            written_rows[index] = rows.rows[index]
        rows.changed.clear()
        assert written_rows == rows.rows
        problems: list[str] = []
        found, good = tree_of(rows.rows, problems)
        assert same(found, tree.find("/"))
        assert problems == []
        assert rows.free == count - sum(record.length for record in good.values())


def test_change_of_one_value_changes_one_row() -> None:
    tree = ParameterTree({"arm": {f"gain{number}": number for number in range(50)}})
    rows = ParameterRows([FREE] * 60, {})
    tree.keep_in(rows, bool, {})
    rows.changed.clear()
    tree.set("/arm/gain7", 8)
    assert list(rows.changed) == [7]
    rows.changed.clear()
    tree.set("/arm", {**tree.find("/arm"), "gain9": 1.5})
    assert list(rows.changed) == [9]


def test_free_rows_are_joined_when_a_long_value_needs_them() -> None:
    tree, rows = ParameterTree({str(number): number for number in range(10)}), ParameterRows([FREE] * 10, {})
    tree.keep_in(rows, bool, {})
    for number in range(0, 10, 2):
        tree.delete(str(number))
    tree.set("long", "x" * 300)
    assert tree_of(rows.rows, [])[0] == tree.find("/")
    with pytest.raises(ParametersFull, match="the parameter tables are full: /more needs 2 rows of 10, 1 are free"):
        tree.set("more", "x" * 100)


def test_invalid_rows_are_ignored_and_emptied() -> None:
    content = [("+", "lost"), ("/a", "1"), ("/b", "[1"), ("/a", "2"), ("/a/c", "3"), FREE, ("/d", "4")]
    problems: list[str] = []
    found, good = tree_of(content, problems)
    assert found == {"a": 1, "d": 4}
    assert [problem.split(":")[0] for problem in problems] == ["row 2", "row 3", "row 4"]
    rows = ParameterRows(content, good)
    assert list(rows.changed) == [0, 2, 3, 4]
    assert [record.name for record in records(rows.rows)] == ["/a", "/d"]


@settings(max_examples=50)
@given(st.binary(min_size=128, max_size=128))
def test_unused_rows_can_be_rewritten(image: bytes) -> None:
    assert unpack(b"".join(map(pack, unpack(image)))) == unpack(image)


def kept() -> ParameterTree:
    tree = ParameterTree()
    tree.keep_in(ParameterRows([FREE] * 8_128, {}), lambda: None, {})
    return tree


EXCESSIVE = {
    "a text": ("/big", "y" * 8_000_000),
    "a larger text": ("/big", "y" * 60_000_000),
    "bytes": ("/big", b"y" * 8_000_000),
    "a list": ("/big", [0] * 700_000),
    "many names": ("/big", dict.fromkeys(map(str, range(50_000)), 1)),
    "a name": ("/" + "a" * 1_000_000, 1),
    "a deep name": ("/a" * 101, 1),
}


@pytest.mark.parametrize(("key", "value"), EXCESSIVE.values(), ids=list(EXCESSIVE))
def test_excessive_parameter_is_refused_before_rows_are_made(
    key: str, value: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    def rows_made(name: str, text: str) -> None:
        raise AssertionError("rows were made")

    tree = kept()
    tree.set("/small", 1)
    monkeypatch.setattr(rows_module, "rows_for", rows_made)
    with pytest.raises(ROSException) as refused:
        tree.set(key, value)
    assert len(str(refused.value)) < 400
    assert tree.names() == ["/small"]


@pytest.mark.parametrize("depth", [95, 100, 5_000, 200_000])
def test_depth_of_a_parameter_is_bounded(depth: int) -> None:
    value: Any = 1
    for number in range(depth):
        value = [value] if number % 2 else {"a": value}
    if depth <= 98:
        kept().set("/ns/deep", value)
        return
    for tree in (kept(), ParameterTree()):
        with pytest.raises(ROSException, match="more than 100 nested namespaces and lists"):
            tree.set("/ns/deep", value)


def test_rows_of_a_long_text_are_made_in_linear_time() -> None:
    text = "abcdefgh" * 80_000
    rows = rows_for("/long", text)
    assert len(rows) == 8_000
    assert [each.text for each in records(rows)] == [text]


@given(st.text("abc", max_size=300), st.text("abc", max_size=300))
def test_number_of_rows_is_known_in_advance(name: str, text: str) -> None:
    assert count_rows(name, text) == len(rows_for(name, text))
    assert list(leaf_names(name, {"a": {}, "b": {"c": text}})) == [
        each for each, _ in leaves_of(name, {"a": {}, "b": {"c": text}})
    ]
