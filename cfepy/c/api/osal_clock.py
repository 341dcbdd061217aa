"""OS_GetLocalTime and its kin for C. What else there is for an OS_time_t are inline functions of its header.

Code may wait by reading a clock again and again: each reading costs virtual time.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.c.api.osal_values import BAD
from cfepy.osal import OsTime

if TYPE_CHECKING:
    from cfepy.c.calls import Declarations
    from cfepy.c.runtime import CRuntime


def declare(api: Declarations, c: CRuntime) -> None:
    """Add the functions; see `cfepy.c.api`."""
    os, memory = c.handle.os, c.memory

    def set_local_time(time: int) -> None:
        os.set_local_time(OsTime(memory.i64(time)))

    def to_relative(time: int) -> int:
        return os.time_to_relative_milliseconds(OsTime(time))

    api.add("OS_GetMonotonicTime", "$8", os.get_monotonic_time, BAD)
    api.add("OS_GetLocalTime", "$8", os.get_local_time, BAD)
    api.add("OS_SetLocalTime", "P", set_local_time, BAD)
    api.add("OS_TimeFromRelativeMilliseconds", "$i", os.time_from_relative_milliseconds)
    api.add("OS_TimeToRelativeMilliseconds", "$q", to_relative)
