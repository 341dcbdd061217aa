"""The source place of an address of a shared object: function, file and line, from its symbols and debug data.

Tracebacks, the stall watch, debuggers and timelines look at frames of Python. So calls and exceptions of C code go
through frames that look like these places.
"""

from __future__ import annotations

import ast
import re
import sys
from bisect import bisect_right
from collections.abc import Callable, Collection, Iterator, Sequence
from functools import lru_cache, partial
from io import BytesIO
from pathlib import PurePath
from struct import Struct
from types import CodeType, FunctionType
from typing import Any, NamedTuple, NoReturn

from cfepy.extra.c.elf import SharedObject, elf_file, symbols_in
from cfepy.interpreter.cached import CachedProperty

SEARCHED_MACHINE = "x86_64"
SLOTS = (".plt", ".plt.sec", ".plt.got")
SLOT_BYTES = 16
_OFFSET = Struct("<i")
_JUMP = re.compile(rb"\xff\x25....", re.DOTALL)
_DIRECT = re.compile(rb"(?=([\xe8\xe9]....))", re.DOTALL)
_INDIRECT = re.compile(rb"(?=\xff([\x15\x25]....))", re.DOTALL)


class CodePlace(NamedTuple):
    """A place in code of a shared object; `file` is empty and `line` 0 without debug data."""

    function: str
    offset: int
    file: str = ""
    line: int = 0
    object: str = ""

    def __str__(self) -> str:
        """Return `CASE_Main (case.c:12)`, or `CASE_Main+0x10` without debug data."""
        return f"{self.function} ({self.name}:{self.line})" if self.file else f"{self.function}+0x{self.offset:x}"

    def without_line(self) -> CodePlace:
        """Return the place for a traceback without a line number: `File "case.so", line 0, in CASE_Main+0x10`."""
        return CodePlace(f"{self.function}+0x{self.offset:x}", 0, self.object)

    @property
    def name(self) -> str:
        """The file without its folders."""
        return PurePath(self.file).name


class _Row(NamedTuple):
    address: int
    file: str
    line: int


class Places:
    """The places of one shared object; use `places_of`.

    Args:
        data: its file.
        name: of the file.
    """

    def __init__(self, data: bytes, name: str) -> None:
        self._data = data
        self._name = name

    def at(self, address: int) -> CodePlace:
        """Return the place of an address, counted from the object's base."""
        number = bisect_right(self._functions, (address, "\U0010ffff"))
        start, function = self._functions[number - 1] if number else (0, self._name)
        row = self._row(address)
        return CodePlace(function, address - start, *(row[1:] if row else ("", 0)), self._name)

    def variable_at(self, address: int) -> str:
        """Return the variable of an address, counted from the object's base; empty if it is not known."""
        number = bisect_right(self._variables, (address, sys.maxsize, ""))
        start, size, name = self._variables[number - 1] if number else (0, 0, "")
        return name if start <= address < start + size else ""

    def _row(self, address: int) -> _Row | None:
        number = bisect_right(self._rows, address, key=lambda row: row.address)
        found = self._rows[number - 1] if number else None
        return found if found is not None and found.line else None

    @CachedProperty
    def _elf(self) -> Any:
        return elf_file(BytesIO(self._data))

    @CachedProperty
    def _functions(self) -> list[tuple[int, str]]:
        """Functions by address, including those that are not exported."""
        return [(start, name) for start, _, name in self._symbols("STT_FUNC")]

    @CachedProperty
    def _variables(self) -> list[tuple[int, int, str]]:
        """Variables: address, bytes, name."""
        return self._symbols("STT_OBJECT")

    def _symbols(self, kind: str) -> list[tuple[int, int, str]]:
        found: set[tuple[int, int, str]] = set()
        for section in (".symtab", ".dynsym"):
            table = self._elf.get_section_by_name(section)
            if table is not None:
                names = self._elf.get_section(table["sh_link"]).data()
                found.update(
                    (each.address, each.size, each.name)
                    for each in symbols_in(table.data(), names)
                    if each.kind == kind and each.is_defined
                )
        return sorted(found)

    @CachedProperty
    def _rows(self) -> list[_Row]:
        """The line table of all compilation units; a row of line 0 ends a range."""
        if not self._elf.has_dwarf_info():
            return []
        rows = []
        dwarf = self._elf.get_dwarf_info()
        for unit in dwarf.iter_CUs():
            program = dwarf.line_program_for_CU(unit)
            if program is None:
                continue
            files = _files_of(program, unit)
            for entry in program.get_entries():
                state = entry.state
                if state is not None:
                    line = 0 if state.end_sequence else state.line
                    rows.append(_Row(state.address, files.get(state.file, ""), line))
        rows.sort(key=lambda row: (row.address, row.line == 0))
        return rows


