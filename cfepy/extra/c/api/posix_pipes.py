"""pipe of POSIX, and signal and sigaction, with which an application ignores SIGPIPE."""

from __future__ import annotations

import errno
from typing import TYPE_CHECKING

from cfepy.extra.c.api.posix_calls import PosixCalls
from cfepy.extra.c.posix.open_descriptors import O_NONBLOCK, failure
from cfepy.extra.c.posix.pipes import make_pipe

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

O_CLOEXEC, O_DIRECT = 0o2000000, 0o40000
SIGACTION_BYTES, SIGSET_BYTES = 152, 128
"""sizeof(struct sigaction), which begins with the handler, and sizeof(sigset_t)."""


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
