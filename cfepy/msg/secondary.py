"""cFE's secondary headers: function code and checksum of a command, time of a telemetry packet (CFE_MSG).

Reading a field that this kind of packet does not have raises CFE_MSG_WRONG_MSG_TYPE. A time here is (seconds,
subseconds of 2**-32 s); the packet keeps the upper 16 bits of the subseconds.
"""

from __future__ import annotations

from functools import reduce
from operator import xor

from cfepy.msg.header import (
    CMD_HEADER_SIZE,
    PRIMARY_HEADER_SIZE,
    TLM_HEADER_SIZE,
    MsgType,
    Packet,
    bad_argument,
    check_range,
    get_size,
    get_type,
    init,
    set_msg_id,
    set_size,
)
from cfepy.status import CFE_MSG_WRONG_MSG_TYPE, CfeError

MAX_BUS_MSG_SIZE = 32768
"""CFE_MISSION_SB_MAX_SB_MSG_SIZE."""

_FCN_CODE_MASK = 0x7F
_KIND_MASK = 0xF8
_CMD_KIND = 0x18
_TLM_KIND = 0x08
"""The top five bits of a packet: version 0, the type, "has a secondary header"."""

_FOLD_FROM = 32
_TIME = slice(6, 12)


def _check_kind(packet: Packet, kind: int, size: int, what: str) -> None:
    if len(packet) >= PRIMARY_HEADER_SIZE and packet[0] & _KIND_MASK != kind:
        raise CfeError(CFE_MSG_WRONG_MSG_TYPE, f"message 0x{packet[0]:02X}{packet[1]:02X} has no {what}")
    if len(packet) < size:
        raise bad_argument(f"a packet of {len(packet)} bytes has no {what}")


def get_fcn_code(packet: Packet) -> int:
    """Return the function code of a command, 0..127 (CFE_MSG_GetFcnCode).

    Raises:
        CfeError: CFE_MSG_WRONG_MSG_TYPE if it is not a command with a secondary header.
    """
    _check_kind(packet, _CMD_KIND, PRIMARY_HEADER_SIZE + 1, "function code")
    return packet[PRIMARY_HEADER_SIZE] & _FCN_CODE_MASK


def set_fcn_code(packet: bytearray, fcn_code: int) -> None:
    """Set the function code of a command, 0..127 (CFE_MSG_SetFcnCode)."""
    check_range("function code", fcn_code, _FCN_CODE_MASK)
    _check_kind(packet, _CMD_KIND, CMD_HEADER_SIZE, "function code")
    packet[6] = fcn_code


def _fold(data: Packet) -> int:
    """Return the XOR of all bytes; long packets are folded in half as one integer, which is much faster than byte by
    byte.
    """
    if len(data) <= _FOLD_FROM:
        return reduce(xor, data, 0)
    value = int.from_bytes(data, "little")
    width = 8 << (len(data) - 1).bit_length()
    while width > 8:
        width >>= 1
        value = value >> width ^ value & (1 << width) - 1
    return value


def compute_checksum(packet: Packet) -> int:
    """Return the XOR of 0xFF and every byte within the header's size (CFE_MSG_ComputeCheckSum).

    Raises:
        CfeError: CFE_MSG_BAD_ARGUMENT if the buffer is shorter than the header's size.
    """
    size = get_size(packet)
    if size > len(packet):
        raise bad_argument(f"the header specifies {size} bytes, but the buffer has {len(packet)}")
    return 0xFF ^ _fold(packet if size == len(packet) else memoryview(packet)[:size])


def generate_checksum(packet: bytearray) -> None:
    """Write the checksum of a command, so that the whole packet XORs to 0xFF (CFE_MSG_GenerateChecksum)."""
    _check_kind(packet, _CMD_KIND, CMD_HEADER_SIZE, "checksum")
    packet[7] = 0
    packet[7] = compute_checksum(packet)


def validate_checksum(packet: Packet) -> bool:
    """Return whether the checksum of a command is right (CFE_MSG_ValidateChecksum)."""
    _check_kind(packet, _CMD_KIND, CMD_HEADER_SIZE, "checksum")
    return compute_checksum(packet) == 0