@lru_cache(32)
def places_of(data: bytes, name: str) -> Places:
    """Return the places of a shared object, read once for all its copies, because each explored run loads it anew.

    Args:
        data: its file.
        name: of the file.
    """
    return Places(data, name)


def _files_of(program: Any, unit: Any) -> dict[int, str]:
    """Return the files of a line program, by its numbers for them: from 0 since DWARF 5, from 1 before."""
    header = program.header
    folders = [_text(each) for each in header["include_directory"]]
    first = 0 if header["version"] >= 5 else 1
    if first:
        built_in = unit.get_top_DIE().attributes.get("DW_AT_comp_dir")
        folders.insert(0, _text(built_in.value) if built_in is not None else "")
    return {
        number: str(PurePath(folders[each.dir_index] if each.dir_index < len(folders) else "") / _text(each.name))
        for number, each in enumerate(header["file_entry"], first)
    }


def _text(raw: bytes | str) -> str:
    return raw if isinstance(raw, str) else raw.decode(errors="replace")


# -- calls of other objects --------------------------------------------------------------------------------------------
#
# A call of a function of another object goes to a slot of the procedure linkage table. The slot jumps to the address in
# a word that the loader fills in. So a call with the address of the slot, or through the word, calls that function.


def first_calls(source: SharedObject, names: Collection[str]) -> dict[str, CodePlace]:
    """Return the first place in a shared object that calls each function.

    Args:
        source: the shared object.
        names: the functions; those without a place in the debug data are left out. Only code for x86-64 is searched.
    """
    found: dict[str, CodePlace] = {}
    if not names or source.machine != SEARCHED_MACHINE:
        return found
    words = {
        each.address: source.symbols[each.symbol].name
        for each in source.relocations
        if each.symbol and source.symbols[each.symbol].name in names
    }
    places = places_of(source.data, source.name)
    for address, name in _calls(source, words):
        place = places.at(address)
        if name not in found and place.file:
            found[name] = place
    return found


