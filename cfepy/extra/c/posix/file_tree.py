"""Files and folders of OSAL's file system in the terms of POSIX: paths, open files, and changes by path.

The current folder of the process is the root, which has the mount points: /cf, cf and ./cf are the same folder. A path
that leads elsewhere does not exist. OSAL's limits on the lengths of names do not apply.
"""

from __future__ import annotations

import errno
import zlib
from collections.abc import Callable
from typing import NamedTuple

from cfepy.extra.c.posix.open_descriptors import (
    O_ACCMODE,
    O_APPEND,
    O_CREAT,
    O_DIRECTORY,
    O_EXCL,
    O_RDONLY,
    O_RDWR,
    O_TRUNC,
    O_WRONLY,
    S_IFDIR,
    S_IFREG,
    SEEK_CUR,
    SEEK_END,
    SEEK_SET,
    Descriptor,
    Facts,
    failure,
)
from cfepy.osal import OS_FILESTAT_MODE_READ, OS_FILESTAT_MODE_WRITE, FileNode, FilePlace, FileSystem
from cfepy.reading.texts import to_bytes

LONGEST_PATH, LONGEST_NAME = 4096, 256
R_OK, W_OK, X_OK = 4, 2, 1
_OWNER_READS, _OWNER_WRITES = 0o400, 0o200
FOLDER = Facts(S_IFDIR | 0o755, 4096)


class FoundPath(NamedTuple):
    """The object at a path.

    Attributes:
        path: the whole path, without ".", ".." and empty parts.
        place: volume and path in it; None for the root.
        node: the file there; None for a folder, or if there is nothing.
        is_folder: whether there is a folder.
        must_be_folder: whether the path ends in "/" or ".".
    """

    path: str
    place: FilePlace | None
    node: FileNode | None
    is_folder: bool
    must_be_folder: bool

    @property
    def number(self) -> int:
        """The number of the file, which is the same in each run."""
        return zlib.crc32(to_bytes(self.path)) | 1


