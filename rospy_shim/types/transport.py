"""ROS messages in cFE packets: one telemetry packet, or several for a message that does not fit in one.

A long message is cut into packets with the CCSDS sequence flags first, continuation and last (CCSDS 133.0-B-2,
4.1.3.4.2.2) and put together again by each subscriber.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator

HEADER_BYTES = 16  # of a cFE telemetry packet
SPARE_AT = 12  # in the header; its bytes are 0 but in packets for one subscriber alone
EVERYBODY = bytes(HEADER_BYTES - SPARE_AT)
WHOLE = 0xC0  # sequence flags, as they stand in byte 2 of a packet
FIRST = 0x40
MIDDLE = 0x00
LAST = 0x80

_header = struct.Struct(">HBBH10x").pack


def whole_header(msg_id: int) -> bytes:
    """The header of a packet that holds a whole message; the bus fills in sequence count, length and time."""
    return _header(msg_id, WHOLE, 0, 0)


def addressed(packet: bytes, pipe: int, number: int = 0) -> bytes:
    """The same packet for one subscriber alone.

    Args:
        packet: of a topic.
        pipe: the id of the subscriber's pipe.
        number: of the subscription, of those that a compiled node has to the topic; the first is 0.
    """
    return packet[:SPARE_AT] + _address(pipe, number) + packet[HEADER_BYTES:]


def is_for_another(packet: bytes, pipe: int) -> bool:
    """Whether a packet whose spare bytes are not 0 is for another subscriber than the one with this pipe."""
    return len(packet) >= HEADER_BYTES and packet[SPARE_AT:HEADER_BYTES] != _address(pipe)


def _address(pipe: int, number: int = 0) -> bytes:
    return ((pipe & 0xFFFFFF) << 8 | number << 1 | 1).to_bytes(4, "big")


def segments(msg_id: int, payload: bytes, room: int) -> Iterator[bytes]:
    """The packets that a long payload is sent in; the bus fills in sequence counts and times.

    Args:
        msg_id: of the topic.
        payload: the serialised message.
        room: bytes of payload that fit in one packet.
    """
    size = len(payload)
    for start in range(0, size, room):
        part = payload[start : start + room]
        flags = FIRST if start == 0 else LAST if start + room >= size else MIDDLE
        yield _header(msg_id, flags, 0, len(part) + HEADER_BYTES - 7) + part


class Assembler:
    """Puts the segments of long messages together, those of each sender for themselves."""

    def __init__(self) -> None:
        self._parts: dict[object, list[bytes]] = {}
        self.lost = 0  # messages of which a segment is missing

    def add(self, packet: bytes, sender: object, index: int | None) -> bytes | None:
        """Take a segment; the whole message, behind a header, when it is the last one.

        Args:
            packet: a packet whose sequence flags are not `WHOLE`.
            sender: tells publishers of one topic apart.
            index: number of the segment in its message, from 0; None when only its sequence count can tell.
        """
        flags = packet[2] & 0xC0
        parts = self._parts.pop(sender, None)
        if flags == FIRST:
            self.lost += parts is not None
            self._parts[sender] = [packet]
            return None
        if parts is None or not _continues(parts, packet, index):
            self.lost += parts is not None
            return None
        parts.append(packet)
        if flags == MIDDLE:
            self._parts[sender] = parts
            return None
        return parts[0] + b"".join(part[HEADER_BYTES:] for part in parts[1:])


def sequence_of(packet: bytes) -> int:
    """The sequence count of a packet, 0 to 16383."""
    return (packet[2] & 0x3F) << 8 | packet[3]


def _continues(parts: list[bytes], packet: bytes, index: int | None) -> bool:
    if index is not None:
        return index == len(parts)
    return sequence_of(packet) == (sequence_of(parts[-1]) + 1) & 0x3FFF
