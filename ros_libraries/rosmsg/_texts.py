"""Definitions with nested types' definitions indented below the fields, from the full text in message classes."""

from __future__ import annotations

from typing import Any

_FENCE = "=" * 80
_BUILTIN = frozenset(
    [
        "bool",
        "byte",
        "char",
        "int8",
        "uint8",
        "int16",
        "uint16",
        "int32",
        "uint32",
        "int64",
        "uint64",
        "float32",
        "float64",
        "string",
        "time",
        "duration",
    ]
)


def expanded(message_class: Any) -> str:
    """Return the definition of a message, constants first, as `rosmsg show` prints it.

    Args:
        message_class: its class.
    """
    first, *rest = message_class._full_text.split(_FENCE + "\n")
    parts = {}
    for part in rest:
        title, _, body = part.partition("\n")
        parts[title.removeprefix("MSG:").strip()] = body
    return "".join(_lines(first, message_class._type, parts, ""))


def _lines(text: str, full_name: str, parts: dict[str, str], indent: str) -> list[str]:
    package = full_name.partition("/")[0]
    constants, fields = [], []
    for line in text.splitlines():
        kind, _, rest = line.strip().partition(" ")
        name, equals, value = rest.partition("=")
        if not kind or kind.startswith("#"):
            continue
        if equals and "#" not in name:
            constants.append(
                f"{indent}{kind} {name.strip()}={value if kind == 'string' else value.partition('#')[0].strip()}\n"
            )
            continue
        nested = _nested(kind, package, parts)
        fields.append(f"{indent}{nested or kind}{_brackets(kind) if nested else ''} {rest.partition('#')[0].strip()}\n")
        if nested:
            fields += _lines(parts[nested], nested, parts, indent + "  ")
    return constants + fields


def _brackets(kind: str) -> str:
    return kind[kind.index("[") :] if "[" in kind else ""


def _nested(kind: str, package: str, parts: dict[str, str]) -> str | None:
    """Return the full name of the message type of a field; None for a plain one."""
    base = kind.partition("[")[0]
    if base in _BUILTIN:
        return None
    for name in (base, f"{package}/{base}", f"std_msgs/{base}"):
        if "/" in name and name in parts:
            return name
    return None
