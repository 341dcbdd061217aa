"""The bytes that SBN peers exchange: a header and a payload (SBN_PackMsg, SBN_UnpackMsg, sbn_subs.c).

All numbers are big-endian and nothing is aligned. The header: bytes of the payload (i16), type (u8), processor id (u32)
and spacecraft id (u32) of the sender. The payload of subscriptions: the sender's source ident (48 bytes), their number
(u16), and for each MsgId (u32), priority (u8), reliability (u8).
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from typing import NamedTuple

from cfepy.status import CFE_STATUS_WRONG_MSG_LENGTH, CfeError

NO_MSG, SUB_MSG, UNSUB_MSG, APP_MSG, PROTO_MSG = range(5)
"""Types of messages (SBN_MsgTypeEnum_t)."""

MODULE_SPECIFIC = 0x80
"""Bit of the types that a protocol module has for itself."""

PROTO_VER = 11
IDENT = "$Id: dccf6239093d99c4c9351e140c15b61a95d8fc37 $"
"""What git makes of SBN_IDENT in a checkout of NASA's SBN (main, April 2023): the id of its sbn_types.h.

A peer that was built from another one refuses subscriptions.
"""

IDENT_LEN = 48
MAX_SUBS = 256  # SBN_MAX_SUBS_PER_PEER
LONGEST = 0x7FFF  # bytes of a payload that the header can express
_HEADER = struct.Struct(">hBII")
_COUNT = struct.Struct(">H")
_SUB = struct.Struct(">IBB")
HEADER_SIZE = _HEADER.size


class Malformed(CfeError):
    """A malformed message of a peer. The text gives the reason."""

    def __init__(self, text: str) -> None:
        super().__init__(CFE_STATUS_WRONG_MSG_LENGTH, text)


class NetMsg(NamedTuple):
    """A message: its type, its sender, and the payload."""

    kind: int
    processor_id: int
    spacecraft_id: int
    payload: bytes = b""


class Sub(NamedTuple):
    """A subscription of a processor: a MsgId, and the quality of service as two bytes (CFE_SB_Qos_t)."""

    msg_id: int
    priority: int = 0
    reliability: int = 0


def pack(message: NetMsg) -> bytes:
    """Return a message as bytes (SBN_PackMsg)."""
    kind, processor_id, spacecraft_id, payload = message
    return _HEADER.pack(len(payload), kind, processor_id, spacecraft_id) + payload


def unpack(data: bytes, longest: int) -> NetMsg:
    """Return the message in a datagram. Bytes after it are ignored (SBN_UnpackMsg).

    Args:
        data: the datagram.
        longest: maximum bytes of a payload (CFE_MISSION_SB_MAX_SB_MSG_SIZE).

    Raises:
        Malformed: it is shorter than its header, or than its header says; or no payload has such a length.
    """
    if len(data) < HEADER_SIZE:
        raise Malformed(f"{len(data)} bytes, a header has {HEADER_SIZE}")
    size, kind, processor_id, spacecraft_id = _HEADER.unpack_from(data)
    if not 0 <= size <= longest:
        raise Malformed(f"a payload of {size} bytes")
    if len(data) < HEADER_SIZE + size:
        raise Malformed(f"{len(data) - HEADER_SIZE} of the {size} bytes of its payload")
    return NetMsg(kind, processor_id, spacecraft_id, bytes(data[HEADER_SIZE : HEADER_SIZE + size]))


def pack_subscriptions(subscriptions: Sequence[Sub], ident: str) -> bytes:
    """Return the payload of SUB_MSG and UNSUB_MSG.

    Args:
        subscriptions: at most 256.
        ident: which source this SBN claims to be built from.
    """
    told = b"".join(_SUB.pack(*each) for each in subscriptions)
    return ident.encode()[: IDENT_LEN - 1].ljust(IDENT_LEN, b"\0") + _COUNT.pack(len(subscriptions)) + told


def unpack_subscriptions(payload: bytes) -> tuple[str, list[Sub]]:
    """Parse that payload. Returns the ident, up to its first NUL, and the subscriptions.

    Raises:
        Malformed: it ends too early.
    """
    start = IDENT_LEN + _COUNT.size
    if len(payload) < start:
        raise Malformed(f"subscriptions of {len(payload)} bytes")
    (count,) = _COUNT.unpack_from(payload, IDENT_LEN)
    if len(payload) < start + count * _SUB.size:
        raise Malformed(f"{len(payload)} bytes for {count} subscriptions")
    ident = payload[:IDENT_LEN].partition(b"\0")[0].decode(errors="replace")
    return ident, [Sub(*_SUB.unpack_from(payload, start + number * _SUB.size)) for number in range(count)]
