"""TO_LAB's main task: start and the loop (to_lab_app.c)."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from cfepy.app import Cfe
from cfepy.config.versions import version_string
from cfepy.es import APP_ERROR, APP_RUN
from cfepy.sb import POLL
from cfepy.status import CFE_SUCCESS, CfeError

from . import events as ev
from . import packets as pk
from .commands import ToLabCommands, qos_of
from .downlink import Downlink

VERSION = version_string("TO Lab", "equuleus-rc1+dev62", "Equuleus", "v2.3.0")
TASK_MS = 500
COMMAND_PIPE, COMMAND_PIPE_DEPTH = "TO_LAB_CMD_PIPE", 8
TELEMETRY_PIPE, TELEMETRY_PIPE_DEPTH = "TO_LAB_TLM_PIPE", 50
MAIN_TASK_PERF_ID = 34


def TO_LAB_AppMain(cfe: Cfe) -> None:
    """Run the app; the startup script names this entry point."""
    cfe.es.perf_log_entry(MAIN_TASK_PERF_ID)
    app = TelemetryOutput(cfe)
    run_status = app.start()
    while cfe.es.run_loop(run_status):
        cfe.es.perf_log_exit(MAIN_TASK_PERF_ID)
        cfe.os.task_delay(TASK_MS)
        cfe.es.perf_log_entry(MAIN_TASK_PERF_ID)
        app.work()
    cfe.es.exit_app(run_status)


class TelemetryOutput:
    """TO_LAB's table and pipes."""

    def __init__(self, cfe: Cfe) -> None:
        self._cfe = cfe
        self._downlink = Downlink(cfe)

    def start(self) -> int:
        """Prepare everything before the first packet. Returns the run status to continue with."""
        cfe = self._cfe
        try:
            self._register()
            self._start_table()
            self._start_pipes()
            refused = self._subscribe()
            text = f"TO Lab Initialized.{VERSION}, Awaiting enable command."
            cfe.evs.send_info(ev.INIT_INF_EID, text)
        except CfeError:  # it was reported where it happened
            refused = True
        cfe.os.task_install_delete_handler(self._downlink.close)
        return APP_ERROR if refused else APP_RUN

    def work(self) -> None:
        """Run one round: forward the packets that wait for the ground, then handle the commands."""
        self._downlink.forward(self._telemetry)
        while (packet := self._cfe.sb.receive_buffer(self._commands_pipe, POLL)) is not None:
            self._commands.handle(packet)

    def _register(self) -> None:
        try:
            self._cfe.evs.register()
        except CfeError as error:
            self._cfe.es.write_to_sys_log(f"TO_LAB: Error registering for Event Services, RC = {error.hex}")
            raise

    def _start_table(self) -> None:
        tbl = self._cfe.tbl
        with self._reporting(ev.TBL_ERR_EID, ev.REGISTER_LINE, "register table"):
            table = tbl.register(pk.SUBSCRIPTIONS.own_name, pk.SUBSCRIPTIONS.size)
        with self._reporting(ev.TBL_ERR_EID, ev.LOAD_LINE, "load table"):
            status = tbl.load(table, pk.SUBSCRIPTIONS.file)
            if status != CFE_SUCCESS:
                raise CfeError(status)
        with self._reporting(ev.TBL_ERR_EID, ev.ADDRESS_LINE, "get table addr"):
            self._table, _ = tbl.get_address(table)  # kept as long as the app lives

    def _start_pipes(self) -> None:
        sb = self._cfe.sb
        with self._reporting(ev.CR_PIPE_ERR_EID, ev.COMMAND_PIPE_LINE, "create cmd pipe"):
            self._commands_pipe = sb.create_pipe(COMMAND_PIPE_DEPTH, COMMAND_PIPE)
        sb.subscribe(pk.CMD_MID, self._commands_pipe)
        sb.subscribe(pk.SEND_HK_MID, self._commands_pipe)
        with self._reporting(ev.TLMPIPE_ERR_EID, ev.TELEMETRY_PIPE_LINE, "create Tlm pipe"):
            self._telemetry = sb.create_pipe(TELEMETRY_PIPE_DEPTH, TELEMETRY_PIPE)
        self._commands = ToLabCommands(self._cfe, self._downlink, self._telemetry, self._table, VERSION)

    def _subscribe(self) -> bool:
        """Subscribe to the packets of the table, up to the first empty row.

        Returns whether the last subscription was refused.
        """
        refused = False
        for row in pk.SUBSCRIPTIONS.unpack(self._table):
            stream = row["Stream"]
            if not self._cfe.sb.is_valid_msg_id(stream):
                break
            refused = False
            try:
                self._cfe.sb.subscribe_ex(stream, self._telemetry, qos_of(row), row["BufLimit"])
            except CfeError as error:
                refused = True
                text = f"L{ev.SUBSCRIBE_LINE} TO Can't subscribe to stream 0x{stream:x} status {error.status}"
                self._cfe.evs.send_err(ev.SUBSCRIBE_ERR_EID, text)
        return refused

    @contextmanager
    def _reporting(self, event_id: int, line: int, what: str) -> Iterator[None]:
        try:
            yield
        except CfeError as error:
            self._cfe.evs.send_err(event_id, f"L{line} TO Can't {what} status {error.status}")
            raise
