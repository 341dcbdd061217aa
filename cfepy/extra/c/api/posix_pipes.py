"""pipe of POSIX with the buffers of Linux, and signal and sigaction, with which an application ignores SIGPIPE.

A pipe has 16 pages. A write goes on in the last page if it fits, and the rest goes into new pages.
"""

from __future__ import annotations

import errno
from collections import deque
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from cfepy.extra.c.api.posix_calls import PosixCalls
from cfepy.extra.c.posix.descriptor_waits import await_descriptors
from cfepy.extra.c.posix.open_descriptors import (
    O_NONBLOCK,
    O_RDONLY,
    O_WRONLY,
    POLLERR,
    POLLHUP,
    POLLIN,
    POLLOUT,
    Descriptor,
    Facts,
    failure,
)
from cfepy.extra.c.posix.signal_actions import SignalActions
from cfepy.osal import Endpoint
from cfepy.rtos import FOREVER, Kernel

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

O_CLOEXEC, O_DIRECT = 0o2000000, 0o40000
SIGACTION_BYTES, SIGSET_BYTES = 152, 128
"""sizeof(struct sigaction), which begins with the handler, and sizeof(sigset_t)."""


PAGE_BYTES = 4096
MOST_PAGES = 16
S_IFIFO = 0o010000


class _Page:
    """The bytes of a page that are not read yet, and the bytes that were ever written into it."""

    def __init__(self, data: bytes) -> None:
        self.data = bytearray(data)
        self.filled = len(data)


class PipeBuffer:
    """The bytes between the two ends of a pipe.

    Args:
        kernel: the processor.
        signals: the action of SIGPIPE.

    Attributes:
        endpoint: announces changes.
        has_reader, has_writer: whether each end is open.
    """

    def __init__(self, kernel: Kernel, signals: SignalActions) -> None:
        self.kernel = kernel
        self.signals = signals
        self.endpoint = Endpoint()
        self.has_reader = self.has_writer = True
        self._pages: deque[_Page] = deque()

    @property
    def has_data(self) -> bool:
        """Whether bytes wait to be read."""
        return bool(self._pages)

    @property
    def has_room(self) -> bool:
        """Whether a page is free."""
        return len(self._pages) < MOST_PAGES

    @property
    def size(self) -> int:
        """The number of bytes that wait."""
        return sum(len(each.data) for each in self._pages)

    def take(self, count: int) -> bytes:
        """Return up to `count` bytes."""
        taken = bytearray()
        while self._pages and len(taken) < count:
            page = self._pages[0]
            piece = page.data[: count - len(taken)]
            taken += piece
            del page.data[: len(piece)]
            if not page.data:
                self._pages.popleft()
        return bytes(taken)

    def join(self, data: bytes) -> int:
        """Add the part of a write that goes into the last page. Returns its size."""
        part = len(data) % PAGE_BYTES
        if not self._pages or not part or self._pages[-1].filled + part > PAGE_BYTES:
            return 0
        self._pages[-1].data += data[:part]
        self._pages[-1].filled += part
        return part

    def add(self, data: bytes) -> int:
        """Add pages while there is room. Returns the number of bytes."""
        sent = 0
        while sent < len(data) and self.has_room:
            page = _Page(data[sent : sent + PAGE_BYTES])
            self._pages.append(page)
            sent += page.filled
        return sent


class PipeEnd(Descriptor):
    """An end of a pipe.

    Args:
        buffer: the bytes.
        flags: O_RDONLY or O_WRONLY, and O_NONBLOCK.
    """

    def __init__(self, buffer: PipeBuffer, flags: int) -> None:
        super().__init__(flags)
        self._buffer = buffer
        self._is_reader = flags & ~O_NONBLOCK == O_RDONLY

    @property
    def endpoints(self) -> Sequence[Endpoint]:
        return (self._buffer.endpoint,)

    @property
    def events(self) -> int:
        buffer = self._buffer
        if self._is_reader:
            return (POLLIN if buffer.has_data else 0) | (0 if buffer.has_writer else POLLHUP)
        return (POLLOUT if buffer.has_room else 0) | (0 if buffer.has_reader else POLLERR)

    def read(self, count: int) -> bytes:
        buffer = self._buffer
        if not self._is_reader:
            raise failure(errno.EBADF)
        if not count:
            return b""
        self._wait(lambda: buffer.has_data or not buffer.has_writer)
        data = buffer.take(count)
        buffer.endpoint.changed()
        return data

    def write(self, data: bytes) -> int:
        buffer = self._buffer
        if self._is_reader:
            raise failure(errno.EBADF)
        if not data:
            return 0
        if not buffer.has_reader:
            raise buffer.signals.broken_pipe("the pipe has no reader")
        sent = buffer.join(data)
        while sent < len(data):
            if not buffer.has_room and (sent and self.is_nonblocking):
                break
            self._wait(lambda: buffer.has_room or not buffer.has_reader)
            if not buffer.has_reader:
                if not sent:
                    raise buffer.signals.broken_pipe("the pipe has no reader")
                break
            sent += buffer.add(data[sent:])
            buffer.endpoint.changed()
        buffer.endpoint.changed()
        return sent

    def waiting(self) -> int:
        return self._buffer.size

    def facts(self) -> Facts:
        return Facts(S_IFIFO | 0o600)

    def close(self) -> None:
        if self._is_reader:
            self._buffer.has_reader = False
        else:
            self._buffer.has_writer = False
        self._buffer.endpoint.changed()

    def _wait(self, ready: Callable[[], bool]) -> None:
        timeout_ns = 0 if self.is_nonblocking else FOREVER
        if not await_descriptors(self._buffer.kernel, [self], ready, timeout_ns):
            raise failure(errno.EAGAIN)


def make_pipe(kernel: Kernel, signals: SignalActions, flags: int) -> tuple[PipeEnd, PipeEnd]:
    """Return the end to read and the end to write of a new pipe.

    Args:
        kernel: the processor.
        signals: the action of SIGPIPE.
        flags: O_NONBLOCK or 0.
    """
    buffer = PipeBuffer(kernel, signals)
    return PipeEnd(buffer, O_RDONLY | flags), PipeEnd(buffer, O_WRONLY | flags)


def declare(api: Declarations, c: CRuntime) -> None:
    calls, signals, memory = PosixCalls(api, c), c.signals, c.memory

    def pipe(at: int, flags: int) -> int:
        c.kernel.preempt()
        if flags & ~(O_NONBLOCK | O_CLOEXEC | O_DIRECT):
            raise failure(errno.EINVAL)
        reader, writer = make_pipe(c.kernel, signals, flags & O_NONBLOCK)
        first = c.descriptors.add(reader)
        try:
            second = c.descriptors.add(writer)
        except OSError:
            c.descriptors.close(first)
            raise
        memory.put_u32(at, first)
        memory.put_u32(at + 4, second)
        return 0

    def action(number: int, new: int, old: int) -> int:
        before = signals.action(number)
        if new:
            signals.choose("sigaction", number, memory.u64(new))
        if old:
            memory.poke(old, before.to_bytes(8, "little") + bytes(SIGACTION_BYTES - 8))
        return 0

    def fill(at: int, byte: int) -> int:
        memory.poke(at, bytes([byte]) * SIGSET_BYTES)
        return 0

    calls.add("pipe", "$P", lambda at: pipe(at, 0))
    calls.add("pipe2", "$Pi", pipe)
    calls.add("signal", "ip", lambda number, handler: signals.choose("signal", number, handler))
    calls.add("sigaction", "ipp", action)
    calls.add("sigemptyset", "P", lambda at: fill(at, 0))