def _calls(source: SharedObject, words: dict[int, str]) -> Iterator[tuple[int, str]]:
    """Yield the address of each call, and the function.

    Args:
        source: the shared object.
        words: the functions by the addresses of the words that the loader fills in.
    """
    sections = {each.name: each for each in elf_file(BytesIO(source.data)).iter_sections()}
    slots = {}
    for name in SLOTS:
        if name in sections:
            start, code = sections[name]["sh_addr"], sections[name].data()
            for jump in _JUMP.finditer(code):
                (offset,) = _OFFSET.unpack_from(code, jump.start() + 2)
                function = words.get(start + jump.end() + offset)
                if function is not None:
                    slots[start + jump.start() // SLOT_BYTES * SLOT_BYTES] = function
    for name, section in sections.items():
        if name.startswith(".text"):
            start, code = section["sh_addr"], section.data()
            found = []
            for pattern, targets in ((_DIRECT, slots), (_INDIRECT, words)):
                for call in pattern.finditer(code):
                    (offset,) = _OFFSET.unpack_from(code, call.start(1) + 1)
                    function = targets.get(start + call.end(1) + offset)
                    if function is not None:
                        found.append((start + call.start(), function))
            yield from sorted(found)


# -- frames ------------------------------------------------------------------------------------------------------------


Watch = Callable[[float, int], object]
"""Called with the seconds of computation without a call, and the return address of the last call."""


Call = Callable[..., object]
"""Called with a function and its arguments; calls it."""


class PreemptedFrames(dict[int, Watch]):
    """Functions that the engine calls while C code computes without a call, by the current address of the code.

    Each function looks like the place of that address. So Python code that looks at the thread, such as the stall
    watch, finds the place.

    Args:
        place_of: returns the place of an address, if it is known.
        watch: each function calls it.
    """

    def __init__(self, place_of: Callable[[int], CodePlace | None], watch: Watch) -> None:
        super().__init__()
        self._place_of = place_of
        self._watch = watch

    def __missing__(self, address: int) -> Watch:
        function: Watch = _seen_as(self._place_of(address), _WATCH, {"watch": self._watch}) or self._watch
        self[address] = function
        return function


CallHeard = Callable[[str, tuple[object, ...]], object]
"""Called with the place of a call and its arguments."""


def _call(function: Call, *args: object) -> object:
    return function(*args)


class CallFrames(dict[int, Call]):
    """Functions through which the engine calls the API, by the address of the call, for tools that look at frames.

    Args:
        place_of: returns the place of an address, if it is known.
        heard: gets the place and the arguments of each call whose place is known; None for no observer.
    """

    def __init__(self, place_of: Callable[[int], CodePlace | None], heard: CallHeard | None = None) -> None:
        super().__init__()
        self._place_of = place_of
        self._heard = heard

    def __missing__(self, address: int) -> Call:
        place = self._place_of(address)
        if self._heard is None or place is None:
            function: Call | None = _seen_as(place, _CALL, {})
        else:
            function = _seen_as(place, _HEARD_CALL, {"heard": partial(self._heard, f"{place.file}:{place.line}")})
        made = self[address] = function or _call
        return made


def raise_at(calls: Sequence[CodePlace], error: BaseException) -> NoReturn:
    """Raise an error from frames that look like places of C, without its earlier traceback.

    Args:
        calls: the places, the outermost first; without debug data the frames show functions of the object.
        error: the error.

    Raises:
        BaseException: the error.
    """
    if calls:
        *outer, last = (each if each.file else each.without_line() for each in calls)
        first, *others = [*(_function(each, _CALL, {}) for each in outer), _function(last, _RAISE, {})]
        first(*others, error)
    raise error from None


def _seen_as(place: CodePlace | None, code: CodeType, names: dict[str, object]) -> FunctionType | None:
    """Return a function of this code that looks like a place; None for a place that is not known."""
    return None if place is None or not place.file else _function(place, code, names)


def _function(place: CodePlace, code: CodeType, names: dict[str, object]) -> FunctionType:
    return FunctionType(_renamed(code, place.function, place.file, place.line), names)


@lru_cache(1024)
def _renamed(code: CodeType, function: str, file: str, line: int) -> CodeType:
    return code.replace(co_name=function, co_qualname=function, co_filename=file, co_firstlineno=line)


def _code(source: str) -> CodeType:
    """Return the code of a function, all on its first line with its full width, so that tracebacks mark no part."""
    tree = ast.parse(source)
    for node in ast.walk(tree):
        if isinstance(node, ast.expr | ast.stmt | ast.arg):
            node.lineno, node.col_offset, node.end_lineno, node.end_col_offset = 1, 0, 2, 0
    [function] = (each for each in compile(tree, "", "exec").co_consts if isinstance(each, CodeType))
    return function


_WATCH = _code("def frame(computed_s, called_from): return watch(computed_s, called_from)")
_CALL = _code("def frame(function, *args): return function(*args)")
_HEARD_CALL = _code("def frame(function, *args): heard(args); return function(*args)")
_RAISE = _code("def frame(error): raise error from None")
