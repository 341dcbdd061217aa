"""LZ4 frames as ROS writes them into bags, made by the package lz4: byte for byte those of ROS's own module roslz4.

They have independent blocks of 1 MB and a checksum of the content. May import lz4, and is the only one that does.
"""

from __future__ import annotations

from typing import Any

try:
    import lz4.block as _block
    import lz4.frame as _frame
except ImportError as _error:
    raise ImportError("LZ4 needs the package lz4: pip install 'cfepy[bag]'", name="lz4") from _error


_HEAD = 7  # bytes of a frame's header at least: magic, flags, size of blocks, check byte
_LINKED_WITHOUT, _BLOCK_CHECKSUMS, _HAS_SIZE, _HAS_DICTIONARY = 0x20, 0x10, 0x08, 0x01  # in the flags
_NOT_PACKED = 1 << 31  # in the size of a block
_WINDOW = 64 << 10  # bytes that a match may reach back
_LEAST_MATCH = 4


class LZ4Compressor:
    """Compresses piece by piece."""

    def __init__(self) -> None:
        size = _frame.BLOCKSIZE_MAX1MB
        self._frame: Any = _frame.LZ4FrameCompressor(block_size=size, block_linked=False, content_checksum=True)
        self._begun = False

    def compress(self, data: bytes) -> bytes:
        """Add a piece. Returns the bytes that are ready."""
        return self._begin() + bytes(self._frame.compress(data))

    def flush(self) -> bytes:
        """Return the rest of the frame."""
        return self._begin() + bytes(self._frame.flush())

    def _begin(self) -> bytes:
        head = b"" if self._begun else bytes(self._frame.begin())
        self._begun = True
        return head


class LZ4Decompressor:
    """Decompresses piece by piece."""

    def __init__(self) -> None:
        self._frame: Any = _frame.LZ4FrameDecompressor()

    def decompress(self, data: bytes) -> bytes:
        """Add a piece. Returns the bytes that are ready."""
        return bytes(self._frame.decompress(data))

    @property
    def eof(self) -> bool:
        """Whether the frame has ended."""
        return bool(self._frame.eof)


def compress(data: bytes) -> bytes:
    """Return a frame with all the data."""
    compressor = LZ4Compressor()
    return compressor.compress(data) + compressor.flush()


def decompress(data: bytes, most: int = -1) -> bytes:
    """Return the data of a frame.

    Args:
        data: the frame.
        most: maximum bytes of the result; the rest is left out. Negative for any number.

    Raises:
        RuntimeError: it is damaged.
    """
    return bytes(_frame.LZ4FrameDecompressor().decompress(data, most))


def unpacked(data: bytes, most: int) -> tuple[bytes, bool]:
    """Return the result of `decompress`, and whether the frame is complete."""
    frame = _frame.LZ4FrameDecompressor()
    return bytes(frame.decompress(data, most)), bool(frame.eof)


def beginning(data: bytes, most: int) -> bytes:
    """Return the data of a damaged or truncated frame up to the damage. No checksum is verified.

    The package lz4 decompresses complete blocks. Of the first incomplete one, all available data is decompressed.

    Args:
        data: the frame.
        most: maximum bytes of the result.
    """
    if len(data) < _HEAD:
        return b""
    flags, largest = data[4], 1 << 8 + 2 * (data[5] >> 4 & 7)
    at = _HEAD + 8 * bool(flags & _HAS_SIZE) + 4 * bool(flags & _HAS_DICTIONARY)
    found = bytearray()
    while at + 4 <= len(data) and len(found) < most:
        said = int.from_bytes(data[at : at + 4], "little")
        size = said % _NOT_PACKED
        block = data[at + 4 : at + 4 + size]
        if not said or size > largest:
            break
        window = b"" if flags & _LINKED_WITHOUT else bytes(found[-_WINDOW:])
        more, is_whole = (block, True) if said & _NOT_PACKED else _of_block(block, window, largest)
        found += more
        if not is_whole or len(block) < size:
            break
        at += 4 + size + 4 * bool(flags & _BLOCK_CHECKSUMS)
    return bytes(found[:most])


def _of_block(block: bytes, window: bytes, most: int) -> tuple[bytes, bool]:
    """Return the data of a block, and whether it is complete."""
    try:
        return bytes(_block.decompress(block, uncompressed_size=most, dict=window)), True
    except _block.LZ4BlockError:
        return _beginning_of_block(block, window, most), False


def _beginning_of_block(block: bytes, window: bytes, most: int) -> bytes:
    """Return the data of a block up to its end or its first invalid token; `window` is the data before it."""
    found, at, end = bytearray(window), 0, len(window) + most
    while at < len(block) and len(found) < end:
        token = block[at]
        length, at = _length(block, at + 1, token >> 4)
        found += block[at : at + length]
        at += length
        if at + 2 > len(block):
            break  # the end, or where it is cut off
        offset = int.from_bytes(block[at : at + 2], "little")
        length, at = _length(block, at + 2, token & 15)
        if at > len(block) or not 0 < offset <= len(found):
            break
        length = min(length + _LEAST_MATCH, end - len(found))
        match = bytes(found[len(found) - offset : len(found) - offset + length])
        found += (match * (length // len(match) + 1))[:length]
    return bytes(found[len(window) : end])


def _length(block: bytes, at: int, length: int) -> tuple[int, int]:
    """Return a length that a token begins, and the next position.

    If the length is truncated, that is behind the block's end.
    """
    if length < 15:
        return length, at
    while at < len(block):
        length += block[at]
        at += 1
        if block[at - 1] != 255:
            return length, at
    return length, at + 1
