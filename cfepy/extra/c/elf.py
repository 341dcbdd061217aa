"""Shared objects (ELF files): their needs and contents, read with pyelftools (the extra `cfepy[c]`)."""

from __future__ import annotations

import platform
import struct
from collections.abc import Iterator
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path, PurePath
from typing import Any

from cfepy.reading.input_files import beginning_of
from cfepy.status import UsageError

MAGIC = b"\x7fELF"
LARGEST = 1 << 30
"""Bytes of memory that a shared object may take."""
_MARK_OF_GCOV = b"GCOV_PREFIX\0"
_SYMBOL = struct.Struct("<IBBHQQ")
_RELOCATION = struct.Struct("<QQq")
_WORD = struct.Struct("<Q")
_BITS = 63
_WEAK = 2
_KINDS = {1: "STT_OBJECT", 2: "STT_FUNC", 6: "STT_TLS", 10: "STT_GNU_IFUNC"}
MACHINES = {"EM_X86_64": "x86_64", "EM_AARCH64": "aarch64"}
RELATIVE = {"x86_64": 8, "aarch64": 1027}
"""The kind of relocation that adds the object's base (R_X86_64_RELATIVE, R_AARCH64_RELATIVE)."""


def is_elf(file: Path) -> bool:
    """Return True if the file exists and is an ELF file."""
    return beginning_of(file, len(MAGIC)) == MAGIC


class ElfError(Exception):
    """A file is not a shared object for this computer."""


@dataclass(frozen=True, slots=True)
class Segment:
    """A part of the file that is loaded: `rights` are 4 read, 2 write, 1 execute."""

    offset: int
    address: int
    file_size: int
    memory_size: int
    rights: int


@dataclass(frozen=True, slots=True)
class Symbol:
    """A symbol: `is_defined` by this object; `address` counts from its base."""

    name: str
    address: int
    size: int
    is_defined: bool
    is_weak: bool
    kind: str


@dataclass(frozen=True, slots=True)
class Relocation:
    """A word to fill in: `symbol` is a number in the list of symbols."""

    address: int
    kind: int
    symbol: int
    addend: int


@dataclass(slots=True)
class SharedObject:
    """The contents of a shared object's file.

    Attributes:
        name: of its file, for errors.
        data: its bytes.
        segments: the parts that are loaded.
        symbols: those that the loader needs, by number.
        relocations: words to fill in.
        needed: libraries that it was linked with.
        functions_at_load: address of the array of functions to call after loading, and their number.
        function_at_load: address of a function to call before them, or 0.
        functions_at_end, function_at_end: the same for its end.
        headers: address of its program headers, and their number.
        unwinding: address of the table by which exceptions of C++ find frames (PT_GNU_EH_FRAME), or 0.
        thread_local: (address, bytes in the file, bytes in memory, alignment) of its thread-local variables.
    """

    name: str
    data: bytes
    machine: str = ""
    segments: list[Segment] = field(default_factory=list)
    symbols: list[Symbol] = field(default_factory=list)
    relocations: list[Relocation] = field(default_factory=list)
    needed: list[str] = field(default_factory=list)
    functions_at_load: tuple[int, int] = (0, 0)
    function_at_load: int = 0
    functions_at_end: tuple[int, int] = (0, 0)
    function_at_end: int = 0
    headers: tuple[int, int] = (0, 0)
    unwinding: int = 0
    thread_local: tuple[int, int, int, int] | None = None

    def wanted(self) -> list[str]:
        """Return the names that it needs from other objects."""
        return [each.name for each in self.symbols if each.name and not each.is_defined and not each.is_weak]

    def initial(self, address: int, size: int) -> bytes:
        """Return the bytes of the file that belong to an address."""
        for each in self.segments:
            if each.address <= address < each.address + each.memory_size:
                at = each.offset + address - each.address
                return self.data[at : at + size]
        return b""

    @property
    def has_coverage(self) -> bool:
        """Whether libgcov is linked into it, which counts executed lines."""
        return _MARK_OF_GCOV in self.data

    @property
    def size(self) -> int:
        """Bytes of memory from its base."""
        return max(each.address + each.memory_size for each in self.segments)


def check_elf_reader() -> None:
    """Check that object files can be read; call it before a build, which may take minutes.

    Raises:
        UsageError: pyelftools is not installed.
    """
    _elf_reader()


def _elf_reader() -> Any:
    try:
        from elftools.elf.elffile import ELFFile
    except ImportError:
        raise UsageError("compiled applications require pyelftools: pip install 'cfepy[c]'") from None
    return ELFFile


def elf_file(stream: BytesIO) -> Any:
    """Return an ELF file as pyelftools reads it.

    Raises:
        UsageError: pyelftools is not installed.
    """
    return _elf_reader()(stream)


def read_shared_object(data: bytes, name: str) -> SharedObject:
    """Read a shared object.

    Args:
        data: the file.
        name: of the file, for errors.

    Raises:
        ElfError: it is not a shared object, or is for another computer.
        UsageError: pyelftools is not installed.
    """
    try:
        return _read(elf_file(BytesIO(data)), data, name)
    except (ElfError, UsageError):
        raise
    except Exception as error:  # pyelftools raises many types, such as KeyError and UnicodeError
        raise ElfError(f"{name}: damaged ELF file: {error}") from error


