"""Time Services: one spacecraft time for all, set by ground and tone (cFE TIME).

Code that generates, keeps or converts spacecraft time belongs here. The virtual time of the simulation belongs to the
kernel (`cfepy.rtos`). The five services are independent of one another; TIME reaches the others through its `Ports`.
The central file is `cfepy/time/service.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.time.clock import CLOCK_FLYWHEEL, CLOCK_INVALID, CLOCK_VALID
    from cfepy.time.packets import COMMANDS, TELEMETRY
    from cfepy.time.service import TimeServices
    from cfepy.time.settings import TimeSettings
    from cfepy.time.systime import (
        A_GT_B,
        A_LT_B,
        EQUAL,
        SysTime,
        add,
        compare,
        copy,
        micro2sub_secs,
        print_,
        sub2micro_secs,
        subtract,
    )

__all__ = [
    "A_GT_B",
    "A_LT_B",
    "CLOCK_FLYWHEEL",
    "CLOCK_INVALID",
    "CLOCK_VALID",
    "COMMANDS",
    "EQUAL",
    "TELEMETRY",
    "SysTime",
    "TimeServices",
    "TimeSettings",
    "add",
    "compare",
    "copy",
    "micro2sub_secs",
    "print_",
    "sub2micro_secs",
    "subtract",
]

if not TYPE_CHECKING:  # type checkers see only the names above
    __getattr__, __dir__ = face(
        __name__,
        {
            ".clock": (
                "CLOCK_FLYWHEEL",
                "CLOCK_INVALID",
                "CLOCK_VALID",
            ),
            ".packets": (
                "COMMANDS",
                "TELEMETRY",
            ),
            ".service": ("TimeServices",),
            ".settings": ("TimeSettings",),
            ".systime": (
                "A_GT_B",
                "A_LT_B",
                "EQUAL",
                "SysTime",
                "add",
                "compare",
                "copy",
                "micro2sub_secs",
                "print_",
                "sub2micro_secs",
                "subtract",
            ),
        },
    )
