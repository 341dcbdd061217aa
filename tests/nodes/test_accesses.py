"""Recorded accesses of code with hooks: object and key, order, and lifetime of objects."""

from __future__ import annotations

import gc
import weakref

import pytest

from cfepy.nodes.accesses import ThingNumbers
from cfepy.nodes.instrument import Kinds
from tests.nodes.test_instrument import flown

PRELUDE = """
class Arm:
    limit = 3
    def __init__(self): self.n, self.d, self.l, self.q = 1, {"x": 1}, [1, 2], None
    def go(self): pass
    @property
    def twice(self): return self.n * 2
    @twice.setter
    def twice(self, value): self.n = value
arm = Arm()
def make():
    count = 0
    def add():
        nonlocal count
        count += 1
    return add
add = make()
total = 0
def change():
    global total
"""
QUIET = Kinds(accesses=True)
"""As a module that is imported: its own statements do not count."""


def touches(body: str) -> list[str]:
    """Return the accesses of a function with this body: `r name` or `w name`, a WHOLE container with a `*`."""
    lines = "".join(f"    {line}\n" for line in body.split("; "))
    (_, ended), seen, _ = flown(f"{PRELUDE}{lines}change()\n", QUIET)
    assert ended is None
    own = [each for each in seen if each.code.co_qualname not in ("Arm.__init__", "make")]
    stars = ["*" if each.key == "*" else "" for each in own]
    return [f"{'w' if each.is_write else 'r'} {each.name}{star}" for each, star in zip(own, stars, strict=True)]


@pytest.mark.parametrize(
    ("body", "told"),
    [
        ("arm.n", "r Arm.n"),
        ("arm.n = 2", "w Arm.n"),
        ("arm.n += 1", "r Arm.n, w Arm.n"),
        ("arm.n = arm.n + arm.n", "r Arm.n, r Arm.n, w Arm.n"),
        ("del arm.n", "w Arm.n"),
        ("arm.go()", ""),
        ("arm.limit", "r Arm.limit"),
        ("Arm.limit += 1", "r Arm.limit, w Arm.limit"),
        ("arm.twice", "r Arm.n"),
        ("arm.twice += 1", "r Arm.n, w Arm.n"),
        ("arm.d['x'] = 2", "r Arm.d, w arm.d['x']"),
        ("arm.d['new'] = 2", "r Arm.d, w arm.d*"),
        ("arm.d['x'] += 1", "r Arm.d, r arm.d['x'], w arm.d['x']"),
        ("arm.l[-1] = arm.l[int('0')]", "r Arm.l, r arm.l[0], r Arm.l, w arm.l[1]"),
        ("arm.l[:1] = []", "r Arm.l, w arm.l*"),
        ("del arm.d['x']", "r Arm.d, w arm.d*"),
        ("arm.l.append(arm.n)", "r Arm.l, r Arm.n, w arm.l*"),
        ("arm.d.get('x')", "r Arm.d, r arm.d*"),
        ("len(arm.l) and 1 in arm.l", "r Arm.l, r arm.l*, r Arm.l, r arm.l*"),
        ("[each for each in arm.l]", "r Arm.l, r arm.l*"),
        ("for each in arm.l: pass", "r Arm.l, r arm.l*, r arm.l*, r arm.l*"),
        ("'a' in 'abc' and 'abc'[0]", ""),
        ("arm.q and arm.n", "r Arm.q"),
        ("total = total + 1", "r program.total, w program.total"),
        ("total = 2", "w program.total"),
        ("total += 1", "r program.total, w program.total"),
        ("add()", "r make.count, w make.count"),
        ("sum(map(abs, arm.l))", "r Arm.l, r arm.l*"),
        ("print", ""),
        ("import math; math.pi", ""),
    ],
)
def test_accesses_are_recorded(body: str, told: str) -> None:
    assert touches(body) == (told.split(", ") if told else [])


def test_object_has_one_number_for_all_its_names() -> None:
    seen = flown(f"{PRELUDE}    mine = arm.l; mine.append(1); arm.l.pop()\nchange()\n", QUIET)[1]
    numbers = {each.thing for each in seen if each.key == "*"}
    assert len(numbers) == 1
    assert [each.place for each in seen if each.key == "*"] == ["change (program.py:21)"] * 2


def test_numbers_keep_no_object_alive() -> None:
    class Thing:
        pass

    gone: list[int] = []
    numbers = ThingNumbers()
    numbers.on_gone = gone.append
    thing, lists = Thing(), [[n] for n in range(2000)]
    kept = weakref.ref(thing)
    assert [numbers.of(each) for each in (thing, *lists)] == list(range(1, 2002))
    assert [numbers.of(each) for each in lists] == list(range(2, 2002))
    del thing
    gc.collect()
    assert kept() is None
    assert gone == [1]
    del lists[10:]
    more = [[n] for n in range(5000)]
    assert [numbers.of(each) for each in more] == list(range(2002, 7002))
    assert [numbers.of(each) for each in lists] == list(range(2, 12))
    assert set(gone) == {1, *range(12, 2002)}
