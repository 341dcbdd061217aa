"""The globals of one generated codec: structs, caches and classes under short names, and the source lines themselves.

Used by `encoder` and `decoder`. Imports nothing of cfepy.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from functools import cache
from types import CodeType
from typing import Any

from rospy_shim.genpy.rostime import Duration, Time
from rospy_shim.msgs import runtime


class Namespace:
    """Globals of generated functions, each value under one name."""

    def __init__(self) -> None:
        self.globals: dict[str, Any] = {
            "_new": object.__new__,
            "_join": b"".join,
            "_struct_error": struct.error,
            "_too_short": runtime.too_short,
            "_write_strings": runtime.write_strings,
            "_read_strings": runtime.read_strings,
            "_read_times": runtime.read_times,
            "_array_bytes": runtime.array_bytes,
            "_Time": Time,
            "_Duration": Duration,
        }
        self._names: dict[tuple[str, ...], str] = {}

    def pack(self, code: str) -> str:
        """Name of the `pack` of a format."""
        return self._named(("pack", code), lambda: struct.Struct("<" + code).pack)

    def unpack(self, code: str) -> str:
        """Name of the `unpack_from` of a format."""
        return self._named(("unpack", code), lambda: struct.Struct("<" + code).unpack_from)

    def packers(self, before: str, after: str) -> str:
        """Name of a `Packers`."""
        return self._named(("packers", before, after), lambda: runtime.Packers(before, after))

    def unpackers(self, code: str) -> str:
        """Name of an `Unpackers`."""
        return self._named(("unpackers", code), lambda: runtime.Unpackers(code))

    def cls(self, full_name: str, cls: type) -> str:
        """Name of a message class."""
        return self._named(("class", full_name), lambda: cls)

    def strings_site(self, length: int | None) -> str:
        """Name of a new memory for a list of strings; it starts with the default value, which is a true entry too."""
        site = [[""] * length, bytes(4 * length)] if length is not None else [[], bytes(4)]
        return self._named(("site", str(len(self._names))), lambda: site)

    def _named(self, key: tuple[str, ...], make: Callable[[], Any]) -> str:
        name = self._names.get(key)
        if name is None:
            name = self._names[key] = f"_{key[0]}{len(self._names)}"
            self.globals[name] = make()
        return name

    def compile(self, lines: list[str], function: str, full_name: str) -> Callable[..., Any]:
        """Run the source of one function and return it."""
        scope = self.globals
        exec(_code("\n".join(lines), f"<codec of {full_name}>"), scope)
        made: Callable[..., Any] = scope[function]
        return made


@cache
def _code(source: str, file: str) -> CodeType:
    """Code of a function; every node of a mission has message classes of its own, made of the same code."""
    return compile(source, file, "exec")


class Lines:
    """Source lines at a changing depth, and fresh names for local variables."""

    def __init__(self, depth: int = 0) -> None:
        self.lines: list[str] = []
        self.depth = depth
        self._count = 0

    def add(self, line: str) -> None:
        """Append one line at the current depth."""
        self.lines.append("    " * self.depth + line)

    def local(self, prefix: str = "v") -> str:
        """A name not used before in this function."""
        self._count += 1
        return f"{prefix}{self._count}"
