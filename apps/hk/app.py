"""HK's main task: start, commands, and care for its two tables (hk_app.c, hk_dispatch.c, hk_cmds.c)."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from cfepy.app import Cfe
from cfepy.es import APP_ERROR, APP_EXIT, APP_RUN
from cfepy.msg import BAD_CODE, BAD_LENGTH, BAD_MSG_ID, CommandTable, Dispatch
from cfepy.status import (
    CFE_SUCCESS,
    CFE_TBL_INFO_DUMP_PENDING,
    CFE_TBL_INFO_UPDATE_PENDING,
    CFE_TBL_INFO_VALIDATION_PENDING,
    CfeError,
)
from cfepy.tbl import OPT_DBL_BUFFER, OPT_DUMP_ONLY

from . import events as ev
from . import packets as pk
from .combiner import Combiner
from .copy_table import find_fault

VERSION = "7.0.0.0"
PERF_ID = 25
PIPE_NAME = "HK_CMD_PIPE"
PIPE_DEPTH = 40
WAKEUP_MS = 1000
POOL_BYTES = 6144


def HK_AppMain(cfe: Cfe) -> None:
    """Run the app; the startup script names this entry point."""
    run(cfe)


def run(cfe: Cfe, discard_incomplete: bool = False) -> None:
    """HK's life, to its end.

    Args:
        cfe: the app's handle.
        discard_incomplete: do not send combined packets that lack data (HK_DISCARD_INCOMPLETE_COMBO).
    """
    cfe.es.perf_log_entry(PERF_ID)
    app = HkApp(cfe, discard_incomplete)
    try:
        app.start()
    except CfeError:  # it was reported where it happened
        app.run_status = APP_ERROR
    while cfe.es.run_loop(app.run_status):
        app.wait()
    cfe.es.perf_log_exit(PERF_ID)
    cfe.es.exit_app(APP_EXIT if app.run_status == APP_RUN else app.run_status)


class HkApp:
    """HK's counters, pipe, pool and tables. The arguments are those of `run`."""

    def __init__(self, cfe: Cfe, discard_incomplete: bool) -> None:
        self._cfe = cfe
        self._discard_incomplete = discard_incomplete
        self.run_status = APP_RUN
        self._reset()
        self._commands = CommandTable(
            (pk.NOOP, self._noop),
            (pk.RESET_COUNTERS, self._reset_counters),
            (pk.SEND_HK, self._send_hk),
            (pk.SEND_COMBINED_PKT, self._send_combined),
        )

    def _reset(self) -> None:
        self._done = self._errors = self._sent = self._lacking = 0

    # --- start ---

    def start(self) -> None:
        """Prepare everything before the first message.

        Raises:
            CfeError: a service refused; an event, or the system log, reports it.
        """
        cfe = self._cfe
        try:
            cfe.evs.register()
        except CfeError as error:
            cfe.es.write_to_sys_log(f"HK: error registering for event services: {error.hex}")
            raise
        with self._reporting(ev.CR_PIPE_ERR_EID, "Error Creating SB Pipe"):
            self._pipe = cfe.sb.create_pipe(PIPE_DEPTH, PIPE_NAME)
        for event_id, what, msg_id in (
            (ev.SUB_CMB_ERR_EID, "HK Snd Cmb Pkt", pk.SEND_COMBINED_PKT_MID),
            (ev.SUB_REQ_ERR_EID, "HK Request", pk.SEND_HK_MID),
            (ev.SUB_CMD_ERR_EID, "HK Gnd Cmds", pk.CMD_MID),
        ):
            with self._reporting(event_id, f"Error Subscribing to {what}, MID=0x{msg_id:08X}", separator=", "):
                cfe.sb.subscribe(msg_id, self._pipe)
        with self._reporting(ev.CR_POOL_ERR_EID, "Error Creating Memory Pool"):
            self._pool = cfe.es.pool_create(POOL_BYTES)
        self._start_tables()
        cfe.evs.send_info(ev.INIT_INF_EID, f"HK Initialized.  Version {VERSION}")

    def _start_tables(self) -> None:
        tbl = self._cfe.tbl
        with self._reporting(ev.CPTBL_REG_ERR_EID, "Error Registering Copy Table"):
            size = pk.COPY_TABLE.size
            self._copy_table = tbl.register(pk.COPY_TABLE.own_name, size, OPT_DBL_BUFFER, self._validate)
        with self._reporting(ev.RTTBL_REG_ERR_EID, "Error Registering Runtime Table"):
            size = pk.RUNTIME_TABLE.size
            self._runtime_table = tbl.register(pk.RUNTIME_TABLE.own_name, size, OPT_DUMP_ONLY)
        with self._reporting(ev.CPTBL_LD_ERR_EID, "Error Loading Copy Table"):
            _expect_success(tbl.load(self._copy_table, pk.COPY_TABLE.file))
        with self._reporting(ev.CPTBL_MNG_ERR_EID, "Error from TBL Manage call for Copy Table"):
            _expect_success(tbl.manage(self._copy_table))
        with self._reporting(ev.RTTBL_MNG_ERR_EID, "Error from TBL Manage call for Runtime Table"):
            _expect_success(tbl.manage(self._runtime_table))
        with self._reporting(ev.CPTBL_GADR_ERR_EID, "Error Getting Adr for Cpy Tbl"):
            entries_now, _ = tbl.get_address(self._copy_table)
        with self._reporting(ev.RTTBL_GADR_ERR_EID, "Error Getting Adr for Runtime Table"):
            self._runtime, _ = tbl.get_address(self._runtime_table)
        self._combiner = Combiner(self._cfe, self._pipe, self._pool, self._discard_incomplete)
        self._combiner.use_table(entries_now)

    def _validate(self, table: memoryview) -> int:
        fault = find_fault(table)
        if fault is None:
            return 0
        self._cfe.evs.send_err(ev.NEWCPYTBL_HK_FAILED_EID, f"HK Validate: {fault}\n")
        return -1

    # --- messages ---

    def wait(self) -> None:
        """Do one message, or after a second without any, look after the tables."""
        cfe = self._cfe
        cfe.es.perf_log_exit(PERF_ID)
        try:
            packet = cfe.sb.receive_buffer(self._pipe, WAKEUP_MS)
        except CfeError as error:
            text = f"HK_APP Exiting due to CFE_SB_RcvMsg error {error.hex}"
            cfe.evs.send_err(ev.RCV_MSG_ERR_EID, text)
            cfe.es.write_to_sys_log(text)
            self.run_status = APP_ERROR
            return
        if packet is None:
            self._look_after_tables()
        else:
            cfe.es.perf_log_entry(PERF_ID)
            self._handle(packet)

    def _handle(self, packet: bytes) -> None:
        done = self._commands.dispatch(packet)
        if done.outcome == BAD_MSG_ID:  # not one of HK's own: a packet to collect from
            self._combiner.take_in(done.msg_id, packet)
        elif done.outcome == BAD_CODE:
            self._errors += 1
            text = f"Cmd Msg with Invalid command code Rcvd -- ID = 0x{done.msg_id:08X}, CC = {done.fcn_code}"
            self._cfe.evs.send_err(ev.CC_ERR_EID, text)
        elif done.outcome == BAD_LENGTH:
            self._bad_length(done)

    def _bad_length(self, done: Dispatch) -> None:
        sizes = f"Exp Len = {done.expected}, Len = {done.length}"
        if done.msg_id == pk.CMD_MID:
            self._errors += 1
            text = f"Cmd Msg with Bad length Rcvd: ID = 0x{done.msg_id:08X}, CC = {done.fcn_code}, {sizes}"
            self._cfe.evs.send_err(ev.CMD_LEN_ERR_EID, text)
        else:
            text = f"Msg with Bad length Rcvd: ID = 0x{done.msg_id:08X}, {sizes}"
            self._cfe.evs.send_err(ev.MSG_LEN_ERR_EID, text)

    def _noop(self, packet: bytes) -> None:
        self._cfe.evs.send_info(ev.NOOP_INF_EID, f"HK No-op command, Version {VERSION}")
        self._done += 1

    def _reset_counters(self, packet: bytes) -> None:
        self._reset()
        self._cfe.evs.send_info(ev.RESET_INF_EID, "HK Reset Counters command received")

    def _send_combined(self, packet: bytes) -> None:
        wanted = pk.SEND_COMBINED_PKT.read(packet)["OutMsgToSend"]
        sent, lacking = self._combiner.send(wanted)
        self._sent += sent
        self._lacking += lacking

    def _send_hk(self, packet: bytes) -> None:
        packet = pk.HK_TLM.packet(
            CmdCounter=self._done & 0xFF,
            ErrCounter=self._errors & 0xFF,
            CombinedPacketsSent=self._sent & 0xFFFF,
            MissingDataCtr=self._lacking & 0xFFFF,
            MemPoolHandle=self._pool,
        )
        self._cfe.sb.transmit_msg(packet)
        self._look_after_tables()

    # --- tables ---

    def _look_after_tables(self) -> None:
        """Perform pending ground requests for either table. If a service refuses, HK ends."""
        try:
            self._look_after_copy_table()
            self._look_after_runtime_table()
        except CfeError:  # its event is out already
            self.run_status = APP_ERROR

    def _look_after_copy_table(self) -> None:
        tbl, table = self._cfe.tbl, self._copy_table
        with self._unexpected(ev.UNEXPECTED_GETSTAT_RET_EID, "GetStatus", "Copy"):
            status = tbl.get_status(table)
        if status == CFE_TBL_INFO_VALIDATION_PENDING:
            self._validate_copy_table()
        elif status == CFE_TBL_INFO_UPDATE_PENDING:
            self._combiner.tear_down()
            with self._unexpected(ev.UNEXPECTED_RELADDR_RET_EID, "ReleaseAddress", "Copy"):
                _expect_success(tbl.release_address(table))  # else this table would be locked against its own update
            with self._unexpected(ev.UNEXPECTED_TBLUPD_RET_EID, "Update", "Copy"):
                _expect_success(tbl.update(table))
            with self._unexpected(ev.UNEXPECTED_GETADDR_RET_EID, "GetAddress", "Copy"):
                entries, _ = tbl.get_address(table)
            self._combiner.use_table(entries)

    def _validate_copy_table(self) -> None:
        """Validate a new table. If that fails, HK sends an error event and continues."""
        try:
            _expect_success(self._cfe.tbl.validate(self._copy_table))
        except CfeError as error:
            text = f"Unexpected CFE_TBL_Validate return ({error.hex}) for Copy Table"
            self._cfe.evs.send_err(ev.UNEXPECTED_TBLVLD_RET_EID, text)

    def _look_after_runtime_table(self) -> None:
        tbl, table = self._cfe.tbl, self._runtime_table
        with self._unexpected(ev.UNEXPECTED_GETSTAT2_RET_EID, "GetStatus", "Runtime"):
            status = tbl.get_status(table)
        if status == CFE_TBL_INFO_DUMP_PENDING:
            self._combiner.fill_runtime_table(self._runtime)
            with self._unexpected(ev.UNEXPECTED_DUMPTOBUFFER_RET_EID, "DumpToBuffer", "Runtime"):
                _expect_success(tbl.dump_to_buffer(table))

    @contextmanager
    def _reporting(self, event_id: int, text: str, separator: str = ",") -> Iterator[None]:
        """Send an error event if a service refuses a call inside the block."""
        try:
            yield
        except CfeError as error:
            self._cfe.evs.send_err(event_id, f"{text}{separator}RC={error.hex}")
            raise

    @contextmanager
    def _unexpected(self, event_id: int, function: str, table: str) -> Iterator[None]:
        """Send a critical event when a table call ends as it never should."""
        try:
            yield
        except CfeError as error:
            status = error.hex
            self._cfe.evs.send_crit(event_id, f"Unexpected CFE_TBL_{function} return ({status}) for {table} Table")
            raise


def _expect_success(status: int) -> None:
    """Treat a warning as HK does: as a failure."""
    if status != CFE_SUCCESS:
        raise CfeError(status)
