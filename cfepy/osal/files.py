"""OSAL's file and directory functions (osapi-file.h, osapi-dir.h) on the virtual file system.

A read gives bytes, b"" at the end of the file. Reading and writing never wait, so there are no timed forms here. May
import cfepy.ids, status and its neighbours in cfepy.osal.
"""

from __future__ import annotations

from typing import NamedTuple

from cfepy.ids import OS_DIR_BASE, OS_STREAM_BASE
from cfepy.osal.core import Core, ObjectTable, OsObject, Setup, check_size
from cfepy.osal.filesystem import FileSystem
from cfepy.osal.limits import (
    OS_FILE_FLAG_CREATE,
    OS_FILE_FLAG_NONE,
    OS_FILE_FLAG_TRUNCATE,
    OS_FILESTAT_MODE_DIR,
    OS_FILESTAT_MODE_READ,
    OS_FILESTAT_MODE_WRITE,
    OS_MAX_NUM_OPEN_DIRS,
    OS_MAX_NUM_OPEN_FILES,
    OS_READ_ONLY,
    OS_READ_WRITE,
    OS_SEEK_CUR,
    OS_SEEK_END,
    OS_SEEK_SET,
    OS_WRITE_ONLY,
    PS_PER_NS,
)
from cfepy.osal.volumes import Node
from cfepy.status import OS_ERROR, OS_FS_ERR_PATH_INVALID, OsalError


class FileStat(NamedTuple):
    """What `stat` tells (os_fstat_t): mode bits, bytes, and virtual time of the last change in ns."""

    file_mode: int
    file_size: int
    file_time_ns: int


class FileInfo(NamedTuple):
    """What `fd_get_info` tells (OS_file_prop_t)."""

    path: str
    user: int
    is_valid: bool


class OsFile(OsObject):
    """The record of an open file."""

    __slots__ = ("access", "node", "path", "position")

    def __init__(self, name: str, path: str, node: Node, access: int) -> None:
        super().__init__(name)
        self.path = path
        self.node = node
        self.access = access
        self.position = 0


class OsDirectory(OsObject):
    """The record of an open folder."""

    __slots__ = ("entries", "position")

    def __init__(self, name: str, entries: list[str]) -> None:
        super().__init__(name)
        self.entries = entries
        self.position = 0


