"""The part of pthreads that the compilers' libraries and std::mutex, std::call_once and similar use.

Threads of an application are tasks of OSAL and ES: there is no pthread_create.
"""

from __future__ import annotations

import errno
import platform
from typing import TYPE_CHECKING

from cfepy.extra.c.crashes import CFault
from cfepy.rtos import Mutex

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.image import Image
    from cfepy.extra.c.runtime import CRuntime

ONCE_DONE = 2
FUTEX = {"x86_64": 202, "aarch64": 98}
"""The system call by which code waits for a static C++ variable that another task initialises."""
FUTEX_COMMANDS = 0x7F
FUTEX_WAIT = 0
WAIT_MS = 1


def declare(api: Declarations, c: CRuntime) -> None:
    memory, kernel = c.memory, c.kernel
    mutexes: dict[int, Mutex] = {}

    def mutex(address: int) -> Mutex:
        if address not in mutexes:
            mutexes[address] = Mutex(kernel, f"at {address:#x}")
        return mutexes[address]

    def lock(address: int) -> None:
        kernel.preempt()
        mutex(address).take()

    def try_lock(address: int) -> int:
        kernel.preempt()
        found = mutex(address)
        if found.owner not in (None, kernel.current):
            return errno.EBUSY
        found.take()
        return 0

    def unlock(address: int) -> int:
        return 0 if mutex(address).give() else errno.EPERM

    def forget(address: int) -> None:
        mutexes.pop(address, None)

    def forget_all(image: Image) -> None:
        for address in [each for each in mutexes if each in image]:
            del mutexes[address]

    def once(control: int, function: int) -> None:
        if memory.u32(control) != ONCE_DONE:
            memory.put_u32(control, ONCE_DONE)
            c.run(function)

    def system_call(number: int, address: int, command: int, value: int) -> int:
        if number != FUTEX[platform.machine()]:
            raise CFault(f"syscall({number}) is not available: applications cannot call the kernel of the host")
        if command & FUTEX_COMMANDS == FUTEX_WAIT and memory.u32(address) == value & 0xFFFFFFFF:
            c.handle.os.task_delay(WAIT_MS)
        return 0

    def set_up(attributes: int) -> None:
        """Do nothing: all mutexes are recursive, as OSAL's are."""

    c.on_unload.append(forget_all)
    api.add("pthread_mutexattr_init", "P", set_up, errno.EINVAL)
    api.add("pthread_mutexattr_destroy", "P", set_up, errno.EINVAL)
    api.add("pthread_mutexattr_settype", "P-", set_up, errno.EINVAL)
    api.add("pthread_mutex_init", "P-", forget, errno.EINVAL)
    api.add("pthread_mutex_destroy", "P", forget, errno.EINVAL)
    api.add("pthread_mutex_lock", "P", lock, errno.EINVAL)
    api.add("pthread_mutex_trylock", "P", try_lock, errno.EINVAL)
    api.add("pthread_mutex_unlock", "P", unlock, errno.EINVAL)
    api.add("pthread_once", "PP", once, errno.EINVAL)
    api.add("syscall", "qpiI", system_call)
