"""A message on its way to clients: in JSON, as the pixels of a PNG, or in CBOR (ROSBRIDGE_PROTOCOL.md 3.4).

It is made once for all clients that want the same form. A JSON text in UTF-8 fills a PNG with three bytes a pixel,
about as wide as high; newlines fill the rest of it (W3C PNG). In CBOR, numbers, texts, maps and lists are CBOR's own
(RFC 8949). uint8[] is a byte string. An array of other numbers is a byte string of little-endian numbers, under a tag
for the type (RFC 8746).
"""

from __future__ import annotations

import json
import struct
import zlib
from base64 import b64encode
from math import isqrt
from typing import Any, NamedTuple

from cfepy.extra.viewers.rosbridge.json_values import json_values
from cfepy.extra.viewers.rosbridge.sending import CBOR, CBOR_RAW, PNG
from rospy_shim.types.genpy import DeserializationError, Message
from rospy_shim.types.msgs import MessageClass

_MARK = b"\x89PNG\r\n\x1a\n"
_TRUE_COLOUR = 2
_BITS = 8
_PIXEL = 3  # bytes
_TYPED = {
    **{"uint16": (69, "H"), "uint32": (70, "I"), "uint64": (71, "Q"), "byte": (72, "b"), "int8": (72, "b")},
    **{"int16": (77, "h"), "int32": (78, "i"), "int64": (79, "q"), "float32": (85, "f"), "float64": (86, "d")},
}
"""Tag and code of struct of each type of number in an array."""
_UNSIGNED, _NEGATIVE, _BYTES, _TEXT, _LIST, _MAP, _TAG = range(7)
_FALSE, _TRUE, _NULL, _DOUBLE = b"\xf4", b"\xf5", b"\xf6", 0xFB
_double = struct.Struct(">Bd").pack


class Outgoing:
    """A message.

    Args:
        payload: the message as ROS serialises it.
        kind: its class; None if all clients want it serialised.
        at: ROS time, s and ns, at which it is passed on.

    Attributes:
        kind: its class.
    """

    def __init__(self, payload: bytes, kind: MessageClass | None, at: tuple[int, int]) -> None:
        self.payload = payload
        self.kind = kind
        self._at = at
        self._message: Message | None = None
        self._made: dict[tuple[str, str], str | bytes] = {}

    def op(self, topic: str, compression: str) -> str | bytes:
        """Return the op `publish` for it.

        Args:
            topic: its name, as the client has given it.
            compression: one of `sending.COMPRESSIONS`.

        Raises:
            DeserializationError: it is not a message of its class.
        """
        found = self._made.get((topic, compression))
        if found is None:
            found = self._made[topic, compression] = self._make(topic, compression)
        return found

    def _make(self, topic: str, compression: str) -> str | bytes:
        op: dict[str, Any] = {"op": "publish", "topic": topic}
        if compression == CBOR_RAW:
            secs, nsecs = self._at
            return dumps({**op, "msg": {"secs": secs, "nsecs": nsecs, "bytes": self.payload}})
        if compression == CBOR:
            return dumps({**op, "msg": cbor_values(self._parsed())})
        text = json.dumps({**op, "msg": json_values(self._parsed())})
        return json.dumps({"op": "png", "data": png_of(text)}) if compression == PNG else text

    def _parsed(self) -> Message:
        if self._message is None:
            assert self.kind is not None
            try:
                self._message = self.kind().deserialize(self.payload)
            except Exception as error:  # the generated code may raise any error for bytes of another type
                raise DeserializationError(str(error)) from None
        return self._message


def png_of(text: str) -> str:
    """Return the image of a text, in base64."""
    data = text.encode(errors="replace")
    pixels = max(1, -(-len(data) // _PIXEL))
    width = max(1, isqrt(len(data) // _PIXEL))
    height = -(-pixels // width)
    row = width * _PIXEL
    data = data.ljust(row * height, b"\n")
    lines = b"".join(b"\0" + data[at : at + row] for at in range(0, len(data), row))  # each without a filter
    header = struct.pack(">IIBBBBB", width, height, _BITS, _TRUE_COLOUR, 0, 0, 0)
    chunks = ((b"IHDR", header), (b"IDAT", zlib.compress(lines, 6)), (b"IEND", b""))
    return b64encode(_MARK + b"".join(_chunk(*each) for each in chunks)).decode("ascii")


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


# -- CBOR --------------------------------------------------------------------------------------------------------------


class Tagged(NamedTuple):
    """A byte string under a tag."""

    tag: int
    data: bytes


def cbor_values(message: Message) -> dict[str, Any]:
    """Convert a message to a value for `dumps`."""
    kind = type(message)
    return {
        name: _value(getattr(message, name), field)
        for name, field in zip(kind.__slots__, kind._slot_types, strict=True)
    }


def _value(value: Any, field: str) -> Any:
    base, bracket, _ = field.partition("[")
    if bracket:
        if base in ("uint8", "char"):
            return bytes(value)
        if base in _TYPED:
            tag, code = _TYPED[base]
            return Tagged(tag, struct.pack(f"<{len(value)}{code}", *value))
        return [_value(each, base) for each in value]
    if base in ("time", "duration"):
        return {"secs": value.secs, "nsecs": value.nsecs}
    if base == "bool":
        return bool(value)
    return cbor_values(value) if isinstance(value, Message) else value


def dumps(value: Any) -> bytes:
    """Encode a value in CBOR: a dict of texts, a list, a text, bytes, a number, None, or a `Tagged`."""
    out: list[bytes] = []
    _write(value, out)
    return b"".join(out)


def _write(value: Any, out: list[bytes]) -> None:
    if isinstance(value, bool):
        out.append(_TRUE if value else _FALSE)
    elif isinstance(value, int):
        out.append(_head(_UNSIGNED, value) if value >= 0 else _head(_NEGATIVE, -1 - value))
    elif isinstance(value, float):
        out.append(_double(_DOUBLE, value))
    elif isinstance(value, str):
        data = value.encode(errors="replace")
        out += (_head(_TEXT, len(data)), data)
    elif isinstance(value, bytes):
        out += (_head(_BYTES, len(value)), value)
    elif isinstance(value, Tagged):
        out += (_head(_TAG, value.tag), _head(_BYTES, len(value.data)), value.data)
    elif isinstance(value, dict):
        out.append(_head(_MAP, len(value)))
        for key, each in value.items():
            _write(key, out)
            _write(each, out)
    elif value is None:
        out.append(_NULL)
    else:
        out.append(_head(_LIST, len(value)))
        for each in value:
            _write(each, out)


def _head(major: int, number: int) -> bytes:
    """Return a major type with its number, in the fewest bytes."""
    first = major << 5
    if number < 24:
        return bytes((first | number,))
    for more, (size, code) in enumerate(((1, "B"), (2, "H"), (4, "I"), (8, "Q"))):
        if number < 1 << 8 * size:
            return struct.pack(f">B{code}", first | 24 + more, number)
    raise ValueError(f"{number} has more than 64 bits")
