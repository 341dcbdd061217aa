"""Code with hooks behaves the same as without, and its hooks report its accesses."""

from __future__ import annotations

import linecache
import traceback
from types import ModuleType
from typing import Any

import pytest

from cfepy.interpreter.syntax_trees import compiled, parsed
from cfepy.nodes.accesses import Accesses, Touch
from cfepy.nodes.instrument import Kinds, with_hooks
from cfepy.rtos import Policy
from cfepy.schedules import make_kernel
from tests.nodes.programs import PROGRAMS

ALL = Kinds(accesses=True, lines=True, calls=False, is_main=True)
FILE = "program.py"


def flown(source: str, kinds: Kinds | None, policy: Policy | None = None) -> tuple[Any, list[Touch], Accesses]:
    """Return the results of a program: the content of `out`, its end, its lines, and its accesses."""
    kernel = make_kernel(policy=policy)
    accesses, seen = Accesses(kernel), list[Touch]()
    accesses.observers.append(seen.append)
    names: dict[str, Any] = {"__name__": "__main__", "__file__": FILE, "out": []}
    module = ModuleType("builtins")
    import builtins

    vars(module).update(vars(builtins))
    vars(module).update(accesses.hooks())
    names["__builtins__"] = vars(module)
    code = compiled(source, FILE) if kinds is None else compiled(with_hooks(parsed(source, FILE), kinds), FILE)
    accesses.adopt(names)
    ended: Any = None
    linecache.cache[FILE] = (len(source), None, source.splitlines(True), FILE)
    try:
        exec(code, names)
    except Exception as error:
        lines = [
            (each.lineno, each.name) for each in traceback.extract_tb(error.__traceback__) if each.filename == FILE
        ]
        ended = type(error).__name__, str(error), lines
    return (names["out"], ended), seen, accesses


@pytest.mark.parametrize("source", PROGRAMS.values(), ids=PROGRAMS.keys())
def test_program_does_the_same_with_hooks(source: str) -> None:
    assert flown(source, ALL)[0] == flown(source, None)[0]


@pytest.mark.parametrize("source", PROGRAMS.values(), ids=PROGRAMS.keys())
def test_accesses_are_the_same_each_time(source: str) -> None:
    once, again = (
        [(each.thing, each.key, each.is_write, each.name, each.place) for each in flown(source, ALL)[1]]
        for _ in range(2)
    )
    assert once == again
