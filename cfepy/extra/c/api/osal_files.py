"""OS_OpenCreate, OS_read, OS_stat, OS_DirectoryOpen and related functions: files and folders for C.

A descriptor may be a socket, which can be polled, so reading and writing cost virtual time.
"""

from __future__ import annotations

from struct import Struct
from typing import TYPE_CHECKING

from cfepy.extra.c.api.osal_values import BAD, check_size, in_time, new_id
from cfepy.extra.c.memory import chars
from cfepy.osal import OS_MAX_FILE_NAME, OS_MAX_PATH_LEN, OS_READ_ONLY, OS_READ_WRITE, OS_WRITE_ONLY, OsTime
from cfepy.status import OS_ERROR, OS_ERROR_TIMEOUT, OsalError

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

FILE_STAT = Struct("<I4xqQ")
"""os_fstat_t: mode bits, time, size."""
FILE_INFO = Struct(f"<{OS_MAX_PATH_LEN}sIB3x")
"""OS_file_prop_t: path, user, whether it is valid."""


def declare(api: Declarations, c: CRuntime) -> None:
    _declare_descriptors(api, c)
    _declare_transfers(api, c)
    _declare_paths(api, c)
    _declare_folders(api, c)


def _declare_descriptors(api: Declarations, c: CRuntime) -> None:
    os, memory = c.handle.os, c.memory

    def open_create(path: str | None, flags: int, access_mode: int) -> int:
        if access_mode not in (OS_READ_ONLY, OS_WRITE_ONLY, OS_READ_WRITE):
            raise OsalError(OS_ERROR, f"invalid access mode {access_mode}")
        if path is None:
            raise OsalError(BAD, "missing path")
        return os.open_create(path, flags, access_mode)

    def get_info(filedes: int, at: int) -> None:
        memory.poke(at, bytes(FILE_INFO.size))
        info = os.fd_get_info(filedes)
        memory.poke(at, FILE_INFO.pack(chars(info.path, OS_MAX_PATH_LEN), info.user, info.is_valid))

    def open_check(path: str) -> None:
        if not os.file_open_check(path):
            raise OsalError(OS_ERROR, f"{path} is not open")

    api.add("OS_OpenCreate", "~4sii", open_create, BAD)
    api.add("OS_close", "I", os.close)
    api.add("OS_lseek", "IqI", os.lseek)
    api.add("OS_FileAllocate", "Iqq", os.file_allocate)
    api.add("OS_FileTruncate", "Iq", os.file_truncate)
    api.add("OS_FDGetInfo", "$IP", get_info, BAD)
    api.add("OS_FileOpenCheck", "$S", open_check, BAD)
    api.add("OS_CloseAllFiles", "", os.close_all_files)
    api.add("OS_CloseFileByName", "S", os.close_file_by_name, BAD)


def _declare_transfers(api: Declarations, c: CRuntime) -> None:
    """Add functions for reading and writing. Status codes are below 0, other results are counts of bytes."""
    os, memory = c.handle.os, c.memory
    timed_read = in_time(os.timed_read, OS_ERROR_TIMEOUT)
    timed_read_abs = in_time(os.timed_read_abs, OS_ERROR_TIMEOUT)
    timed_write = in_time(os.timed_write, OS_ERROR_TIMEOUT)
    timed_write_abs = in_time(os.timed_write_abs, OS_ERROR_TIMEOUT)

    def put(buffer: int, data: bytes) -> int:
        memory.poke(buffer, data)
        return len(data)

    def data_of(buffer: int, size: int) -> bytes:
        check_size(size)
        return bytes(memory.peek(buffer, size))

    api.add("OS_read", "$IPQ", lambda fd, at, size: put(at, os.read(fd, size)), BAD)
    api.add("OS_TimedRead", "$IPQi", lambda fd, at, size, ms: put(at, timed_read(fd, size, ms)), BAD)
    api.add("OS_TimedReadAbs", "$IPQq", lambda fd, at, size, by: put(at, timed_read_abs(fd, size, OsTime(by))), BAD)
    api.add("OS_write", "$IPQ", lambda fd, at, size: os.write(fd, data_of(at, size)), BAD)
    api.add("OS_TimedWrite", "$IPQi", lambda fd, at, size, ms: timed_write(fd, data_of(at, size), ms), BAD)
    api.add(
        "OS_TimedWriteAbs", "$IPQq", lambda fd, at, size, by: timed_write_abs(fd, data_of(at, size), OsTime(by)), BAD
    )


def _declare_paths(api: Declarations, c: CRuntime) -> None:
    os, memory = c.handle.os, c.memory

    def stat(path: str | None, at: int) -> None:
        memory.poke(at, bytes(FILE_STAT.size))
        if path is None:
            raise OsalError(BAD, "missing path")
        memory.poke(at, FILE_STAT.pack(*os.stat(path)))

    api.add("OS_stat", "$sP", stat, BAD)
    api.add("OS_chmod", "SI", os.chmod, BAD)
    api.add("OS_remove", "S", os.remove, BAD)
    api.add("OS_rename", "SS", os.rename, BAD)
    api.add("OS_cp", "SS", os.cp, BAD)
    api.add("OS_mv", "SS", os.mv, BAD)


def _declare_folders(api: Declarations, c: CRuntime) -> None:
    os, memory = c.handle.os, c.memory

    def open_directory(path: str) -> int:
        return os.directory_open(path, with_dots=True)

    def read(dir_id: int, entry: int) -> None:
        name = os.directory_read(dir_id)
        if name is None:
            raise OsalError(OS_ERROR, "no more names")
        memory.put_text(entry, name, OS_MAX_FILE_NAME)

    api.add("OS_mkdir", "SI", os.mkdir, BAD)
    api.add("OS_rmdir", "S", os.rmdir, BAD)
    api.add("OS_DirectoryOpen", "=4S", new_id(open_directory, OS_ERROR), BAD)
    api.add("OS_DirectoryClose", "I", os.directory_close)
    api.add("OS_DirectoryRead", "IP", read, BAD)
    api.add("OS_DirectoryRewind", "I", os.directory_rewind)
