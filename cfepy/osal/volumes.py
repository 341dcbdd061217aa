"""A volume of the virtual file system: files in memory, on top of an optional folder of the host.

The host's folder is only read. Files that a mission writes, renames or removes change in memory only. A host file is
read once and kept, so a run does not see later changes. Paths are relative to the volume, such as "sub/x.tbl".
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, field
from pathlib import Path

from cfepy.osal.limits import OS_FILESTAT_MODE_READ, OS_FILESTAT_MODE_WRITE
from cfepy.reading.input_files import read_limited

LAST_OF_TMPFS = (1 << 63) - 1
"""The last position in a file of a RAM disk, which is a tmpfs on NASA's Linux."""
LAST_OF_EXT4 = ((1 << 32) - 1) * 4096
"""The last position in a file of a folder of the computer, an ext4 there: blocks are numbered with 32 bits."""


@dataclass(slots=True)
class FileNode:
    """A file.

    Attributes:
        data: its content.
        modified_ns: virtual time of the last write in ns; 0 if the mission has not changed it.
        mode: the allowed access, OS_FILESTAT_MODE_READ and _WRITE.
        openings: number of descriptors that it is open with; they keep it and its bytes when it is removed.
    """

    data: bytearray = field(default_factory=bytearray)
    modified_ns: int = 0
    mode: int = OS_FILESTAT_MODE_READ | OS_FILESTAT_MODE_WRITE
    openings: int = 0


@dataclass(slots=True, eq=False)
class Folder:
    """A folder, which stays the same when it is renamed.

    Attributes:
        path: its path in the volume; None after its removal.
    """

    path: str | None


class Volume:
    """Files and folders below one mount point.

    Args:
        host: folder of the host under it; None for none.
        capacity: limit of the total size of files in memory, in bytes; None for no limit.
        last_position: the last position that a descriptor of a file can have.
    """

    def __init__(
        self, host: Path | None = None, capacity: int | None = None, last_position: int = LAST_OF_TMPFS
    ) -> None:
        self.host = host
        self.capacity = capacity
        self.last_position = last_position
        self._nodes: dict[str, FileNode] = {}
        self._removed: list[FileNode] = []  # files without a path that were open when they lost it
        self._folders: dict[str, Folder] = {"": Folder("")}
        self._hidden: set[str] = set()  # removed or renamed files and folders of the host

    def node(self, path: str) -> FileNode | None:
        """Return the file at a path, or None if there is none."""
        found = self._nodes.get(path)
        if found is None and (real := self._on_host(path)) is not None and real.is_file():
            found = self._nodes[path] = FileNode(bytearray(read_limited(real, sys.maxsize)))
        return found

    def create(self, path: str) -> FileNode:
        """Create an empty file at a path without one."""
        node = self._nodes[path] = FileNode()
        return node

    def remove(self, path: str) -> None:
        """Remove a file; an open one keeps its bytes."""
        self._forget(path)
        self._hidden.add(path)

    def rename(self, old: str, new: str) -> None:
        """Move a file within this volume, replacing an existing file."""
        node = self.node(old)
        if node is not None and new != old:
            self._forget(new)
            self._nodes[new] = self._nodes.pop(old)
            self._hidden.add(old)

    def rename_folder(self, old: str, new: str) -> None:
        """Move a folder within this volume, with its content."""
        names, moved = self.names(old), self.folder(old)
        if moved is None:
            return
        if new in self._folders:
            self.remove_folder(new)
        for name in names:
            source, target = _join(old, name), _join(new, name)
            if self.is_folder(source):
                self.rename_folder(source, target)
            else:
                self.rename(source, target)
        self.remove_folder(old)
        moved.path = new
        self._folders[new] = moved

    def folder(self, path: str) -> Folder | None:
        """Return the folder at a path, or None if there is none."""
        found = self._folders.get(path)
        if found is None and (real := self._on_host(path)) is not None and real.is_dir():
            found = self._folders[path] = Folder(path)
        return found

    def is_folder(self, path: str) -> bool:
        """Return whether there is a folder at a path."""
        return self.folder(path) is not None

    def make_folder(self, path: str) -> None:
        """Add a folder; one that exists stays as it is."""
        self._folders.setdefault(path, Folder(path))

    def remove_folder(self, path: str) -> None:
        """Remove an empty folder."""
        removed = self._folders.pop(path, None)
        if removed is not None:
            removed.path = None
        self._hidden.add(path)

    def names(self, path: str) -> list[str]:
        """Return the names of the files and folders in a folder, sorted."""
        found = {_inside(path, other) for other in (*self._nodes, *self._folders)} - {""}
        real = self._on_host(path)
        if real is not None and real.is_dir():
            found |= {entry.name for entry in real.iterdir() if _join(path, entry.name) not in self._hidden}
        return sorted(found)

    def used(self) -> int:
        """Return the total bytes of the files in memory, with those that were removed while open."""
        self._removed = [node for node in self._removed if node.openings]
        return sum(len(node.data) for node in (*self._nodes.values(), *self._removed))

    def room(self) -> int | None:
        """Return the number of bytes that fit in addition; None for no limit."""
        return None if self.capacity is None else max(0, self.capacity - self.used())

    def written(self) -> list[str]:
        """Return the sorted paths of the files that the mission wrote, without its original files."""
        return sorted(path for path, node in self._nodes.items() if node.modified_ns or self.host is None)

    def clear(self) -> None:
        """Remove all files in memory (format)."""
        self._nodes.clear()
        for folder in self._folders.values():
            folder.path = None
        self._folders = {"": Folder("")}

    def _forget(self, path: str) -> None:
        node = self._nodes.pop(path, None)
        if node is not None and node.openings:
            self._removed.append(node)

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
    """Return the next name on the way from a folder to a path inside it, or "" if the path is elsewhere."""
    prefix = f"{folder}/" if folder else ""
    return path[len(prefix) :].partition("/")[0] if path.startswith(prefix) else ""