def get_msg_time(packet: Packet) -> tuple[int, int]:
    """Return the time of a telemetry packet as (seconds, subseconds), the latter a multiple of 2**16
    (CFE_MSG_GetMsgTime).

    Raises:
        CfeError: CFE_MSG_WRONG_MSG_TYPE if it is not telemetry with a secondary header.
    """
    _check_kind(packet, _TLM_KIND, _TIME.stop, "time")
    stamp = int.from_bytes(packet[_TIME], "big")
    return stamp >> 16, (stamp & 0xFFFF) << 16


def set_msg_time(packet: bytearray, time: tuple[int, int]) -> None:
    """Set the time of a telemetry packet from (seconds, subseconds) (CFE_MSG_SetMsgTime)."""
    _check_kind(packet, _TLM_KIND, _TIME.stop, "time")
    seconds = check_range("seconds", time[0], 0xFFFFFFFF)
    subseconds = check_range("subseconds", time[1], 0xFFFFFFFF)
    packet[_TIME] = (seconds << 16 | subseconds >> 16).to_bytes(6, "big")


def origination_action(packet: bytearray, stamp: int) -> None:
    """Complete a packet at its origin: set the time of telemetry or the checksum of a command.

    A packet without the field stays unchanged (CFE_MSG_OriginationAction).

    Args:
        packet: the packet, changed in place.
        stamp: the time as a 48-bit integer, seconds << 16 | upper 16 bits of the subseconds.
    """
    kind = packet[0] & _KIND_MASK
    if kind == _TLM_KIND and len(packet) >= _TIME.stop:
        packet[_TIME] = stamp.to_bytes(6, "big")
    elif kind == _CMD_KIND and len(packet) >= CMD_HEADER_SIZE:
        generate_checksum(packet)


def verification_action(packet: Packet) -> bool:
    """Return whether the bus accepts an incoming packet: always, as in NASA's default (CFE_MSG_VerificationAction)."""
    return True


def get_type_from_msg_id(msg_id: int) -> MsgType:
    """Return whether a message id belongs to a command or telemetry (CFE_MSG_GetTypeFromMsgId)."""
    scratch = bytearray(PRIMARY_HEADER_SIZE)
    set_msg_id(scratch, msg_id)
    return get_type(scratch)


def get_header_size(packet: Packet) -> int:
    """Return the bytes of the headers: 6, 8 for a command, 16 for telemetry (CFE_SB_MsgHdrSize)."""
    first = packet[0] if packet else 0
    if not first & 0x08:
        return PRIMARY_HEADER_SIZE
    return CMD_HEADER_SIZE if first & 0x10 else TLM_HEADER_SIZE


def get_user_data(packet: Packet) -> memoryview:
    """Return a view of the bytes after the headers (CFE_SB_GetUserData)."""
    return memoryview(packet)[get_header_size(packet) :]


def get_user_data_length(packet: Packet) -> int:
    """Return the bytes after the headers, by the header's size (CFE_SB_GetUserDataLength)."""
    return get_size(packet) - get_header_size(packet)


def set_user_data_length(packet: bytearray, length: int) -> None:
    """Set the header's size so that `length` bytes follow the headers (CFE_SB_SetUserDataLength).

    Raises:
        CfeError: CFE_MSG_BAD_ARGUMENT if the packet would exceed the bus's limit of 32768 bytes.
    """
    size = check_range("packet size", get_header_size(packet) + length, MAX_BUS_MSG_SIZE)
    set_size(packet, size)


def command(msg_id: int, fcn_code: int, payload: bytes = b"") -> bytearray:
    """Return a whole command packet with its checksum.

    Raises:
        CfeError: if the id does not belong to a command, or a value does not fit.
    """
    packet = init(msg_id, CMD_HEADER_SIZE + len(payload))
    packet[CMD_HEADER_SIZE:] = payload
    set_fcn_code(packet, fcn_code)
    generate_checksum(packet)
    return packet


def telemetry(msg_id: int, payload: bytes = b"", header_size: int = TLM_HEADER_SIZE) -> bytearray:
    """Return a whole telemetry packet, its time still 0; cFE 6 has headers of another size."""
    packet = init(msg_id, header_size + len(payload))
    packet[header_size:] = payload
    return packet
