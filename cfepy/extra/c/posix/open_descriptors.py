"""The descriptors of a processor, as of one process of Linux: small numbers, shared by all applications.

A FILE of stdio is the buffer of a descriptor, which is filled and emptied at the same places as glibc's. Written bytes
reach the file when it is full, with fflush, fseek and fclose, and at the end of the process.

Descriptors stay open when their application ends, as in NASA's process on Linux, which closes them at its own end.
"""

from __future__ import annotations

import errno
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from cfepy.osal import Endpoint

EOF = -1
BLOCK = 4096
"""st_blksize, which is the size of a buffer."""
FULL, LINES, NONE = 0, 1, 2
"""_IOFBF, _IOLBF, _IONBF."""
SEEK_SET, SEEK_CUR, SEEK_END = 0, 1, 2
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
    """An open file, device or socket. Subclasses replace the functions of their kind; the others fail as on Linux.

    Args:
        flags: the flags of open.

    Attributes:
        links: the numbers that lead to it.
        users: the calls that wait at it, which keep it open.
    """

    is_regular = is_terminal = announces_nothing = False

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


class StandardStream(Descriptor):
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


def flags_of(mode: str) -> int:
    """Return the flags of open for a mode of fopen.

    Raises:
        OSError: EINVAL.
    """
    first = {"r": O_RDONLY, "w": O_WRONLY | O_CREAT | O_TRUNC, "a": O_WRONLY | O_CREAT | O_APPEND}.get(mode[:1])
    if first is None:
        raise failure(errno.EINVAL)
    rest = mode[1:].partition(",")[0]
    if "+" in rest:
        first = first & ~O_WRONLY | O_RDWR
    return first | (0o200 if "x" in rest else 0)  # O_EXCL


