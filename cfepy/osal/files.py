"""OSAL's open files and directories (osapi-file.h, osapi-dir.h) on the virtual file system.

Functions by path are in cfepy.osal.paths. A read returns bytes, or b"" at the end of the file, and never waits.
cfepy.osal.streams adds sockets and the timed calls.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from cfepy.ids import OS_DIR_BASE, OS_STREAM_BASE
from cfepy.osal.core import Core, OsObject, OsObjectTable, Setup, check_size
from cfepy.osal.filesystem import FileSystem
from cfepy.osal.limits import (
    OS_FILE_FLAG_CREATE,
    OS_FILE_FLAG_NONE,
    OS_FILE_FLAG_TRUNCATE,
    OS_FILESTAT_MODE_READ,
    OS_FILESTAT_MODE_WRITE,
    OS_READ_ONLY,
    OS_READ_WRITE,
    OS_SEEK_CUR,
    OS_SEEK_END,
    OS_SEEK_SET,
    OS_WRITE_ONLY,
)
from cfepy.osal.volumes import FileNode
from cfepy.status import (
    OS_ERR_NO_FREE_IDS,
    OS_ERR_OPERATION_NOT_SUPPORTED,
    OS_ERR_OUTPUT_TOO_LARGE,
    OS_ERROR,
    OS_FS_ERR_PATH_INVALID,
    OsalError,
)

ACCESS_BITS = {
    OS_READ_ONLY: OS_FILESTAT_MODE_READ,
    OS_WRITE_ONLY: OS_FILESTAT_MODE_WRITE,
    OS_READ_WRITE: OS_FILESTAT_MODE_READ | OS_FILESTAT_MODE_WRITE,
}
"""The mode bits that a file needs to be opened with an access mode; `chmod` sets the same bits."""


_DOTS = (".", "..")


class FileInfo(NamedTuple):
    """The result of `fd_get_info` (OS_file_prop_t)."""

    path: str
    user: int
    is_valid: bool


class OsStream(OsObject):
    """The record behind a descriptor: an open file, or a socket, which has no path."""

    __slots__ = ("path",)

    def __init__(self, name: str, path: str = "") -> None:
        super().__init__(name)
        self.path = path


class OsFile(OsStream):
    """The record of an open file."""

    __slots__ = ("access", "node", "position")

    def __init__(self, name: str, path: str, node: FileNode, access: int) -> None:
        super().__init__(name, path)
        self.node = node
        self.access = access
        self.position = 0

    @property
    def resource_name(self) -> str:
        return self.path


class FileApi(Core):
    """The functions on descriptors."""

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        self.files: FileSystem = setup.files
        self._streams: OsObjectTable[OsStream] = self._table("file", OS_STREAM_BASE, setup.config.os_max_num_open_files)
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
            OsalError: OS_ERROR for an invalid mode, a missing file, or a file whose mode forbids the access (`chmod`);
                OS_FS_ERR_* for the path; OS_ERR_NO_FREE_IDS.
        """
        if access_mode not in ACCESS_BITS:
            raise OsalError(OS_ERROR, f"invalid access mode {access_mode} for {path}")
        self.files.translate(path)
        if len(self._streams) == self._streams.capacity:  # before the file is created or truncated
            raise OsalError(OS_ERR_NO_FREE_IDS, f"too many open files; cannot open {path}")
        node = self.files.open_node(path) if flags & OS_FILE_FLAG_CREATE else self.files.find(path)
        if node is None:
            raise OsalError(OS_ERROR, f"file {path} does not exist")
        needed = ACCESS_BITS[access_mode] | (OS_FILESTAT_MODE_WRITE if flags & OS_FILE_FLAG_TRUNCATE else 0)
        if needed & ~node.mode:
            raise OsalError(OS_ERROR, f"the mode of {path} does not permit this access")
        if flags & OS_FILE_FLAG_TRUNCATE:
            node.data.clear()
        return self._register(self._streams, OsFile(self._next_name(), path, node, access_mode), "file", 0)

    def close(self, filedes: int) -> None:
        """Close a descriptor (OS_close); raises OS_ERR_INVALID_ID."""
        self._unregister(self._streams, self._stream(filedes))

    def read(self, filedes: int, nbytes: int) -> bytes:
        """Read at most `nbytes` at the position of the descriptor (OS_read).

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERR_INVALID_SIZE, OS_ERROR if it is not open for reading.
        """
        check_size(nbytes, "read")
        stream = self._file(filedes)
        if stream.access == OS_WRITE_ONLY:
            raise OsalError(OS_ERROR, f"{stream.path} is not open for reading")
        data = bytes(stream.node.data[stream.position : stream.position + nbytes])
        stream.position += len(data)
        self._charge_bytes(len(data))
        return data

    def write(self, filedes: int, data: bytes | bytearray | memoryview) -> int:
        """Write at the position of the descriptor (OS_write); return the number of bytes.

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERR_INVALID_SIZE, OS_ERROR if it is not open for writing or the disk is
                full.
        """
        check_size(len(data), "write")
        stream = self._file(filedes)
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
        """Move the position of a descriptor (OS_lseek); return the new position from the start.

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERROR for an invalid `whence` or a position before the start.
        """
        stream = self._file(filedes)
        origins = {OS_SEEK_SET: 0, OS_SEEK_CUR: stream.position, OS_SEEK_END: len(stream.node.data)}
        if whence not in origins or origins[whence] + offset < 0:
            raise OsalError(OS_ERROR, f"invalid seek by {offset} from {whence} in {stream.path}")
        stream.position = origins[whence] + offset
        return stream.position

    def file_allocate(self, filedes: int, offset: int, length: int) -> None:
        """Make a file at least `offset + length` bytes long (OS_FileAllocate).

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERR_OUTPUT_TOO_LARGE if there is no room, OS_ERROR for a negative offset, a
                length below 1, or a descriptor that is not open for writing.
        """
        self._resize(filedes, lambda size: max(size, offset + length), offset >= 0 and length > 0)

    def file_truncate(self, filedes: int, length: int) -> None:
        """Make a file `length` bytes long, shorter or longer (OS_FileTruncate).

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERR_OUTPUT_TOO_LARGE if there is no room, OS_ERROR for a negative length or
                a descriptor that is not open for writing.
        """
        self._resize(filedes, lambda size: length, length >= 0)

    def fd_get_info(self, filedes: int) -> FileInfo:
        """Return facts about a descriptor (OS_FDGetInfo); raises OS_ERR_INVALID_ID."""
        stream = self._stream(filedes)
        return FileInfo(stream.path, stream.creator, True)

    def file_open_check(self, path: str) -> bool:
        """Return whether a file is open (OS_FileOpenCheck)."""
        return any(stream.path == path for stream in self._streams)

    def close_file_by_name(self, path: str) -> None:
        """Close all descriptors of a file (OS_CloseFileByName).

        Raises:
            OsalError: OS_FS_ERR_PATH_INVALID if it is not open.
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

    def _next_name(self) -> str:
        """Return a unique name for a record; open files have no names in OSAL."""
        self._opened += 1
        return f"#{self._opened}"

    def _stream(self, filedes: int) -> OsStream:
        if self._cost:
            self.kernel.charge(self._cost)
        stream = self._streams.lookup(filedes)
        if stream is None:
            raise self._streams.missing(filedes)
        return stream

    def _file(self, filedes: int) -> OsFile:
        """Return the record of a file; a socket raises OS_ERR_OPERATION_NOT_SUPPORTED."""
        stream = self._stream(filedes)
        if not isinstance(stream, OsFile):
            raise OsalError(OS_ERR_OPERATION_NOT_SUPPORTED, f"descriptor {filedes:#x} is a socket")
        return stream

    def _charge_bytes(self, count: int) -> None:
        if self._costs.byte_ps:
            self.kernel.charge(self._costs.of_copying(count))

    def _resize(self, filedes: int, new_size: Callable[[int], int], is_valid: bool) -> None:
        stream = self._file(filedes)
        if not is_valid or stream.access == OS_READ_ONLY:
            raise OsalError(OS_ERROR, f"cannot set this size of {stream.path} through this descriptor")
        data = stream.node.data
        size = new_size(len(data))
        try:
            self._grow(stream, size)
        except OsalError as error:
            raise OsalError(OS_ERR_OUTPUT_TOO_LARGE, error.text) from error
        del data[size:]
        stream.node.modified_ns = self.kernel.now

    def _grow(self, stream: OsFile, size: int) -> None:
        missing = size - len(stream.node.data)
        if missing > 0:
            self.files.check_room(stream.path, missing)
            stream.node.data.extend(bytes(missing))


class OsDirectory(OsObject):
    """The record of an open folder."""

    __slots__ = ("entries", "path", "position", "with_dots")

    def __init__(self, name: str, path: str, with_dots: bool) -> None:
        super().__init__(name)
        self.path = path
        self.with_dots = with_dots
        self.entries: list[str] | None = None
        self.position = 0

    @property
    def resource_name(self) -> str:
        return self.path


class DirectoryApi(Core):
    """The functions on folders."""

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        self.files: FileSystem = setup.files
        self._directories: OsObjectTable[OsDirectory] = self._table(
            "directory", OS_DIR_BASE, setup.config.os_max_num_open_dirs
        )
        self._directories_opened = 0

    def mkdir(self, path: str, access: int = OS_READ_WRITE) -> None:
        """Create a folder (OS_mkdir). It raises OS_ERROR if that is not possible, and OS_FS_ERR_* for the path.

        Args:
            path: virtual path; an existing folder stays unchanged.
            access: has no effect, as in NASA's OSAL.
        """
        self.files.make_folder(path)

    def rmdir(self, path: str) -> None:
        """Remove an empty folder (OS_rmdir). It raises OS_ERROR if it is not an empty folder, and OS_FS_ERR_* for the
        path.
        """
        self.files.remove_folder(path)

    def directory_open(self, path: str, *, with_dots: bool = False) -> int:
        """Open a folder to read its names in sorted order, as of the first read (OS_DirectoryOpen).

        Args:
            path: virtual path.
            with_dots: read "." and ".." before the others, as NASA's OSAL does.

        Raises:
            OsalError: OS_ERROR if there is none; OS_FS_ERR_* for the path; OS_ERR_NO_FREE_IDS.
        """
        self._directories_opened += 1  # open folders have no names in OSAL, but records need one
        self.files.list_dir(path)
        record = OsDirectory(f"#{self._directories_opened}", path, with_dots)
        return self._register(self._directories, record, "directory", 0)

    def directory_close(self, dir_id: int) -> None:
        """Close a folder (OS_DirectoryClose); raises OS_ERR_INVALID_ID."""
        self._unregister(self._directories, self._directory(dir_id))

    def directory_read(self, dir_id: int) -> str | None:
        """Return the next name, or None after the last one, where NASA's function returns OS_ERROR (OS_DirectoryRead).

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        directory = self._directory(dir_id)
        if directory.entries is None:
            directory.entries = self._names_in(directory)
        if directory.position >= len(directory.entries):
            return None
        directory.position += 1
        return directory.entries[directory.position - 1]

    def _names_in(self, directory: OsDirectory) -> list[str]:
        try:
            return [*(_DOTS if directory.with_dots else ()), *self.files.list_dir(directory.path)]
        except OsalError:  # the folder was removed while it was open
            return []

    def directory_rewind(self, dir_id: int) -> None:
        """Start again with the first name (OS_DirectoryRewind); raises OS_ERR_INVALID_ID."""
        directory = self._directory(dir_id)
        directory.position, directory.entries = 0, None

    def _directory(self, dir_id: int) -> OsDirectory:
        directory = self._directories.lookup(dir_id)
        if directory is None:
            raise self._directories.missing(dir_id)
        return directory
