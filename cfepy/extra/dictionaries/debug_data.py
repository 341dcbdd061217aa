"""Packets of a compiled application, from its debug data: structs, enumerators, and macros (`-g3`).

NASA's conventions connect them: the macro HS_CMD_MID is the MsgId of the commands HS_..._CC, the struct
HS_SetMaxResetsCmd_t belongs to HS_SET_MAX_RESETS_CC, and HS_HkPacket_t or HS_HkTlm_t to HS_HK_TLM_MID.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from cfepy.extra.c import CStruct, FieldType, Macros, StructField, Structs, macros_of, structs_of
from cfepy.extra.dictionaries.debug_cache import cached_content
from cfepy.extra.dictionaries.nasa_names import snake
from cfepy.extra.dictionaries.packets import DeclaredPacket, SourceContent
from cfepy.msg import CMD_HEADER_SIZE, NO_PAYLOAD, TLM_HEADER_SIZE, Layout, ValueNames, is_valid_msg_id
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import OBJECT_BYTES
from cfepy.status import UsageError

COMMAND_HEADER, TELEMETRY_HEADER = "CFE_MSG_CommandHeader", "CFE_MSG_TelemetryHeader"
_HEADERS = (COMMAND_HEADER, TELEMETRY_HEADER)
GAP = "spare_"
"""The beginning of the names of padding; the rest is its offset."""
_MID, _CODE = "_MID", "_CC"
_COMMAND_BIT = 0x1000
_CFE_6 = "CFEPY_CFE_6"
"""The macro of sources that were built for cFE 6."""
_WITH_OLD_HEADERS = (65, 67)
"""Its values where packets have headers of cFE 6."""
_OLD_HEADERS = ("CFE_SB_CmdHdr", "CFE_SB_TlmHdr", "CCSDS_CmdPkt", "CCSDS_TlmPkt", "CCSDS_Command", "CCSDS_Telemetry")
_OLD_TELEMETRY = 12
_FIRST = ("CFE_", "OS_", "CCSDS_")
"""Macros of cFE itself, which are in every application."""
_ENDS = re.compile(r"(CMD|COMMAND|TLM|PKT|PACKET|MSG|TELEMETRY|T)$")
_SAME = (("HOUSEKEEPING", "HK"),)
_WITHOUT_PAYLOAD = ("NOOP", "RESET", "RESET_COUNTERS", "RESET_CNTRS", "SEND_HK")
"""Commands that have no payload in NASA's applications, whether or not they have a struct."""
_NO_FIELD = StructField("", 0, FieldType("", (), 0))
_BYTES = {"union": "u8", "pointer": "u8"}


def read_debug_data(libraries: Iterable[Path]) -> SourceContent:
    """Return the packets of compiled applications.

    Args:
        libraries: their files; one without debug data declares nothing.
    """
    libraries = tuple(libraries)
    content = SourceContent("debug data")
    for library in libraries:
        try:
            data = read_limited(library, OBJECT_BYTES)
        except (UsageError, OSError):
            continue  # `cfepy check` reports the error
        found = cached_content(data, partial(_content_of, data, library))
        content.packets += [replace(packet, library=library) for packet in found.packets]
        content.names = found.names | content.names
    content.layout = partial(_struct_of, libraries)
    return content


def _struct_of(libraries: Iterable[Path], name: str) -> Layout | None:
    """Return a struct of the first library that has it."""
    for library in libraries:
        try:
            struct = structs_of(read_limited(library, OBJECT_BYTES)).find(name)
        except (UsageError, OSError):
            continue
        if struct is not None:
            return layout_of(struct)
    return None


def _content_of(data: bytes, library: Path) -> SourceContent:
    content = SourceContent("debug data")
    macros = macros_of(data)
    if not all(each.startswith(_FIRST) for each in macros.names(_MID)):
        _Application(library, macros, structs_of(data), content).read()
    return content


