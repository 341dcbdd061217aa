"""The CCSDS primary header of a packet (CFE_MSG, Space Packet Protocol CCSDS 133.0-B): six bytes, big-endian.

Every function works on the bytes of the packet. Getters take any bytes-like object, and setters change a bytearray in
place. Message ids are "version 1": the first 16 bits of the packet.

As in cFE's default configuration there are no extended headers ("version 2"). The functions for their fields raise
CFE_MSG_NOT_IMPLEMENTED.
"""

from __future__ import annotations

from enum import IntEnum
from typing import NoReturn

from cfepy.status import CFE_MSG_BAD_ARGUMENT, CFE_MSG_NOT_IMPLEMENTED, CfeError

Packet = bytes | bytearray | memoryview
PRIMARY_HEADER_SIZE = 6
CMD_HEADER_SIZE = 8
TLM_HEADER_SIZE = 16
HIGHEST_VALID_MSG_ID = 0x1FFF
MAX_SEQUENCE_COUNT = 0x3FFF
_LENGTH_OFFSET = 7
"""A packet's size is its length field plus this (CCSDS 133.0-B 4.1.3.5)."""


class MsgType(IntEnum):
    """Command or telemetry (CFE_MSG_Type_t)."""

    INVALID = 0
    CMD = 1
    TLM = 2


class SegmentationFlag(IntEnum):
    """The position of a packet in a sequence of segments (CFE_MSG_SegmentationFlag_t)."""

    INVALID = 0
    CONTINUE = 1
    FIRST = 2
    LAST = 3
    UNSEGMENTED = 4


_FLAG_OF_BITS = (
    SegmentationFlag.CONTINUE,
    SegmentationFlag.FIRST,
    SegmentationFlag.LAST,
    SegmentationFlag.UNSEGMENTED,
)


def bad_argument(text: str) -> CfeError:
    """Return the error for a value that does not fit its field, or for a packet too short for the field."""
    return CfeError(CFE_MSG_BAD_ARGUMENT, text)


def check_range(name: str, value: int, highest: int, lowest: int = 0) -> int:
    """Return `value` if it is within lowest..highest.

    Raises:
        CfeError: CFE_MSG_BAD_ARGUMENT otherwise.
    """
    if not lowest <= value <= highest:
        raise bad_argument(f"{name} must be {lowest} to {highest}, not {value}")
    return value


def _word(packet: Packet, offset: int) -> int:
    if len(packet) < PRIMARY_HEADER_SIZE:
        raise bad_argument(
            f"a packet must have at least {PRIMARY_HEADER_SIZE} bytes for its primary header, not {len(packet)}"
        )
    return packet[offset] << 8 | packet[offset + 1]


def _put(packet: bytearray, offset: int, mask: int, bits: int) -> None:
    word = _word(packet, offset) & ~mask | bits
    packet[offset] = word >> 8
    packet[offset + 1] = word & 0xFF


def is_valid_msg_id(msg_id: int) -> bool:
    """Return whether a message id lies within 1..0x1FFF (CFE_SB_IsValidMsgId)."""
    return 0 < msg_id <= HIGHEST_VALID_MSG_ID


def init(msg_id: int, size: int) -> bytearray:
    """Return a new packet: all zero except message id, size and "unsegmented" (CFE_MSG_Init).

    Args:
        msg_id: 1..0x1FFF.
        size: bytes of the whole packet, including the headers.

    Raises:
        CfeError: CFE_MSG_BAD_ARGUMENT for an invalid id or size.
    """
    packet = bytearray(check_range("packet size", size, 0xFFFF + _LENGTH_OFFSET, _LENGTH_OFFSET))
    set_msg_id(packet, msg_id)
    set_segmentation_flag(packet, SegmentationFlag.UNSEGMENTED)
    set_size(packet, size)
    return packet


def get_msg_id(packet: Packet) -> int:
    """Return the message id (CFE_MSG_GetMsgId)."""
    return _word(packet, 0)


def set_msg_id(packet: bytearray, msg_id: int) -> None:
    """Set the message id, 1..0x1FFF, and with it type, secondary header flag and APID (CFE_MSG_SetMsgId)."""
    if not is_valid_msg_id(msg_id):
        raise bad_argument(f"message id must be 0x1 to 0x{HIGHEST_VALID_MSG_ID:X}, not 0x{msg_id:X}")
    _put(packet, 0, 0xFFFF, msg_id)


def get_header_version(packet: Packet) -> int:
    """Return the CCSDS packet version number, 0..7 (CFE_MSG_GetHeaderVersion)."""
    return _word(packet, 0) >> 13


def set_header_version(packet: bytearray, version: int) -> None:
    """Set the CCSDS packet version number, 0..7 (CFE_MSG_SetHeaderVersion)."""
    _put(packet, 0, 0xE000, check_range("header version", version, 7) << 13)


def get_type(packet: Packet) -> MsgType:
    """Return whether the packet is a command or telemetry (CFE_MSG_GetType)."""
    return MsgType.CMD if _word(packet, 0) & 0x1000 else MsgType.TLM


