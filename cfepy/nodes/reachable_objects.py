"""What the code of a task can still get hold of: whether any way leads from there to an object.

It is for telling whether somebody is left who could release a lock. The answer errs on the side of yes: all that an
object holds counts as reached, and all that a function names, whether or not it will be executed. Of a function that
has begun, what lies behind it does not count, as far as its bytecode shows that it cannot go back there.
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
    CodeType,
    CoroutineType,
    FrameType,
    FunctionType,
    GeneratorType,
    GetSetDescriptorType,
    MethodDescriptorType,
    ModuleType,
    WrapperDescriptorType,
)
from typing import Any
from weakref import ReferenceType

_ANYTHING = frozenset(
    ["__dict__", "__import__", "eval", "exec", "get_objects", "globals", "import_module", "locals", "modules", "vars"]
)
"""What names one of these may get hold of all that its module knows."""
_OPAQUE = frozenset([*sys.stdlib_module_names, "cfepy", "numpy", "ros_libraries", "rospy_shim"])
_WITH = ("BEFORE_WITH", "BEFORE_ASYNC_WITH", "LOAD_SPECIAL")
_JUMPS = frozenset((*dis.hasjrel, *dis.hasjabs))
_LEAVES = frozenset([CodeType, FrameType, GetSetDescriptorType, WrapperDescriptorType, MethodDescriptorType])
_PLAIN = frozenset([str, bytes, bytearray, bool, int, float, complex, type(None)])


def reaches(roots: Iterable[object], subject: object, closed: Iterable[object] = ()) -> bool:
    """Whether a way leads from one of the roots to the subject.

    Args:
        roots: where ways begin.
        subject: where they may lead.
        closed: what no way leads through.
    """
    seen = {id(each): each for each in closed}  # the values keep what is made here, so that no number comes twice
    ahead = deque(roots)
    while ahead:
        here = ahead.popleft()
        if here is subject:
            return True
        if type(here) in _PLAIN or id(here) in seen:
            continue
        seen[id(here)] = here
        ahead.extend(_next(here))
    return False


def held_by(frame: FrameType | None) -> Iterator[object]:
    """What a task that stands in a frame, the innermost, and goes on from there has in its hands.

    The frames of the simulator itself do not count: they only lead back to the program from where it is.
    """
    while frame is not None:
        if not frame.f_globals.get("__name__", "").startswith("cfepy."):
            yield from _named(_names_ahead(frame.f_code, frame.f_lasti), frame.f_locals, frame.f_globals)
        frame = frame.f_back


def is_private(subject: object, code: CodeType, functions: Iterable[object], closed: Iterable[object]) -> bool:
    """Whether no other code than this knows of an object: none of these functions and classes reaches it."""
    others = (each for each in functions if getattr(each, "__code__", None) is not code)
    return not reaches(others, subject, closed)


def _next(here: object) -> Iterator[object]:
    """What an object leads to; its type decides, since an object may pretend to be of another."""
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
    elif kind not in _LEAVES and not str(kind.__module__).startswith("cfepy."):
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
    """Whether the variables of a module lead to nothing of a program's own, as far as its code uses them."""
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
    """The names that are used from a place on, with those of the statement there.

    Args:
        code: what is executed.
        place: offset of the instruction that is.
    """
    instructions = list(dis.get_instructions(code))
    lines = {each.offset: _line(each) for each in instructions}
    here = lines[max(offset for offset in lines if offset <= max(place, 0))]  # within a call it is behind its start
    start = min(offset for offset, line in lines.items() if line == here)
    while (earlier := _back_from(instructions, start)) < start:
        start = earlier
    if any(each.opname in _WITH for each in instructions if each.offset < start):
        return _all_names(code)  # what leaves the block is not named again
    names: set[str] = set()
    for each in instructions:
        if each.offset >= start:
            names.update(_names_of(each.argval))
    return frozenset(names)


def _back_from(instructions: list[dis.Instruction], start: int) -> int:
    """How far what is executed from a place on goes back: to the start of the loops that it is in."""
    ahead = [each for each in instructions if each.offset >= start]
    first: int = min([start, *(each.argval for each in ahead if each.opcode in _JUMPS)])
    if not any(each.opname == "FOR_ITER" for each in ahead):
        return first
    # What a loop iterates over lies on the stack, and is named where the loop begins.
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