class FileApi(Core):
    """The functions on files, by path and by descriptor, and on folders."""

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        self.files: FileSystem = setup.files
        self._streams: ObjectTable[OsFile] = self._table("file", OS_STREAM_BASE, OS_MAX_NUM_OPEN_FILES)
        self._directories: ObjectTable[OsDirectory] = self._table("directory", OS_DIR_BASE, OS_MAX_NUM_OPEN_DIRS)
        self._opened = 0

    def open_create(self, path: str, flags: int = OS_FILE_FLAG_NONE, access_mode: int = OS_READ_ONLY) -> int:
        """Open a file (OS_OpenCreate).

        Args:
            path: virtual path, e.g. "/ram/log.bin".
            flags: OS_FILE_FLAG_CREATE and OS_FILE_FLAG_TRUNCATE.
            access_mode: OS_READ_ONLY, OS_WRITE_ONLY or OS_READ_WRITE.

        Returns:
            The descriptor.

        Raises:
            OsalError: OS_ERROR for a bad mode or no such file; OS_FS_ERR_* for the path; OS_ERR_NO_FREE_IDS.
        """
        if access_mode not in (OS_READ_ONLY, OS_WRITE_ONLY, OS_READ_WRITE):
            raise OsalError(OS_ERROR, f"access mode {access_mode} for {path}")
        node = self.files.open_node(path) if flags & OS_FILE_FLAG_CREATE else self.files.find(path)
        if node is None:
            raise OsalError(OS_ERROR, f"there is no file {path}")
        if flags & OS_FILE_FLAG_TRUNCATE:
            node.data.clear()
        return self._register(self._streams, OsFile(self._next_name(), path, node, access_mode), "file", 0)

    def close(self, filedes: int) -> None:
        """Close a descriptor (OS_close), or OS_ERR_INVALID_ID."""
        self._unregister(self._streams, self._stream(filedes))

    def read(self, filedes: int, nbytes: int) -> bytes:
        """Read at most `nbytes` from where the descriptor stands (OS_read).

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERR_INVALID_SIZE, OS_ERROR when it is not open for reading.
        """
        check_size(nbytes, "read")
        stream = self._stream(filedes)
        if stream.access == OS_WRITE_ONLY:
            raise OsalError(OS_ERROR, f"{stream.path} is not open for reading")
        data = bytes(stream.node.data[stream.position : stream.position + nbytes])
        stream.position += len(data)
        self._charge_bytes(len(data))
        return data

    def write(self, filedes: int, data: bytes | bytearray | memoryview) -> int:
        """Write where the descriptor stands (OS_write); how many bytes that were.

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERR_INVALID_SIZE, OS_ERROR when it is not open for writing or the disk is
                full.
        """
        check_size(len(data), "write")
        stream = self._stream(filedes)
        if stream.access == OS_READ_ONLY:
            raise OsalError(OS_ERROR, f"{stream.path} is not open for writing")
        end = stream.position + len(data)
        self._grow(stream, end)
        stream.node.data[stream.position : end] = data
        stream.node.modified_ns = self.kernel.now
        stream.position = end
        self._charge_bytes(len(data))
        return len(data)

    def lseek(self, filedes: int, offset: int, whence: int) -> int:
        """Move a descriptor (OS_lseek); the new position from the start.

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERROR for a bad `whence` or a place before the start.
        """
        stream = self._stream(filedes)
        origins = {OS_SEEK_SET: 0, OS_SEEK_CUR: stream.position, OS_SEEK_END: len(stream.node.data)}
        if whence not in origins or origins[whence] + offset < 0:
            raise OsalError(OS_ERROR, f"seek by {offset} from {whence} in {stream.path}")
        stream.position = origins[whence] + offset
        return stream.position

    def file_allocate(self, filedes: int, offset: int, length: int) -> None:
        """Make a file at least `offset + length` bytes long (OS_FileAllocate), or OS_ERROR when there is no room."""
        self._grow(self._stream(filedes), offset + length)

    def file_truncate(self, filedes: int, length: int) -> None:
        """Make a file `length` bytes long (OS_FileTruncate), or OS_ERROR when there is no room."""
        stream = self._stream(filedes)
        self._grow(stream, length)
        del stream.node.data[length:]

    def stat(self, path: str) -> FileStat:
        """Facts about a file or folder (OS_stat).

        Raises:
            OsalError: OS_ERROR when there is none; OS_FS_ERR_* for the path.
        """
        node = self.files.find(path)
        mode = OS_FILESTAT_MODE_READ | OS_FILESTAT_MODE_WRITE
        if node is not None:
            return FileStat(mode, len(node.data), node.modified_ns)
        if self.files.is_folder(path):
            return FileStat(mode | OS_FILESTAT_MODE_DIR, 0, 0)
        raise OsalError(OS_ERROR, f"there is nothing at {path}")

    def remove(self, path: str) -> None:
        """Remove a file (OS_remove); OS_ERROR when there is none, OS_FS_ERR_* for the path."""
        self.files.remove(path)

    def rename(self, old_filename: str, new_filename: str) -> None:
        """Rename a file within a volume (OS_rename); OS_ERROR when that cannot be, OS_FS_ERR_* for the paths."""
        self.files.rename(old_filename, new_filename)
        for _, stream in self._streams.items():
            if stream.path == old_filename:
                stream.path = new_filename

    def cp(self, src: str, dest: str) -> None:
        """Copy a file (OS_cp); OS_ERROR when there is none or no room, OS_FS_ERR_* for the paths."""
        self.files.write_file(dest, self.files.read_file(src), self.kernel.now)

    def mv(self, src: str, dest: str) -> None:
        """Move a file, to another volume too (OS_mv); errors as `cp`."""
        try:
            self.rename(src, dest)
        except OsalError:
            self.cp(src, dest)
            self.remove(src)

    def fd_get_info(self, filedes: int) -> FileInfo:
        """Facts about a descriptor (OS_FDGetInfo), or OS_ERR_INVALID_ID."""
        stream = self._stream(filedes)
        return FileInfo(stream.path, stream.creator, True)

    def file_open_check(self, path: str) -> bool:
        """Whether a file is open (OS_FileOpenCheck)."""
        return any(stream.path == path for stream in self._streams)

    def close_file_by_name(self, path: str) -> None:
        """Close all descriptors of a file (OS_CloseFileByName).

        Raises:
            OsalError: OS_FS_ERR_PATH_INVALID when it is not open.
        """
        open_ones = [filedes for filedes, stream in self._streams.items() if stream.path == path]
        if not open_ones:
            raise OsalError(OS_FS_ERR_PATH_INVALID, f"{path} is not open")
        for filedes in open_ones:
            self.close(filedes)

    def close_all_files(self) -> None:
        """Close every descriptor (OS_CloseAllFiles)."""
        for filedes, _ in self._streams.items():
            self.close(filedes)

    def mkdir(self, path: str) -> None:
        """Make a folder (OS_mkdir); OS_ERROR when that cannot be, OS_FS_ERR_* for the path."""
        self.files.make_folder(path)

    def rmdir(self, path: str) -> None:
        """Remove an empty folder (OS_rmdir); OS_ERROR when it is none, OS_FS_ERR_* for the path."""
        self.files.remove_folder(path)

    def directory_open(self, path: str) -> int:
        """Open a folder to read its names, sorted (OS_DirectoryOpen).

        Raises:
            OsalError: OS_ERROR when there is none; OS_FS_ERR_* for the path; OS_ERR_NO_FREE_IDS.
        """
        return self._register(
            self._directories, OsDirectory(self._next_name(), self.files.list_dir(path)), "directory", 0
        )

    def directory_close(self, dir_id: int) -> None:
        """Close a folder (OS_DirectoryClose), or OS_ERR_INVALID_ID."""
        self._unregister(self._directories, self._directory(dir_id))

    def directory_read(self, dir_id: int) -> str | None:
        """The next name, None after the last one, where NASA's returns OS_ERROR (OS_DirectoryRead).

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        directory = self._directory(dir_id)
        if directory.position >= len(directory.entries):
            return None
        directory.position += 1
        return directory.entries[directory.position - 1]

    def directory_rewind(self, dir_id: int) -> None:
        """Begin again with the first name (OS_DirectoryRewind), or OS_ERR_INVALID_ID."""
        self._directory(dir_id).position = 0

    def _next_name(self) -> str:
        """Open files have no names in OSAL, records here do."""
        self._opened += 1
        return f"#{self._opened}"

    def _stream(self, filedes: int) -> OsFile:
        if self._cost:
            self.kernel.charge(self._cost)
        stream = self._streams.lookup(filedes)
        if stream is None:
            raise self._streams.missing(filedes)
        return stream

    def _directory(self, dir_id: int) -> OsDirectory:
        directory = self._directories.lookup(dir_id)
        if directory is None:
            raise self._directories.missing(dir_id)
        return directory

    def _charge_bytes(self, count: int) -> None:
        if self._byte_cost:
            self.kernel.charge(count * self._byte_cost // PS_PER_NS)

    def _grow(self, stream: OsFile, size: int) -> None:
        missing = size - len(stream.node.data)
        if missing > 0:
            self.files.check_room(stream.path, missing)
            stream.node.data.extend(bytes(missing))
