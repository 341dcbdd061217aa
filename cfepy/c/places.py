"""Where in its source an address of a shared object is: function, file and line, from its symbols and debug data."""

from __future__ import annotations

from bisect import bisect_right
from functools import cached_property
from io import BytesIO
from pathlib import PurePath
from typing import Any, NamedTuple

from cfepy.c.elf import elf_file


class Place(NamedTuple):
    """A place in code; `file` is empty and `line` 0 without debug data."""

    function: str
    offset: int
    file: str = ""
    line: int = 0

    def __str__(self) -> str:
        """`CASE_Main (case.c:12)`, or `CASE_Main+0x10` without debug data."""
        return f"{self.function} ({self.name}:{self.line})" if self.file else f"{self.function}+0x{self.offset:x}"

    @property
    def name(self) -> str:
        """The file without its folders."""
        return PurePath(self.file).name


class _Row(NamedTuple):
    address: int
    file: str
    line: int


class Places:
    """The places of one shared object.

    Args:
        data: its file.
        name: of the file.
    """

    def __init__(self, data: bytes, name: str) -> None:
        self._data = data
        self._name = name

    def at(self, address: int) -> Place:
        """The place of an address, counted from the object's base."""
        number = bisect_right(self._functions, (address, "\U0010ffff"))
        start, function = self._functions[number - 1] if number else (0, self._name)
        row = self._row(address)
        return Place(function, address - start, *(row[1:] if row else ()))

    def _row(self, address: int) -> _Row | None:
        number = bisect_right(self._rows, address, key=lambda row: row.address)
        found = self._rows[number - 1] if number else None
        return found if found is not None and found.line else None

    @cached_property
    def _elf(self) -> Any:
        return elf_file(BytesIO(self._data))

    @cached_property
    def _functions(self) -> list[tuple[int, str]]:
        """Functions by address, those that are not exported too."""
        found = set()
        for section in (".symtab", ".dynsym"):
            table = self._elf.get_section_by_name(section)
            for symbol in table.iter_symbols() if table is not None else ():
                if symbol["st_info"]["type"] == "STT_FUNC" and symbol["st_shndx"] != "SHN_UNDEF":
                    found.add((symbol["st_value"], symbol.name))
        return sorted(found)

    @cached_property
    def _rows(self) -> list[_Row]:
        """The line table of all compilation units; a row of line 0 ends a stretch."""
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


def _files_of(program: Any, unit: Any) -> dict[int, str]:
    """The files of a line program, by the number that it gives them: from 0 since DWARF 5, from 1 before."""
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
