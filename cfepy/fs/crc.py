"""The cyclic redundancy checks of CFE_ES_CalculateCRC: table images, CDS blocks and code segments are guarded by them.

cFE computes CRC-16/ARC alone; its CRC_8 and CRC_32 have been names without an algorithm from the start and give 0.
Imports nothing of cfepy.
"""

from __future__ import annotations

CRC_NONE = 0
CRC_16 = 1
CRC_8 = 3
CRC_32 = 4

_POLYNOMIAL = 0xA001
"""x^16 + x^15 + x^2 + 1, bits reversed."""


def _entry(value: int) -> int:
    for _ in range(8):
        value = value >> 1 ^ (_POLYNOMIAL if value & 1 else 0)
    return value


_TABLE = tuple(_entry(value) for value in range(256))


def crc16(data: bytes | bytearray | memoryview, crc: int = 0) -> int:
    """CRC-16/ARC of some bytes.

    Args:
        data: the bytes.
        crc: result of the bytes before these, 0 to begin.
    """
    table = _TABLE
    crc &= 0xFFFF
    for byte in data:
        crc = crc >> 8 ^ table[(crc ^ byte) & 0xFF]
    return crc


def calculate_crc(data: bytes | bytearray | memoryview, crc: int = 0, kind: int = CRC_16) -> int:
    """CFE_ES_CalculateCRC.

    Args:
        data: the bytes; of none at all the result is `crc` itself.
        crc: result of the bytes before these, 0 to begin.
        kind: CRC_16; any other kind gives 0, as in cFE.
    """
    if len(data) == 0:
        return crc
    return crc16(data, crc) if kind == CRC_16 else 0
