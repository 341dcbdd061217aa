"""The board under a mission (cFE's Platform Support Package): its profile, memory, clock and resets.

The properties of a board belong here: the numbers of its profile, its memory and the use of it, the memory that
outlives a reset, the watchdog, and stored exceptions. The reactions of cFE to a reset or an exception belong to
`cfepy.es`. The central file is `cfepy/psp/psp.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.psp.addresses import AllMemory, BadAddress
    from cfepy.psp.exceptions import ExceptionSummary
    from cfepy.psp.measured import Measured
    from cfepy.psp.memory import MemoryBudget, OverBudget, object_sizes
    from cfepy.psp.profile import (
        LIMIT_NAMES,
        MEMORIES,
        RANGES,
        BoardProfile,
        Limit,
        available_boards,
        load_profile,
        read_limit,
        read_memory,
    )
    from cfepy.psp.psp import (
        AREA_ADDRESSES,
        RST_SUBTYPE_EXCEPTION,
        RST_SUBTYPE_HW_SPECIAL_COMMAND,
        RST_SUBTYPE_HW_WATCHDOG,
        RST_SUBTYPE_POWER_CYCLE,
        RST_SUBTYPE_RESET_COMMAND,
        RST_TYPE_POWERON,
        RST_TYPE_PROCESSOR,
        PanicError,
        Psp,
        RestartType,
    )
    from cfepy.psp.retained import EEPROM_BYTES, Retained
    from cfepy.psp.watchdog import Watchdog

__all__ = [
    "AREA_ADDRESSES",
    "EEPROM_BYTES",
    "LIMIT_NAMES",
    "MEMORIES",
    "RANGES",
    "RST_SUBTYPE_EXCEPTION",
    "RST_SUBTYPE_HW_SPECIAL_COMMAND",
    "RST_SUBTYPE_HW_WATCHDOG",
    "RST_SUBTYPE_POWER_CYCLE",
    "RST_SUBTYPE_RESET_COMMAND",
    "RST_TYPE_POWERON",
    "RST_TYPE_PROCESSOR",
    "AllMemory",
    "BadAddress",
    "BoardProfile",
    "ExceptionSummary",
    "Limit",
    "Measured",
    "MemoryBudget",
    "OverBudget",
    "PanicError",
    "Psp",
    "RestartType",
    "Retained",
    "Watchdog",
    "available_boards",
    "load_profile",
    "object_sizes",
    "read_limit",
    "read_memory",
]

if not TYPE_CHECKING:  # type checkers see only the names above
    __getattr__, __dir__ = face(
        __name__,
        {
            ".addresses": (
                "AllMemory",
                "BadAddress",
            ),
            ".exceptions": ("ExceptionSummary",),
            ".measured": ("Measured",),
            ".memory": (
                "MemoryBudget",
                "OverBudget",
                "object_sizes",
            ),
            ".profile": (
                "LIMIT_NAMES",
                "MEMORIES",
                "RANGES",
                "BoardProfile",
                "Limit",
                "available_boards",
                "load_profile",
                "read_limit",
                "read_memory",
            ),
            ".psp": (
                "AREA_ADDRESSES",
                "RST_SUBTYPE_EXCEPTION",
                "RST_SUBTYPE_HW_SPECIAL_COMMAND",
                "RST_SUBTYPE_HW_WATCHDOG",
                "RST_SUBTYPE_POWER_CYCLE",
                "RST_SUBTYPE_RESET_COMMAND",
                "RST_TYPE_POWERON",
                "RST_TYPE_PROCESSOR",
                "PanicError",
                "Psp",
                "RestartType",
            ),
            ".retained": (
                "EEPROM_BYTES",
                "Retained",
            ),
            ".watchdog": ("Watchdog",),
        },
    )
