"""The file of a journal: a mark, then frames, each with its length and checksum, so that a broken file is told.

A frame is written in one go and handed to the operating system at once: a process that is killed leaves all frames but
at most the last one. A frame is `<II` (bytes that follow, their CRC-32) and a msgpack array: its kind, and a mapping.
May import cfepy.status.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from cfepy.status import UsageError

MARK = b"cfepy journal\r\n\x1a"
LARGEST = 1 << 30  # bytes of a frame; a length beyond is no length
_head = struct.Struct("<II")


def is_journal(path: str | Path) -> bool:
    """Whether a file begins as a journal does.

    Raises:
        OSError: it cannot be read.
    """
    with open(path, "rb") as file:
        return file.read(len(MARK)) == MARK


class JournalError(UsageError):
    """A file that is no journal, is broken, or is of a kind that cannot be read here."""


class FrameWriter:
    """Writes a journal's frames.

    Args:
        path: the file; what was in it is lost.

    Raises:
        OSError: it cannot be written.
    """

    def __init__(self, path: str | Path) -> None:
        import msgpack

        self._pack = msgpack.Packer().pack
        self._file = open(path, "wb", buffering=0)  # noqa: SIM115  # closed in `close`
        self._file.write(MARK)

    def write(self, kind: str, body: Mapping[str, Any]) -> None:
        """Write a frame.

        Raises:
            OSError: the disk is full.
        """
        data = self._pack([kind, body])
        frame = memoryview(_head.pack(len(data), zlib.crc32(data)) + data)
        while frame:
            frame = frame[self._file.write(frame) :]

    def close(self) -> None:
        """No more frames."""
        self._file.close()


def read_frames(path: str | Path) -> Iterator[tuple[str, dict[str, Any]]]:
    """The frames of a journal, kind and body; a last one that was cut off is left out.

    Raises:
        JournalError: it is no journal, or it is damaged.
        OSError: it cannot be read.
    """
    import msgpack

    with open(path, "rb") as file:
        if file.read(len(MARK)) != MARK:
            raise JournalError("is no journal; give a file that `cfepy run --record FILE` wrote", file=path)
        while len(head := file.read(_head.size)) == _head.size:
            size, checksum = _head.unpack(head)
            at = file.tell()
            data = file.read(min(size, LARGEST))
            if len(data) < size <= LARGEST:
                return
            if size > LARGEST or zlib.crc32(data) != checksum:
                raise JournalError(f"is damaged at byte {at}: the checksum is wrong; copy it again", file=path)
            kind, body = msgpack.unpackb(data, strict_map_key=False)
            yield kind, body
