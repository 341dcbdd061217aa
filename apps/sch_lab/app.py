"""SCH_LAB's main task: a timer ticks, and at every tick SCH_LAB sends the commands that are due (sch_lab_app.c).

The first 1 Hz packet of TIME starts it, so that it keeps step with the spacecraft's seconds from then on.
"""

from __future__ import annotations

from contextlib import suppress

from cfepy.app import Cfe
from cfepy.config.versions import version_string
from cfepy.es import APP_ERROR
from cfepy.msg import local_cmd_topic_id_to_msg_id
from cfepy.sb import POLL
from cfepy.status import CFE_STATUS_EXTERNAL_RESOURCE_FAIL, CFE_SUCCESS, CfeError, OsalError

from . import schedule

VERSION = version_string("SCH Lab", "equuleus-rc1+dev29", "Equuleus", "v2.3.0")
TIME_ONEHZ_MID = local_cmd_topic_id_to_msg_id(0x11)
PIPE_NAME = "SCH_LAB_CMD_PIPE"
PIPE_DEPTH = 8
NO_PIPE = 0
OBJECT_NAME = "SCH_LAB"
TIMEBASE = "cFS-Master"
SECOND_US = 1_000_000
PERF_ID = 36


def SCH_LAB_AppMain(cfe: Cfe) -> None:
    """Run the app; the startup script names this entry point."""
    cfe.es.perf_log_entry(PERF_ID)
    app = SchLab(cfe)
    try:
        app.start()
    except CfeError as error:
        cfe.es.write_to_sys_log(f"SCH_LAB: Error Initializing RC = {error.long_hex}")
        cfe.es.exit_app(APP_ERROR)  # does not return
    while cfe.es.run_loop():
        cfe.es.perf_log_exit(PERF_ID)
        app.wait()
    cfe.es.exit_app()


class SchLab:
    """The ticking and the entries of the table."""

    def __init__(self, cfe: Cfe) -> None:
        self._cfe = cfe
        self._started = False
        self._pipe = NO_PIPE

    def start(self) -> None:
        """Prepare everything before the first tick.

        Raises:
            CfeError: no table, or an OSAL object could not be made; the system log names it.
        """
        cfe = self._cfe
        timer = self._make_timer()
        self._load_table()
        self._listen()
        try:
            cfe.os.timer_set(timer, SECOND_US, self._period_us)
        except OsalError as error:
            cfe.es.write_to_sys_log(f"SCH_LAB_AppInit: OS_TimerSet failed:RC={error.status}")
        cfe.os.printf(f"SCH Lab Initialized.{VERSION}\n")

    def _make_timer(self) -> int:
        cfe, call = self._cfe, ""
        try:
            call = "OS_CountSemCreate"
            self._ticks = cfe.os.count_sem_create(OBJECT_NAME, 0)
            call = "OS_TimeBaseGetIdByName"
            timebase = cfe.os.time_base_get_id_by_name(TIMEBASE)
            call = "OS_TimerAdd"
            return cfe.os.timer_add(OBJECT_NAME, timebase, self._tick)
        except OsalError as error:
            cfe.es.write_to_sys_log(f"SCH_LAB_AppInit: {call} failed:RC={error.status}")
            raise CfeError(CFE_STATUS_EXTERNAL_RESOURCE_FAIL, f"{call} failed") from None

    def _tick(self, timer_id: int, argument: object) -> None:
        self._cfe.os.count_sem_give(self._ticks)

    def _load_table(self) -> None:
        cfe, step = self._cfe, ""
        try:
            step = "Registering"
            handle = cfe.tbl.register(schedule.SCHEDULE_TABLE.own_name, schedule.SCHEDULE_TABLE.size)
            step = "Loading Table"
            status = cfe.tbl.load(handle, schedule.SCHEDULE_TABLE.file)
            if status != CFE_SUCCESS:
                raise CfeError(status)
            step = "Getting Table's Address"
            table, _ = cfe.tbl.get_address(handle)
        except CfeError as error:
            cfe.es.write_to_sys_log(f"SCH_LAB: Error {step} {schedule.SCHEDULE_TABLE.own_name}, RC = {error.long_hex}")
            raise
        tick_rate, self._entries = schedule.read(table)
        cfe.tbl.release_address(handle)
        self._period_us = self._tick_period(tick_rate)

    def _listen(self) -> None:
        """Without its pipe or the subscription it ticks on, and sends nothing."""
        cfe = self._cfe
        try:
            self._pipe = cfe.sb.create_pipe(PIPE_DEPTH, PIPE_NAME)
        except CfeError:
            cfe.os.printf("SCH Error creating pipe!\n")
        try:
            cfe.sb.subscribe(TIME_ONEHZ_MID, self._pipe)
        except CfeError:
            cfe.os.printf("SCH Error subscribing to 1hz!\n")

    def _tick_period(self, tick_rate: int) -> int:
        """Return microseconds of a tick, from ticks a second."""
        log = self._cfe.es.write_to_sys_log
        if tick_rate == 0:
            log("SCH_LAB_AppInit: Using default tick rate of 1 second")
            return SECOND_US
        if SECOND_US % tick_rate:
            text = f"tick rate of {tick_rate} is not an integer number of microseconds"
            log(f"SCH_LAB_AppInit: WARNING: {text}")
        return max(1, SECOND_US // tick_rate)

    def wait(self) -> None:
        """Wait for one tick, then send the commands that are due.

        Failed sends are reported only by the services' events.
        """
        cfe = self._cfe
        has_ticked = False
        with suppress(CfeError):
            cfe.os.count_sem_take(self._ticks)
            has_ticked = True
            if cfe.sb.receive_buffer(self._pipe, POLL) is not None:
                self._started = True
        cfe.es.perf_log_entry(PERF_ID)
        if has_ticked and self._started:
            for entry in self._entries:
                if entry.tick():
                    with suppress(CfeError):
                        cfe.sb.transmit_msg(entry.packet)
