"""CI_LAB's main task: start, commands, housekeeping (ci_lab_app.c, ci_lab_cmds.c, ci_lab_dispatch.c)."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.config.versions import version_string
from cfepy.es import APP_ERROR
from cfepy.msg import BAD_LENGTH, BAD_MSG_ID, CommandTable
from cfepy.status import CfeError

from . import events as ev
from . import packets as pk
from .uplink import Uplink

VERSION = version_string("CI Lab App")
VERSION_NUMBERS = "7.0.0.0"
PIPE_NAME = "CI_LAB_CMD_PIPE"
PIPE_DEPTH = 32
WAKEUP_MS = 500
BASE_UDP_PORT = 1234
MAIN_TASK_PERF_ID = 32


def CI_LAB_AppMain(cfe: Cfe) -> None:
    """Run the app; the startup script names this entry point."""
    cfe.es.perf_log_entry(MAIN_TASK_PERF_ID)
    app = CommandIngest(cfe)
    try:
        app.start()
    except CfeError:  # it was reported where it happened
        cfe.es.exit_app(APP_ERROR)  # does not return
    while cfe.es.run_loop():
        cfe.es.perf_log_exit(MAIN_TASK_PERF_ID)
        app.wait()
    cfe.es.exit_app()


class CommandIngest:
    """CI_LAB's command counters and pipe. `uplink` handles datagrams from the ground."""

    def __init__(self, cfe: Cfe) -> None:
        self._cfe = cfe
        self._accepted = self._rejected = 0
        self._scheduled = False
        self._uplink = Uplink(cfe)
        self._commands = CommandTable((pk.NOOP, self._noop), (pk.RESET_COUNTERS, self._reset_counters))
        self._commands.handle(pk.SEND_HK, self._send_hk, any_length=True)
        self._commands.handle(pk.READ_UPLINK, self._read_uplink, any_length=True)

    def start(self) -> None:
        """Prepare everything before the first message.

        Failures are reported, and the app continues without the failed part.

        Raises:
            CfeError: the pipe is missing, and the app would only spin without it.
        """
        cfe = self._cfe
        try:
            cfe.evs.register()
        except CfeError as error:
            cfe.es.write_to_sys_log(f"CI_LAB: Error registering for Event Services, RC = {error.hex}")
        self._subscribe()
        port = BASE_UDP_PORT + cfe.psp.get_processor_id() - 1
        self._uplink.open(port & 0xFFFF)  # a uint16 in C
        cfe.os.task_install_delete_handler(self._uplink.close)
        cfe.evs.send_info(ev.INIT_INF_EID, f"CI Lab Initialized.{VERSION}")

    def _subscribe(self) -> None:
        cfe = self._cfe
        try:
            self._pipe = cfe.sb.create_pipe(PIPE_DEPTH, PIPE_NAME)
        except CfeError as error:
            cfe.evs.send_err(ev.CR_PIPE_ERR_EID, f"Error creating SB Command Pipe, RC = {error.hex}")
            raise
        for msg_id, event_id, what in (
            (pk.CMD_MID, ev.SB_SUBSCRIBE_CMD_ERR_EID, "Commands"),
            (pk.SEND_HK_MID, ev.SB_SUBSCRIBE_HK_ERR_EID, "HK Request"),
            (pk.READ_UPLINK_MID, ev.SB_SUBSCRIBE_UL_ERR_EID, "Read Uplink Request"),
        ):
            try:
                cfe.sb.subscribe(msg_id, self._pipe)
            except CfeError as error:
                cfe.evs.send_err(event_id, f"Error subscribing to SB {what}, RC = {error.hex}")

    def wait(self) -> None:
        """Handle one message or wait half a second. Then read the socket, unless a scheduler controls that."""
        packet = self._cfe.sb.receive_buffer(self._pipe, WAKEUP_MS)
        self._cfe.es.perf_log_entry(MAIN_TASK_PERF_ID)
        if packet is not None:
            self._handle(packet)
        if self._uplink.is_open and not self._scheduled:
            self._uplink.read()

    def _handle(self, packet: bytes) -> None:
        """Handle a message. An unknown function code is ignored, as in NASA's code."""
        done = self._commands.dispatch(packet)
        if done.outcome == BAD_LENGTH:
            self._rejected += 1
            sizes = f"Len = {done.length}, Expected = {done.expected}"
            text = f"Invalid msg length: ID = 0x{done.msg_id:X},  CC = {done.fcn_code}, {sizes}"
            self._cfe.evs.send_err(ev.CMD_LEN_ERR_EID, text)
        elif done.outcome == BAD_MSG_ID:
            self._rejected += 1
            self._cfe.evs.send_err(ev.MID_ERR_EID, f"CI: invalid command packet,MID = 0x{done.msg_id:x}")

    def _noop(self, packet: bytes) -> None:
        self._accepted += 1
        self._cfe.evs.send_info(ev.NOOP_INF_EID, f"CI: NOOP command. Version {VERSION_NUMBERS}")

    def _reset_counters(self, packet: bytes) -> None:
        self._cfe.evs.send_info(ev.RESET_INF_EID, "CI: RESET command")
        self._accepted = self._rejected = 0
        self._uplink.packets = self._uplink.errors = 0

    def _read_uplink(self, packet: bytes) -> None:
        self._scheduled = True
        self._uplink.read()

    def _send_hk(self, packet: bytes) -> None:
        packet = pk.HK_TLM.packet(
            CommandCounter=self._accepted & 0xFF,
            CommandErrorCounter=self._rejected & 0xFF,
            SocketConnected=self._uplink.is_open,
            IngestPackets=self._uplink.packets & 0xFFFFFFFF,
            IngestErrors=self._uplink.errors & 0xFFFFFFFF,
        )
        self._cfe.sb.transmit_msg(packet)
