"""PIL.Image: pictures of 8 bits a channel from bytes and to bytes, and as PNG files without interlacing (RFC 2083)."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any, BinaryIO

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_COLOURS = {"L": (0, 1), "LA": (4, 2), "RGB": (2, 3), "RGBA": (6, 4)}  # PNG's number, and channels
_HINT = "pip install pillow"


class Image:
    """A picture.

    Args:
        mode: "L", "LA", "RGB" or "RGBA".
        size: width and height in pixels.
        data: rows from the top, with the channels of a pixel next to each other.
    """

    def __init__(self, mode: str, size: tuple[int, int], data: bytes) -> None:
        self.mode = mode
        self.size = self.width, self.height = size
        self._data = data
        self._row = size[0] * _channels(mode)
        if len(data) != self._row * size[1]:
            raise ValueError("not enough image data" if len(data) < self._row * size[1] else "too much image data")

    def tobytes(self) -> bytes:
        """Return its pixels."""
        return self._data

    def save(self, fp: str | BinaryIO, format: str = "PNG", **params: Any) -> None:
        """Write it as a PNG file.

        Raises:
            ImportError: another format requires Pillow itself.
        """
        if format.upper() != "PNG":
            raise ImportError(f"pictures in the format {format} need Pillow: {_HINT}")
        if isinstance(fp, str):
            Path(fp).write_bytes(self._png())
        else:
            fp.write(self._png())

    def _png(self) -> bytes:
        rows = range(0, len(self._data), self._row)
        lines = b"".join(b"\0" + self._data[at : at + self._row] for at in rows)
        head = struct.pack(">IIBBBBB", *self.size, 8, _COLOURS[self.mode][0], 0, 0, 0)
        return _SIGNATURE + _chunk(b"IHDR", head) + _chunk(b"IDAT", zlib.compress(lines)) + _chunk(b"IEND", b"")


def frombytes(mode: str, size: tuple[int, int], data: bytes) -> Image:
    """Make a picture from its pixels; see `Image`.

    Raises:
        ValueError: there are more or fewer bytes than the picture has.
    """
    return Image(mode, size, bytes(data))


def new(mode: str, size: tuple[int, int], color: int | tuple[int, ...] = 0) -> Image:
    """Make a picture of one colour."""
    pixel = bytes(color) if isinstance(color, tuple) else bytes([color] * _channels(mode))
    return Image(mode, size, pixel * (size[0] * size[1]))


def open(fp: str | BinaryIO) -> Image:
    """Read a PNG file.

    Raises:
        ImportError: it is another format, or a kind of PNG that requires Pillow itself.
    """
    data = Path(fp).read_bytes() if isinstance(fp, str) else fp.read()
    if not data.startswith(_SIGNATURE):
        raise ImportError(f"pictures other than PNG need Pillow: {_HINT}")
    chunks = list(_chunks(data))
    width, height, depth, colour, _, _, interlaced = struct.unpack(">IIBBBBB", chunks[0][1])
    mode = next((mode for mode, (number, _) in _COLOURS.items() if number == colour), None)
    if mode is None or depth != 8 or interlaced:
        raise ImportError(f"this kind of PNG needs Pillow: {_HINT}")
    lines = zlib.decompress(b"".join(content for name, content in chunks if name == b"IDAT"))
    return Image(mode, (width, height), _unfiltered(lines, width * _channels(mode), _channels(mode)))


def _channels(mode: str) -> int:
    if mode not in _COLOURS:
        raise ImportError(f"pictures of the mode {mode} need Pillow: {_HINT}")
    return _COLOURS[mode][1]


def _chunk(name: bytes, content: bytes) -> bytes:
    return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))


def _chunks(data: bytes) -> Iterator[tuple[bytes, bytes]]:
    at = len(_SIGNATURE)
    while at < len(data):
        length = int.from_bytes(data[at : at + 4], "big")
        yield data[at + 4 : at + 8], data[at + 8 : at + 8 + length]
        at += 12 + length


def _unfiltered(lines: bytes, width: int, step: int) -> bytes:
    """Undo the filters of lines that each begin with the number of their filter. Returns the pixels."""
    above, found = bytearray(width), bytearray()
    for at in range(0, len(lines), width + 1):
        kind, line = lines[at], bytearray(lines[at + 1 : at + 1 + width])
        for x in range(width):
            left, corner = (line[x - step], above[x - step]) if x >= step else (0, 0)
            line[x] = (line[x] + _guess(kind, left, above[x], corner)) & 0xFF
        found += line
        above = line
    return bytes(found)


def _guess(kind: int, left: int, up: int, corner: int) -> int:
    if kind == 4:
        return min((left, up, corner), key=lambda each: abs(left + up - corner - each))
    return (0, left, up, (left + up) // 2)[kind]
