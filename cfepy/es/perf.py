"""The performance log (CFE_ES_PerfLogAdd, first half of cfe_es_perf.c): when which piece of code ran.

Code marks where it begins and ends with a number below 128. While the log waits for a trigger or was triggered, marked
places that pass the filter are recorded with the time, until enough came after the trigger.
"""

from __future__ import annotations

from collections.abc import Callable

from cfepy.es.packets import PERF_ENTRY, PERF_METADATA
from cfepy.es.reset_data import PERF_MASK_WORDS, PerfData

IDLE, WAITING_FOR_TRIGGER, TRIGGERED = 0, 1, 2
"""States of the log (CFE_ES_PERF_*)."""

TRIGGER_START, TRIGGER_CENTER, TRIGGER_END = 0, 1, 2
"""What part of the log comes after the trigger: all, half, nothing (CFE_ES_PerfTrigger_*)."""

MAX_IDS = 128
EXIT_BIT = 31
MARKER_VERSION = 1


class PerformanceLog:
    """A ring of entries.

    Args:
        data: where it is kept.
        size: entries it holds.
        now: upper and lower part of the time.
        log: writes to the system log.
    """

    def __init__(
        self, data: PerfData, size: int, now: Callable[[], tuple[int, int]], log: Callable[[str], object]
    ) -> None:
        self.data = data
        self.size = size
        self._now = now
        self._log = log

    def add(self, marker: int, entry_exit: int) -> None:
        """Record that a place was reached (CFE_ES_PerfLogAdd); see `PerfApi.perf_log_add`."""
        data = self.data
        if data.state == IDLE:
            return
        if not 0 <= marker < MAX_IDS:
            self._refuse(marker)
        elif _in_mask(data.filter_mask, marker):
            self._store((marker | (entry_exit & 1) << EXIT_BIT, *self._now()))  # in C the rest is shifted out
            if data.state == WAITING_FOR_TRIGGER and _in_mask(data.trigger_mask, marker):
                data.state = TRIGGERED
            if data.state == TRIGGERED:
                self._count_triggered()

    def _refuse(self, marker: int) -> None:
        if not self.data.invalid_marker_reported:
            self.data.invalid_marker_reported = True
            self._log(f"CFE_ES_PerfLogAdd: Invalid performance marker {marker},max is {MAX_IDS - 1}")

    def _store(self, entry: tuple[int, int, int]) -> None:
        data = self.data
        data.entries[data.end : data.end + 1] = [entry]
        data.end = (data.end + 1) % self.size
        if data.count < self.size:
            data.count += 1
        else:
            data.start = data.end

    def _count_triggered(self) -> None:
        data = self.data
        data.trigger_count += 1
        enough = {TRIGGER_START: self.size, TRIGGER_CENTER: self.size // 2}.get(data.mode, 0)
        if data.trigger_count >= enough:
            data.state = IDLE

    def start(self, mode: int) -> None:
        """Empty the log and wait for a trigger."""
        data = self.data
        data.mode = mode
        data.trigger_count = data.start = data.end = data.count = 0
        data.entries.clear()
        data.invalid_marker_reported = False
        data.state = WAITING_FOR_TRIGGER

    def stop(self) -> None:
        """Record nothing more."""
        self.data.state = IDLE

    def metadata_record(self) -> bytes:
        """What stands in front of the entries in the log's file."""
        data = self.data
        return PERF_METADATA.pack(
            Version=MARKER_VERSION,
            TimerTicksPerSecond=data.ticks_per_second,
            TimerLow32Rollover=data.low32_rollover,
            State=data.state,
            Mode=data.mode,
            TriggerCount=data.trigger_count,
            DataStart=data.start,
            DataEnd=data.end,
            DataCount=data.count,
            InvalidMarkerReported=int(data.invalid_marker_reported),
            FilterTriggerMaskSize=PERF_MASK_WORDS,
            FilterMask=data.filter_mask,
            TriggerMask=data.trigger_mask,
        )

    def entry_record(self, number: int) -> bytes:
        """An entry as it stands in the log's file, by its age: 0 is the oldest."""
        data = self.data
        marker, upper, lower = data.entries[(data.start + number) % self.size]
        return PERF_ENTRY.pack(Data=marker, TimerUpper32=upper, TimerLower32=lower)


def _in_mask(mask: list[int], marker: int) -> bool:
    return bool(mask[marker // 32] >> marker % 32 & 1)
