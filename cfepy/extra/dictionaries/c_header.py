"""Structs in C headers, as far as a struct of a packet is written: members of plain types, one a line or more."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import CPP_BYTES
from cfepy.status import UsageError

_COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)
_LEFT_OUT = re.compile(r"^[ \t]*#[ \t]*if[ \t]+0[ \t]*$.*?^[ \t]*#[ \t]*endif[^\n]*$", re.DOTALL | re.MULTILINE)
"""Lines that no compiler reads; they have no other directive."""
_DIRECTIVE = re.compile(r"^[ \t]*#", re.MULTILINE)
_MEMBER = re.compile(r"\s*(?:const\s+)?(?:struct\s+)?(\w+(?:\s+\w+)*?)\s+(\w+)\s*((?:\[[^\]]*\]\s*)*)$")
_NAME = re.compile(r"\s*(\w+)\s*((?:\[[^\]]*\]\s*)*)$")
"""A further member of a declaration."""
_TYPES = {
    "uint8": "u8", "int8": "i8", "uint16": "u16", "int16": "i16", "uint32": "u32", "int32": "i32", "uint64": "u64",
    "int64": "i64", "uint8_t": "u8", "int8_t": "i8", "uint16_t": "u16", "int16_t": "i16", "uint32_t": "u32",
    "int32_t": "i32", "uint64_t": "u64", "int64_t": "i64", "float": "f32", "double": "f64", "bool": "bool",
}  # fmt: skip


def header_difference(file: Path, struct: str, compiled: Sequence[tuple[str, str, int]]) -> tuple[int, str] | None:
    """Return where a struct in a header differs from a compiled one: its line and a text, or None.

    A header that is gone, or has the struct in another form, is not compared.

    Args:
        file: the header.
        struct: the name of the struct.
        compiled: name, type and number of items of the members when it was compiled; "" for an unknown type.
    """
    try:
        text = read_limited(file, CPP_BYTES).decode("utf-8", "replace")
    except (UsageError, OSError):
        return None
    found = _body(_COMMENT.sub(_blank, text), struct)
    if found is None:
        return None
    start, body = found
    members = _members(_LEFT_OUT.sub(_without_code, body))
    if not members:
        return None
    known = {name: (kind, count) for name, kind, count in compiled}
    if members[0][1] not in known and len(members) == len(known) + 1:
        members = members[1:]  # the header of the packet
    for (offset, name, kind, count), (there, _, _) in zip(members, compiled, strict=False):
        line = text.count("\n", 0, start + offset) + 1
        if name not in known:
            return line, f".{name}: is here, where {there} is"
        if name != there:
            return line, f".{name}: is here, where {there} is"
        was, items = known[name]
        if kind and was and kind != was:
            return line, f".{name}: is {kind} here, but {was}"
        if count and kind and was and not was.startswith("char") and count != items:
            return line, f".{name}: has {count} items here, but {items}"
    if len(members) != len(compiled):
        line = text.count("\n", 0, start) + 1
        return line, f": has {len(members)} members here, but {len(compiled)}"
    return None


def _body(text: str, struct: str) -> tuple[int, str] | None:
    """Return the place and the text between the braces of a struct, by its typedef or tag."""
    match = re.search(rf"\}}\s*(?:__attribute__\s*\(\(\w+\)\)\s*)?{re.escape(struct)}\s*;", text)
    if match is None:
        tag = re.search(rf"struct\s+{re.escape(struct)}\s*\{{", text)
        end = -1 if tag is None else text.find("}", tag.end())
        return None if tag is None or end < 0 else (tag.end(), text[tag.end() : end])
    start = text.rfind("{", 0, match.start())
    body = text[start + 1 : match.start()]
    return None if start < 0 or "}" in body else (start + 1, body)


def _members(body: str) -> list[tuple[int, str, str, int]]:
    """Return offset in the text, name, type ("" if unknown) and number of items (0 if unknown) of each member.

    The list is empty for a struct with other forms, such as members that a condition decides, bits and pointers.
    """
    found: list[tuple[int, str, str, int]] = []
    if _DIRECTIVE.search(body):
        return found
    at = 0
    for part in body.split(";"):
        first, *others = part.split(",")
        match = _MEMBER.match(first)
        if match is not None:
            kind = _TYPES.get(match[1].strip(), "")
            found.append((at + match.start(2), match[2], kind, _items(match[3])))
        elif part.strip():
            return []
        place = at + len(first) + 1
        for other in others:
            name = _NAME.match(other)
            if name is None or match is None:
                return []
            found.append((place + name.start(1), name[1], kind, _items(name[2])))
            place += len(other) + 1
        at += len(part) + 1
    return found


def _without_code(match: re.Match[str]) -> str:
    """Return spaces for lines that no compiler reads; other directives in them stay."""
    return match[0] if len(_DIRECTIVE.findall(match[0])) > 2 else _blank(match)


def _blank(match: re.Match[str]) -> str:
    """Return spaces for a piece of text, with its lines."""
    return re.sub(r"[^\n]", " ", match[0])


def _items(dimensions: str) -> int:
    count = 1
    for each in re.findall(r"\[([^\]]*)\]", dimensions):
        if not each.strip().isdigit():
            return 0
        count *= int(each)
    return count
