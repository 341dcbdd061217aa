"""The data of Executive Services that outlive a processor reset: reset variables and the three logs
(CFE_ES_ResetData_t).

These are plain data; the modules of the logs interpret them.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

from cfepy.config.platform import PlatformConfig

OVERWRITE, DISCARD = 0, 1
"""Modes of the system log (CFE_ES_LogMode_*)."""

PERF_MASK_WORDS = 4
ALL_IDS = 0xFFFFFFFF


@dataclass(slots=True)
class ResetVariables:
    """The cause and the number of the processor's starts (CFE_ES_ResetVariables_t)."""

    reset_type: int = 0
    reset_subtype: int = 0
    boot_source: int = 0
    es_caused_reset: bool = False
    processor_reset_count: int = 0
    max_processor_reset_count: int = 0


@dataclass(slots=True)
class SysLogData:
    """The system log: its bytes, the position of the next line, the end of the text, and the lines since it was
    cleared.
    """

    memory: bytearray
    write_index: int = 0
    end_index: int = 0
    entries: int = 0
    mode: int = OVERWRITE


class ErLogEntry(NamedTuple):
    """An exception or a reset (CFE_ES_ERLog_MetaData_t); `time` is (seconds, subseconds)."""

    entry_type: int
    reset_type: int
    reset_subtype: int
    boot_source: int
    processor_reset_count: int
    max_processor_reset_count: int
    time: tuple[int, int]
    description: str
    app_id: int
    context_id: int


@dataclass(slots=True)
class ErLogData:
    """The exception and reset log: entries in the order of their slots, the next slot, and the number of entries
    written.
    """

    slots: list[ErLogEntry | None]
    index: int = 0
    entries: int = 0


@dataclass(slots=True)
class PerfData:
    """The performance log (CFE_ES_PerfData_t); an entry is (marker and exit bit, upper and lower time)."""

    ticks_per_second: int
    low32_rollover: int
    state: int = 0
    mode: int = 0
    trigger_count: int = 0
    start: int = 0
    end: int = 0
    count: int = 0
    invalid_marker_reported: bool = False
    filter_mask: list[int] = field(default_factory=lambda: [ALL_IDS] * PERF_MASK_WORDS)
    trigger_mask: list[int] = field(default_factory=lambda: [0] * PERF_MASK_WORDS)
    entries: list[tuple[int, int, int]] = field(default_factory=list)


class ResetData:
    """All reset data, as after a power-on reset.

    Args:
        config: sizes of the logs.
        ticks_per_second, low32_rollover: properties of the clock for performance entries.
    """

    __slots__ = ("er_log", "perf", "syslog", "variables")

    def __init__(self, config: PlatformConfig, ticks_per_second: int, low32_rollover: int) -> None:
        self.variables = ResetVariables()
        self.syslog = SysLogData(bytearray(config.es_system_log_size))
        self.er_log = ErLogData([None] * config.es_er_log_entries)
        self.perf = PerfData(ticks_per_second, low32_rollover)
