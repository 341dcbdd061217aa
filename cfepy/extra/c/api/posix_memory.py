"""mmap and related functions of POSIX, and sysconf for the size of a page and other limits."""

from __future__ import annotations

import errno
from typing import TYPE_CHECKING

from cfepy.extra.c.api.posix_calls import PosixCalls
from cfepy.extra.c.arena import PAGE
from cfepy.extra.c.posix.mapped_memory import MAP_ANONYMOUS
from cfepy.extra.c.posix.open_descriptors import MOST, failure

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

LIMITS = {2: 100, 4: MOST, 30: PAGE, 60: 1024, 83: 1, 84: 1}
"""sysconf: ticks per second, open files, bytes of a page, entries of writev, processors, and those that run."""


def declare(api: Declarations, c: CRuntime) -> None:
    calls, mapped = PosixCalls(api, c), c.mapped_memory

    def map_memory(address: int, size: int, protection: int, flags: int, number: int, offset: int) -> int:
        c.kernel.preempt()
        file = None if flags & MAP_ANONYMOUS else c.descriptors.of(number)
        return mapped.map(size, protection, flags, file, offset)

    def limit(name: int) -> int:
        if name not in LIMITS:
            raise failure(errno.EINVAL)
        return LIMITS[name]

    calls.add("mmap mmap64", "$pQiiiq", map_memory)
    calls.add("munmap", "$pQ", lambda address, size: mapped.unmap(address, size))
    calls.add("msync", "$pQi", lambda address, size, flags: mapped.sync(address, size))
    calls.add("sysconf", "i", limit)
    api.add("getpagesize", "", lambda: PAGE)