class _Application:
    """A compiled application: its file, its macros and structs."""

    def __init__(self, library: Path, macros: Macros, structs: Structs, content: SourceContent) -> None:
        self._library = library
        self._macros = macros
        self._structs = structs
        self._content = content
        self._constants = structs.enumerators()
        self._names = structs.struct_names()
        self._functions = structs.function_names()
        self._is_cfe_6 = macros.value(_CFE_6, self._constants) in _WITH_OLD_HEADERS

    def read(self) -> None:
        """Add its packets to the content."""
        mids = {name: value for name, value in self._values(_MID) if is_valid_msg_id(value)}
        codes = dict(self._values(_CODE))
        for name, msg_id in mids.items():
            short = name.removesuffix(_MID)
            owner = self._owner(short)
            if owner is None:
                continue
            self._content.names.setdefault(msg_id, short)
            if not msg_id & _COMMAND_BIT:
                self._add(short, msg_id, None, self._struct(owner, short, TELEMETRY_HEADER))
            elif short == f"{owner}_CMD":
                self._add_commands(owner, msg_id, codes)
            else:
                self._add(short, msg_id, None, self._command_struct(owner, short))

    def _values(self, suffix: str) -> list[tuple[str, int]]:
        names = [name for name in self._macros.names(suffix) if not name.startswith(_FIRST)]
        found = [(name, self._macros.value(name, self._constants)) for name in names]
        return [(name, value) for name, value in found if value is not None]

    def _owner(self, name: str) -> str | None:
        """Return the application of a MsgId: the longest beginning of its name that structs of the file have."""
        parts = name.split("_")
        for end in range(len(parts) - 1, 0, -1):
            owner = "_".join(parts[:end])
            if any(each.startswith(f"{owner}_") for each in self._names):
                return owner
        return None

    def _add_commands(self, owner: str, msg_id: int, codes: Mapping[str, int]) -> None:
        for name, code in codes.items():
            if name.startswith(f"{owner}_") and 0 <= code < 128:
                short = name.removesuffix(_CODE)
                self._add(short, msg_id, code, self._command_struct(owner, short))

    def _command_struct(self, owner: str, name: str) -> CStruct | None:
        struct = self._struct(owner, name, COMMAND_HEADER)
        if struct is None and name.removeprefix(f"{owner}_") in _WITHOUT_PAYLOAD:
            return CStruct("", 0, (_NO_FIELD,), (COMMAND_HEADER,))
        return struct

    def _header_of(self, struct: CStruct) -> str | None:
        """Return the header with which a struct begins; for cFE 6 that may be an array of bytes."""
        found = header_of(struct)
        return old_header_of(struct) if found is None and self._is_cfe_6 else found

    def _struct(self, owner: str, name: str, header: str) -> CStruct | None:
        """Return the struct of a packet.

        It is the one with the same name without underscores and endings, or to which the function of that name gets a
        pointer; otherwise the struct of the only function that has all words of the name and the fewest others.
        """
        wanted = _key(name.removeprefix(f"{owner}_"))
        for find, names in ((self._structs.find, self._names), (self._structs.argument_of, self._functions)):
            for each in names:
                if each.startswith(f"{owner}_") and _key(snake(each.removeprefix(f"{owner}_"))) == wanted:
                    struct = find(each)
                    if struct is not None and self._header_of(struct) == header:
                        return struct
        words = _words_of(name.removeprefix(f"{owner}_"))
        alike: dict[int, list[CStruct]] = {}
        for each in self._functions:
            more = _words_of(snake(each.removeprefix(f"{owner}_"))) - words if each.startswith(f"{owner}_") else None
            if more is None or not words <= _words_of(snake(each.removeprefix(f"{owner}_"))):
                continue
            struct = self._structs.argument_of(each)
            if struct is not None and self._header_of(struct) == header:
                alike.setdefault(len(more), []).append(struct)
        best = alike[min(alike)] if alike else []
        return best[0] if len(best) == 1 else None

    def _add(self, name: str, msg_id: int, code: int | None, struct: CStruct | None) -> None:
        if struct is None:
            return
        payload, inner = payload_of(struct)
        if payload is None:
            return
        place = self._structs.place_of(inner or struct.name) or self._structs.place_of(struct.name)
        file, line = (self._library, 0) if place is None else (Path(place.file), place.line)
        structs = tuple(each for each in (struct.name, inner) if each)
        is_command = bool(msg_id & _COMMAND_BIT)
        header_size = struct.fields[0].type.size if struct.fields and not is_command else TLM_HEADER_SIZE
        self._content.packets.append(
            DeclaredPacket(
                name, msg_id, payload, is_command, file, line, code, structs=structs, header_size=header_size
            )
        )


def _words_of(name: str) -> set[str]:
    """Return the words of a name, in the singular and without endings."""
    return {word.removesuffix("S") for word in name.split("_")} - {"CMD", "TLM", "PKT", ""}


def _key(name: str) -> str:
    """Return the common part of the names of a macro and of its struct."""
    short = name.replace("_", "")
    for long, other in _SAME:
        short = short.replace(long, other)
    while (found := _ENDS.sub("", short)) != short and found:
        short = found
    return short