def set_type(packet: bytearray, msg_type: int) -> None:
    """Set the type to command or telemetry (CFE_MSG_SetType)."""
    if msg_type not in (MsgType.CMD, MsgType.TLM):
        raise bad_argument(f"message type must be MsgType.CMD or MsgType.TLM, not {msg_type}")
    _put(packet, 0, 0x1000, 0x1000 if msg_type == MsgType.CMD else 0)


def get_has_secondary_header(packet: Packet) -> bool:
    """Return whether a secondary header follows (CFE_MSG_GetHasSecondaryHeader)."""
    return bool(_word(packet, 0) & 0x0800)


def set_has_secondary_header(packet: bytearray, present: bool) -> None:
    """Set whether a secondary header follows (CFE_MSG_SetHasSecondaryHeader)."""
    _put(packet, 0, 0x0800, 0x0800 if present else 0)


def get_ap_id(packet: Packet) -> int:
    """Return the application process id, 0..0x7FF (CFE_MSG_GetApId)."""
    return _word(packet, 0) & 0x07FF


def set_ap_id(packet: bytearray, ap_id: int) -> None:
    """Set the application process id, 0..0x7FF (CFE_MSG_SetApId)."""
    _put(packet, 0, 0x07FF, check_range("APID", ap_id, 0x07FF))


def get_segmentation_flag(packet: Packet) -> SegmentationFlag:
    """Return the position in a sequence of segments (CFE_MSG_GetSegmentationFlag)."""
    return _FLAG_OF_BITS[_word(packet, 2) >> 14]


def set_segmentation_flag(packet: bytearray, flag: int) -> None:
    """Set the position in a sequence of segments, a SegmentationFlag (CFE_MSG_SetSegmentationFlag)."""
    _put(packet, 2, 0xC000, check_range("segmentation flag", flag, 4, 1) - 1 << 14)


def get_sequence_count(packet: Packet) -> int:
    """Return the sequence count, 0..0x3FFF (CFE_MSG_GetSequenceCount)."""
    return _word(packet, 2) & MAX_SEQUENCE_COUNT


def set_sequence_count(packet: bytearray, count: int) -> None:
    """Set the sequence count, 0..0x3FFF (CFE_MSG_SetSequenceCount)."""
    _put(packet, 2, MAX_SEQUENCE_COUNT, check_range("sequence count", count, MAX_SEQUENCE_COUNT))


def get_next_sequence_count(count: int) -> int:
    """Return the count after `count`: one more, 0 after 0x3FFF (CFE_MSG_GetNextSequenceCount)."""
    return count + 1 if count < MAX_SEQUENCE_COUNT else 0


def get_size(packet: Packet) -> int:
    """Return the bytes of the whole packet according to its header, 7..65542 (CFE_MSG_GetSize)."""
    return _word(packet, 4) + _LENGTH_OFFSET


def set_size(packet: bytearray, size: int) -> None:
    """Set the size of the whole packet in the header, 7..65542; the buffer keeps its length (CFE_MSG_SetSize)."""
    _put(packet, 4, 0xFFFF, check_range("packet size", size, 0xFFFF + _LENGTH_OFFSET, _LENGTH_OFFSET) - _LENGTH_OFFSET)


def _absent(field: str) -> NoReturn:
    raise CfeError(CFE_MSG_NOT_IMPLEMENTED, f"{field} is in the extended header, which this mission does not use")


def get_eds_version(packet: Packet) -> NoReturn:
    """Refuse CFE_MSG_GetEDSVersion, which this header does not support."""
    _absent("the EDS version")


def set_eds_version(packet: bytearray, version: int) -> NoReturn:
    """Refuse CFE_MSG_SetEDSVersion, which this header does not support."""
    _absent("the EDS version")


def get_endian(packet: Packet) -> NoReturn:
    """Refuse CFE_MSG_GetEndian, which this header does not support."""
    _absent("the byte order")


def set_endian(packet: bytearray, endian: int) -> NoReturn:
    """Refuse CFE_MSG_SetEndian, which this header does not support."""
    _absent("the byte order")


def get_playback_flag(packet: Packet) -> NoReturn:
    """Refuse CFE_MSG_GetPlaybackFlag, which this header does not support."""
    _absent("the playback flag")


def set_playback_flag(packet: bytearray, flag: int) -> NoReturn:
    """Refuse CFE_MSG_SetPlaybackFlag, which this header does not support."""
    _absent("the playback flag")


def get_subsystem(packet: Packet) -> NoReturn:
    """Refuse CFE_MSG_GetSubsystem, which this header does not support."""
    _absent("the subsystem")


def set_subsystem(packet: bytearray, subsystem: int) -> NoReturn:
    """Refuse CFE_MSG_SetSubsystem, which this header does not support."""
    _absent("the subsystem")


def get_system(packet: Packet) -> NoReturn:
    """Refuse CFE_MSG_GetSystem, which this header does not support."""
    _absent("the system")


def set_system(packet: bytearray, system: int) -> NoReturn:
    """Refuse CFE_MSG_SetSystem, which this header does not support."""
    _absent("the system")
