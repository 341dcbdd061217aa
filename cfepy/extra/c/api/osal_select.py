"""OS_Select*: waiting for several descriptors, for C. An OS_FdSet has a bit for each place in their table."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.config.platform import PlatformConfig
from cfepy.extra.c.api.osal_values import BAD
from cfepy.extra.c.memory import CMemory
from cfepy.osal import FdSet, OsTime
from cfepy.status import OS_ERROR_TIMEOUT, OsalError

if TYPE_CHECKING:
    from collections.abc import Callable

    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

SET_BITS = PlatformConfig().os_max_num_open_files  # the header's limit, with which the application was compiled
SET_BYTES = (SET_BITS + 7) // 8
"""sizeof(OS_FdSet)."""


def read_set(memory: CMemory, at: int) -> FdSet | None:
    """Return the set at an address; None for NULL."""
    if not at:
        return None
    made = FdSet()
    bits = int.from_bytes(memory.peek(at, SET_BYTES), "little")
    made.slots.extend(slot for slot in range(SET_BITS) if bits >> slot & 1)
    return made


def write_set(memory: CMemory, at: int, fd_set: FdSet | None) -> None:
    """Write a set back; do nothing for NULL."""
    if fd_set is not None:
        memory.poke(at, sum(1 << slot for slot in fd_set.slots).to_bytes(SET_BYTES, "little"))


def declare(api: Declarations, c: CRuntime) -> None:
    _declare_sets(api, c)
    _declare_waits(api, c)


def _declare_sets(api: Declarations, c: CRuntime) -> None:
    os, memory = c.handle.os, c.memory

    def change(function: Callable[[FdSet, int], object]) -> Callable[[int, int], None]:
        def call(at: int, filedes: int) -> None:
            fd_set = read_set(memory, at) or FdSet()
            function(fd_set, filedes)
            write_set(memory, at, fd_set)

        return call

    def is_set(at: int, filedes: int) -> bool:
        return os.select_fd_is_set(read_set(memory, at) or FdSet(), filedes)

    api.add("OS_SelectFdZero", "P", lambda at: memory.poke(at, bytes(SET_BYTES)), BAD)
    api.add("OS_SelectFdAdd", "PI", change(os.select_fd_add), BAD)
    api.add("OS_SelectFdClear", "PI", change(os.select_fd_clear), BAD)
    api.add("OS_SelectFdIsSet", "PI", is_set, 0)


def _declare_waits(api: Declarations, c: CRuntime) -> None:
    os, memory = c.handle.os, c.memory

    def give_flags(at: int, found: int | None) -> None:
        memory.put_u32(at, found or 0)
        if found is None:
            raise OsalError(OS_ERROR_TIMEOUT)

    def single(filedes: int, flags: int, timeout: int) -> None:
        give_flags(flags, os.select_single(filedes, memory.u32(flags), timeout))

    def single_abs(filedes: int, flags: int, timeout: int) -> None:
        give_flags(flags, os.select_single_abs(filedes, memory.u32(flags), OsTime(timeout)))

    def multiple(readers: int, writers: int, wait: Callable[[FdSet | None, FdSet | None], bool]) -> None:
        sets = read_set(memory, readers), read_set(memory, writers)
        if not wait(*sets):
            raise OsalError(OS_ERROR_TIMEOUT)
        write_set(memory, readers, sets[0])
        write_set(memory, writers, sets[1])

    def multiple_in(readers: int, writers: int, timeout: int) -> None:
        multiple(readers, writers, lambda read, write: os.select_multiple(read, write, timeout))

    def multiple_by(readers: int, writers: int, timeout: int) -> None:
        multiple(readers, writers, lambda read, write: os.select_multiple_abs(read, write, OsTime(timeout)))

    api.add("OS_SelectSingle", "$IPi", single, BAD)
    api.add("OS_SelectSingleAbs", "$IPq", single_abs, BAD)
    api.add("OS_SelectMultiple", "$ppi", multiple_in, BAD)
    api.add("OS_SelectMultipleAbs", "$ppq", multiple_by, BAD)
