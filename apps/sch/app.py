"""SCH's main task: start, and slot after slot of the schedule (sch_app.c)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from cfepy.app import Cfe
from cfepy.es import APP_ERROR, APP_EXIT, APP_RUN
from cfepy.msg import get_size
from cfepy.sb import POLL
from cfepy.status import CFE_SUCCESS, CfeError, OsalError

from . import events as ev
from . import packets as pk
from .commands import SchCommands
from .frames import LAST_SLOT, NOT_SYNCHRONIZED, WORST_ACCURACY_US, Frames
from .slots import due, is_due
from .state import VERSION, SchCounters, Tables

PIPE_NAME = "SCH_CMD_PIPE"
PIPE_DEPTH = 12
STARTUP_SYNC_MS = 50_000
PERF_ID = 36
LIBRARY_STATE = "SCH_GetProcessingState"


def SCH_AppMain(cfe: Cfe) -> None:
    """Run the app; the startup script names this entry point."""
    cfe.es.perf_log_entry(PERF_ID)
    app = SchSlots(cfe)
    run_status, status = APP_RUN, CFE_SUCCESS
    try:
        app.start()
    except (CfeError, OsalError) as error:  # it was reported where it happened
        run_status, status = APP_ERROR, error.status
    while cfe.es.run_loop(run_status):
        cfe.es.perf_log_exit(PERF_ID)
        try:
            app.wait()
        except (CfeError, OsalError) as error:
            run_status, status = APP_ERROR, error.status
    if status != CFE_SUCCESS:
        text = f"err = 0x{status & 0xFFFFFFFF:08X}"
        cfe.evs.send_crit(ev.APP_EXIT_EID, f"SCH App: terminating, {text}")
        cfe.es.write_to_sys_log(f"SCH App terminating, {text}")
    app.clean_up()
    cfe.es.perf_log_exit(PERF_ID)
    cfe.es.exit_app(APP_EXIT if run_status == APP_RUN else run_status)


class SchSlots:
    """The progress of the schedule: selects the next slot and sends its messages."""

    def __init__(self, cfe: Cfe) -> None:
        self._cfe = cfe
        self._counters = SchCounters()
        self._frames = Frames(cfe)
        self._tables = Tables(cfe, self._counters)
        self._commands = SchCommands(cfe, self._counters, self._frames, self._tables)
        self._behind = 0
        self._noise_reported = False
        self._goes_on: Callable[[Any], bool] | None = None

    # -- start and end ---------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Prepare everything before the first frame.

        Raises:
            CfeError, OsalError: a service refused; an event, or the system log, reports it.
        """
        cfe = self._cfe
        try:
            cfe.evs.register(ev.FILTERS)
        except CfeError as error:
            cfe.es.write_to_sys_log(f"SCH App: Error Registering For Event Services, RC={error.hex}")
            raise
        self._start_pipe()
        self._start_tables()
        self._start_timer()
        cfe.evs.send_info(ev.INITSTATS_INF_EID, f"SCH Initialized. Version {VERSION}")
        with self._reporting(ev.MAJOR_FRAME_SUB_ERR_EID, "Error initializing Timers (RC={})"):
            cfe.es.wait_for_startup_sync(STARTUP_SYNC_MS)
            self._frames.start()

    def _start_pipe(self) -> None:
        sb = self._cfe.sb
        with self._reporting(ev.CR_PIPE_ERR_EID, "Error Creating SB Pipe, RC={}"):
            self._pipe = sb.create_pipe(PIPE_DEPTH, PIPE_NAME)
        for event_id, what, msg_id in (
            (ev.SUB_HK_REQ_ERR_EID, "HK Request", pk.SEND_HK_MID),
            (ev.SUB_GND_CMD_ERR_EID, "GND CMD", pk.CMD_MID),
        ):
            with self._reporting(event_id, f"Error Subscribing to {what}(MID=0x{msg_id:04X}), RC={{}}"):
                sb.subscribe(msg_id, self._pipe)

    def _start_tables(self) -> None:
        tables = self._tables
        with self._reporting(ev.SDT_REG_ERR_EID, "Error Registering SDT, RC={}"):
            tables.register_schedule()
        with self._reporting(ev.MDT_REG_ERR_EID, "Error Registering MDT, RC={}"):
            tables.register_messages()
        text = f"Error (RC={{}}) Loading SDT with {pk.SCHEDULE_TABLE.file}"
        with self._reporting(ev.SDT_LOAD_ERR_EID, text):
            tables.load_schedule()
        with self._reporting(ev.MDT_LOAD_ERR_EID, f"Error (RC={{}}) Loading MDT with {pk.MESSAGE_TABLE.file}"):
            tables.load_messages()
        with self._reporting(ev.ACQ_PTR_ERR_EID, "Error Acquiring Tbl Ptrs (RC={})"):
            tables.acquire()

    def _start_timer(self) -> None:
        with self._reporting(ev.MINOR_FRAME_TIMER_CREATE_ERR_EID, "Error creating Timer (RC={})"):
            accuracy_us = self._frames.create_timer()
        if accuracy_us > WORST_ACCURACY_US:
            text = f"({accuracy_us} > reqd {WORST_ACCURACY_US} usec) requires Minor Frame MET sync"
            self._cfe.evs.send_info(ev.MINOR_FRAME_TIMER_ACC_WARN_EID, f"OS Timer Accuracy {text}")
        with self._reporting(ev.SEM_CREATE_ERR_EID, "Error creating Main Loop Timing Semaphore (RC={})"):
            self._frames.create_semaphore()
        try:
            self._goes_on = self._cfe.os.symbol_lookup(LIBRARY_STATE)
        except OsalError:
            pass  # the startup script does not load SCH's library, so no app can hold the schedule

    def clean_up(self) -> None:
        """Let no tone come here any more."""
        try:
            self._cfe.time.unregister_synch_callback(self._frames.on_major_frame)
        except CfeError:
            pass  # the start did not get that far

    @contextmanager
    def _reporting(self, event_id: int, text: str) -> Iterator[None]:
        """Send an error event if a service refuses a call inside the block. {} in the text stands for the status."""
        try:
            yield
        except (CfeError, OsalError) as error:
            self._cfe.evs.send_err(event_id, text.format(f"0x{error.status & 0xFFFFFFFF:08X}"))
            raise

    # -- slots -----------------------------------------------------------------------------------------------------

    def wait(self) -> None:
        """Wait for the next frame and do the work that is due.

        Raises:
            CfeError: the pipe or a table failed.
        """
        cfe, frames = self._cfe, self._frames
        cfe.os.bin_sem_take(frames.semaphore)
        cfe.es.perf_log_entry(PERF_ID)
        if frames.ignored and not self._noise_reported:
            text = f"Major Frame Sync too noisy (Slot {frames.since_tone}). Disabling synchronization."
            cfe.evs.send_err(ev.NOISY_MAJOR_FRAME_ERR_EID, text)
        self._noise_reported = frames.ignored
        if self._goes_on is None or self._goes_on(cfe):
            self._do_what_is_due(frames.current_slot())

    def _do_what_is_due(self, current: int) -> None:
        evs, counters, frames = self._cfe.evs, self._counters, self._frames
        now = due(current, frames.following, self._behind)
        self._behind = now.behind
        if now.same:
            counters.same_slot += 1
            evs.send_dbg(ev.SAME_SLOT_EID, f"Slot did not increment: slot = {current}")
        if now.skipped:
            self._skip(current, now.skipped)
        if now.todo > 1:
            counters.multiple_slots += 1
            if now.todo > frames.worst_slots or frames.sync_to_met == NOT_SYNCHRONIZED:
                text = f"slot = {frames.following}, count = {now.todo}"
                evs.send_info(ev.MULTI_SLOTS_EID, f"Multiple slots processed: {text}")
        for _ in range(now.todo):
            self._do_slot()

    def _skip(self, current: int, count: int) -> None:
        """Continue with the current slot. Commands that waited for the end of the table are not delayed by that."""
        counters, frames = self._counters, self._frames
        counters.skipped_slots += 1
        text = f"Slots skipped: slot = {frames.following}, count = {count}"
        self._cfe.evs.send_err(ev.SKIPPED_SLOTS_EID, text)
        if current < frames.following:
            counters.table_passes += 1
        if frames.following + count + 1 > LAST_SLOT:
            self._do_commands()
        frames.following = current

    def _do_slot(self) -> None:
        frames, counters = self._frames, self._counters
        for entry in range(pk.ENTRIES_PER_SLOT):
            if self._tables.is_enabled(frames.following, entry):
                self._do_entry(frames.following, entry)
        if frames.following == LAST_SLOT:
            self._do_commands()
        frames.following = (frames.following + 1) % pk.SLOTS
        if not frames.following:
            counters.table_passes += 1
        counters.slots_processed += 1

    def _do_entry(self, slot: int, number: int) -> None:
        values = self._tables.entry(slot, number)
        frequency, remainder, index = values["Frequency"], values["Remainder"], values["MessageIndex"]
        good = index < pk.MAX_MESSAGES and values["Type"] == pk.ACTIVITY_SEND_MSG and remainder < frequency
        if not good:
            self._report_corruption(slot, number, values)
        elif is_due(self._counters.table_passes, frequency, remainder):
            self._send(slot, number, index)

    def _report_corruption(self, slot: int, number: int, values: dict[str, int]) -> None:
        """The table was good when it was loaded: something wrote over it since."""
        evs = self._cfe.evs
        self._counters.bad_table_data += 1
        evs.send_err(ev.CORRUPTION_EID, f"Corrupt data error (1): slot = {slot}, entry = {number}")
        what = f"msg = {values['MessageIndex']}, freq = {values['Frequency']}"
        text = f"{what}, type = {values['Type']}, rem = {values['Remainder']}"
        evs.send_err(ev.CORRUPTION_EID, f"Corrupt data error (2): {text}")
        self._tables.set_states([(slot, number)], pk.DISABLED)

    def _send(self, slot: int, number: int, index: int) -> None:
        message = self._tables.message(index)
        try:
            self._cfe.sb.transmit_msg(bytes(message[: get_size(message)]))
            self._counters.activities_done += 1
        except CfeError as error:
            self._counters.activities_failed += 1
            text = f"Activity error: slot = {slot}, entry = {number}, err = 0x{error.status & 0xFFFFFFFF:08X}"
            self._cfe.evs.send_err(ev.PACKET_SEND_EID, text)

    def _do_commands(self) -> None:
        """Commands are done at the end of the table alone, so that none changes a second that has begun."""
        while (packet := self._cfe.sb.receive_buffer(self._pipe, POLL)) is not None:
            self._commands.handle(packet)
