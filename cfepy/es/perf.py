"""The performance log (cfe_es_perf.c): the times at which code sections ran, and the file of the log.

Code marks the entry and exit of a section with a number below 128 (CFE_ES_PerfLogAdd). While the log waits for a
trigger or is triggered, it records the markers that pass the filter with the time, until enough entries follow the
trigger.

The file is written a few entries at a time (CFE_ES_RunPerfLogDump): the background task calls `PerfDump.run`. Every
step costs one credit, and elapsed time earns credits.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from cfepy.es import events as ev
from cfepy.es.packets import PERF_ENTRY, PERF_METADATA
from cfepy.es.reset_data import PERF_MASK_WORDS, PerfData
from cfepy.fs import HEADER_SIZE, SUBTYPE_ES_PERFDATA, init_header
from cfepy.osal import OS_FILE_FLAG_CREATE, OS_FILE_FLAG_TRUNCATE, OS_WRITE_ONLY, Osal
from cfepy.ports import Ports
from cfepy.status import CfeError, OsalError

IDLE, WAITING_FOR_TRIGGER, TRIGGERED = 0, 1, 2
"""States of the log (CFE_ES_PERF_*)."""

TRIGGER_START, TRIGGER_CENTER, TRIGGER_END = 0, 1, 2
"""The part of the log that follows the trigger: all, half, nothing (CFE_ES_PerfTrigger_*)."""

MAX_IDS = 128
EXIT_BIT = 31
MARKER_VERSION = 1
DESCRIPTION = "ES Performance data file"
DELAY_MS = 20  # CFE_PLATFORM_ES_PERF_CHILD_MS_DELAY
ENTRIES_BETWEEN_DELAYS = 50


class PerformanceLog:
    """A ring of entries.

    Args:
        data: the stored data.
        size: number of entries.
        now: returns the upper and lower part of the time.
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
        """Record a marker (CFE_ES_PerfLogAdd); see `PerfApi.perf_log_add`."""
        data = self.data
        if data.state == IDLE:
            return
        if not 0 <= marker < MAX_IDS:
            self._refuse(marker)
        elif _in_mask(data.filter_mask, marker):
            self._store((marker | (entry_exit & 1) << EXIT_BIT, *self._now()))  # in C the other bits are shifted out
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
        """Stop recording."""
        self.data.state = IDLE

    def metadata_record(self) -> bytes:
        """Return the record in front of the entries in the log's file."""
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
        """Return an entry as a record of the log's file, by its age: 0 is the oldest."""
        data = self.data
        marker, upper, lower = data.entries[(data.start + number) % self.size]
        return PERF_ENTRY.pack(Data=marker, TimerUpper32=upper, TimerLower32=lower)


def _in_mask(mask: list[int], marker: int) -> bool:
    return bool(mask[marker // 32] >> marker % 32 & 1)


class PerfDump:
    """The dump of the log to a file; only one at a time.

    Args:
        log: the log to write.
        osal: writes the file.
        ports: provides the header and the events.

    Attributes:
        remaining: number of entries still to write, for housekeeping.
    """

    def __init__(self, log: PerformanceLog, osal: Osal, ports: Ports) -> None:
        self._log = log
        self._osal = osal
        self._ports = ports
        self._steps: Iterator[None] | None = None
        self._credit = 0
        self.remaining = 0

    @property
    def is_busy(self) -> bool:
        """Whether a dump is in progress."""
        return self._steps is not None

    def start(self, path: str) -> None:
        """Start to write the log to a file in the background task."""
        self._steps = self._write(path)
        self.remaining = self._log.data.count

    def run(self, elapsed_ms: int) -> bool:
        """Take as many steps as the elapsed time allows; return whether the dump continues."""
        earned = elapsed_ms * ENTRIES_BETWEEN_DELAYS // DELAY_MS
        self._credit = min(ENTRIES_BETWEEN_DELAYS, self._credit + earned)
        while self._credit > 0 and self._steps is not None:
            self._credit -= 1
            if next(self._steps, self) is self:
                self._steps = None
        return self.is_busy

    def _write(self, path: str) -> Iterator[None]:
        """Yield at the end of each step of a dump."""
        yield
        try:
            filedes = self._osal.open_create(path, OS_FILE_FLAG_CREATE | OS_FILE_FLAG_TRUNCATE, OS_WRITE_ONLY)
        except OsalError as error:
            self._send(ev.PERF_LOG_ERR_EID, f"Error creating file {path}, RC = {error.status}", ev.ERROR)
            self.remaining = 0
            return
        self._credit = 0  # NASA's state machine waits here, whatever its credit is
        yield
        yield from self._write_records(filedes, path)
        self.remaining = 0
        self._osal.close(filedes)

    def _write_records(self, filedes: int, path: str) -> Iterator[None]:
        count, block, written = self._log.data.count, HEADER_SIZE, HEADER_SIZE
        try:
            self._ports.fs.write_whole_header(filedes, init_header(DESCRIPTION, SUBTYPE_ES_PERFDATA))
            yield
            for number, record in enumerate(self._records()):
                block = len(record)
                written += self._osal.write_whole(filedes, record)
                self.remaining = count - number
                yield
        except CfeError as error:
            status = error.status & 0xFFFFFFFF
            text = f"File write,byte cnt err,file {path},request={block},status=0x{status:08x}"
            self._send(ev.FILEWRITE_ERR_EID, text, ev.ERROR)
            return
        self._send(ev.PERF_DATAWRITTEN_EID, f"{path} written:Size={written},EntryCount={count}", ev.DEBUG)

    def _records(self) -> Iterator[bytes]:
        yield self._log.metadata_record()
        for number in range(self._log.data.count):
            yield self._log.entry_record(number)

    def _send(self, event_id: int, text: str, kind: int) -> None:
        self._ports.evs.send_event(event_id, kind, text)
