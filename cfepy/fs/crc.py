"""The checksums of CFE_ES_CalculateCRC, which protect table images, CDS blocks and code segments.

cFE only computes CRC-16/ARC. Its CRC_8 and CRC_32 have always been names without an algorithm, and give 0.
"""

from __future__ import annotations

from functools import lru_cache

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


_PIECE = 256
_REMEMBERED = 4096


def crc16(data: bytes | bytearray | memoryview, crc: int = 0) -> int:
    """Return the CRC-16/ARC of some bytes.

    It is fast for an image that has changed little since the last call: the results of parts are cached, and the
    results of two parts give the result of both, because the code is linear.

    Args:
        data: the bytes.
        crc: result of the preceding bytes, 0 at the start.
    """
    crc &= 0xFFFF
    whole = len(data) - len(data) % _PIECE if len(data) >= 2 * _PIECE else 0
    if whole:
        if not crc and bytes(data) == bytes(len(data)):  # only zeros from the start: a table before its first load
            return 0
        low, high = _behind_a_piece()
        view = memoryview(data).cast("B")
        for start in range(0, whole, _PIECE):
            crc = low[crc & 0xFF] ^ high[crc >> 8] ^ _crc_of_piece(bytes(view[start : start + _PIECE]))
        data = view[whole:]
    return _crc_of(data, crc)


def _crc_of(data: bytes | memoryview | bytearray, crc: int) -> int:
    table = _TABLE
    for byte in data:
        crc = crc >> 8 ^ table[(crc ^ byte) & 0xFF]
    return crc


@lru_cache(_REMEMBERED)
def _crc_of_piece(piece: bytes) -> int:
    return _crc_of(piece, 0)


@lru_cache(1)
def _behind_a_piece() -> tuple[list[int], list[int]]:
    """Return the effect of a block of zeros on each CRC before it, for its low byte and its high byte."""
    zeros = bytes(_PIECE)
    of_bits = [_crc_of(zeros, 1 << bit) for bit in range(16)]
    return _sums(of_bits[:8]), _sums(of_bits[8:])


def _sums(of_bits: list[int]) -> list[int]:
    """Return the result for each byte from the results for its bits."""
    sums = [0]
    for result in of_bits:
        sums += [before ^ result for before in sums]
    return sums


def calculate_crc(data: bytes | bytearray | memoryview, crc: int = 0, kind: int = CRC_16) -> int:
    """Return a check value as CFE_ES_CalculateCRC does.

    Args:
        data: the bytes; without any, the result is `crc` itself.
        crc: result of the preceding bytes, 0 at the start.
        kind: CRC_16; any other kind gives 0, as in cFE.
    """
    if len(data) == 0:
        return crc
    return crc16(data, crc) if kind == CRC_16 else 0
