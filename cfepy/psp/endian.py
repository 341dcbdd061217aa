"""CFE_PSP_HtoBE16 and its kin: the simulated processors are little-endian, so the LE forms change nothing.

Imports nothing of cfepy.
"""

from __future__ import annotations


def _swapped(value: int, size: int) -> int:
    return int.from_bytes((value & (1 << 8 * size) - 1).to_bytes(size, "little"), "big")


def swap_16(value: int) -> int:
    """The 16-bit number with its bytes the other way round (CFE_PSP_HtoBE16, CFE_PSP_BE16toH)."""
    return _swapped(value, 2)


def swap_32(value: int) -> int:
    """The 32-bit number with its bytes the other way round (CFE_PSP_HtoBE32, CFE_PSP_BE32toH)."""
    return _swapped(value, 4)


def swap_64(value: int) -> int:
    """The 64-bit number with its bytes the other way round (CFE_PSP_HtoBE64, CFE_PSP_BE64toH)."""
    return _swapped(value, 8)


def keep_16(value: int) -> int:
    """The lower 16 bits as they are (CFE_PSP_HtoLE16, CFE_PSP_LE16toH)."""
    return value & 0xFFFF


def keep_32(value: int) -> int:
    """The lower 32 bits as they are (CFE_PSP_HtoLE32, CFE_PSP_LE32toH)."""
    return value & 0xFFFFFFFF


def keep_64(value: int) -> int:
    """The lower 64 bits as they are (CFE_PSP_HtoLE64, CFE_PSP_LE64toH)."""
    return value & 0xFFFFFFFFFFFFFFFF


def is_big_endian() -> bool:
    """Whether the processor is big-endian (CFE_PSP_IsBigEndian)."""
    return False


def is_little_endian() -> bool:
    """Whether the processor is little-endian (CFE_PSP_IsLittleEndian)."""
    return True
