"""Compression of a chunk's data: none, bz2 or LZ4, and in MCAP files Zstandard.

Imports what compresses when it is needed.
"""

from __future__ import annotations

from typing import Any

from .errors import ROSBagException, ROSBagFormatException

NONE = "none"
BZ2 = "bz2"
LZ4 = "lz4"
ZSTD = "zstd"  # of MCAP files only
ALL = (NONE, BZ2, LZ4)
LARGEST = 256 << 20  # bytes of a chunk: BAG_CHUNK_BYTES of `cfepy.reading.input_limits`, which nodes cannot see


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
    """Return the data that `compress` was given.

    Args:
        kind: one of `ALL`, or `ZSTD`.
        data: the compressed chunk.

    Raises:
        ROSBagException: there is no such compression, the data are damaged, or they become too large.
        ImportError: LZ4 or Zstandard is not installed.
    """
    if kind == NONE:
        return data
    if kind == BZ2:
        found = _of_bz2(data)
    elif kind == LZ4:
        from . import lz4_frames

        try:
            found = lz4_frames.decompress(data, LARGEST + 1)
        except RuntimeError as error:
            raise ROSBagFormatException(f"the data of a chunk are damaged: {error}") from None
    elif kind == ZSTD:
        found = _of_zstd(data)
    else:
        raise ROSBagException(f"unsupported compression type: {kind}")
    if len(found) > LARGEST:
        raise ROSBagFormatException(f"a chunk has more than {LARGEST:,} bytes when it is unpacked; record smaller ones")
    return found


def _of_zstd(data: bytes) -> bytes:
    """Decompress at most slightly more than `LARGEST` bytes."""
    zstandard = zstd()
    found = bytearray()
    try:
        for piece in zstandard.ZstdDecompressor().read_to_iter(data):
            found += piece
            if len(found) > LARGEST:
                break
    except zstandard.ZstdError as error:
        raise ROSBagFormatException(f"the data of a chunk are damaged: {error}") from None
    return bytes(found)


def zstd() -> Any:
    """Return the package zstandard.

    Raises:
        ImportError: it is not installed.
    """
    try:
        import zstandard
    except ImportError as error:
        raise ImportError(
            "Zstandard needs the package zstandard: pip install 'cfepy[mcap]'", name="zstandard"
        ) from error
    return zstandard


def _of_bz2(data: bytes) -> bytes:
    """Decompress at most slightly more than `LARGEST` bytes. There may be several streams, as with `bz2`."""
    import bz2

    found = b""
    while data and len(found) <= LARGEST:
        stream = bz2.BZ2Decompressor()
        try:
            more = stream.decompress(data, LARGEST + 1 - len(found))
        except OSError as error:
            if found:
                break  # bytes after a stream that are not a stream are ignored
            raise ROSBagFormatException(f"the data of a chunk are damaged: {error}") from None
        found = found + more if found else more
        if not stream.eof and len(found) <= LARGEST:
            raise ROSBagFormatException("the data of a chunk are cut off")
        data = stream.unused_data
    return found