class PosixFiles:
    """The file system of a processor.

    Args:
        files: OSAL's file system.
        now: returns the virtual time in ns.
        tell: gets each path that leads out of the file system, with the name of the function.
    """

    def __init__(self, files: FileSystem, now: Callable[[], int], tell: Callable[[str, str], object]) -> None:
        self.files = files
        self.now = now
        self._tell = tell

    def find(self, function: str, path: str) -> FoundPath:
        """Return the object at a path, which may be absent.

        Args:
            function: the function of C that needs it.
            path: the path.

        Raises:
            OSError: ENOENT if the path is outside or its folder does not exist, ENOTDIR, ENAMETOOLONG.
        """
        parts = [each for each in path.split("/") if each and each != "."]
        if not path:
            raise failure(errno.ENOENT)
        if len(to_bytes(path)) >= LONGEST_PATH or any(len(to_bytes(each)) >= LONGEST_NAME for each in parts):
            raise failure(errno.ENAMETOOLONG)
        ends_in_folder = path.endswith(("/", "/.", "/..")) or path in (".", "..")
        kept: list[str] = []
        for number, part in enumerate(parts):
            if part != "..":
                kept.append(part)
            if number + 1 < len(parts) or part == "..":
                self._enter(function, path, kept)
            if part == ".." and kept:
                kept.pop()
        return self._at(function, path, kept, ends_in_folder)

    def _enter(self, function: str, path: str, parts: list[str]) -> None:
        """Check that a part of a path is a folder."""
        found = self._at(function, path, parts, False)
        if found.node is not None:
            raise failure(errno.ENOTDIR)
        if not found.is_folder:
            raise failure(errno.ENOENT)

    def _at(self, function: str, path: str, parts: list[str], must_be_folder: bool) -> FoundPath:
        whole = "/" + "/".join(parts)
        if not parts:
            return FoundPath(whole, None, None, True, must_be_folder)
        place = self.files.place_of(whole)
        if place is None:
            if any(each.startswith(f"{whole}/") for each in self.files.mount_points()):
                return FoundPath(whole, None, None, True, must_be_folder)
            self._tell(function, path)
            raise failure(errno.ENOENT)
        node = place.node()
        if node is not None and must_be_folder:
            raise failure(errno.ENOTDIR)
        return FoundPath(whole, place, node, node is None and place.volume.is_folder(place.path), must_be_folder)

    # -- opening -----------------------------------------------------------------------------------------------------

    def open(self, function: str, path: str, flags: int, mode: int) -> Descriptor:
        """Open a file or a folder.

        Args:
            function: the function of C.
            path: the path.
            flags: Linux's flags.
            mode: the permissions of a new file.

        Raises:
            OSError: as open of Linux.
        """
        found = self.find(function, path)
        writes = flags & O_ACCMODE != O_RDONLY
        if flags & O_CREAT and flags & O_EXCL and (found.node is not None or found.is_folder):
            raise failure(errno.EEXIST)
        if found.is_folder:
            if writes or flags & O_CREAT:
                raise failure(errno.EISDIR)
            return OpenFolder(self, found)
        if flags & O_DIRECTORY:
            raise failure(errno.ENOENT if found.node is None else errno.ENOTDIR)
        node = found.node
        assert found.place is not None
        if node is None:
            if not flags & O_CREAT:
                raise failure(errno.ENOENT)
            if found.must_be_folder:
                raise failure(errno.EISDIR)
            self._check_parent(found)
            node = found.place.volume.create(found.place.path)
            node.modified_ns = self.now()
            node.mode = OS_FILESTAT_MODE_READ * bool(mode & _OWNER_READS)
            node.mode |= OS_FILESTAT_MODE_WRITE * bool(mode & _OWNER_WRITES)
        else:
            self._check_access(node, flags & O_ACCMODE)
            if flags & O_TRUNC and writes:
                node.data.clear()
                node.modified_ns = self.now()
        return OpenFile(self, found, node, flags)

    def _check_parent(self, found: FoundPath) -> None:
        assert found.place is not None
        volume, path, _ = found.place
        if not path or not volume.is_folder(path.rpartition("/")[0]):
            raise failure(errno.ENOENT)

    def _check_access(self, node: FileNode, access: int) -> None:
        needed = OS_FILESTAT_MODE_READ * (access in (O_RDONLY, O_RDWR))
        needed |= OS_FILESTAT_MODE_WRITE * (access in (O_WRONLY, O_RDWR))
        if needed & ~node.mode:
            raise failure(errno.EACCES)

    # -- by path -----------------------------------------------------------------------------------------------------

    def facts(self, function: str, path: str) -> Facts:
        """Return the result of stat."""
        found = self.existing(function, path)
        return self.facts_of(found, found.node)

    def facts_of(self, found: FoundPath, node: FileNode | None) -> Facts:
        """Return the result of stat for an object."""
        if node is None:
            return Facts(FOLDER.mode, FOLDER.size, 0, found.number)
        mode = 0o444 * bool(node.mode & OS_FILESTAT_MODE_READ) | _OWNER_WRITES * bool(
            node.mode & OS_FILESTAT_MODE_WRITE
        )
        return Facts(S_IFREG | mode, len(node.data), node.modified_ns, found.number)

    def existing(self, function: str, path: str) -> FoundPath:
        """Return the object at a path.

        Raises:
            OSError: as `find`, and ENOENT if there is none.
        """
        found = self.find(function, path)
        if found.node is None and not found.is_folder:
            raise failure(errno.ENOENT)
        return found

    def access(self, function: str, path: str, wanted: int) -> None:
        """Raise EACCES if a path does not permit an access (R_OK, W_OK, X_OK)."""
        found = self.existing(function, path)
        if found.node is None:
            return
        mode = found.node.mode
        if (
            (wanted & X_OK)
            or (wanted & R_OK and not mode & OS_FILESTAT_MODE_READ)
            or (wanted & W_OK and not mode & OS_FILESTAT_MODE_WRITE)
        ):
            raise failure(errno.EACCES)

    def truncate(self, function: str, path: str, size: int) -> None:
        """Make a file shorter or longer."""
        found = self.existing(function, path)
        if found.node is None:
            raise failure(errno.EISDIR)
        self._check_access(found.node, O_WRONLY)
        OpenFile(self, found, found.node, O_WRONLY).truncate(size)

    def make_folder(self, function: str, path: str) -> None:
        """Make a folder; raises EEXIST if there is anything."""
        found = self.find(function, path.rstrip("/") or "/")
        if found.node is not None or found.is_folder:
            raise failure(errno.EEXIST)
        self._check_parent(found)
        assert found.place is not None
        found.place.volume.make_folder(found.place.path)

    def remove_folder(self, function: str, path: str) -> None:
        """Remove an empty folder."""
        found = self.existing(function, path)
        if found.node is not None:
            raise failure(errno.ENOTDIR)
        if path.endswith("/.") or path == ".":
            raise failure(errno.EINVAL)
        if found.place is None or not found.place.path:
            raise failure(errno.EBUSY)
        if found.place.volume.names(found.place.path):
            raise failure(errno.ENOTEMPTY)
        found.place.volume.remove_folder(found.place.path)

    def unlink(self, function: str, path: str) -> None:
        """Remove a file; an open one keeps its bytes."""
        found = self.existing(function, path)
        if found.node is None:
            raise failure(errno.EISDIR)
        assert found.place is not None
        found.place.volume.remove(found.place.path)

    def remove(self, function: str, path: str) -> None:
        """Remove a file or an empty folder."""
        if self.existing(function, path).node is None:
            self.remove_folder(function, path)
        else:
            self.unlink(function, path)

    def rename(self, function: str, old: str, new: str) -> None:
        """Rename a file or folder, replacing a file or an empty folder."""
        source, target = self.existing(function, old), self.find(function, new)
        if source.place is None or target.place is None or not source.place.path or not target.place.path:
            raise failure(errno.EBUSY)
        volume = source.place.volume
        if volume is not target.place.volume:
            raise failure(errno.EXDEV)
        if source.path == target.path:
            return
        if source.node is not None:
            if target.is_folder:
                raise failure(errno.EISDIR)
            if target.must_be_folder:
                raise failure(errno.ENOTDIR)
            self._check_parent(target)
            volume.rename(source.place.path, target.place.path)
            return
        if target.node is not None:
            raise failure(errno.ENOTDIR)
        if f"{target.path}/".startswith(f"{source.path}/"):
            raise failure(errno.EINVAL)
        if target.is_folder and volume.names(target.place.path):
            raise failure(errno.ENOTEMPTY)
        self._check_parent(target)
        volume.rename_folder(source.place.path, target.place.path)

    def names(self, found: FoundPath) -> list[str]:
        """Return the names in a folder, sorted."""
        if found.place is not None:
            return found.place.volume.names(found.place.path)
        inside = found.path.rstrip("/") + "/"
        points = (each for each in self.files.mount_points() if each.startswith(inside))
        return sorted({each[len(inside) :].partition("/")[0] for each in points})


