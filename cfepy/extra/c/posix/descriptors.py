"""The descriptors of a processor, as those of one process of Linux: small numbers, shared by all applications.

They stay open when their application ends, as in NASA's process on Linux, which closes them at its own end.
"""

from __future__ import annotations

import errno
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from cfepy.osal import Endpoint

MOST = 1024
"""The descriptors of a process (RLIMIT_NOFILE), and the bits of an fd_set."""
O_ACCMODE, O_RDONLY, O_WRONLY, O_RDWR = 3, 0, 1, 2
O_CREAT, O_EXCL, O_TRUNC, O_APPEND, O_NONBLOCK = 0o100, 0o200, 0o1000, 0o2000, 0o4000
O_DIRECTORY = getattr(os, "O_DIRECTORY", 0o200000)  # differs between processors; other systems do not define it
POLLIN, POLLPRI, POLLOUT, POLLERR, POLLHUP, POLLNVAL = 1, 2, 4, 8, 0x10, 0x20
CHANGEABLE = O_APPEND | O_NONBLOCK
"""The flags that F_SETFL changes."""
S_IFREG, S_IFDIR, S_IFCHR, S_IFSOCK = 0o100000, 0o040000, 0o020000, 0o140000


def failure(number: int) -> OSError:
    """Return the error for an errno."""
    return OSError(number, os.strerror(number))


@dataclass(frozen=True, slots=True)
class Facts:
    """The result of stat: kind and permissions, size, time of the last change in virtual ns, number of the file."""

    mode: int
    size: int = 0
    modified_ns: int = 0
    number: int = 1


class Descriptor:
    """An open file, device or socket. Subclasses replace what their kind can do; the rest fails as on Linux.

    Args:
        flags: the flags of open.

    Attributes:
        links: the numbers that lead to it.
        users: the calls that wait at it, which keep it open.
    """

    is_regular = is_terminal = announces_nothing = False
    more_events = 0
    """Events of poll beside POLLWRNORM that come with POLLOUT."""

    def __init__(self, flags: int = O_RDWR) -> None:
        self.flags = flags
        self.links = self.users = 0

    @property
    def is_nonblocking(self) -> bool:
        """Whether a call that would wait fails with EAGAIN."""
        return bool(self.flags & O_NONBLOCK)

    @property
    def endpoints(self) -> Sequence[Endpoint]:
        """The ends of the network that announce a change of `events`."""
        return ()

    @property
    def events(self) -> int:
        """The events of poll that are true now."""
        return POLLIN | POLLOUT

    def read(self, count: int) -> bytes:
        """Return up to `count` bytes, or b"" at the end."""
        raise failure(errno.EINVAL)

    def write(self, data: bytes) -> int:
        """Write bytes. Returns their number."""
        raise failure(errno.EINVAL)

    def read_at(self, count: int, position: int) -> bytes:
        """Read at a position, and leave the descriptor's own position."""
        raise failure(errno.ESPIPE)

    def write_at(self, data: bytes, position: int) -> int:
        """Write at a position, and leave the descriptor's own position."""
        raise failure(errno.ESPIPE)

    def seek(self, offset: int, whence: int) -> int:
        """Move the position. Returns the new one."""
        raise failure(errno.ESPIPE)

    def truncate(self, size: int) -> None:
        """Make a file shorter or longer."""
        raise failure(errno.EINVAL)

    def facts(self) -> Facts:
        """Return the result of fstat."""
        return Facts(S_IFCHR | 0o620)

    def waiting(self) -> int:
        """Return the number of bytes that can be read (FIONREAD)."""
        raise failure(errno.ENOTTY)

    def control(self, request: int, argument: int) -> int:
        """Perform a request of ioctl."""
        raise failure(errno.ENOTTY)

    def lock(self, command: int, argument: int) -> int:
        """Perform a command of fcntl that is not about flags, such as a lock of a file."""
        raise failure(errno.EINVAL)

    def bind_to(self, at: int, size: int) -> int:
        """Bind a socket of another family to the sockaddr at an address."""
        raise failure(errno.ENOTSOCK)

    def set_option(self, level: int, name: int, value: bytes) -> int:
        """Set an option of a socket of another family."""
        raise failure(errno.ENOTSOCK)

    def close(self) -> None:
        """Release it when its last number is closed."""


class Console(Descriptor):
    """A standard stream: writing goes to the console of the mission, and there is nothing to read.

    Args:
        write: takes bytes; None for the standard input.
    """

    def __init__(self, write: Callable[[bytes], object] | None = None) -> None:
        super().__init__(O_RDONLY if write is None else O_WRONLY)
        self._write = write

    def read(self, count: int) -> bytes:
        if self._write is not None:
            raise failure(errno.EBADF)
        return b""

    def write(self, data: bytes) -> int:
        if self._write is None:
            raise failure(errno.EBADF)
        self._write(data)
        return len(data)


class DescriptorTable:
    """The open descriptors of a processor, by number."""

    def __init__(self) -> None:
        self._open: dict[int, Descriptor] = {}

    def add(self, descriptor: Descriptor, least: int = 0) -> int:
        """Open a descriptor.

        Args:
            descriptor: the object.
            least: the lowest number that it may have.

        Returns:
            The lowest free number.

        Raises:
            OSError: EMFILE.
        """
        number = next((each for each in range(least, MOST) if each not in self._open), MOST)
        if number == MOST:
            if not descriptor.links:
                descriptor.close()
            raise failure(errno.EMFILE)
        self._open[number] = descriptor
        descriptor.links += 1
        return number

    def of(self, number: int) -> Descriptor:
        """Return an open descriptor.

        Raises:
            OSError: EBADF.
        """
        found = self._open.get(number)
        if found is None:
            raise failure(errno.EBADF)
        return found

    def close(self, number: int) -> None:
        """Close a number, and the object behind it if that was its last one.

        Raises:
            OSError: EBADF.
        """
        found = self.of(number)
        del self._open[number]
        found.links -= 1
        if not found.links and not found.users:  # a call that waits releases it afterwards
            found.close()

    def replace(self, number: int, other: int) -> int:
        """Let a number lead to the object of another one, as dup2 does. Returns the number.

        Raises:
            OSError: EBADF.
        """
        found = self.of(other)
        if not 0 <= number < MOST:
            raise failure(errno.EBADF)
        if number != other:
            if number in self._open:
                self.close(number)
            self._open[number] = found
            found.links += 1
        return number

    def close_all(self) -> None:
        """Close all numbers, as the end of a process does."""
        for number in list(self._open):
            self.close(number)
