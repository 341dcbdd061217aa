"""SAMPLE_APP: waits for commands on a pipe, answers with events and telemetry, and keeps a parameter table.

Every cFE app has this shape. The startup script names the entry point `SAMPLE_APP_Main`. cFE calls it in a separate
task with the handle `cfe`, which gives access to all services: `cfe.CFE_service.function`, named as in NASA's API
(CFE_SB_CreatePipe is cfe.sb.create_pipe). A call that fails raises CfeError with NASA's status.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from cfepy.app import Cfe
from cfepy.config.versions import version_string
from cfepy.es import APP_ERROR
from cfepy.msg import BAD_CODE, BAD_LENGTH, BAD_MSG_ID, CommandTable
from cfepy.sb import PEND_FOREVER
from cfepy.status import CfeError

from . import events as ev
from . import packets as pk
from .library import call_library

VERSION = "equuleus-rc1+dev54"
VERSION_TEXT = version_string("Sample App", VERSION, "Equuleus", "v1.1.0")
PERF_ID = 91


def SAMPLE_APP_Main(cfe: Cfe) -> None:
    """Start, then do one message after another until cFE wants the app to end."""
    cfe.es.perf_log_entry(PERF_ID)
    app = SampleApp(cfe)
    try:
        app.start()
    except CfeError:  # it was reported where it happened
        cfe.es.exit_app(APP_ERROR)  # does not return
    while cfe.es.run_loop():
        cfe.es.perf_log_exit(PERF_ID)
        packet = app.receive()
        cfe.es.perf_log_entry(PERF_ID)
        if packet is not None:
            app.handle(packet)
    cfe.es.perf_log_exit(PERF_ID)
    cfe.es.exit_app()


class SampleApp:
    """The app's state: an object, not module variables, so that many missions can run in one process."""

    def __init__(self, cfe: Cfe) -> None:
        self.cfe = cfe
        self.accepted = 0
        self.rejected = 0
        # Maps each command to its handler. Each command defines its own length.
        self.commands = CommandTable(
            (pk.NOOP, self.noop),
            (pk.RESET_COUNTERS, self.reset_counters),
            (pk.PROCESS, self.process),
            (pk.DISPLAY_PARAM, self.display_param),
        )
        self.commands.handle(pk.SEND_HK, self.send_hk, any_length=True)  # NASA's does not look

    def start(self) -> None:
        """Register with the services: events first, so that later failures can be reported.

        Raises:
            CfeError: a service refused; an event reports it.
        """
        cfe = self.cfe
        try:
            cfe.evs.register()
        except CfeError as error:
            cfe.es.write_to_sys_log(f"Sample App: Error Registering Events, RC = {error.long_hex}")
            raise
        with self.reporting(ev.CR_PIPE_ERR_EID, "Error creating SB Command Pipe"):
            self.pipe = cfe.sb.create_pipe(depth=32, name="SAMPLE_APP_CMD_PIPE")
        with self.reporting(ev.SUB_HK_ERR_EID, "Error Subscribing to HK request"):
            cfe.sb.subscribe(pk.SEND_HK_MID, self.pipe)
        with self.reporting(ev.SUB_CMD_ERR_EID, "Error Subscribing to Commands"):
            cfe.sb.subscribe(pk.CMD_MID, self.pipe)
        try:
            with self.reporting(ev.TABLE_REG_ERR_EID, "Error Registering Example Table"):
                self.table = cfe.tbl.register(pk.TABLE.own_name, pk.TABLE.size, validate=check_table)
            cfe.tbl.load(self.table, pk.TABLE.file)  # CFE_TBL itself reports a failure
        finally:
            cfe.evs.send_info(ev.INIT_INF_EID, f"Sample App Initialized.{VERSION_TEXT}")

    @contextmanager
    def reporting(self, event_id: int, text: str) -> Iterator[None]:
        """Send an error event if a service refuses a call inside the block."""
        try:
            yield
        except CfeError as error:
            self.cfe.evs.send_err(event_id, f"Sample App: {text}, RC = {error.long_hex}")
            raise

    def receive(self) -> bytes | None:
        """Wait for the next message. If the pipe is broken, the app ends."""
        try:
            return self.cfe.sb.receive_buffer(self.pipe, PEND_FOREVER)
        except CfeError:
            self.cfe.evs.send_err(ev.PIPE_ERR_EID, "SAMPLE APP: SB Pipe Read Error, App Will Exit")
            self.cfe.es.exit_app(APP_ERROR)  # does not return
            return None

    def handle(self, packet: bytes) -> None:
        """Pass a message to its handler, or report the reason for refusing it to the ground."""
        done = self.commands.dispatch(packet)
        if done.outcome == BAD_MSG_ID:
            text = f"SAMPLE: invalid command packet,MID = 0x{done.msg_id:x}"
            self.cfe.evs.send_err(ev.MID_ERR_EID, text)
        elif done.outcome == BAD_CODE:
            self.cfe.evs.send_err(ev.CC_ERR_EID, f"Invalid ground command code: CC = {done.fcn_code}")
        elif done.outcome == BAD_LENGTH:
            self.rejected += 1
            what = f"ID = 0x{done.msg_id:X},  CC = {done.fcn_code}, Len = {done.length}, Expected = {done.expected}"
            self.cfe.evs.send_err(ev.CMD_LEN_ERR_EID, f"Invalid Msg length: {what}")

    def send_hk(self, packet: bytes) -> None:
        """Answer the scheduler's housekeeping request: send the counters, then perform ground requests for the
        table."""
        counters = pk.HK_TLM.packet(CommandErrorCounter=self.rejected & 0xFF, CommandCounter=self.accepted & 0xFF)
        self.cfe.sb.transmit_msg(counters)
        self.cfe.tbl.manage(self.table)

    def noop(self, packet: bytes) -> None:
        """Answer the ground's NOOP command, which checks that the app is alive."""
        self.accepted += 1
        self.cfe.evs.send_info(ev.NOOP_INF_EID, f"SAMPLE: NOOP command {VERSION}")

    def reset_counters(self, packet: bytes) -> None:
        """Start counting anew."""
        self.accepted = self.rejected = 0
        self.cfe.evs.send_info(ev.RESET_INF_EID, "SAMPLE: RESET command")

    def process(self, packet: bytes) -> None:
        """Use the table: get its address, read, release it soon, so that it can be updated."""
        self.accepted += 1
        cfe = self.cfe
        image, _ = cfe.tbl.get_address(self.table)
        values = pk.EXAMPLE_TABLE.unpack(image)
        cfe.es.write_to_sys_log(f"Sample App: Example Table Value 1: {values['Int1']}  Value 2: {values['Int2']}")
        cfe.es.write_to_sys_log(f"Sample App: CRC: 0x{cfe.tbl.get_info(pk.TABLE.name).crc:08X}\n\n")
        cfe.tbl.release_address(self.table)
        call_library(cfe)

    def display_param(self, packet: bytes) -> None:
        """A command with a payload: read its fields."""
        self.accepted += 1
        given = pk.DISPLAY_PARAM.read(packet)
        text = f"SAMPLE_APP: ValU32={given['ValU32']}, ValI16={given['ValI16']}, ValStr={given['ValStr']}"
        self.cfe.evs.send_info(ev.VALUE_INF_EID, text)


def check_table(image: memoryview) -> int:
    """Return whether a table image is good: 0, or a negative number. cFE asks before the image is ever used."""
    return 0 if pk.find_fault(image) is None else pk.TABLE_OUT_OF_RANGE
