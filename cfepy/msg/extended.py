"""The fields of CCSDS extended headers ("version 2"): none of them exists here.

cfepy builds packets with the plain primary header, as cFE's default configuration does; every function of this module
raises CFE_MSG_NOT_IMPLEMENTED. Imports only cfepy.status and the primary header.
"""

from __future__ import annotations

from typing import NoReturn

from cfepy.msg.header import Packet
from cfepy.status import CFE_MSG_NOT_IMPLEMENTED, CfeError


def _absent(field: str) -> NoReturn:
    raise CfeError(CFE_MSG_NOT_IMPLEMENTED, f"{field} is in the extended header, which this mission does not use")


def get_eds_version(packet: Packet) -> NoReturn:
    """CFE_MSG_GetEDSVersion: not with this header."""
    _absent("the EDS version")


def set_eds_version(packet: bytearray, version: int) -> NoReturn:
    """CFE_MSG_SetEDSVersion: not with this header."""
    _absent("the EDS version")


def get_endian(packet: Packet) -> NoReturn:
    """CFE_MSG_GetEndian: not with this header."""
    _absent("the byte order")


def set_endian(packet: bytearray, endian: int) -> NoReturn:
    """CFE_MSG_SetEndian: not with this header."""
    _absent("the byte order")


def get_playback_flag(packet: Packet) -> NoReturn:
    """CFE_MSG_GetPlaybackFlag: not with this header."""
    _absent("the playback flag")


def set_playback_flag(packet: bytearray, flag: int) -> NoReturn:
    """CFE_MSG_SetPlaybackFlag: not with this header."""
    _absent("the playback flag")


def get_subsystem(packet: Packet) -> NoReturn:
    """CFE_MSG_GetSubsystem: not with this header."""
    _absent("the subsystem")


def set_subsystem(packet: bytearray, subsystem: int) -> NoReturn:
    """CFE_MSG_SetSubsystem: not with this header."""
    _absent("the subsystem")


def get_system(packet: Packet) -> NoReturn:
    """CFE_MSG_GetSystem: not with this header."""
    _absent("the system")


def set_system(packet: bytearray, system: int) -> NoReturn:
    """CFE_MSG_SetSystem: not with this header."""
    _absent("the system")
