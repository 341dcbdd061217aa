"""OSAL's functions on files by path (osapi-file.h): facts, access, removing, renaming, copying.

OS_FILESTAT_MODE and the other macros on the result of `stat` are functions here.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from typing import NamedTuple

from cfepy.osal.clock import OS_TIME_TICK_RESOLUTION_NS, ClockApi, OsTime, time_get_total_seconds
from cfepy.osal.files import ACCESS_BITS, FileApi, OsFile
from cfepy.osal.limits import (
    OS_FILE_FLAG_CREATE,
    OS_FILE_FLAG_TRUNCATE,
    OS_FILESTAT_MODE_DIR,
    OS_FILESTAT_MODE_EXEC,
    OS_FILESTAT_MODE_READ,
    OS_FILESTAT_MODE_WRITE,
    OS_WRITE_ONLY,
)
from cfepy.status import OS_ERROR, OsalError

COPY_BLOCK = 512
"""Bytes that `cp` reads and writes at once (OS_CP_BLOCK_SIZE)."""
_FOLDER_MODE = OS_FILESTAT_MODE_DIR | OS_FILESTAT_MODE_READ | OS_FILESTAT_MODE_WRITE | OS_FILESTAT_MODE_EXEC


class FileStat(NamedTuple):
    """The result of `stat` (os_fstat_t): OS_FILESTAT_MODE_* bits, local time of the last change, size in bytes."""

    file_mode_bits: int
    file_time: OsTime
    file_size: int


def filestat_mode(stats: FileStat) -> int:
    """Return all OS_FILESTAT_MODE_* bits (OS_FILESTAT_MODE)."""
    return stats.file_mode_bits


def filestat_isdir(stats: FileStat) -> bool:
    """Return whether it is a folder (OS_FILESTAT_ISDIR)."""
    return bool(stats.file_mode_bits & OS_FILESTAT_MODE_DIR)


def filestat_exec(stats: FileStat) -> bool:
    """Return whether it can be executed, or searched if it is a folder (OS_FILESTAT_EXEC)."""
    return bool(stats.file_mode_bits & OS_FILESTAT_MODE_EXEC)


def filestat_write(stats: FileStat) -> bool:
    """Return whether it can be written (OS_FILESTAT_WRITE)."""
    return bool(stats.file_mode_bits & OS_FILESTAT_MODE_WRITE)


def filestat_read(stats: FileStat) -> bool:
    """Return whether it can be read (OS_FILESTAT_READ)."""
    return bool(stats.file_mode_bits & OS_FILESTAT_MODE_READ)


def filestat_size(stats: FileStat) -> int:
    """Return the size in bytes (OS_FILESTAT_SIZE)."""
    return stats.file_size


def filestat_time(stats: FileStat) -> int:
    """Return the local time of the last change in whole seconds (OS_FILESTAT_TIME)."""
    return time_get_total_seconds(stats.file_time)


class PathApi(ClockApi, FileApi):
    """The functions on files that are not open."""

    filestat_mode = staticmethod(filestat_mode)
    filestat_isdir = staticmethod(filestat_isdir)
    filestat_exec = staticmethod(filestat_exec)
    filestat_write = staticmethod(filestat_write)
    filestat_read = staticmethod(filestat_read)
    filestat_size = staticmethod(filestat_size)
    filestat_time = staticmethod(filestat_time)

    def stat(self, path: str) -> FileStat:
        """Return facts about a file or folder (OS_stat).

        Raises:
            OsalError: OS_ERROR if there is none; OS_FS_ERR_* for the path.
        """
        node = self.files.find(path)
        if node is not None:
            return FileStat(node.mode, self._local_time_at(node.modified_ns), len(node.data))
        if self.files.is_folder(path):
            return FileStat(_FOLDER_MODE, self._local_time_at(0), 0)
        raise OsalError(OS_ERROR, f"{path} does not exist")

    def chmod(self, path: str, access_mode: int) -> None:
        """Set the access mode of a file (OS_chmod); open descriptors keep their access.

        Args:
            path: virtual path.
            access_mode: OS_READ_ONLY, OS_WRITE_ONLY or OS_READ_WRITE; any other value forbids both, as in NASA's OSAL.

        Raises:
            OsalError: OS_ERROR if the file does not exist, or can be neither read nor written; OS_FS_ERR_* for the
                path.
        """
        node = self.files.find(path)
        if node is None and self.files.is_folder(path):
            return  # folders have no access mode here
        if node is None or not node.mode:
            raise OsalError(OS_ERROR, f"{path} is not a file that can be opened")
        node.mode = ACCESS_BITS.get(access_mode, 0)

    def remove(self, path: str) -> None:
        """Remove a file (OS_remove). It raises OS_ERROR if the file does not exist, and OS_FS_ERR_* for the path."""
        self.files.remove(path)

    def rename(self, old_filename: str, new_filename: str) -> None:
        """Rename a file or folder in a volume (OS_rename). It raises OS_ERROR if that is impossible, OS_FS_ERR_* for
        the paths.
        """
        self.files.rename(old_filename, new_filename)
        for stream in self._streams:
            if isinstance(stream, OsFile) and stream.path == old_filename:
                stream.path = new_filename

    def cp(self, src: str, dest: str) -> None:
        """Copy a file in blocks (OS_cp).

        It empties the target first. So a file that is copied onto itself is empty afterwards, and an error leaves the
        part that was copied.

        Raises:
            OsalError: OS_ERROR if the file does not exist or cannot be read, if the copy cannot be written, or if there
                is no room; OS_FS_ERR_* for the paths; OS_ERR_NO_FREE_IDS, for it takes two descriptors.
        """
        opened = [self.open_create(src)]
        try:
            opened.append(self.open_create(dest, OS_FILE_FLAG_CREATE | OS_FILE_FLAG_TRUNCATE, OS_WRITE_ONLY))
            while block := self.read(opened[0], COPY_BLOCK):
                while block:
                    block = block[self.write(opened[1], block) :]
        except OsalError:
            self._close_again(opened)
            raise
        self._close_again(opened)

    def mv(self, src: str, dest: str) -> None:
        """Move a file, also to another volume (OS_mv); see `cp` for the errors."""
        try:
            self.rename(src, dest)
        except OsalError:
            self.cp(src, dest)
            with suppress(OsalError):
                self.remove(src)

    def _close_again(self, opened: Sequence[int]) -> None:
        """Close descriptors; another task may have closed some."""
        for filedes in opened:
            with suppress(OsalError):
                self.close(filedes)

    def _local_time_at(self, virtual_ns: int) -> OsTime:
        return OsTime(virtual_ns // OS_TIME_TICK_RESOLUTION_NS + self._local_offset)
