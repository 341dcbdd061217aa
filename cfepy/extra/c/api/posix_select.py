"""select and poll: waiting for several descriptors in virtual time."""

from __future__ import annotations

import errno
from struct import Struct
from typing import TYPE_CHECKING

from cfepy.extra.c.api.posix_calls import PosixCalls
from cfepy.extra.c.crashes import CFault
from cfepy.extra.c.posix.descriptor_waits import await_descriptors
from cfepy.extra.c.posix.open_descriptors import (
    MOST,
    POLLERR,
    POLLHUP,
    POLLIN,
    POLLNVAL,
    POLLOUT,
    POLLPRI,
    Descriptor,
    failure,
)
from cfepy.extra.c.posix.open_sockets import POLLWRBAND, SOCK_DGRAM, PosixSocket
from cfepy.rtos import FOREVER
from cfepy.units import NS_PER_MS, NS_PER_S, NS_PER_US

if TYPE_CHECKING:
    from collections.abc import Callable

    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

POLLFD = Struct("<ihh")
PAIR = Struct("<qq")
"""struct timeval and struct timespec."""
POLLRDNORM, POLLWRNORM = 0x40, 0x100
CAUSES = (POLLIN | POLLHUP | POLLERR, POLLOUT | POLLERR, POLLPRI)
"""The events that count for reading, writing and exceptions in select."""
_WORD = 64


class PosixWaits:
    """The functions that wait for descriptors.

    Args:
        c: the C side of the processor.
    """

    def __init__(self, c: CRuntime) -> None:
        self._c = c
        self._memory = c.memory
        self._table = c.descriptors

    # -- select ------------------------------------------------------------------------------------------------------

    def select(self, count: int, readers: int, writers: int, exceptions: int, timeout: int) -> int:
        start = self._c.kernel.now
        wait_ns = self._time(timeout, NS_PER_US)
        found = self._select(count, (readers, writers, exceptions), wait_ns)
        if timeout:  # Linux leaves the rest of the time there
            rest = max(wait_ns - (self._c.kernel.now - start), 0)
            self._memory.poke(timeout, PAIR.pack(rest // NS_PER_S, rest % NS_PER_S // NS_PER_US))
        return found

    def select_precisely(self, count: int, readers: int, writers: int, exceptions: int, timeout: int) -> int:
        return self._select(count, (readers, writers, exceptions), self._time(timeout, 1))

    def _time(self, at: int, unit_ns: int) -> int:
        if not at:
            return FOREVER
        seconds, parts = PAIR.unpack(self._memory.peek(at, PAIR.size))
        if seconds < 0 or parts < 0 or (unit_ns == 1 and parts >= NS_PER_S):
            raise failure(errno.EINVAL)
        return int(seconds) * NS_PER_S + int(parts) * unit_ns

    def _select(self, count: int, sets: tuple[int, int, int], wait_ns: int) -> int:
        self._c.kernel.preempt()
        if count < 0:
            raise failure(errno.EINVAL)
        size = -(-min(count, MOST) // _WORD) * (_WORD // 8)
        wanted: list[list[tuple[int, Descriptor]]] = []
        for at in sets:
            bits = int.from_bytes(self._memory.peek(at, size), "little") if at and size else 0
            numbers = [number for number in range(min(count, MOST)) if bits >> number & 1]
            wanted.append([(number, self._table.of(number)) for number in numbers])

        def found() -> list[list[int]]:
            return [
                [number for number, each in row if each.events & cause]
                for row, cause in zip(wanted, CAUSES, strict=True)
            ]

        self._wait([each for row in wanted for _, each in row], lambda: any(found()), wait_ns)
        result = found()
        for at, numbers in zip(sets, result, strict=True):
            if at and size:
                self._memory.poke(at, sum(1 << number for number in numbers).to_bytes(size, "little"))
        return sum(map(len, result))

    # -- poll --------------------------------------------------------------------------------------------------------

    def poll(self, at: int, count: int, timeout_ms: int) -> int:
        return self._poll(at, count, FOREVER if timeout_ms < 0 else timeout_ms * NS_PER_MS)

    def poll_checked(self, at: int, count: int, timeout_ms: int, room: int) -> int:
        if count * POLLFD.size > room:
            raise CFault("buffer overflow detected")
        return self.poll(at, count, timeout_ms)

    def poll_precisely(self, at: int, count: int, timeout: int, mask: int) -> int:
        return self._poll(at, count, self._time(timeout, 1))

    def _poll(self, at: int, count: int, wait_ns: int) -> int:
        self._c.kernel.preempt()
        if count > MOST:
            raise failure(errno.EINVAL)
        places = [at + n * POLLFD.size for n in range(count)]
        entries = [POLLFD.unpack(self._memory.peek(place, POLLFD.size)) for place in places]
        found: dict[int, Descriptor] = {}
        for number, _, _ in entries:
            try:
                if number >= 0:
                    found[number] = self._table.of(number)
            except OSError:
                continue

        def results() -> list[int]:
            return [_result(found.get(number), number, events) for number, events, _ in entries]

        self._wait(list(found.values()), lambda: any(results()), wait_ns)
        result = results()
        for place, (number, events, _), revents in zip(places, entries, result, strict=True):
            self._memory.poke(place, POLLFD.pack(number, events, revents))
        return sum(1 for each in result if each)

    def _wait(self, descriptors: list[Descriptor], ready: Callable[[], bool], wait_ns: int) -> None:
        kernel = self._c.kernel
        if not descriptors and wait_ns != FOREVER and not ready():  # a sleep
            kernel.delay(wait_ns)
            return
        await_descriptors(kernel, descriptors, ready, wait_ns)


def _result(descriptor: Descriptor | None, number: int, events: int) -> int:
    """Return revents of an entry."""
    if number < 0:
        return 0
    if descriptor is None:
        return POLLNVAL
    now = descriptor.events
    now |= POLLRDNORM * bool(now & POLLIN) | POLLWRNORM * bool(now & POLLOUT)
    if isinstance(descriptor, PosixSocket) and descriptor.kind == SOCK_DGRAM and now & POLLOUT:
        now |= POLLWRBAND
    return now & (events | POLLERR | POLLHUP)


def declare(api: Declarations, c: CRuntime) -> None:
    calls, waits = PosixCalls(api, c), PosixWaits(c)
    calls.add("select", "$ipppp", waits.select)
    calls.add("pselect", "$ipppp", waits.select_precisely)
    calls.add("poll", "$pQi", waits.poll)
    calls.add("ppoll", "$pQpp", waits.poll_precisely)
    calls.add("__poll_chk", "$pQiQ", waits.poll_checked)

    def bit(number: int) -> int:
        if not 0 <= number < MOST:
            raise CFault("buffer overflow detected")
        return number // _WORD

    for name in ("__fdelt_chk", "__fdelt_warn"):
        api.add(name, "q", bit)
