"""Commands for the performance log (second half of cfe_es_perf.c)."""

from __future__ import annotations

from cfepy.core_app import Replies
from cfepy.es import events as ev
from cfepy.es import packets as pk
from cfepy.es.command_group import CommandGroup, Handlers
from cfepy.es.perf import TRIGGER_END, TRIGGER_START, PerformanceLog
from cfepy.es.perf_dump import DELAY_MS, ENTRIES_BETWEEN_DELAYS, PerfDump
from cfepy.es.reset_data import PERF_MASK_WORDS
from cfepy.es.service import ExecutiveServices
from cfepy.fs import dump_file_name
from cfepy.status import CfeError

DEFAULT_FILE = "/ram/cfe_es_perf.dat"


class PerfCommands(CommandGroup):
    """The performance log.

    Args:
        es: the service.
        replies: how they answer.
        dump: writes the log's file.
    """

    def __init__(self, es: ExecutiveServices, replies: Replies, dump: PerfDump) -> None:
        super().__init__(es, replies)
        self._dump = dump

    @property
    def _log(self) -> PerformanceLog:
        return self._es.perf_log

    def handlers(self) -> Handlers:
        return (
            (pk.START_PERF_DATA, self._start),
            (pk.STOP_PERF_DATA, self._stop),
            (pk.SET_PERF_FILTER_MASK, self._set_filter_mask),
            (pk.SET_PERF_TRIGGER_MASK, self._set_trigger_mask),
        )

    def _start(self, packet: bytes) -> None:
        mode = pk.START_PERF_DATA.read(packet)["TriggerMode"]
        what = "Cannot start collecting performance data,"
        if self._dump.is_busy:
            self._replies.reject(ev.PERF_STARTCMD_ERR_EID, f"{what}perf data write in progress")
        elif mode > TRIGGER_END:
            text = f"{what} trigger mode ({mode}) out of range ({TRIGGER_START} to {TRIGGER_END})"
            self._replies.reject(ev.PERF_STARTCMD_TRIG_ERR_EID, text)
        else:
            self._log.start(mode)
            text = f"Start collecting performance data cmd received, trigger mode = {mode}"
            self._replies.accept(ev.PERF_STARTCMD_EID, text, ev.DEBUG)

    def _stop(self, packet: bytes) -> None:
        if self._dump.is_busy:
            text = "Stop performance data cmd ignored,perf data write in progress"
            self._replies.reject(ev.PERF_STOPCMD_ERR2_EID, text)
            return
        self._log.stop()
        try:
            path = dump_file_name(pk.STOP_PERF_DATA.read(packet)["DataFileName"], DEFAULT_FILE)
        except CfeError as error:
            self._replies.reject(ev.PERF_LOG_ERR_EID, f"Error parsing filename, RC = {error.status}")
            return
        self._dump.start(path)
        self._es.background_wakeup()
        count = self._log.data.count
        delays = f"{DELAY_MS}mS dly every {ENTRIES_BETWEEN_DELAYS} entries"
        self._replies.accept(ev.PERF_STOPCMD_EID, f"Perf Stop Cmd Rcvd, will write {count} entries.{delays}", ev.DEBUG)

    def _set_filter_mask(self, packet: bytes) -> None:
        fields = pk.SET_PERF_FILTER_MASK.read(packet)
        number, mask = fields["FilterMaskNum"], fields["FilterMask"]
        if number >= PERF_MASK_WORDS:
            text = f"Performance Filter Mask Cmd Error,Index({number})out of range({PERF_MASK_WORDS})"
            self._replies.reject(ev.PERF_FILTMSKERR_EID, text)
            return
        self._log.data.filter_mask[number] = mask
        text = f"Set Performance Filter Mask Cmd rcvd, num {number}, val 0x{mask:08X}"
        self._replies.accept(ev.PERF_FILTMSKCMD_EID, text, ev.DEBUG)

    def _set_trigger_mask(self, packet: bytes) -> None:
        fields = pk.SET_PERF_TRIGGER_MASK.read(packet)
        number, mask = fields["TriggerMaskNum"], fields["TriggerMask"]
        if number >= PERF_MASK_WORDS:
            text = f"Performance Trigger Mask Cmd Error,Index({number})out of range({PERF_MASK_WORDS})"
            self._replies.reject(ev.PERF_TRIGMSKERR_EID, text)
            return
        self._log.data.trigger_mask[number] = mask
        text = f"Set Performance Trigger Mask Cmd rcvd,num {number}, val 0x{mask:08X}"
        self._replies.accept(ev.PERF_TRIGMSKCMD_EID, text, ev.DEBUG)
