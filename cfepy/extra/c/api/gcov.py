"""Host files for libgcov, which writes the counts of an object that was compiled with --coverage.

An application reaches the files of the run through OSAL. These functions are only for libgcov, which is linked into the
object, and only for its files: their names end in .gcda, and a folder is made only below GCOV_PREFIX.
"""

from __future__ import annotations

import errno
import os
from collections.abc import Callable
from typing import IO, TYPE_CHECKING

from cfepy.extra.c.crashes import CFault

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

SUFFIX = ".gcda"
PREFIX = "GCOV_PREFIX"
SETTINGS = (PREFIX, "GCOV_PREFIX_STRIP")
FLOCK = 32
"""Bytes of struct flock."""
STREAM = 0x1000
"""The first handle of a libgcov FILE."""
FAILED = -1


def declare(api: Declarations, c: CRuntime) -> None:
    _declare_files(api, c)
    _declare_streams(api, c)
    _declare_rest(api, c)


def _declare_files(api: Declarations, c: CRuntime) -> None:
    """Add functions for files by name and number."""
    import fcntl  # the engine is for Linux, but tools on other systems read the declarations

    memory = c.memory
    opened: set[int] = set()

    def failing(call: Callable[[], object]) -> int:
        """Return the number that a call of the host gives, 0 for another answer, or -1 with errno."""
        try:
            answer = call()
            return answer if isinstance(answer, int) else 0
        except OSError as error:
            memory.put_u32(c.thread_locals.errno(), error.errno or errno.EIO)
            return FAILED

    def open_file(name: str, flags: int, mode: int) -> int:
        if not name.endswith(SUFFIX):
            raise CFault(f"open() of {name} is not available; use OS_OpenCreate")
        number = failing(lambda: os.open(name, flags, mode))
        if number != FAILED:
            opened.add(number)
        return number

    def control(number: int, command: int, lock: int) -> int:
        if number not in opened or command not in (fcntl.F_SETLK, fcntl.F_SETLKW):
            raise CFault("fcntl() is only available for files of libgcov")
        return failing(lambda: fcntl.fcntl(number, command, memory.peek(lock, FLOCK)))

    def close(number: int) -> int:
        if number not in opened:
            raise CFault("close() is only available for files of libgcov")
        opened.discard(number)
        return failing(lambda: os.close(number))

    def access(name: str, mode: int) -> int:
        if not any(image.source.has_coverage for image in c.images()):
            raise CFault(f"access() of {name} is not available; use OS_stat")
        return 0 if os.access(name, mode) else FAILED

    def make_folder(name: str, mode: int) -> int:
        if not name.startswith(os.environ.get(PREFIX) or "\0"):
            raise CFault(f"mkdir() of {name} is not available; use OS_mkdir")
        return failing(lambda: os.mkdir(name, mode))

    api.add("open", "SiI", open_file, FAILED)
    api.add("fcntl", "iip", control)
    api.add("close", "i", close)
    api.add("access", "Si", access, FAILED)
    api.add("mkdir", "SI", make_folder, FAILED)


def _declare_streams(api: Declarations, c: CRuntime) -> None:
    """Add functions for files as streams."""
    memory = c.memory
    streams: dict[int, IO[bytes]] = {}

    def stream_of(number: int, mode: str) -> int:
        handle = STREAM + number
        streams[handle] = os.fdopen(number, mode.replace("b", "") + "b")
        c.streams.writers[handle] = streams[handle].write
        return handle

    def read(to: int, size: int, count: int, stream: int) -> int:
        data = _of(streams, stream).read(size * count)
        memory.poke(to, data)
        return len(data) // size if size else 0

    def seek(stream: int, offset: int, whence: int) -> int:
        _of(streams, stream).seek(offset, whence)
        return 0

    def close(stream: int) -> int:
        _of(streams, stream).close()
        del streams[stream], c.streams.writers[stream]
        return 0

    def open_stream(name: str, mode: str) -> int:
        raise CFault(f"fopen() of {name} is not available; use OS_OpenCreate")

    api.add("fdopen", "iS", stream_of)
    api.add("fread", "pQQp", read)
    api.add("fseek", "pqi", seek)
    api.add("fclose", "p", close)
    api.add("fopen", "SS", open_stream)


def _declare_rest(api: Declarations, c: CRuntime) -> None:
    """Add functions for the environment."""

    def get_environment(name: str) -> int:
        value = os.environ.get(name) if name in SETTINGS else None
        return 0 if value is None else c.constants.text(value)

    def map_memory() -> None:
        raise CFault("mmap() is not available; use malloc or a memory pool of cFE")

    api.add("getenv", "S", get_environment)
    api.add("getpid", "", lambda: 1)
    api.add("mmap", "", map_memory)


def _of(streams: dict[int, IO[bytes]], stream: int) -> IO[bytes]:
    found = streams.get(stream)
    if found is None:
        raise CFault(f"0x{stream:x} is not an open FILE")
    return found
