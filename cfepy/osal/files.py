"""OSAL's open files and directories (osapi-file.h, osapi-dir.h) on the virtual file system.

Functions by path are in cfepy.osal.paths. A read returns bytes, or b"" at the end of the file, and never waits.
cfepy.osal.streams adds sockets and the timed calls.
"""

from __future__ import annotations

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
from cfepy.osal.volumes import FileNode, Folder, Volume
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
READERS, WRITERS = (OS_READ_ONLY, OS_READ_WRITE), (OS_WRITE_ONLY, OS_READ_WRITE)
NO_ACCESS = -1
"""The access mode of a folder that is open as a file."""

_DOTS = (".", "..")


class FileInfo(NamedTuple):
    """The result of `fd_get_info` (OS_file_prop_t)."""

    path: str
    user: int
    is_valid: bool


class OsStream(OsObject):
    """The record behind a descriptor: an open file, or a socket, whose path is its name once it has an address."""

    __slots__ = ("path",)

    def __init__(self, name: str, path: str = "") -> None:
        super().__init__(name)
        self.path = path


class OsFile(OsStream):
    """The record of an open file."""

    __slots__ = ("access", "node", "position", "volume")

    def __init__(self, name: str, path: str, volume: Volume, node: FileNode, access: int) -> None:
        super().__init__(name, path)
        self.volume = volume
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
            path: virtual path, e.g. "/ram/log.bin". A folder can be opened to be read, but every read fails.
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
        place = self.files.translate(path)
        if len(self._streams) == self._streams.capacity:  # before the file is created or truncated
            raise OsalError(OS_ERR_NO_FREE_IDS, f"too many open files; cannot open {path}")
        node = self.files.open_node(path) if flags & OS_FILE_FLAG_CREATE else place.node()
        if node is None:
            if access_mode == OS_READ_ONLY and not flags & OS_FILE_FLAG_TRUNCATE and self.files.is_folder(path):
                return self._opened_file(path, place.volume, FileNode(), NO_ACCESS)
            raise OsalError(OS_ERROR, f"file {path} does not exist")
        needed = ACCESS_BITS[access_mode] | (OS_FILESTAT_MODE_WRITE if flags & OS_FILE_FLAG_TRUNCATE else 0)
        if needed & ~node.mode:
            raise OsalError(OS_ERROR, f"the mode of {path} does not permit this access")
        if flags & OS_FILE_FLAG_TRUNCATE:
            node.data.clear()
        return self._opened_file(path, place.volume, node, access_mode)

    def _opened_file(self, path: str, volume: Volume, node: FileNode, access: int) -> int:
        record = OsFile(self._next_name(), path, volume, node, access)
        filedes = self._register(self._streams, record, "file", 0)
        node.openings += 1
        return filedes

    def close(self, filedes: int) -> None:
        """Close a descriptor (OS_close); raises OS_ERR_INVALID_ID."""
        stream = self._stream(filedes)
        self._unregister(self._streams, stream)
        if isinstance(stream, OsFile):
            stream.node.openings -= 1

    def read(self, filedes: int, nbytes: int) -> bytes:
        """Read at most `nbytes` at the position of the descriptor (OS_read).

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERR_INVALID_SIZE, OS_ERROR if it is not open for reading.
        """
        check_size(nbytes, "read")
        stream = self._file(filedes)
        if stream.access not in READERS:
            raise OsalError(OS_ERROR, f"{stream.path} is not open for reading")
        data = bytes(stream.node.data[stream.position : stream.position + nbytes])
        stream.position += len(data)
        self._charge_bytes(len(data))
        return data

    def write(self, filedes: int, data: bytes | bytearray | memoryview) -> int:
        """Write at the position of the descriptor (OS_write); return the number of bytes, fewer on a disk that is full
        after them.

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERR_INVALID_SIZE, OS_ERROR if it is not open for writing or the disk has
                no room for a byte.
        """
        check_size(len(data), "write")
        stream = self._file(filedes)
        if stream.access not in WRITERS:
            raise OsalError(OS_ERROR, f"{stream.path} is not open for writing")
        position, size = stream.position, len(stream.node.data)
        end = position + len(data)
        if end > size:
            end = self.files.fitting(stream.volume, size, end)
            if end <= position:  # nothing is written, so the file stays as long as it is
                raise OsalError(OS_ERROR, f"the volume of {stream.path} has no room")
            data = data[: end - position]
            self._grow(stream, end)
        count = len(data)
        stream.node.data[position : position + count] = data
        stream.node.modified_ns = self.kernel.now
        stream.position = position + count
        self._charge_bytes(count)
        return count

    def write_whole(self, filedes: int, data: bytes) -> int:
        """Write like `write`; a short write is an error, with the number of bytes as its status, as in cFE's events."""
        count = self.write(filedes, data)
        if count != len(data):
            raise OsalError(count, f"only {count} of {len(data)} bytes were written")
        return count

    def lseek(self, filedes: int, offset: int, whence: int) -> int:
        """Move the position of a descriptor (OS_lseek); return the new position from the start.

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERROR for an invalid `whence`, a position before the start, or one beyond
                the last of the disk.
        """
        if whence not in (OS_SEEK_SET, OS_SEEK_CUR, OS_SEEK_END):
            self._stream(filedes)
            raise OsalError(OS_ERROR, f"unknown origin {whence} of a seek")
        stream = self._file(filedes)
        origins = {OS_SEEK_SET: 0, OS_SEEK_CUR: stream.position, OS_SEEK_END: len(stream.node.data)}
        if not 0 <= origins[whence] + offset <= stream.volume.last_position:
            raise OsalError(OS_ERROR, f"invalid seek by {offset} from {whence} in {stream.path}")
        stream.position = origins[whence] + offset
        return stream.position

    def file_allocate(self, filedes: int, offset: int, length: int) -> None:
        """Make a file at least `offset + length` bytes long (OS_FileAllocate).

        As on NASA's Linux, the call also succeeds when it has no effect: with a negative offset, a length below 1, a
        descriptor that is not open for writing, a socket, or a full disk.

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        stream = self._stream(filedes)
        if not isinstance(stream, OsFile) or offset < 0 or length <= 0 or stream.access not in WRITERS:
            return
        size, wanted = len(stream.node.data), offset + length
        if wanted > size and self.files.fitting(stream.volume, size, wanted) == wanted:
            self._grow(stream, wanted)
            stream.node.modified_ns = self.kernel.now

    def file_truncate(self, filedes: int, length: int) -> None:
        """Make a file `length` bytes long, shorter or longer (OS_FileTruncate).

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERR_OUTPUT_TOO_LARGE if there is no room, OS_ERROR for a negative length or
                a descriptor that is not open for writing.
        """
        stream = self._stream(filedes)
        if not isinstance(stream, OsFile) or length < 0 or stream.access not in WRITERS:
            raise OsalError(OS_ERROR, f"cannot set this size of {stream.path} through this descriptor")
        data = stream.node.data
        if self.files.fitting(stream.volume, len(data), length) < length:
            raise OsalError(OS_ERR_OUTPUT_TOO_LARGE, f"the volume of {stream.path} has no room for {length} bytes")
        self._grow(stream, length)
        del data[length:]
        stream.node.modified_ns = self.kernel.now

    def fd_get_info(self, filedes: int) -> FileInfo:
        """Return facts about a descriptor (OS_FDGetInfo); raises OS_ERR_INVALID_ID."""
        stream = self._stream(filedes)
        return FileInfo(stream.path, stream.creator, True)

    def file_open_check(self, path: str) -> bool:
        """Return whether a file is open (OS_FileOpenCheck)."""
        return any(isinstance(stream, OsFile) and stream.path == path for stream in self._streams)

    def close_file_by_name(self, path: str) -> None:
        """Close all descriptors of a file (OS_CloseFileByName).

        Raises:
            OsalError: OS_FS_ERR_PATH_INVALID if it is not open.
        """
        open_ones = [
            filedes for filedes, stream in self._streams.items() if isinstance(stream, OsFile) and stream.path == path
        ]
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

    def _grow(self, stream: OsFile, size: int) -> None:
        """Fill a file with zeros until it has `size` bytes, or until its volume is full."""
        data = stream.node.data
        if size > len(data):
            size = self.files.fitting(stream.volume, len(data), size)
            data.extend(bytes(size - len(data)))


class OsDirectory(OsObject):
    """The record of an open folder."""

    __slots__ = ("entries", "folder", "path", "position", "volume", "with_dots")

    def __init__(self, name: str, path: str, volume: Volume, folder: Folder, with_dots: bool) -> None:
        super().__init__(name)
        self.path = path
        self.volume = volume
        self.folder = folder
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
        """Open a folder to read its names in sorted order, as of the first read (OS_DirectoryOpen); it stays open when
        it is renamed, and has no more names after its removal.

        Args:
            path: virtual path.
            with_dots: read "." and ".." before the others, as NASA's OSAL does.

        Raises:
            OsalError: OS_ERROR if there is none; OS_FS_ERR_* for the path; OS_ERR_NO_FREE_IDS.
        """
        self._directories_opened += 1  # open folders have no names in OSAL, but records need one
        volume, rest, _ = self.files.translate(path)
        folder = volume.folder(rest)
        if folder is None:
            raise OsalError(OS_ERROR, f"folder {path} does not exist")
        record = OsDirectory(f"#{self._directories_opened}", path, volume, folder, with_dots)
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
        path = directory.folder.path
        if path is None:
            return []
        return [*(_DOTS if directory.with_dots else ()), *directory.volume.names(path)]

    def directory_rewind(self, dir_id: int) -> None:
        """Start again with the first name (OS_DirectoryRewind); raises OS_ERR_INVALID_ID."""
        directory = self._directory(dir_id)
        directory.position, directory.entries = 0, None

    def _directory(self, dir_id: int) -> OsDirectory:
        directory = self._directories.lookup(dir_id)
        if directory is None:
            raise self._directories.missing(dir_id)
        return directory
