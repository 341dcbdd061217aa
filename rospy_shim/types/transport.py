"""ROS messages in cFE packets: one telemetry packet, or several for a message that does not fit in one.

A long message is cut into packets with the CCSDS sequence flags first, continuation and last (CCSDS 133.0-B-2,
4.1.3.4.2.2) and put together again by each subscriber.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator

HEADER_BYTES = 16  # of a cFE telemetry packet
SPARE_AT = 12  # in the header; its bytes are 0 except in packets for one subscriber alone
EVERYBODY = bytes(HEADER_BYTES - SPARE_AT)
WHOLE = 0xC0  # sequence flags, as in byte 2 of a packet
FIRST = 0x40
MIDDLE = 0x00
LAST = 0x80

_header = struct.Struct(">HBBH10x").pack


def whole_header(msg_id: int) -> bytes:
    """Return the header of a packet with a whole message; the bus fills in sequence count, length and time."""
    return _header(msg_id, WHOLE, 0, 0)


def addressed(packet: bytes, pipe: int, number: int = 0) -> bytes:
    """Return the same packet for one subscriber alone.

    Args:
        packet: packet of a topic.
        pipe: the id of the subscriber's pipe.
        number: number of the subscription among a compiled node's subscriptions to the topic; the first is 0.
    """
    return packet[:SPARE_AT] + _address(pipe, number) + packet[HEADER_BYTES:]


def is_for_another(packet: bytes, pipe: int) -> bool:
    """Return True if a packet whose spare bytes are not 0 is for another subscriber than the one with this pipe."""
    return len(packet) >= HEADER_BYTES and packet[SPARE_AT:HEADER_BYTES] != _address(pipe)


def _address(pipe: int, number: int = 0) -> bytes:
    return ((pipe & 0xFFFFFF) << 8 | number << 1 | 1).to_bytes(4, "big")


def segments(msg_id: int, payload: bytes, room: int) -> Iterator[bytes]:
    """Yield the packets of a long payload; the bus fills in sequence counts and times.

    Args:
        msg_id: MsgId of the topic.
        payload: the serialised message.
        room: bytes of payload that fit in one packet.
    """
    size = len(payload)
    for start in range(0, size, room):
        part = payload[start : start + room]
        flags = FIRST if start == 0 else LAST if start + room >= size else MIDDLE
        yield _header(msg_id, flags, 0, len(part) + HEADER_BYTES - 7) + part


class Assembler:
    """Reassembles the segments of long messages, separately for each sender."""

    def __init__(self) -> None:
        self._parts: dict[object, list[bytes]] = {}
        self.lost = 0  # messages with a missing segment

    def add(self, packet: bytes, sender: object, index: int | None) -> bytes | None:
        """Add a segment. Returns the whole message, after a header, if it is the last one, otherwise None.

        Args:
            packet: a packet whose sequence flags are not `WHOLE`.
            sender: distinguishes publishers of one topic.
            index: number of the segment in its message, from 0; None if only its sequence count is known.
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
    """Return the sequence count of a packet, 0 to 16383."""
    return (packet[2] & 0x3F) << 8 | packet[3]


def _continues(parts: list[bytes], packet: bytes, index: int | None) -> bool:
    if index is not None:
        return index == len(parts)
    return sequence_of(packet) == (sequence_of(parts[-1]) + 1) & 0x3FFF
