"""Service calls in packets: a request is a command, an answer telemetry; both are cut into segments when they are long.

Behind the header stands the number of the call; in an answer also 1 for success, 0 for an error; then the serialised
request or response, or the error's text, or a piece of it. Imports nothing of cfepy.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator

from rospy_shim.transport import FIRST, LAST, MIDDLE, WHOLE

REQUEST_LEAD = 8 + 4  # command header (function code 0), call number
ANSWER_LEAD = 16 + 5  # telemetry header, call number, success

_request = struct.Struct(">HBBHBB").pack
_answer = struct.Struct(">HBBH10x").pack
_call = struct.Struct("<I")
_outcome = struct.Struct("<IB")


def request_packets(msg_id: int, number: int, body: bytes, most: int) -> Iterator[bytes]:
    """The packets of a request; the bus fills in sequence count, length and checksum.

    Args:
        msg_id: of the service's requests.
        number: of the call.
        body: the serialised request.
        most: bytes that a packet may have.
    """
    lead = _call.pack(number)
    for flags, piece in _pieces(body, most - REQUEST_LEAD):
        yield _request(msg_id, flags, 0, len(piece) + REQUEST_LEAD - 7, 0, 0) + lead + piece


def answer_packets(msg_id: int, number: int, good: bool, body: bytes, most: int) -> Iterator[bytes]:
    """The packets of an answer; the bus fills in sequence count, length and time.

    Args:
        msg_id: of the service's answers.
        number: of the call.
        good: whether it succeeded.
        body: the serialised response, or the error's text.
        most: bytes that a packet may have.
    """
    lead = _outcome.pack(number, good)
    for flags, piece in _pieces(body, most - ANSWER_LEAD):
        yield _answer(msg_id, flags, 0, len(piece) + ANSWER_LEAD - 7) + lead + piece


def call_of_request(packet: bytes) -> int:
    """The number of the call that a request belongs to."""
    number: int = _call.unpack_from(packet, REQUEST_LEAD - 4)[0]
    return number


def call_of_answer(packet: bytes) -> tuple[int, bool]:
    """The number of the call that an answer belongs to, and whether the call succeeded."""
    number, good = _outcome.unpack_from(packet, ANSWER_LEAD - 5)
    return number, bool(good)


class Pieces:
    """Puts segments together, those of each call for themselves.

    Args:
        lead: bytes of a packet in front of the piece.
    """

    def __init__(self, lead: int) -> None:
        self._lead = lead
        self._parts: dict[int, list[bytes]] = {}

    def add(self, number: int, packet: bytes) -> bytes | None:
        """Take a packet of a call; the whole request or answer if it is the last one."""
        flags, piece = packet[2] & WHOLE, packet[self._lead :]
        if flags == WHOLE:
            return piece
        if flags == FIRST:
            self._parts[number] = [piece]
            return None
        parts = self._parts.get(number)
        if parts is None:
            return None  # its beginning came before this side was there
        parts.append(piece)
        return b"".join(self._parts.pop(number)) if flags == LAST else None


def _pieces(body: bytes, room: int) -> Iterator[tuple[int, bytes]]:
    """What goes into each packet, with its sequence flags."""
    size = len(body)
    if size <= room:
        yield WHOLE, body
        return
    for start in range(0, size, room):
        yield FIRST if start == 0 else LAST if start + room >= size else MIDDLE, body[start : start + room]
