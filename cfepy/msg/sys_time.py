"""A spacecraft time in packets and files: CFE_TIME_SysTime_t, which every service has in its structs.

Imports only its neighbours in cfepy.msg.
"""

from __future__ import annotations

from cfepy.msg.layout import Layout

SYS_TIME = Layout("CFE_TIME_SysTime_t", [("Seconds", "u32"), ("Subseconds", "u32")])


def sys_time_fields(time: tuple[int, int]) -> dict[str, int]:
    """A time (seconds, subseconds of 2**-32 s) as the fields of SYS_TIME."""
    return {"Seconds": time[0], "Subseconds": time[1]}
