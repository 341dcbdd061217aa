"""Host files for libgcov, which writes the counts of an object that was compiled with --coverage.

An application reaches the files of the mission. The host's files are only for libgcov, which is linked into the object,
and only its own: their names end in .gcda, and a folder is made only below GCOV_PREFIX.
"""

from __future__ import annotations

import errno
import os
from typing import TYPE_CHECKING

from cfepy.extra.c.posix.open_descriptors import O_ACCMODE, Descriptor, failure

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

SUFFIX = ".gcda"
PREFIX = "GCOV_PREFIX"
SETTINGS = (PREFIX, "GCOV_PREFIX_STRIP")
FLOCK = 32
"""Bytes of struct flock."""


class HostFile(Descriptor):
    """A file of libgcov on the host.

    Args:
        c: the C side of the processor.
        path: its path.
        flags: the flags of open.
        mode: the permissions of a new file.

    Raises:
        OSError: it cannot be opened.
    """

    is_regular = True

    def __init__(self, c: CRuntime, path: str, flags: int, mode: int) -> None:
        super().__init__(flags & O_ACCMODE)
        self._c = c
        self._number = os.open(path, flags, mode)

    def read(self, count: int) -> bytes:
        return os.read(self._number, count)

    def write(self, data: bytes) -> int:
        return os.write(self._number, data)

    def seek(self, offset: int, whence: int) -> int:
        return os.lseek(self._number, offset, whence)

    def lock(self, command: int, argument: int) -> int:
        import fcntl  # the engine is for Linux, but tools on other systems read the declarations

        if command not in (fcntl.F_SETLK, fcntl.F_SETLKW):
            raise failure(errno.EINVAL)
        fcntl.fcntl(self._number, command, bytes(self._c.memory.peek(argument, FLOCK)))
        return 0

    def close(self) -> None:
        os.close(self._number)


def declare(api: Declarations, c: CRuntime) -> None:
    """Add functions for the environment, and the files."""

    def opened(path: str, flags: int, mode: int) -> Descriptor | None:
        return HostFile(c, path, flags, mode) if path.endswith(SUFFIX) and _has_coverage(c) else None

    def get_environment(name: str) -> int:
        value = os.environ.get(name) if name in SETTINGS else None
        return 0 if value is None else c.constants.text(value)

    c.openers.append(opened)
    api.add("getenv", "S", get_environment)
    api.add("getpid", "", lambda: 1)


def _has_coverage(c: CRuntime) -> bool:
    return any(image.source.has_coverage for image in c.images())


def has_host_folder(c: CRuntime, path: str) -> bool:
    """Return whether libgcov finds a folder of the host."""
    return _has_coverage(c) and os.path.isdir(path)


def make_host_folder(path: str, mode: int) -> bool:
    """Make a folder below GCOV_PREFIX. Returns False for other paths, which are the mission's.

    Raises:
        OSError: it cannot be made.
    """
    if not path.startswith(os.environ.get(PREFIX) or "\0"):
        return False
    os.mkdir(path, mode)
    return True
