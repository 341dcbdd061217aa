"""The files that make a mission, as they were when it ran: found, hashed, and kept for a journal.

What a mission with a startup script can use is in its folder, which is taken as a whole; what else was read on the way,
such as launch files, node scripts, packages, meshes, is seen when it is opened (`cfepy.journal.reading`). May import
cfepy.mission.
"""

from __future__ import annotations

import os
import zlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

from cfepy.mission.spec import MissionSpec

CARRIED = 32 << 20  # bytes of files that a journal carries, before they are compressed
MOST_FILES = 5_000  # of a folder
_SKIPPED = ("__pycache__",)


@dataclass(frozen=True, slots=True)
class FileRecord:
    """A file of the computer that a run had.

    Attributes:
        path: absolute.
        size: in bytes.
        sha256: of its content, hexadecimal; empty when it could not be had.
        packed: its content, compressed; None when the journal does not carry it.
    """

    path: str
    size: int
    sha256: str
    packed: bytes | None = None

    @property
    def data(self) -> bytes | None:
        """Its content, if the journal carries it."""
        return None if self.packed is None else zlib.decompress(self.packed)

    def same_on_disk(self) -> bool:
        """Whether the file at its path has this content now."""
        try:
            return sha256(Path(self.path).read_bytes()).hexdigest() == self.sha256
        except OSError:
            return not self.sha256


class Carrier:
    """Makes records of files, and says which contents are still to be carried.

    Args:
        limit: bytes of contents that are carried altogether; 0 for none.
    """

    def __init__(self, limit: int) -> None:
        self._left = limit

    def record(self, path: str) -> FileRecord:
        """The record of a file as it is now."""
        try:
            content = Path(path).read_bytes()
        except OSError:
            return FileRecord(path, 0, "")
        packed = None
        if len(content) <= self._left:
            self._left -= len(content)
            packed = zlib.compress(content)
        return FileRecord(path, len(content), sha256(content).hexdigest(), packed)


def files_of(spec: MissionSpec) -> list[str]:
    """The files that a mission can use by itself, sorted: its folder's, if it has a startup script."""
    if spec.startup is not None and spec.mission_file is None:
        return []  # made from a launch file or a node script, which may lie anywhere; what it uses is seen
    found = [str(path) for path in _below(spec.folder)]
    return sorted({*found, str(spec.script)})


def _below(folder: Path) -> Iterator[Path]:
    count = 0
    for place, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if not name.startswith(".") and name not in _SKIPPED)
        for name in sorted(names):
            path = Path(place, name)
            if path.is_file() and not name.startswith("."):
                count += 1
                if count > MOST_FILES:
                    return
                yield path


def hash_of(files: Iterable[FileRecord]) -> str:
    """SHA-256 over names and contents."""
    whole = sha256()
    for each in sorted(files, key=lambda file: file.path):
        whole.update(f"{each.path}\0{each.size}\0{each.sha256}\n".encode())
    return whole.hexdigest()