def header_of(struct: CStruct) -> str | None:
    """Return the header with which a struct begins, or None if it is not a packet."""
    if not struct.fields:
        return None
    base = struct.fields[0].type.base
    names = (struct.typedefs[0], "" if isinstance(base, str) else base.name)
    return next((name.removesuffix("_t") for name in names if name.removesuffix("_t") in _HEADERS), None)


def old_header_of(struct: CStruct) -> str | None:
    """Return the header with which a struct of cFE 6 begins, such as `uint8 TlmHeader[CFE_SB_TLM_HDR_SIZE]`."""
    if not struct.fields:
        return None
    first = struct.fields[0]
    base = first.type.base
    is_header = first.type.counts and base == "u8" and "H" in first.name
    typedef = struct.typedefs[0] if isinstance(base, str) else struct.typedefs[0] or base.name
    if is_header or typedef.startswith(_OLD_HEADERS):
        return {CMD_HEADER_SIZE: COMMAND_HEADER, _OLD_TELEMETRY: TELEMETRY_HEADER}.get(first.type.size)
    return None


def payload_of(struct: CStruct) -> tuple[Layout | None, str]:
    """Return the layout of a packet after its header, and the name of the struct that it is, if it is one.

    The layout is None for a struct that has no such layout, such as one with bit fields.
    """
    header, *rest = struct.fields
    start = header.offset + header.type.size
    if not rest:
        return NO_PAYLOAD, ""
    if len(rest) == 1 and not isinstance(rest[0].type.base, str) and not rest[0].type.counts:
        inner = rest[0].type.base
        return layout_of(inner), inner.name
    moved = tuple(each._replace(offset=each.offset - start) for each in rest)
    return layout_of(CStruct(struct.name, struct.size - start, moved, struct.typedefs[1:])), ""


def layout_of(struct: CStruct) -> Layout | None:
    """Return a struct as a layout; None if it has another one than C's types give it."""
    fields: list[tuple[str, object]] = []
    for each in struct.fields:
        kind = _type_of(each.type)
        if kind is None or not each.name:
            return None
        fields.append((each.name, kind))
    try:
        layout = Layout(struct.name, fields)
        if layout.size != struct.size or any(layout.offsets[each.name] != each.offset for each in struct.fields):
            layout = Layout(struct.name, list(_with_gaps(struct, fields)), packed=True)
    except UsageError:
        return None
    fits = all(layout.offsets[each.name] == each.offset for each in struct.fields)
    return layout if fits and layout.size == struct.size else None


def _with_gaps(struct: CStruct, fields: Sequence[tuple[str, object]]) -> Iterator[tuple[str, object]]:
    """Yield the fields of a struct, and bytes for its padding, which the bytes of a union do not bring about."""
    at = 0
    for each, field in zip(struct.fields, fields, strict=True):
        if each.offset > at:
            yield f"{GAP}{at}", f"u8[{each.offset - at}]"
        yield field
        at = each.offset + each.type.size
    if struct.size > at:
        yield f"{GAP}{at}", f"u8[{struct.size - at}]"


def _type_of(kind: FieldType) -> object | None:
    """Return the type of a field for a layout; a union or a pointer is bytes."""
    base: object | None
    if isinstance(kind.base, CStruct):
        base = layout_of(kind.base)
        base = f"u8[{kind.base.size}]" if base is None else base
        if isinstance(base, str):
            return f"u8[{kind.size}]"
    elif kind.base in _BYTES:
        return f"u8[{kind.size}]" if kind.size else None
    else:
        base = kind.base
    if isinstance(base, str) and not re.fullmatch(r"[uif]\d+|bool|char", base):
        return None
    if kind.names and isinstance(base, str) and base[0] in "ui":
        base = ValueNames.of(base, _without_prefix(dict(kind.names)))
    if base == "char":
        return "char" + "".join(f"[{count}]" for count in kind.counts)
    for count in reversed(kind.counts):
        base = (base, count)
    return base


def _without_prefix(names: dict[str, int]) -> dict[str, int]:
    """Return enumerators without the words that all of them begin with: TANK_MODE_OFF, TANK_MODE_ON are OFF, ON."""
    words = [name.split("_") for name in names]
    shared = 0
    while len(names) > 1 and all(len(each) > shared + 1 and each[shared] == words[0][shared] for each in words):
        shared += 1
    return {"_".join(each[shared:]): value for each, value in zip(words, names.values(), strict=True)}