class OpenFile(Descriptor):
    """An open file.

    Args:
        files: the file system.
        found: the file's place.
        node: the file.
        flags: the flags of open.
    """

    is_regular = True

    def __init__(self, files: PosixFiles, found: FoundPath, node: FileNode, flags: int) -> None:
        super().__init__(flags)
        self._files = files
        self._found = found
        self._node = node
        self._position = 0
        node.openings += 1

    def read(self, count: int) -> bytes:
        data = self.read_at(count, self._position)
        self._position += len(data)
        return data

    def read_at(self, count: int, position: int) -> bytes:
        if self.flags & O_ACCMODE == O_WRONLY:
            raise failure(errno.EBADF)
        if position < 0:
            raise failure(errno.EINVAL)
        return bytes(self._node.data[position : position + count])

    def write(self, data: bytes) -> int:
        if self.flags & O_APPEND:
            self._position = len(self._node.data)
        count = self.write_at(data, self._position)
        self._position += count
        return count

    def write_at(self, data: bytes, position: int) -> int:
        if self.flags & O_ACCMODE == O_RDONLY:
            raise failure(errno.EBADF)
        if position < 0:
            raise failure(errno.EINVAL)
        held = self._node.data
        size, end = len(held), position + len(data)
        if data and end > size:
            end = self._fitting(end)
            if end <= position:
                raise failure(errno.ENOSPC)
            held.extend(bytes(end - size))
        count = end - position
        held[position:end] = data[:count]
        if count:
            self._node.modified_ns = self._files.now()
        return count

    def _fitting(self, wanted: int) -> int:
        assert self._found.place is not None
        return self._files.files.fitting(self._found.place.volume, len(self._node.data), wanted)

    def seek(self, offset: int, whence: int) -> int:
        origins = {SEEK_SET: 0, SEEK_CUR: self._position, SEEK_END: len(self._node.data)}
        if whence not in origins or origins[whence] + offset < 0:
            raise failure(errno.EINVAL)
        self._position = origins[whence] + offset
        return self._position

    def waiting(self) -> int:
        return len(self._node.data) - self._position

    def truncate(self, size: int) -> None:
        if self.flags & O_ACCMODE == O_RDONLY or size < 0:
            raise failure(errno.EINVAL)
        held = self._node.data
        if size > len(held):
            if self._fitting(size) < size:
                raise failure(errno.ENOSPC)
            held.extend(bytes(size - len(held)))
        del held[size:]
        self._node.modified_ns = self._files.now()

    def facts(self) -> Facts:
        return self._files.facts_of(self._found, self._node)

    def close(self) -> None:
        self._node.openings -= 1


class OpenFolder(Descriptor):
    """An open folder: its names, as of the first reading.

    Args:
        files: the file system.
        found: its place.

    Attributes:
        position: the number of names that were read.
    """

    def __init__(self, files: PosixFiles, found: FoundPath) -> None:
        super().__init__(O_RDONLY)
        self._files = files
        self._found = found
        self._names: list[str] | None = None
        self.position = 0

    @property
    def path(self) -> str:
        """Its whole path."""
        return self._found.path

    def read(self, count: int) -> bytes:
        raise failure(errno.EISDIR)

    def write(self, data: bytes) -> int:
        raise failure(errno.EBADF)

    def seek(self, offset: int, whence: int) -> int:
        return 0

    def facts(self) -> Facts:
        return self._files.facts_of(self._found, None)

    def next_name(self) -> tuple[str, FoundPath] | None:
        """Return the next name and its object, or None at the end; "." and ".." come first."""
        if self._names is None:
            self._names = [".", "..", *self._files.names(self._found)]
        if self.position >= len(self._names):
            return None
        name = self._names[self.position]
        self.position += 1
        inside = f"{self._found.path.rstrip('/')}/{name}"
        try:
            return name, self._files.find("readdir", inside)
        except OSError:  # it was removed meanwhile
            return name, FoundPath(inside, None, None, False, False)

    def rewind(self) -> None:
        """Begin again, with the names of now."""
        self._names = None
        self.position = 0
