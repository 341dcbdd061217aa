"""Waiting for descriptors in virtual time: blocking calls of sockets, select and poll."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from cfepy.extra.c.posix.open_descriptors import Descriptor
from cfepy.osal import Endpoint
from cfepy.rtos import FOREVER, Kernel, WaitList
from cfepy.units import NS_PER_MS

LOOK_NS = 10 * NS_PER_MS
"""Time until a device is looked at again, which announces nothing."""


def await_descriptors(
    kernel: Kernel, descriptors: Sequence[Descriptor], ready: Callable[[], bool], timeout_ns: int
) -> bool:
    """Wait until `ready` returns true; it is called again after each change.

    A descriptor that is closed meanwhile stays open until the wait ends, as on Linux.

    Args:
        kernel: the processor.
        descriptors: the descriptors that change.
        ready: returns whether the wait is over.
        timeout_ns: longest wait in virtual time; FOREVER for no limit.

    Returns:
        False after the timeout.
    """
    if ready():
        return True
    if timeout_ns == 0:
        return False
    until = FOREVER if timeout_ns == FOREVER else kernel.now + timeout_ns
    waits = WaitList("descriptors")
    endpoints: list[Endpoint] = [end for each in descriptors for end in each.endpoints]
    looks = any(each.announces_nothing for each in descriptors)
    for endpoint in endpoints:
        endpoint.watch(kernel, waits)
    for each in descriptors:
        each.users += 1
    try:
        while not ready():
            left = FOREVER if until == FOREVER else until - kernel.now
            if left <= 0 and left != FOREVER:
                return False
            if looks:
                left = LOOK_NS if left == FOREVER else min(left, LOOK_NS)
            kernel.wait_on(waits, left)
        return True
    finally:
        for endpoint in endpoints:
            endpoint.unwatch(kernel, waits)
        for each in descriptors:
            each.users -= 1
            if not each.users and not each.links:
                each.close()
