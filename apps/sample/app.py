"""SAMPLE_APP: waits for commands on a pipe, answers with events and telemetry, and keeps a parameter table.

Every cFE app has this shape. The startup script names the entry point `SAMPLE_APP_Main`; cFE calls it in a task of its
own with the handle `cfe`, through which the app reaches everything: `cfe.CFE_service.function`, named as in NASA's API
(CFE_SB_CreatePipe is cfe.sb.create_pipe). A call that fails raises CfeError with NASA's status.
"""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.es import APP_ERROR
from cfepy.msg import CMD_HEADER_SIZE, CommandTable, get_user_data, telemetry
from cfepy.msg.dispatch import BAD_CODE, BAD_LENGTH, BAD_MSG_ID
from cfepy.sb import PEND_FOREVER
from cfepy.status import CfeError

from . import events, messages

VERSION = "v1.0.0"


def SAMPLE_APP_Main(cfe: Cfe) -> None:
    """Start, then do one message after another until cFE wants the app to end."""
    app = SampleApp(cfe)
    try:
        app.start()
    except CfeError as error:
        cfe.es.write_to_sys_log(f"SAMPLE_APP: cannot start: {error}")
        cfe.es.exit_app(APP_ERROR)  # does not return
    while cfe.es.run_loop():
        packet = cfe.sb.receive_buffer(app.pipe, PEND_FOREVER)
        if packet is not None:
            app.handle(packet)
    cfe.es.exit_app()


class SampleApp:
    """The app's state: an object, not module variables, so that many missions can run in one process."""

    def __init__(self, cfe: Cfe) -> None:
        self.cfe = cfe
        self.accepted = 0
        self.rejected = 0
        # Which function handles which command, and how long that command must be.
        self.commands = CommandTable()
        self.commands.add_message(messages.SEND_HK_MID, CMD_HEADER_SIZE, self.send_hk)
        for fcn_code, size, handler in (
            (messages.NOOP_CC, 0, self.noop),
            (messages.RESET_COUNTERS_CC, 0, self.reset_counters),
            (messages.PROCESS_CC, 0, self.process),
            (messages.DISPLAY_PARAM_CC, messages.DISPLAY_PARAM.size, self.display_param),
        ):
            self.commands.add(messages.CMD_MID, fcn_code, CMD_HEADER_SIZE + size, handler)

    def start(self) -> None:
        """Register with the services: events first, so that anything after can be reported."""
        cfe = self.cfe
        cfe.evs.register()
        self.pipe = cfe.sb.create_pipe(depth=32, name="SAMPLE_APP_CMD_PIPE")
        cfe.sb.subscribe(messages.SEND_HK_MID, self.pipe)
        cfe.sb.subscribe(messages.CMD_MID, self.pipe)
        self.table = cfe.tbl.register("ExampleTable", messages.EXAMPLE_TABLE.size, validate=check_table)
        cfe.tbl.load(self.table, "/cf/sample_app_tbl.tbl")
        cfe.evs.send_info(events.INIT_INF_EID, f"Sample App Initialized.Sample App {VERSION}")

    def handle(self, packet: bytes) -> None:
        """Give a message to its handler, or tell the ground why not."""
        done = self.commands.dispatch(packet)
        if done.outcome == BAD_MSG_ID:
            text = f"SAMPLE: invalid command packet,MID = 0x{done.msg_id:x}"
            self.cfe.evs.send_err(events.MID_ERR_EID, text)
        elif done.outcome == BAD_CODE:
            self.rejected += 1
            self.cfe.evs.send_err(events.CC_ERR_EID, f"Invalid ground command code: CC = {done.fcn_code}")
        elif done.outcome == BAD_LENGTH:
            self.rejected += 1
            what = f"ID = 0x{done.msg_id:X},  CC = {done.fcn_code}, Len = {done.length}, Expected = {done.expected}"
            self.cfe.evs.send_err(events.CMD_LEN_ERR_EID, f"Invalid Msg length: {what}")

    def send_hk(self, packet: bytes) -> None:
        """The scheduler asks for housekeeping: send the counters, then do what the ground wants with the table."""
        payload = messages.HOUSEKEEPING.pack(
            CommandErrorCounter=self.rejected & 0xFF, CommandCounter=self.accepted & 0xFF
        )
        self.cfe.sb.transmit_msg(telemetry(messages.HK_TLM_MID, payload))
        self.cfe.tbl.manage(self.table)

    def noop(self, packet: bytes) -> None:
        """The ground asks whether the app is alive."""
        self.accepted += 1
        self.cfe.evs.send_info(events.NOOP_INF_EID, f"SAMPLE: NOOP command {VERSION}")

    def reset_counters(self, packet: bytes) -> None:
        """Start counting anew."""
        self.accepted = self.rejected = 0
        self.cfe.evs.send_info(events.RESET_INF_EID, "SAMPLE: RESET command")

    def process(self, packet: bytes) -> None:
        """Use the table: get its address, read, release it soon, so that it can be updated."""
        self.accepted += 1
        image, _ = self.cfe.tbl.get_address(self.table)
        values = messages.EXAMPLE_TABLE.unpack(image)
        self.cfe.tbl.release_address(self.table)
        text = f"Example Table Value 1: {values['Int1']}  Value 2: {values['Int2']}"
        self.cfe.es.write_to_sys_log(f"Sample App: {text}")

    def display_param(self, packet: bytes) -> None:
        """A command with a payload: unpack it with its layout."""
        self.accepted += 1
        given = messages.DISPLAY_PARAM.unpack(get_user_data(packet))
        text = f"SAMPLE_APP: ValU32={given['ValU32']}, ValI16={given['ValI16']}, ValStr={given['ValStr']}"
        self.cfe.evs.send_info(events.VALUE_INF_EID, text)


def check_table(image: memoryview) -> int:
    """Whether a table image is good: 0, or a negative number. cFE asks before the image is ever used."""
    values = messages.EXAMPLE_TABLE.unpack(image)
    return 0 if values["Int1"] <= messages.INT1_MAX else messages.TABLE_OUT_OF_RANGE
