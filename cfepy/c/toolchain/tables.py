"""Tables of compiled applications: what a C source with CFE_TBL_FILEDEF says, as a table file (elf2cfetbl's work).

The compiler has laid out the table's object; its bytes are taken from the object file as they stand.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import Any, NamedTuple

from cfepy.c.elf import MACHINES, elf_file
from cfepy.status import UsageError
from cfepy.tbl import TableImage
from cfepy.tbl import build as table_file
from cfepy.texts import from_bytes

DEFINITION = "CFE_TBL_FileDef"
LAYOUT = struct.Struct("<64s40s32s20sI")
"""CFE_TBL_FileDef_t: name of the object, full name of the table, description, name of the file, bytes."""


class TableObject(NamedTuple):
    """A table out of an object file.

    Attributes:
        file: the name of the table file.
        table: its contents.
        addresses: how many words of it are addresses, which a table file cannot have: 0 is written for them.
    """

    file: str
    table: TableImage
    addresses: int

    def write(self, folder: Path) -> Path:
        """Write the table file.

        Args:
            folder: where to.

        Returns:
            Its path.

        Raises:
            UsageError: the table's name is none.
        """
        made = folder / self.file
        made.write_bytes(table_file(self.table))
        return made


def read_table(data: bytes, source: Path) -> TableObject:
    """The table in an object file.

    Args:
        data: the object file.
        source: what it was compiled from, for errors.

    Raises:
        UsageError: it defines no table, or one that it does not have; pyelftools is not installed.
    """
    elf = elf_file(BytesIO(data))
    if elf["e_type"] != "ET_REL" or elf["e_machine"] not in MACHINES or not elf.little_endian:
        raise UsageError("was not compiled to an object file of this computer; is that a cross compiler?", file=source)
    symbols = {each.name: each for each in elf.get_section_by_name(".symtab").iter_symbols() if each.name}
    if DEFINITION not in symbols:
        raise UsageError("defines no table; end it with CFE_TBL_FILEDEF(OBJECT, APP.Table, text, file)", file=source)
    definition, _ = _bytes_of(elf, symbols[DEFINITION])
    if len(definition) != LAYOUT.size:
        text = f"{DEFINITION} has {len(definition)} bytes in place of {LAYOUT.size}"
        raise UsageError(f"{text}: it is no CFE_TBL_FileDef_t of these headers", file=source)
    *texts, size = LAYOUT.unpack(definition)
    name, table, description, file = map(from_bytes, texts)
    if name not in symbols or symbols[name]["st_shndx"] == "SHN_UNDEF":
        raise UsageError(f"CFE_TBL_FILEDEF names {name!r}, which is no object of this file", file=source)
    if not file or "/" in file:
        raise UsageError(f"CFE_TBL_FILEDEF names {file!r}, which is no name of a file", file=source)
    content, addresses = _bytes_of(elf, symbols[name])
    return TableObject(file, TableImage(table, content[:size], description), addresses)


def _bytes_of(elf: Any, symbol: Any) -> tuple[bytes, int]:
    """An object's bytes, and how many words of it the linker would fill in."""
    where, at, size = symbol["st_shndx"], symbol["st_value"], symbol["st_size"]
    if not isinstance(where, int):  # SHN_COMMON: never set
        return bytes(size), 0
    section = elf.get_section(where)
    if section["sh_type"] == "SHT_NOBITS":
        return bytes(size), 0
    addresses = sum(at <= offset < at + size for offset in _filled_in(elf, where))
    return section.data()[at : at + size], addresses


def _filled_in(elf: Any, section: int) -> Iterator[int]:
    """Offsets of words in a section that a linker would fill in."""
    for each in elf.iter_sections():
        if each["sh_type"] in ("SHT_RELA", "SHT_REL") and each["sh_info"] == section:
            yield from (relocation["r_offset"] for relocation in each.iter_relocations())
