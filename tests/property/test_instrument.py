"""Random programs behave the same with hooks at their accesses, lines and calls as without."""

from __future__ import annotations

from textwrap import indent

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cfepy.nodes.instrument import Kinds
from cfepy.rtos import Policy
from tests.nodes.test_instrument import flown

PRELUDE = """
class Box:
    limit = 2
    def __init__(self, n): self.n, self.d, self.l, self.next = n, {"x": n}, [n, 1], None
    @property
    def twice(self): out.append("get"); return self.n * 2
    @twice.setter
    def twice(self, value): out.append("set"); self.n = value
    def add(self, by=1): self.n += by; return self.n
    def __repr__(self): return "Box"
total, box = 0, Box(1)
box.next = Box(2)
"""
PLACES = ("box.n", "box.next.n", "box.twice", "Box.limit", "box.d['x']", "box.d[key]", "box.l[0]", "box.l[-1]", "total")
PLACES += ("count", "box.l[count % 2]", "mine")
VALUES = st.sampled_from(
    [
        *PLACES,
        *("1", "-2", "box.add()", "box.next.add(by=total)", "len(box.l)", "sum(box.l)", "box.d.get(key, 7)", "say(3)"),
        *("(box.n if box.l else total)", "(box.n and count or total)", "max([each for each in box.l], default=0)"),
        *("sum(n for n in box.d.values())", "(lambda: count)()", "{**box.d}['x']", "[*box.l][0]", "(mine := 4)"),
        *("f'{box.n}'.count('1')", "int('x' in box.d)", "box.l[1:].count(1)", "getattr(box, 'n')", "box.missing"),
    ]
)
SUM = st.builds("{} {} {}".format, VALUES, st.sampled_from("+-*"), VALUES)
SIMPLE = st.one_of(
    st.builds("{} = {}".format, st.sampled_from(PLACES), SUM),
    st.builds("{} {}= {}".format, st.sampled_from(PLACES), st.sampled_from("+-*"), VALUES),
    st.builds("{}, {} = {}, {}".format, st.sampled_from(PLACES), st.sampled_from(PLACES), VALUES, VALUES),
    st.builds("out.append({})".format, SUM),
    st.sampled_from(
        [
            *("box.l.append(box.n)", "box.l.pop()", "box.d[key] = count", "del box.d['x']", "del box.n", "del mine"),
            *(
                "box.l[:1] = [total, count]",
                "box.d.update(y=count)",
                "box.l.sort()",
                "key = 'y'",
                "box.l.extend(box.l)",
            ),
            *("box = Box(count)", "bump()", "return", "raise ValueError(count)", "assert box.n, total", "global other"),
        ]
    ),
)


def nested(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    """Statements with others inside."""
    block = st.lists(inner, min_size=1, max_size=3).map(lambda lines: indent("\n".join(lines), "    "))
    return st.one_of(
        st.builds("if {}:\n{}\nelse:\n{}".format, VALUES, block, block),
        st.builds("for each in {}:\n{}".format, st.sampled_from(["box.l[:3]", "list(box.d)", "range(2)"]), block),
        st.builds("try:\n{}\nexcept (KeyError, AttributeError) as error:\n{}".format, block, block),
        st.builds("with Noted(box) as mine:\n{}".format, block),
    )


STATEMENT = st.recursive(SIMPLE, nested, max_leaves=5)
FUNCTION = """
class Noted:
    def __init__(self, box): self.box = box
    def __enter__(self): return self.box.n
    def __exit__(self, *what): self.box.n = 0; out.append(what[0] and what[0].__name__)
def say(value): out.append(value); return value
def run():
    global total, box
    count, key, mine = 1, "x", 0
    def bump():
        nonlocal count
        count += 1
{}
    out.append((count, key, mine))
try: run()
finally: out.append((total, vars(box) if box.next is None else (vars(box.next), box.d, box.l), Box.limit))
"""


@pytest.mark.slow
@given(st.lists(STATEMENT, min_size=1, max_size=6), st.booleans())
def test_program_does_the_same_with_hooks(statements: list[str], has_calls: bool) -> None:
    source = PRELUDE + FUNCTION.format(indent("\n".join(statements), "    "))
    kinds = Kinds(accesses=not has_calls, lines=not has_calls, calls=has_calls, is_main=True)
    policy = Policy(points="calls") if has_calls else None
    assert shown(flown(source, kinds, policy)[0]) == shown(flown(source, None)[0])


def shown(outcome: object) -> str:
    """Return a program's result, with its objects as text."""
    return repr(outcome)
