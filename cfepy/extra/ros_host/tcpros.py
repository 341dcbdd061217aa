"""TCPROS on the wire: connection headers and frames (wiki.ros.org/ROS/TCPROS, wiki.ros.org/ROS/Connection%20Header).

A frame is its length, 4 bytes, the least first, and so many bytes. A connection header is a frame of fields; a field is
its length, and NAME=VALUE. A service answers with a byte, 1 for success, in front of the frame.
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
    """Bytes that are no TCPROS."""


def frame(data: bytes) -> bytes:
    """Bytes behind their length."""
    return _length.pack(len(data)) + data


def pack_header(fields: Mapping[str, str]) -> bytes:
    """A connection header, as a frame."""
    return frame(b"".join(frame(f"{name}={value}".encode()) for name, value in fields.items()))


def parse_header(data: bytes) -> dict[str, str]:
    """The fields of a connection header.

    Args:
        data: what is in its frame.

    Raises:
        WireError: it is none.
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
    """Cuts what comes over a connection into frames.

    Attributes:
        longest: bytes of a frame; more is taken for damage.
        has_status: a byte stands in front of each frame, which is kept as its first.
    """

    def __init__(self) -> None:
        self.longest = LONGEST_HEADER
        self.has_status = False
        self._data = bytearray()

    def __len__(self) -> int:
        """Bytes of a frame that is not complete."""
        return len(self._data)

    def clear(self) -> None:
        """Forget what came."""
        self._data.clear()

    def add(self, data: bytes) -> None:
        """Take what came."""
        self._data += data

    def take(self) -> Iterator[bytes]:
        """The frames that are complete; the settings may be changed between two.

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