class FileStream:
    """An open FILE.

    Args:
        number: its descriptor's number.
        descriptor: the descriptor.
        flags: the flags of its mode.
        buffering: FULL, LINES or NONE.

    Attributes:
        is_ended, is_failed: the results of feof and ferror.
    """

    def __init__(self, number: int, descriptor: Descriptor, flags: int, buffering: int = FULL) -> None:
        self.number = number
        self.descriptor = descriptor
        self.is_ended = self.is_failed = False
        self.buffering = buffering
        self.room = BLOCK
        self._flags = flags
        self._input = b""
        self._at = 0
        self._given_back: list[int] = []
        self._output = bytearray()
        self._has_room = False  # the buffer is made by the first transfer
        if flags & O_APPEND and flags & 3 == O_WRONLY and descriptor.is_regular:
            descriptor.seek(0, SEEK_END)

    # -- reading -----------------------------------------------------------------------------------------------------

    def read(self, count: int) -> bytes:
        """Return up to `count` bytes; fewer at the end or after an error, which the stream notes.

        Raises:
            OSError: there was an error, and no byte before it.
        """
        taken = bytearray()
        while self._given_back and len(taken) < count:
            taken.append(self._given_back.pop())
        while len(taken) < count:
            piece = self._input[self._at : self._at + count - len(taken)]
            if piece:
                self._at += len(piece)
                taken += piece
                continue
            left = count - len(taken)
            try:
                if left < self.room:
                    if not self._underflow():
                        break
                    continue
                self._begin_reading()
                self._has_room = True
                data = self.descriptor.read(left - left % self.room if self.buffering != NONE else left)
            except OSError:
                self.is_failed = True
                if not taken:
                    raise
                break
            if not data:
                self.is_ended = True
                break
            taken += data
        return bytes(taken)

    def read_line(self, limit: int, newline: bytes = b"\n") -> bytes:
        """Return the bytes up to a newline or another byte, at most `limit`."""
        line = bytearray()
        while len(line) < limit and not line.endswith(newline):
            if self._given_back or self._at >= len(self._input):
                try:
                    byte = self.read(1)
                except OSError:
                    break
                if not byte:
                    break
                line += byte
                continue
            end = self._input.find(newline, self._at) + 1 or len(self._input)
            end = min(end, self._at + limit - len(line))
            line += self._input[self._at : end]
            self._at = end
        return bytes(line)

    def give_back(self, code: int) -> int:
        """Put a byte back, to be read next. Returns it, or EOF."""
        if code == EOF or self._flags & 3 == O_WRONLY:
            return EOF
        self._given_back.append(code & 0xFF)
        self.is_ended = False
        return code & 0xFF

    def rest(self) -> tuple[bytes, int]:
        """Return the bytes that are to be read, as an object and the position in it, for scanf.

        A file is read to its end, everything else once.
        """
        if self._given_back:
            back = bytes(reversed(self._given_back))
            self._given_back.clear()
            self._input, self._at = back + self._input[self._at :], 0
        is_first = self._at >= len(self._input)
        while is_first or self.descriptor.is_regular:
            is_first = False
            if self.is_ended:
                break
            self._begin_reading()
            try:
                data = self.descriptor.read(1 << 30 if self.descriptor.is_regular else BLOCK)
            except OSError:
                self.is_failed = True
                raise
            if not data:
                break
            self._input, self._at = self._input[self._at :] + data, 0
        return self._input, self._at

    def skip(self, count: int, is_ended: bool) -> None:
        """Count bytes of `rest` as read."""
        self._at += count
        self.is_ended |= is_ended

    def _underflow(self) -> bool:
        """Fill the buffer. Returns False at the end, which stays."""
        if self.is_ended:
            return False
        self._begin_reading()
        self._has_room = True
        try:
            self._input, self._at = self.descriptor.read(1 if self.buffering == NONE else self.room), 0
        except OSError:
            self.is_failed = True
            raise
        self.is_ended = not self._input
        return bool(self._input)

    def _begin_reading(self) -> None:
        if self._flags & 3 == O_WRONLY:
            self.is_failed = True
            raise failure(errno.EBADF)
        self.flush()

    # -- writing -----------------------------------------------------------------------------------------------------

    def write(self, data: bytes) -> int:
        """Write bytes. Returns the number that the buffer or the file took.

        Raises:
            OSError: the file cannot be written, and no byte was.
        """
        if self._flags & 3 == O_RDONLY:
            self.is_failed = True
            raise failure(errno.EBADF)
        if not data:
            return 0
        self._leave_reading()
        try:
            return self._put(data)
        except OSError:
            self.is_failed = True
            raise

    def _put(self, data: bytes) -> int:
        if self.buffering == NONE:
            return self._deliver(data)
        held = self._output
        free = self.room - len(held) if self._has_room else 0
        self._has_room = True
        if self.buffering == LINES and b"\n" in data:
            end = data.rindex(b"\n") + 1
            held += data[:end]
            self.flush()
            held += data[end:]
            return len(data)
        if len(data) <= free:
            held += data
            return len(data)
        held += data[:free]
        self.flush()
        whole = (len(data) - free) // self.room * self.room
        if whole:
            self._deliver(data[free : free + whole])
        held += data[free + whole :]
        return len(data)

    def _deliver(self, data: bytes) -> int:
        sent = 0
        while sent < len(data):
            sent += self.descriptor.write(data[sent:])
        return sent

    def flush(self) -> None:
        """Write the buffer to the file.

        Raises:
            OSError: the file does not take it; the bytes stay in the buffer.
        """
        while self._output:
            try:
                count = self.descriptor.write(bytes(self._output))
            except OSError:
                self.is_failed = True
                raise
            del self._output[:count]

    # -- positions ---------------------------------------------------------------------------------------------------

    def _leave_reading(self) -> None:
        """Move the descriptor back to where reading ended, and drop the bytes that were read ahead."""
        ahead = len(self._input) - self._at + len(self._given_back)
        self._input, self._at = b"", 0
        self._given_back.clear()
        if ahead and self.descriptor.is_regular:
            self.descriptor.seek(-ahead, SEEK_CUR)

    def sync(self) -> None:
        """Write the buffer, or give back the bytes that were read ahead, as fflush does."""
        self.flush()
        if self.descriptor.is_regular and self._flags & 3 != O_WRONLY:
            self._leave_reading()

    def tell(self) -> int:
        """Return the position of the next byte.

        Raises:
            OSError: ESPIPE.
        """
        if self._output and self._flags & O_APPEND:
            return self.descriptor.seek(0, SEEK_END) + len(self._output)
        here = self.descriptor.seek(0, SEEK_CUR)
        return here + len(self._output) - (len(self._input) - self._at) - len(self._given_back)

    def seek(self, offset: int, whence: int) -> None:
        """Move to a position.

        Raises:
            OSError: EINVAL, ESPIPE, or an error of writing.
        """
        if whence not in (SEEK_SET, SEEK_CUR, SEEK_END):
            raise failure(errno.EINVAL)
        self.flush()
        if whence == SEEK_CUR:
            offset, whence = self.tell() + offset, SEEK_SET
        self.descriptor.seek(offset, whence)
        self._input, self._at = b"", 0
        self._given_back.clear()
        self.is_ended = False

    def set_buffer(self, buffering: int, size: int) -> None:
        """Choose the kind and the size of the buffer.

        Raises:
            OSError: EINVAL.
        """
        if buffering not in (FULL, LINES, NONE):
            raise failure(errno.EINVAL)
        self.buffering = buffering
        if size and buffering != NONE:
            self.room = size

    def clear(self) -> None:
        """Forget the end and the error."""
        self.is_ended = self.is_failed = False
