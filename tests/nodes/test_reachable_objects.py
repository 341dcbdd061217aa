"""Objects that code can still reach."""

from __future__ import annotations

import _thread
import enum
import functools
import operator
import sys
import threading
import weakref
from collections.abc import Callable, Iterator
from contextlib import nullcontext
from types import FrameType
from typing import Any, Literal

import pytest

from cfepy.nodes import held_by, is_private, reaches


class Thing:
    """The object to look for."""


THING = Thing()
KEPT = {"thing": THING}


class Keeper:
    """Holds it, and its methods name it."""

    def __init__(self, thing: Thing) -> None:
        self.held = [thing]

    def look(self) -> Thing:
        """By an attribute."""
        return self.held[0]


class Namer:
    """Its method names the variable."""

    def look(self) -> Thing:
        """By a global variable."""
        return THING


class Flag(enum.Enum):
    """Its method names the variable, and `typing` remembers each flag that a type was made of."""

    UP = 1

    def look(self) -> Thing:
        """By a global variable."""
        return THING


UP = Literal[Flag.UP]


def by_name() -> Thing:
    return THING


@functools.lru_cache
def remembering(thing: Thing) -> Thing:
    return thing


remembering(THING)


def by_inner_function() -> Callable[[], Thing]:
    def inner() -> Thing:
        return THING

    return inner


def by_anything() -> Any:
    return globals()["TH" + "ING"]


def by_default(thing: Thing = THING) -> Thing:
    return thing


def by_generator(thing: Thing) -> Iterator[Thing]:
    yield Thing()
    yield thing


def not_at_all() -> type[Thing]:
    return Thing


def closure(thing: Thing) -> Callable[[], Thing]:
    return lambda: thing


def begun(generator: Iterator[Thing]) -> Iterator[Thing]:
    next(generator)
    return generator


LEADING = [
    by_name,
    functools.cache(by_name),
    remembering,
    UP,
    by_inner_function,
    by_anything,
    by_default,
    begun(by_generator(THING)),
    closure(THING),
    Keeper(THING),
    Keeper(THING).look,
    Namer(),
    Namer().look,
    functools.partial(operator.is_, THING),
    [({1: {THING}},)],
    weakref.ref(THING),
    KEPT.get,
    sys.modules[__name__],
    threading.Thread(target=by_name),
]

NOT_LEADING = [not_at_all, Thing, threading, threading.Thread(), "THING", weakref.ref(Thing()), len, Literal["up"]]


@pytest.mark.parametrize(
    "root",
    [
        pytest.param(root, id=str(number), marks=[pytest.mark.slow] * (root in (by_anything, sys.modules[__name__])))
        for number, root in enumerate(LEADING)
    ],
)
def test_reachable_object_is_found(root: object) -> None:
    assert reaches([root], THING)
    assert not reaches([root], object())


@pytest.mark.parametrize("root", NOT_LEADING, ids=range(len(NOT_LEADING)))
def test_unreachable_object_is_not_found(root: object) -> None:
    assert not reaches([root], THING)


def test_closed_objects_are_not_searched() -> None:
    assert not reaches([KEPT], THING, [KEPT])


def test_object_that_pretends_another_type_is_searched() -> None:
    class Pretender:
        __class__ = property(lambda self: int)

        def __init__(self) -> None:
            self.thing = THING

    assert reaches([Pretender()], THING)


def after(thing: Thing, here: Callable[[], object]) -> None:
    del thing
    here()


def before(thing: Thing, here: Callable[[], object]) -> Thing:
    here()
    return thing


def used_in_loop(thing: Thing, here: Callable[[], object]) -> None:
    for number in range(2):
        hash(thing)
        if number:
            here()


def used_before_loop(thing: Thing, here: Callable[[], object]) -> None:
    hash(thing)
    for number in range(2):
        if number:
            here()


def over_list(thing: Thing, here: Callable[[], object]) -> None:
    things = [Thing(), thing]
    del thing
    for _ in things:
        here()


def in_block(thing: Thing, here: Callable[[], object]) -> None:
    with nullcontext(thing):
        here()


def in_statement(thing: Thing, here: Callable[[], object]) -> object:
    return (thing, here())


def holds(function: Callable[[Thing, Callable[[], object]], object]) -> bool:
    """Return whether a task at the call of `here` can still reach the thing."""
    frames: list[FrameType] = []
    arrived, go = threading.Event(), threading.Event()

    def here() -> None:  # which does not name the object
        frames.append(sys._getframe(1))
        arrived.set()
        go.wait(10)

    _thread.start_new_thread(function, (THING, here))  # there are no other frames below it
    assert arrived.wait(10)
    found = reaches(held_by(frames[0]), THING)
    go.set()
    return found


@pytest.mark.parametrize("function", [before, used_in_loop, over_list, in_block, in_statement])
def test_name_used_later_or_on_the_stack_is_held(function: Callable[..., object]) -> None:
    assert holds(function)


@pytest.mark.parametrize("function", [after, used_before_loop])
def test_name_is_released_after_last_use(function: Callable[..., object]) -> None:
    assert not holds(function)


def test_object_named_by_one_function_is_private() -> None:
    assert is_private(THING, by_name.__code__, [by_name, not_at_all], [])
    assert not is_private(THING, by_name.__code__, [by_name, by_anything], [])
