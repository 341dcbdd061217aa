"""The environment of generated codec functions: their globals under short names, their source lines, and helpers.

Structs are cached by length, encoded lists of strings at the place that held them last. Every cached value is a pure
result, so a cache never changes the encoding or decoding of a message.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from functools import cache
from struct import Struct
from types import CodeType
from typing import Any

from rospy_shim.types.genpy.rostime import Duration, Time
from rospy_shim.types.msgs.reference import raw_array

_LENGTHS_KEPT = 256
_STRINGS_KEPT = 64
_BYTES_KEPT = 4096
_COUNT = Struct("<I")
StringSite = list[Any]
"""[list of str, its encoded form]: the last list of strings that one place in a message held."""


class Packers(dict[int, Callable[..., bytes]]):
    """`pack` of a run of fixed fields around one item of n elements, by n."""

    __slots__ = ("_after", "_before")

    def __init__(self, before: str, after: str) -> None:
        super().__init__()
        self._before, self._after = "<" + before, after

    def __missing__(self, count: int) -> Callable[..., bytes]:
        pack = Struct(f"{self._before}{count}{self._after}").pack
        if len(self) >= _LENGTHS_KEPT:
            self.clear()
        self[count] = pack
        return pack


class Unpackers(dict[int, Callable[..., tuple[Any, ...]]]):
    """`unpack_from` of an array of n elements, by n."""

    __slots__ = ("_code",)

    def __init__(self, code: str) -> None:
        super().__init__()
        self._code = code

    def __missing__(self, count: int) -> Callable[..., tuple[Any, ...]]:
        unpack = Struct(f"<{count}{self._code}").unpack_from
        if len(self) >= _LENGTHS_KEPT:
            self.clear()
        self[count] = unpack
        return unpack


def write_strings(site: StringSite, values: Any, length: int | None) -> bytes:
    """Encode a list of strings and remember it at its site.

    Args:
        site: the cache of the place.
        values: the strings.
        length: length of a fixed array, which has no count on the wire; otherwise None.

    Raises:
        TypeError: a fixed array of another length, or an item that is not a string.
    """
    parts = [] if length is not None else [_COUNT.pack(len(values))]
    if length is not None and len(values) != length:
        raise TypeError("a fixed array has the wrong length")
    for value in values:
        encoded = value.encode()
        parts += (_COUNT.pack(len(encoded)), encoded)
    raw = b"".join(parts)
    # Only true str can be found again by comparison: an object that merely compares equal must not pass.
    if type(values) is list and _worth_keeping(values, raw) and all(type(value) is str for value in values):
        site[:] = values.copy(), raw
    return raw


def read_strings(site: StringSite, data: bytes, start: int, length: int | None) -> tuple[list[str], int]:
    """Decode a list of strings and remember it at its site.

    The encoding delimits itself, so bytes that start with the remembered ones decode to the remembered list.

    Returns:
        The strings and the offset after them.
    """
    at, count = start, length
    if count is None:
        (count,) = _COUNT.unpack_from(data, at)
        at += 4
    values = []
    for _ in range(count):
        (size,) = _COUNT.unpack_from(data, at)
        at += 4 + size
        values.append(data[at - size : at].decode("utf-8", "replace"))
    # A truncated last string decodes to its available bytes, as in genpy; such a form is not complete.
    if at <= len(data) and _worth_keeping(values, data[start:at]):
        site[:] = values.copy(), data[start:at]
    return values, at


def read_times(kind: type[Time] | type[Duration], code: str, data: bytes, at: int, count: int) -> list[Any]:
    """Decode an array of times or durations, without normalising them."""
    flat = Struct(f"<{2 * count}{code}").unpack_from(data, at)
    values = []
    for secs, nsecs in zip(flat[::2], flat[1::2], strict=True):
        value = object.__new__(kind)
        value.secs, value.nsecs = secs, nsecs
        values.append(value)
    return values


def _worth_keeping(values: list[str], raw: bytes) -> bool:
    return len(values) <= _STRINGS_KEPT and len(raw) <= _BYTES_KEPT


class Namespace:
    """Globals of generated functions, each value under one name."""

    def __init__(self) -> None:
        self.globals: dict[str, Any] = {
            "_new": object.__new__,
            "_join": b"".join,
            "_write_strings": write_strings,
            "_read_strings": read_strings,
            "_read_times": read_times,
            "_raw_array": raw_array,
            "_Time": Time,
            "_Duration": Duration,
        }
        self._names: dict[tuple[str, ...], str] = {}

    def pack(self, code: str) -> str:
        """Return the name of the `pack` of a format."""
        return self._named(("pack", code), lambda: struct.Struct("<" + code).pack)

    def unpack(self, code: str) -> str:
        """Return the name of the `unpack_from` of a format."""
        return self._named(("unpack", code), lambda: struct.Struct("<" + code).unpack_from)

    def packers(self, before: str, after: str) -> str:
        """Return the name of a `Packers`."""
        return self._named(("packers", before, after), lambda: Packers(before, after))

    def unpackers(self, code: str) -> str:
        """Return the name of an `Unpackers`."""
        return self._named(("unpackers", code), lambda: Unpackers(code))

    def cls(self, full_name: str, cls: type) -> str:
        """Return the name of a message class."""
        return self._named(("class", full_name), lambda: cls)

    def strings_site(self, length: int | None) -> str:
        """Return the name of a new cache for a list of strings; it starts with the default value, which is a valid
        entry too.
        """
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
    """Return the code of a function; every node of a mission has its own message classes, made from the same code."""
    return compile(source, file, "exec")


class CodeLines:
    """Source lines at a changing depth, and fresh names for local variables."""

    def __init__(self, depth: int = 0) -> None:
        self.lines: list[str] = []
        self.depth = depth
        self._count = 0

    def add(self, line: str) -> None:
        """Append one line at the current depth."""
        self.lines.append("    " * self.depth + line)

    def local(self, prefix: str = "v") -> str:
        """Return a name not used before in this function."""
        self._count += 1
        return f"{prefix}{self._count}"
