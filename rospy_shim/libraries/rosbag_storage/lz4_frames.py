"""LZ4 frames as ROS writes them into bags, made by the package lz4: byte for byte those of ROS's own module roslz4.

They have independent blocks of 1 MB and a checksum of the content. May import lz4, and is the only one that does.
"""

from __future__ import annotations

from typing import Any

try:
    import lz4.frame as _frame
except ImportError as _error:
    raise ImportError("LZ4 needs the package lz4: pip install 'cfepy[bag]'", name="lz4") from _error


class LZ4Compressor:
    """Compresses piece by piece."""

    def __init__(self) -> None:
        size = _frame.BLOCKSIZE_MAX1MB
        self._frame: Any = _frame.LZ4FrameCompressor(block_size=size, block_linked=False, content_checksum=True)
        self._begun = False

    def compress(self, data: bytes) -> bytes:
        """Take a piece; returns what is ready."""
        return self._begin() + bytes(self._frame.compress(data))

    def flush(self) -> bytes:
        """The rest of the frame."""
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
        """Take a piece; returns what is ready."""
        return bytes(self._frame.decompress(data))

    @property
    def eof(self) -> bool:
        """Whether the frame has ended."""
        return bool(self._frame.eof)


def compress(data: bytes) -> bytes:
    """A frame with all the data."""
    compressor = LZ4Compressor()
    return compressor.compress(data) + compressor.flush()


def decompress(data: bytes, most: int = -1) -> bytes:
    """The data of a frame.

    Args:
        data: the frame.
        most: bytes that it may become; what is behind them is left out. Negative for any number.

    Raises:
        RuntimeError: it is damaged.
    """
    return bytes(_frame.LZ4FrameDecompressor().decompress(data, most))
