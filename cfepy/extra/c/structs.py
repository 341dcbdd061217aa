"""Types of a shared object, as its debug data (DWARF) describes them: size, and name, offset and type of fields.

Types have the words of `cfepy.msg.Layout`: u16, f32, bool, char. An enumeration is the integer that holds it. A union,
a bit field or a pointer has no such type, so it has the name of its kind.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from functools import lru_cache
from io import BytesIO
from typing import Any, NamedTuple

from cfepy.extra.c.elf import elf_file

_TRANSPARENT = ("DW_TAG_typedef", "DW_TAG_const_type", "DW_TAG_volatile_type", "DW_TAG_atomic_type")
_STRUCTS = ("DW_TAG_structure_type", "DW_TAG_class_type")
_BOOLEAN, _FLOAT, _SIGNED, _SIGNED_CHAR, _UNSIGNED, _UNSIGNED_CHAR = 2, 4, 5, 6, 7, 8
_LETTERS = {_FLOAT: "f", _SIGNED: "i", _SIGNED_CHAR: "i", _UNSIGNED: "u", _UNSIGNED_CHAR: "u"}
_OTHERS = {"DW_TAG_union_type": "union", "DW_TAG_pointer_type": "pointer"}
BIT_FIELD = "bit field"


class FieldType(NamedTuple):
    """The type of a field: a word or a struct, and the lengths of an array from the outermost.

    `names` are the enumerators of an enumeration and their values.
    """

    base: str | CStruct
    counts: tuple[int, ...]
    size: int
    names: tuple[tuple[str, int], ...] = ()

    def __str__(self) -> str:
        base = self.base if isinstance(self.base, str) else self.base.name
        return base + "".join(f"[{count}]" for count in self.counts)


class StructField(NamedTuple):
    """A field of a struct, with its offset in bytes."""

    name: str
    offset: int
    type: FieldType


class CStruct(NamedTuple):
    """A struct: its name, its bytes, its fields in order, and the typedefs of the types of its fields."""

    name: str
    size: int
    fields: tuple[StructField, ...]
    typedefs: tuple[str, ...]

    def field(self, name: str) -> StructField | None:
        """Return a field by its name, or None."""
        return next((each for each in self.fields if each.name == name), None)


class StructPlace(NamedTuple):
    """Where a struct is declared: the source file as the compiler saw it, and the line."""

    file: str
    line: int


class Structs:
    """The types of one shared object by name; use `structs_of`. Debug data is read as far as a name needs it.

    Args:
        data: the bytes of its file.
    """

    def __init__(self, data: bytes) -> None:
        self._entries: dict[str, Any] = {}
        self._read: dict[int, CStruct] = {}
        self._enumerators: dict[str, int] = {}
        self._functions: dict[str, Any] = {}
        self._unread = _named(data, self._enumerators, self._functions)

    @property
    def has_debug_data(self) -> bool:
        """Whether the debug data has any type."""
        return bool(self._entries) or self._next() is not None

    def struct_names(self) -> list[str]:
        """Return the names of all structs, tags and typedefs."""
        while self._next() is not None:
            pass
        return [name for name, entry in self._entries.items() if _behind(entry).tag in _STRUCTS]

    def enumerators(self) -> dict[str, int]:
        """Return the values of all enumerators by name."""
        while self._next() is not None:
            pass
        return self._enumerators

    def function_names(self) -> list[str]:
        """Return the names of all functions."""
        while self._next() is not None:
            pass
        return list(self._functions)

    def argument_of(self, function: str) -> CStruct | None:
        """Return the struct to which the first argument of a function points; None for another argument."""
        entry = self._functions.get(function)
        try:
            children = () if entry is None else entry.iter_children()
            first = next((each for each in children if each.tag == "DW_TAG_formal_parameter"), None)
            pointer = None if first is None else _behind(first.get_DIE_from_attribute("DW_AT_type"))
            if pointer is None or pointer.tag != "DW_TAG_pointer_type":
                return None
            outer = pointer.get_DIE_from_attribute("DW_AT_type")
            while not _text(outer) and outer.tag in _TRANSPARENT:
                outer = outer.get_DIE_from_attribute("DW_AT_type")
            return self._struct(_behind(outer), _text(outer)) if _behind(outer).tag in _STRUCTS else None
        except Exception:  # as in `find`
            return None

    def place_of(self, name: str) -> StructPlace | None:
        """Return where a struct is declared; None if that is not known."""
        entry = self._entry(name)
        try:
            return None if entry is None else _place(_behind(entry)) or _place(entry)
        except Exception:  # as in `find`
            return None

    def find(self, name: str) -> CStruct | None:
        """Return a struct by its typedef or tag; None if there is none, or its description is damaged."""
        entry = self._entry(name)
        try:
            return None if entry is None else self._struct(_behind(entry), name)
        except Exception:  # debug data may be damaged: pyelftools raises errors of many types
            return None

    def size_of(self, name: str) -> int:
        """Return the bytes of a type; 0 if that is not known."""
        entry = self._entry(name)
        try:
            return 0 if entry is None else _size(_behind(entry))
        except Exception:  # as above
            return 0

    def _entry(self, name: str) -> Any:
        while name not in self._entries:
            if self._next() is None:
                return None
        return self._entries[name]

    def _next(self) -> Any:
        """Read on to the next type that has a name; the first definition of a name stays."""
        try:
            name, entry = next(self._unread, (None, None))
        except Exception:  # as above
            return None
        if name is not None:
            self._entries.setdefault(name, entry)
        return entry

    def _struct(self, entry: Any, name: str) -> CStruct:
        known = self._read.get(entry.offset)
        if known is None:
            members = [each for each in entry.iter_children() if each.tag == "DW_TAG_member"]
            fields = tuple(StructField(_text(each), _offset(each), self._type(each)) for each in members)
            typedefs = tuple(_text(each.get_DIE_from_attribute("DW_AT_type")) for each in members)
            known = CStruct(name, _size(entry), fields, typedefs)
            self._read[entry.offset] = known
        return known

    def _type(self, holder: Any) -> FieldType:
        """Return the type that a member, a typedef or an array refers to."""
        if {"DW_AT_bit_size", "DW_AT_data_bit_offset"} & set(holder.attributes):
            return FieldType(BIT_FIELD, (), 0)
        entry = holder.get_DIE_from_attribute("DW_AT_type")
        outer, entry = _text(entry), _behind(entry)
        name = outer or _text(entry)
        if entry.tag == "DW_TAG_array_type":
            counts = tuple(_count(each) for each in entry.iter_children() if each.tag == "DW_TAG_subrange_type")
            item = self._type(entry)
            size = item.size
            for count in counts:
                size *= count
            return FieldType(item.base, counts + item.counts, size, item.names)
        size = _size(entry)
        if entry.tag in _STRUCTS:
            return FieldType(self._struct(entry, name or "struct"), (), size)
        return FieldType(_word(entry, size), (), size, _enumerators(entry))


def _enumerators(entry: Any) -> tuple[tuple[str, int], ...]:
    """Return the enumerators of an enumeration; none for another type."""
    if entry.tag != "DW_TAG_enumeration_type":
        return ()
    children = [each for each in entry.iter_children() if "DW_AT_const_value" in each.attributes]
    return tuple((_text(each), int(each.attributes["DW_AT_const_value"].value)) for each in children)


def _word(entry: Any, size: int) -> str:
    """Return the word for a type that is no array and no struct."""
    if entry.tag == "DW_TAG_enumeration_type":
        values = [each.attributes["DW_AT_const_value"].value for each in entry.iter_children()]
        return f"{'i' if min(values, default=0) < 0 else 'u'}{8 * size}"
    if entry.tag != "DW_TAG_base_type":
        return _OTHERS.get(entry.tag, "another type")
    encoding = int(entry.attributes["DW_AT_encoding"].value)
    if encoding == _BOOLEAN:
        return "bool"
    if _text(entry) == "char":
        return "char"
    return f"{_LETTERS.get(encoding, 'a type of ')}{8 * size}"


def _named(data: bytes, enumerators: dict[str, int], functions: dict[str, Any]) -> Iterator[tuple[str, Any]]:
    """Yield the complete types of all units, by typedef or tag.

    Args:
        data: the bytes of the file.
        enumerators: receives the enumerators on the way,
        functions: and the functions that are defined.
    """
    elf = elf_file(BytesIO(data))
    for unit in elf.get_dwarf_info().iter_CUs() if elf.has_dwarf_info() else ():
        for entry in unit.get_top_DIE().iter_children():
            if entry.tag == "DW_TAG_enumeration_type":
                for each in entry.iter_children():
                    if "DW_AT_const_value" in each.attributes:
                        enumerators.setdefault(_text(each), int(each.attributes["DW_AT_const_value"].value))
            if entry.tag == "DW_TAG_subprogram" and "DW_AT_low_pc" in entry.attributes:
                functions.setdefault(_text(entry), entry)
            is_type = entry.tag in _TRANSPARENT or "DW_AT_byte_size" in entry.attributes
            if is_type and "DW_AT_name" in entry.attributes:
                yield _text(entry), entry


def _behind(entry: Any) -> Any:
    """Return the type behind typedefs and qualifiers."""
    while entry.tag in _TRANSPARENT and "DW_AT_type" in entry.attributes:
        entry = entry.get_DIE_from_attribute("DW_AT_type")
    return entry


def _place(entry: Any) -> StructPlace | None:
    """Return the declaration of a type, by the table of files of its unit."""
    if not {"DW_AT_decl_file", "DW_AT_decl_line"} <= entry.attributes.keys():
        return None
    unit = entry.cu
    program = unit.dwarfinfo.line_program_for_CU(unit)
    if program is None:
        return None
    header = program.header
    first = 0 if header["version"] >= 5 else 1
    file = header["file_entry"][int(entry.attributes["DW_AT_decl_file"].value) - first]
    folders = header["include_directory"]
    folder = folders[file.dir_index - first] if file.dir_index >= first else b""
    compiled_in = unit.get_top_DIE().attributes.get("DW_AT_comp_dir")
    base = b"" if compiled_in is None else compiled_in.value
    path = os.path.normpath(os.path.join(base, folder, file.name))
    return StructPlace(os.fsdecode(path), int(entry.attributes["DW_AT_decl_line"].value))


def _size(entry: Any) -> int:
    size = entry.attributes.get("DW_AT_byte_size")
    return 0 if size is None else int(size.value)


def _text(entry: Any) -> str:
    name = entry.attributes.get("DW_AT_name")
    return "" if name is None else name.value.decode(errors="replace")


def _offset(member: Any) -> int:
    place = member.attributes.get("DW_AT_data_member_location")
    return 0 if place is None else int(place.value)


def _count(subrange: Any) -> int:
    if "DW_AT_count" in subrange.attributes:
        return int(subrange.attributes["DW_AT_count"].value)
    bound = subrange.attributes.get("DW_AT_upper_bound")
    return 0 if bound is None else int(bound.value) + 1


@lru_cache(64)  # a mission may boot many times in a process
def structs_of(data: bytes) -> Structs:
    """Return the structs of a shared object.

    Args:
        data: the bytes of its file.
    """
    return Structs(data)
