"""Writing the performance log to its file, some entries at a time (CFE_ES_RunPerfLogDump).

The background task calls `run`; every step takes one credit, of which some come back with the time that passed.
"""

from __future__ import annotations

from collections.abc import Iterator

from cfepy.es import events as ev
from cfepy.es.perf import PerformanceLog
from cfepy.fs import HEADER_SIZE, init_header
from cfepy.fs.header import SUBTYPE_ES_PERFDATA
from cfepy.osal import Osal
from cfepy.osal.limits import OS_FILE_FLAG_CREATE, OS_FILE_FLAG_TRUNCATE, OS_WRITE_ONLY
from cfepy.ports import Ports
from cfepy.status import CfeError, OsalError

DESCRIPTION = "ES Performance data file"
DELAY_MS = 20  # CFE_PLATFORM_ES_PERF_CHILD_MS_DELAY
ENTRIES_BETWEEN_DELAYS = 50


class PerfDump:
    """The dump; one at a time.

    Args:
        log: what is written.
        osal: writes it.
        ports: for the header and events.

    Attributes:
        remaining: entries that are still to be written, for housekeeping.
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
        """Whether a dump has begun and not ended."""
        return self._steps is not None

    def start(self, path: str) -> None:
        """Begin to write the log to a file; the background task does it."""
        self._steps = self._write(path)
        self.remaining = self._log.data.count

    def run(self, elapsed_ms: int) -> bool:
        """Take as many steps as the time allows; whether the dump goes on."""
        earned = elapsed_ms * ENTRIES_BETWEEN_DELAYS // DELAY_MS
        self._credit = min(ENTRIES_BETWEEN_DELAYS, self._credit + earned)
        while self._credit > 0 and self._steps is not None:
            self._credit -= 1
            if next(self._steps, self) is self:
                self._steps = None
        return self.is_busy

    def _write(self, path: str) -> Iterator[None]:
        """The steps of a dump; each `yield` is the end of one."""
        yield
        try:
            filedes = self._osal.open_create(path, OS_FILE_FLAG_CREATE | OS_FILE_FLAG_TRUNCATE, OS_WRITE_ONLY)
        except OsalError as error:
            self._send(ev.PERF_LOG_ERR_EID, f"Error creating file {path}, RC = {error.status}", ev.ERROR)
            self.remaining = 0
            return
        self._credit = 0  # NASA's state machine waits here, whatever credit is left
        yield
        yield from self._write_records(filedes, path)
        self.remaining = 0
        self._osal.close(filedes)

    def _write_records(self, filedes: int, path: str) -> Iterator[None]:
        count, block, written = self._log.data.count, HEADER_SIZE, HEADER_SIZE
        try:
            self._ports.fs.write_header(filedes, init_header(DESCRIPTION, SUBTYPE_ES_PERFDATA))
            yield
            for number, record in enumerate(self._records()):
                block = len(record)
                written += self._osal.write(filedes, record)
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
