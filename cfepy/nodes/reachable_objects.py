"""Which objects the code of a task can still reach.

Used to decide whether any task is left that could release a lock. When in doubt the answer is yes: everything that an
object holds counts as reached, and everything that a function names, whether or not it will be executed. In a function
that has started, code before the current place does not count if its bytecode cannot jump back there.
"""

from __future__ import annotations

import dis
import gc
import sys
from collections import deque
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from functools import _lru_cache_wrapper, lru_cache
from types import (
    BuiltinMethodType,
    CodeType,
    CoroutineType,
    FrameType,
    FunctionType,
    GeneratorType,
    GetSetDescriptorType,
    MethodDescriptorType,
    MethodType,
    ModuleType,
    WrapperDescriptorType,
)
from typing import Any
from weakref import ReferenceType

from cfepy.interpreter.own_code import BESIDE

_ANYTHING = frozenset(
    ["__dict__", "__import__", "eval", "exec", "get_objects", "globals", "import_module", "locals", "modules", "vars"]
)
"""Names through which code can reach everything in its module."""
_BY_NAME = frozenset(["attrgetter", "getattr", "methodcaller"])
"""Functions through which code can call a method that it does not name."""
_OPAQUE = frozenset([*sys.stdlib_module_names, "cfepy", "numpy", *BESIDE])
_CLOSED = ("cfepy.", "rospy_shim.types.")
"""Modules whose objects lead to no object of the program, but to what other nodes added to classes of messages."""
_WITH = ("BEFORE_WITH", "BEFORE_ASYNC_WITH", "LOAD_SPECIAL")
_JUMPS = frozenset((*dis.hasjrel, *dis.hasjabs))
_LEAVES = frozenset([CodeType, FrameType, GetSetDescriptorType, WrapperDescriptorType, MethodDescriptorType])
_PLAIN = frozenset([str, bytes, bytearray, bool, int, float, complex, type(None)])


def reaches(roots: Iterable[object], subject: object, closed: Iterable[object] = ()) -> bool:
    """Return whether a path of references leads from one of the roots to the subject.

    Args:
        roots: where paths start.
        subject: the object to reach.
        closed: objects that no path may pass.
    """
    return any(here is subject for here in _reached(roots, closed))


def can_call(
    roots: Iterable[object], frames: Iterable[FrameType], names: frozenset[str], closed: Iterable[object] = ()
) -> bool:
    """Return whether tasks, or code that the roots lead to, can call a method of one of these names.

    Args:
        roots: where paths of references start.
        frames: the innermost frames of the tasks, whose code counts from its place on.
        names: names of methods.
        closed: objects that no path may pass.
    """
    wanted = names | _ANYTHING | _BY_NAME
    if any(not _names_from(frame).isdisjoint(wanted) for frame in frames):
        return True
    return any(_may_call(here, names, wanted) for here in _reached(roots, closed))


def _reached(roots: Iterable[object], closed: Iterable[object]) -> Iterator[object]:
    """Yield each object to which a path of references leads, once; see `reaches`."""
    seen = {id(each): each for each in closed}  # the values keep temporary objects alive, so that ids are not reused
    ahead = deque(roots)
    while ahead:
        here = ahead.popleft()
        if type(here) not in _PLAIN and id(here) not in seen:
            seen[id(here)] = here
            yield here
            ahead.extend(_next(here))


def _may_call(here: object, names: frozenset[str], wanted: frozenset[str]) -> bool:
    """Return whether an object is a method of one of the names, or a function that has a wanted name in its code."""
    if isinstance(here, (MethodType, BuiltinMethodType)):
        return here.__name__ in names
    if type(here) is not FunctionType or _is_opaque(here.__globals__.get("__name__", "")):
        return False
    return not _all_names(here.__code__).isdisjoint(wanted)


def _names_from(frame: FrameType | None) -> frozenset[str]:
    """Return the names in the code of a task from its place on, without the simulator's and Python's."""
    names: frozenset[str] = frozenset()
    while frame is not None:
        if not _is_opaque(frame.f_globals.get("__name__", "")):
            names |= _names_ahead(frame.f_code, frame.f_lasti)
        frame = frame.f_back
    return names


def held_by(frame: FrameType | None) -> Iterator[object]:
    """Yield the objects that a task with this innermost frame can use when it continues from there.

    Frames of the simulator do not count: they only lead back to the program at its current place.
    """
    while frame is not None:
        if not frame.f_globals.get("__name__", "").startswith("cfepy."):
            yield from _named(_names_ahead(frame.f_code, frame.f_lasti), frame.f_locals, frame.f_globals)
        frame = frame.f_back