def _read(elf: Any, data: bytes, name: str) -> SharedObject:
    machine = MACHINES.get(elf["e_machine"], str(elf["e_machine"]))
    found = f"a {elf.elfclass}-bit {'little' if elf.little_endian else 'big'}-endian file for {machine}"
    if elf.elfclass != 64 or not elf.little_endian or machine != platform.machine():
        raise ElfError(f"{name} is {found}; this computer runs 64-bit little-endian {platform.machine()}")
    if elf["e_type"] != "ET_DYN":
        raise ElfError(f"{name} is not a shared object ({elf['e_type']}); link it with -shared")
    made = SharedObject(PurePath(name).name, data, machine)
    made.headers = (elf["e_phoff"], elf["e_phnum"])
    dynamic = None
    for segment in elf.iter_segments():
        head = segment.header
        if head.p_type == "PT_LOAD":
            made.segments.append(Segment(head.p_offset, head.p_vaddr, head.p_filesz, head.p_memsz, head.p_flags & 7))
        elif head.p_type == "PT_DYNAMIC":
            dynamic = segment
        elif head.p_type == "PT_TLS":
            made.thread_local = (head.p_vaddr, head.p_filesz, head.p_memsz, head.p_align)
        elif head.p_type == "PT_GNU_EH_FRAME":
            made.unwinding = head.p_vaddr
    if dynamic is None or not made.segments:
        raise ElfError(f"{name} has no loadable segment; link it with -shared")
    _read_dynamic(made, dynamic)
    _check_bounds(made)
    return made


def _check_bounds(made: SharedObject) -> None:
    """Refuse a file with parts outside of it or of its memory, because the loader does not check them."""
    size, in_file = made.size, len(made.data)
    if size > LARGEST:
        raise ElfError(f"{made.name} requires {size:,} bytes of memory; at most {LARGEST:,} can be loaded")
    segments = all(
        each.file_size <= each.memory_size and each.offset + each.file_size <= in_file for each in made.segments
    )
    words = all(each.address + 8 <= size and each.symbol < len(made.symbols) for each in made.relocations)
    arrays = all(at + 8 * count <= size for at, count in (made.functions_at_load, made.functions_at_end))
    functions = all(each.address <= size for each in made.symbols if each.is_defined and each.kind == "STT_FUNC")
    at, initial, total, _ = made.thread_local or (0, 0, 0, 0)
    if not (segments and words and arrays and functions and initial <= total <= LARGEST and at + initial <= size):
        raise ElfError(f"{made.name}: damaged ELF file: a segment is outside the file or its memory")


def _read_dynamic(made: SharedObject, dynamic: Any) -> None:
    tags: dict[str, int] = {}
    for tag in dynamic.iter_tags():
        if tag.entry.d_tag == "DT_NEEDED":
            made.needed.append(tag.needed)
        else:
            tags.setdefault(tag.entry.d_tag, tag.entry.d_val)
    if "DT_INIT_ARRAY" in tags:
        made.functions_at_load = (tags["DT_INIT_ARRAY"], tags.get("DT_INIT_ARRAYSZ", 0) // 8)
    if "DT_FINI_ARRAY" in tags:
        made.functions_at_end = (tags["DT_FINI_ARRAY"], tags.get("DT_FINI_ARRAYSZ", 0) // 8)
    made.function_at_load = tags.get("DT_INIT", 0)
    made.function_at_end = tags.get("DT_FINI", 0)
    names = made.initial(tags["DT_STRTAB"], tags["DT_STRSZ"])
    made.symbols = list(symbols_in(made.initial(tags["DT_SYMTAB"], dynamic.num_symbols() * _SYMBOL.size), names))
    if "DT_REL" in tags:
        raise ElfError(f"{made.name} has relocations without addends (DT_REL), which are not supported")
    made.relocations += _packed(made, made.initial(tags.get("DT_RELR", 0), tags.get("DT_RELRSZ", 0)))
    for table, size in (("DT_RELA", "DT_RELASZ"), ("DT_JMPREL", "DT_PLTRELSZ")):
        raw = made.initial(tags.get(table, 0), tags.get(size, 0))
        made.relocations += [
            Relocation(at, info & 0xFFFFFFFF, info >> 32, addend) for at, info, addend in _RELOCATION.iter_unpack(raw)
        ]


def _packed(made: SharedObject, raw: bytes) -> Iterator[Relocation]:
    """Yield packed relative relocations (DT_RELR). The words to fill in contain their addends.

    An even number is the address of a word. The bits of an odd number select words among the next 63.
    """

    def at(address: int) -> Relocation:
        (addend,) = _WORD.unpack(made.initial(address, _WORD.size))
        return Relocation(address, RELATIVE[made.machine], 0, addend)

    behind = 0
    for (number,) in _WORD.iter_unpack(raw):
        if number & 1:
            yield from (at(behind + bit * _WORD.size) for bit in range(_BITS) if number >> bit + 1 & 1)
            behind += _BITS * _WORD.size
        else:
            yield at(number)
            behind = number + _WORD.size


def symbols_in(raw: bytes, names: bytes) -> Iterator[Symbol]:
    """Yield the symbols of a table. It does not use pyelftools, because there may be thousands.

    Args:
        raw: the table.
        names: the table of their names.
    """
    for name, info, _, section, address, size in _SYMBOL.iter_unpack(raw):
        text = names[name : names.index(b"\0", name)].decode(errors="replace")
        yield Symbol(text, address, size, section != 0, info >> 4 == _WEAK, _KINDS.get(info & 15, ""))
