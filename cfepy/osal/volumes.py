"""A volume of the virtual file system: files in memory, on top of a folder of the host if there is one.

The host's folder is only ever read; what a mission writes, renames or removes stays in memory and ends with it. A host
file is read once and kept, so that a run does not see later changes. Paths are relative to the volume, "sub/x.tbl".
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, field
from pathlib import Path

from cfepy.osal.limits import OS_FILESTAT_MODE_READ, OS_FILESTAT_MODE_WRITE
from cfepy.reading.input_files import read_limited


@dataclass(slots=True)
class FileNode:
    """A file.

    Attributes:
        data: its content.
        modified_ns: when it was last written, in ns of virtual time; 0 as it came with the mission.
        mode: what may be done with it, OS_FILESTAT_MODE_READ and _WRITE.
    """

    data: bytearray = field(default_factory=bytearray)
    modified_ns: int = 0
    mode: int = OS_FILESTAT_MODE_READ | OS_FILESTAT_MODE_WRITE


class Volume:
    """Files and folders below one mount point.

    Args:
        host: folder of the host that shows through, None for none.
        capacity: bytes that files in memory may take together, None for no limit.
    """

    def __init__(self, host: Path | None = None, capacity: int | None = None) -> None:
        self.host = host
        self.capacity = capacity
        self._nodes: dict[str, FileNode] = {}
        self._folders: set[str] = {""}
        self._hidden: set[str] = set()  # files and folders of the host that were removed or renamed

    def node(self, path: str) -> FileNode | None:
        """The file at a path; None when there is none."""
        found = self._nodes.get(path)
        if found is None and (real := self._on_host(path)) is not None and real.is_file():
            found = self._nodes[path] = FileNode(bytearray(read_limited(real, sys.maxsize)))
        return found

    def create(self, path: str) -> FileNode:
        """An empty file at a path where there was none."""
        node = self._nodes[path] = FileNode()
        return node

    def remove(self, path: str) -> None:
        """Take a file away."""
        self._nodes.pop(path, None)
        self._hidden.add(path)

    def rename(self, old: str, new: str) -> None:
        """Give a file another path in this volume; a file that was there is gone."""
        node = self.node(old)
        if node is not None:
            self.remove(old)
            self._nodes[new] = node

    def rename_folder(self, old: str, new: str) -> None:
        """Give a folder another path in this volume, with all that is in it."""
        self.make_folder(new)
        for name in self.names(old):
            source, target = _join(old, name), _join(new, name)
            if self.is_folder(source):
                self.rename_folder(source, target)
            else:
                self.rename(source, target)
        self.remove_folder(old)

    def is_folder(self, path: str) -> bool:
        """Whether there is a folder at a path."""
        real = self._on_host(path)
        return path in self._folders or (real is not None and real.is_dir())

    def make_folder(self, path: str) -> None:
        """Add a folder."""
        self._folders.add(path)

    def remove_folder(self, path: str) -> None:
        """Take an empty folder away."""
        self._folders.discard(path)
        self._hidden.add(path)

    def names(self, path: str) -> list[str]:
        """Names of the files and folders in a folder, sorted."""
        found = {_inside(path, other) for other in (*self._nodes, *self._folders)} - {""}
        real = self._on_host(path)
        if real is not None and real.is_dir():
            found |= {entry.name for entry in real.iterdir() if _join(path, entry.name) not in self._hidden}
        return sorted(found)

    def used(self) -> int:
        """Bytes of all files in memory."""
        return sum(len(node.data) for node in self._nodes.values())

    def has_room(self, size: int) -> bool:
        """Whether `size` more bytes fit."""
        return self.capacity is None or self.used() + size <= self.capacity

    def written(self) -> list[str]:
        """Paths of the files that a mission wrote, sorted; those that came with it are not among them."""
        return sorted(path for path, node in self._nodes.items() if node.modified_ns or self.host is None)

    def clear(self) -> None:
        """Remove everything that is in memory (format)."""
        self._nodes.clear()
        self._folders = {""}

    def _on_host(self, path: str) -> Path | None:
        if self.host is None:
            return None
        parts = path.split("/")
        if any("/".join(parts[: end + 1]) in self._hidden for end in range(len(parts))):
            return None
        return self.host / path


def _join(folder: str, name: str) -> str:
    return f"{folder}/{name}" if folder else name


def _inside(folder: str, path: str) -> str:
    """The name that leads from a folder towards a path inside it, "" when the path is elsewhere."""
    prefix = f"{folder}/" if folder else ""
    return path[len(prefix) :].partition("/")[0] if path.startswith(prefix) else ""