def is_private(subject: object, code: CodeType, functions: Iterable[object], closed: Iterable[object]) -> bool:
    """Return whether only this code can reach an object: none of the other functions and classes does."""
    others = (each for each in functions if getattr(each, "__code__", None) is not code)
    return not reaches(others, subject, closed)


def _next(here: object) -> Iterator[object]:
    """Yield the objects that an object refers to, by its real type, since `__class__` can be overridden."""
    kind = type(here)
    if issubclass(kind, FunctionType):
        yield from _from_function(here)  # type: ignore[arg-type]  # as mypy sees no more than the object's type
    elif issubclass(kind, (GeneratorType, CoroutineType)):
        yield from gc.get_referents(here)
        yield from held_by(getattr(here, "gi_frame" if issubclass(kind, GeneratorType) else "cr_frame"))
    elif issubclass(kind, _lru_cache_wrapper):  # those of `typing` lead to all classes of the process
        yield from () if _is_opaque(getattr(here, "__module__", "")) else gc.get_referents(here)
    elif issubclass(kind, ReferenceType):
        yield here()  # type: ignore[operator]
    elif issubclass(kind, ModuleType):
        yield from () if _is_opaque(vars(here).get("__name__")) else vars(here).values()
    elif issubclass(kind, type) and isinstance(here, type):
        yield from () if _is_opaque(getattr(here, "__module__", "")) else (*vars(here).values(), *here.__bases__)
    elif kind not in _LEAVES and not str(kind.__module__).startswith(_CLOSED):
        yield from gc.get_referents(here)


def _from_function(function: FunctionType) -> Iterator[object]:
    yield from function.__defaults__ or ()
    yield from (function.__kwdefaults__ or {}).values()
    yield from vars(function).values()
    for cell in function.__closure__ or ():
        with suppress(ValueError):  # an empty one
            yield cell.cell_contents
    if not _is_opaque(function.__globals__.get("__name__", "")):
        yield from _named(_all_names(function.__code__), {}, function.__globals__)


def _is_opaque(module: object) -> bool:
    """Return whether a module's variables are ignored: as its code uses them, they lead to no object of the program."""
    return isinstance(module, str) and module.partition(".")[0] in _OPAQUE


def _named(
    names: frozenset[str], variables: Mapping[str, object], global_variables: Mapping[str, object]
) -> Iterator[object]:
    if names & _ANYTHING:
        yield from (*variables.values(), *global_variables.values())
    for name in names:
        if name in variables:
            yield variables[name]
        elif name in global_variables:
            yield global_variables[name]


@lru_cache(1000)
def _all_names(code: CodeType) -> frozenset[str]:
    names = {*code.co_names, *code.co_varnames, *code.co_cellvars, *code.co_freevars}
    for const in code.co_consts:
        if isinstance(const, CodeType):
            names |= _all_names(const)
    return frozenset(names)


@lru_cache(1000)
def _names_ahead(code: CodeType, place: int) -> frozenset[str]:
    """Return the names used from a place on, including those of the statement there.

    Args:
        code: the executed code.
        place: offset of the current instruction.
    """
    instructions = list(dis.get_instructions(code))
    lines = {each.offset: _line(each) for each in instructions}
    # during a call the offset is after the start of the instruction
    here = lines[max(offset for offset in lines if offset <= max(place, 0))]
    start = min(offset for offset, line in lines.items() if line == here)
    while (earlier := _back_from(instructions, start)) < start:
        start = earlier
    if any(each.opname in _WITH for each in instructions if each.offset < start):
        return _all_names(code)  # the exit of the block is not named again
    names: set[str] = set()
    for each in instructions:
        if each.offset >= start:
            names.update(_names_of(each.argval))
    return frozenset(names)


def _back_from(instructions: list[dis.Instruction], start: int) -> int:
    """Return how far execution from a place on can go back: to the start of the enclosing loops."""
    ahead = [each for each in instructions if each.offset >= start]
    first: int = min([start, *(each.argval for each in ahead if each.opcode in _JUMPS)])
    if not any(each.opname == "FOR_ITER" for each in ahead):
        return first
    # The iterator of a loop is on the stack; it is named where the loop starts.
    begins = [each for each in instructions if each.opname == "GET_ITER" and each.offset < start]
    loop = [each.offset for each in instructions if begins and _line(each) == _line(begins[-1])]
    return min([first, *loop])


def _line(instruction: dis.Instruction) -> int | None:
    return None if instruction.positions is None else instruction.positions.lineno


def _names_of(value: Any) -> frozenset[str]:
    if isinstance(value, str):
        return frozenset([value])
    if isinstance(value, CodeType):
        return _all_names(value)
    return (
        frozenset(value) if isinstance(value, tuple) and all(isinstance(each, str) for each in value) else frozenset()
    )
