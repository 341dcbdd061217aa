"""TCPROS on the wire: connection headers and frames (wiki.ros.org/ROS/TCPROS, wiki.ros.org/ROS/Connection%20Header).

A frame is its length as 4 bytes, little-endian, and then so many bytes. A connection header is a frame of fields; a
field is its length, and NAME=VALUE. A service answers with a byte, 1 for success, in front of the frame.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Mapping

from cfepy.reading.input_limits import TCPROS_FRAME_BYTES, TCPROS_HEADER_BYTES
from cfepy.status import UsageError

LONGEST_HEADER = TCPROS_HEADER_BYTES
LONGEST_FRAME = TCPROS_FRAME_BYTES
_length = struct.Struct("<I")


class WireError(UsageError):
    """Bytes that are not TCPROS."""


def frame(data: bytes) -> bytes:
    """Return bytes preceded by their length."""
    return _length.pack(len(data)) + data


def pack_header(fields: Mapping[str, str]) -> bytes:
    """Return a connection header as a frame."""
    return frame(b"".join(frame(f"{name}={value}".encode()) for name, value in fields.items()))


def parse_header(data: bytes) -> dict[str, str]:
    """Parse a connection header.

    Args:
        data: the contents of its frame.

    Returns:
        The fields.

    Raises:
        WireError: it is not a connection header.
    """
    fields, at = {}, 0
    while at < len(data):
        if at + 4 > len(data):
            raise WireError("a connection header is truncated")
        (size,) = _length.unpack_from(data, at)
        field = data[at + 4 : at + 4 + size]
        at += 4 + size
        name, mark, value = field.partition(b"=")
        if at > len(data) or not mark:
            raise WireError("a field of a connection header is truncated or has no value")
        fields[name.decode(errors="replace")] = value.decode(errors="replace")
    return fields


class TcprosFrames:
    """Splits the data of a connection into frames.

    Attributes:
        longest: maximum bytes of a frame; a longer one is treated as damage.
        has_status: a byte precedes each frame; it becomes the first byte of the frame.
    """

    def __init__(self) -> None:
        self.longest = LONGEST_HEADER
        self.has_status = False
        self._data = bytearray()

    def __len__(self) -> int:
        """Return the bytes of incomplete frames."""
        return len(self._data)

    def clear(self) -> None:
        """Discard the data."""
        self._data.clear()

    def add(self, data: bytes) -> None:
        """Add received data."""
        self._data += data

    def take(self) -> Iterator[bytes]:
        """Yield the frames that are complete; the attributes may be changed between two frames.

        Raises:
            WireError: a frame is too long.
        """
        buffer = self._data
        at = 0
        try:
            while True:
                lead = int(self.has_status)
                if len(buffer) - at < lead + 4:
                    return
                (size,) = _length.unpack_from(buffer, at + lead)
                if size > self.longest:
                    raise WireError(f"not TCPROS: a frame of {size} bytes")
                end = at + lead + 4 + size
                if len(buffer) < end:
                    return
                with memoryview(buffer) as view:
                    found = b"".join((view[at : at + lead], view[at + lead + 4 : end]))
                at = end
                yield found
        finally:
            del buffer[:at]
