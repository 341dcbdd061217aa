"""ROS messages in XTCE, as far as it can say them: numbers, texts with their length, arrays of numbers as bytes.

An array of texts or of messages ends what can be described. What follows it is one piece of bytes as long as its place
in the packet is fixed, and is left out when it is not.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from cfepy.mission.topics import Topic, library_of
from cfepy.mission.xtce_types import TypeSet
from cfepy.msg import TLM_HEADER_SIZE

NUMBERS = {
    "bool": "bool", "char": "u8", "byte": "i8", "int8": "i8", "uint8": "u8", "int16": "i16", "uint16": "u16",
    "int32": "i32", "uint32": "u32", "int64": "i64", "uint64": "u64", "float32": "f32", "float64": "f64",
}  # fmt: skip
"""ROS type to C type."""
TIMES = {"time": ("u32", "u32"), "duration": ("i32", "i32")}
BITS = {"bool": 8}
HEADER_BYTES = 7  # of a packet's length that PKT_LEN does not count


class Part(NamedTuple):
    """A parameter of a topic's container: its name, and the name of its type."""

    name: str
    type: str


class _End(Exception):
    """What follows cannot be described."""


def topic_parts(topic: Topic, types: TypeSet, name: Callable[[str], str]) -> Iterator[Part]:
    """The parameters of a topic's packets.

    Args:
        topic: of a known type.
        types: where their types go.
        name: makes a parameter's name of a field's path.
    """
    message = _Message(library_of(topic), types, name)
    try:
        yield from message.fields(topic.type, "")
    except _End:
        if message.fixed_bytes is not None:
            intercept = 8 * (HEADER_BYTES - TLM_HEADER_SIZE - message.fixed_bytes)
            yield Part(name("rest"), types.counted_bytes("PKT_LEN", 8, intercept))


class _Message:
    """The way through a message; `fixed_bytes` is how far it is into it, None behind something of variable length."""

    def __init__(self, library: Any, types: TypeSet, name: Callable[[str], str]) -> None:
        self.fixed_bytes: int | None = 0
        self._library = library
        self._types = types
        self._name = name

    def fields(self, kind: str, path: str) -> Iterator[Part]:
        """The parameters of a message type."""
        for field in self._library.spec(kind).fields:
            inner = f"{path}.{field.name}" if path else field.name
            if field.is_array and field.length is None:
                yield from self._array(field.base, inner)
            elif field.is_array:
                for number in range(field.length):
                    yield from self._value(field.base, f"{inner}[{number}]")
            else:
                yield from self._value(field.base, inner)

    def _value(self, kind: str, path: str) -> Iterator[Part]:
        if kind in NUMBERS:
            yield self._number(NUMBERS[kind], path)
        elif kind in TIMES:
            for part, number in zip(("secs", "nsecs"), TIMES[kind], strict=True):
                yield self._number(number, f"{path}.{part}")
        elif kind == "string":
            length = self._number("u32", f"{path}.length")
            yield length
            self.fixed_bytes = None
            yield Part(self._name(path), self._types.counted_text(length.name))
        else:
            yield from self.fields(kind, path)

    def _number(self, kind: str, path: str) -> Part:
        if self.fixed_bytes is not None:
            self.fixed_bytes += _bits(kind) // 8
        return Part(self._name(path), self._types.number(kind))

    def _array(self, kind: str, path: str) -> Iterator[Part]:
        """An array of any length: its count, and its items as bytes."""
        count = self._number("u32", f"{path}.count")
        yield count
        if kind not in NUMBERS:
            raise _End
        self.fixed_bytes = None
        yield Part(self._name(path), self._types.counted_bytes(count.name, _bits(NUMBERS[kind])))


def _bits(kind: str) -> int:
    return BITS.get(kind) or int(kind[1:])
