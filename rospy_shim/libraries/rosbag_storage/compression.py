"""How the data of a chunk are compressed: not at all, by bz2 or by LZ4. Imports `bz2` and LZ4 when needed."""

from __future__ import annotations

from .errors import ROSBagException

NONE = "none"
BZ2 = "bz2"
LZ4 = "lz4"
ALL = (NONE, BZ2, LZ4)


def compress(kind: str, data: bytes) -> bytes:
    """Compress the data of a chunk.

    Args:
        kind: one of `ALL`.
        data: the chunk.

    Raises:
        ROSBagException: there is no such compression.
        ImportError: LZ4 is not installed.
    """
    if kind == NONE:
        return data
    if kind == BZ2:
        import bz2

        return bz2.compress(data)
    if kind == LZ4:
        from . import lz4_frames

        return lz4_frames.compress(data)
    raise ROSBagException(f"unsupported compression type: {kind}")


def decompress(kind: str, data: bytes) -> bytes:
    """What `compress` was given; the same arguments and errors."""
    if kind == NONE:
        return data
    if kind == BZ2:
        import bz2

        return bz2.decompress(data)
    if kind == LZ4:
        from . import lz4_frames

        return lz4_frames.decompress(data)
    raise ROSBagException(f"unsupported compression type: {kind}")
