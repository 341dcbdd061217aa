"""The CFE_TBL task: its pipe, dispatch, housekeeping, and the commands that change no table.

Stands for cfe_tbl_task.c and part of cfe_tbl_task_cmds.c; the rest is in `cfepy.tbl.commands`. Imports only
cfepy.config, cfepy.msg, cfepy.ports, cfepy.status, cfepy.versions and its neighbours here.
"""

from __future__ import annotations

from cfepy.config import PlatformConfig
from cfepy.core_app import serve
from cfepy.msg import CommandTable
from cfepy.msg.dispatch import BAD_CODE, BAD_LENGTH, BAD_MSG_ID, Dispatch
from cfepy.ports import Ports
from cfepy.status import CfeError
from cfepy.tbl import events as ev
from cfepy.tbl import packets as pk
from cfepy.tbl.buffers import BufferMemory
from cfepy.tbl.commands import APP_NAME, TableCommands
from cfepy.tbl.critical import CriticalTables
from cfepy.tbl.dumps import Dumps
from cfepy.tbl.housekeeping import Housekeeping
from cfepy.tbl.loads import Loads
from cfepy.tbl.registry import Registry, Table
from cfepy.tbl.registry_dump import RegistryDump
from cfepy.tbl.table_file import Files
from cfepy.versions import version_string

PIPE_NAME = "TBL_CMD_PIPE"
PIPE_DEPTH = 12
MAIN_PERF_ID = 3


class TableTask:
    """The core application CFE_TBL."""

    def __init__(
        self,
        ports: Ports,
        config: PlatformConfig,
        files: Files,
        registry: Registry,
        loads: Loads,
        dumps: Dumps,
        memory: BufferMemory,
        critical: CriticalTables,
    ) -> None:
        self._ports = ports
        self._config = config
        self._registry = registry
        self._dumps = dumps
        self._housekeeping = Housekeeping(registry, memory, dumps)
        self._registry_dump = RegistryDump(ports, registry, self._housekeeping, files)
        commands = TableCommands(ports, config, registry, loads, dumps, critical, self._housekeeping)
        self._commands = CommandTable(
            (pk.SEND_HK, self._send_hk),
            (pk.NOOP, self._noop),
            (pk.RESET_COUNTERS, self._reset_counters),
            (pk.LOAD, commands.load),
            (pk.DUMP, commands.dump),
            (pk.VALIDATE, commands.validate),
            (pk.ACTIVATE, commands.activate),
            (pk.DUMP_REGISTRY, self._dump_registry),
            (pk.SEND_REGISTRY, commands.send_registry),
            (pk.DELETE_CDS, commands.delete_cds),
            (pk.ABORT_LOAD, commands.abort_load),
        )

    def main(self) -> None:
        """The task's main function (CFE_TBL_TaskMain)."""
        ports = self._ports
        ports.es.perf_log_entry(MAIN_PERF_ID)
        self._registry.services_app_id = ports.es.get_app_id()
        ports.evs.register()
        pipe = ports.sb.create_pipe(PIPE_DEPTH, PIPE_NAME)
        ports.sb.subscribe(pk.SEND_HK_MID, pipe)
        ports.sb.subscribe(pk.CMD_MID, pipe)
        text = f"cFE TBL Initialized: {version_string(APP_NAME)}"
        ports.evs.send_event(ev.INIT_INF_EID, ev.INFORMATION, text)
        serve(ports, self._config, pipe, MAIN_PERF_ID, self.handle)

    def handle(self, packet: bytes) -> None:
        """Do what one packet from the command pipe asks for (CFE_TBL_TaskPipe).

        A handler returns True or False for the command or the error counter, None to count nothing.
        """
        done = self._commands.dispatch(packet)
        if isinstance(done.result, bool):
            self._housekeeping.count_command(done.result)
        if done.outcome == BAD_CODE:
            self._housekeeping.count_command(False)
        self._report(done)

    def _report(self, done: Dispatch) -> None:
        if done.outcome == BAD_LENGTH:
            sizes = f"Len = {done.length}, Expected = {done.expected}"
            text = f"Invalid msg length -- ID = 0x{done.msg_id:X}, CC = {done.fcn_code}, {sizes}"
            self._error(ev.LEN_ERR_EID, text)
        elif done.outcome == BAD_CODE:
            text = f"Invalid command code -- ID = 0x{done.msg_id:X}, CC = {done.fcn_code}"
            self._error(ev.CC1_ERR_EID, text)
        elif done.outcome == BAD_MSG_ID:
            self._error(ev.MID_ERR_EID, f"Invalid message ID -- ID = 0x{done.msg_id:X}")

    def note_update(self, table: Table) -> None:
        """Remember for housekeeping which table changed last."""
        self._housekeeping.last_updated = table

    def _send_hk(self, packet: bytes) -> None:
        try:
            self._ports.sb.transmit_msg(pk.HK_TLM.packet(self._housekeeping.collect()))
        except CfeError as error:
            self._error(ev.FAIL_HK_SEND_ERR_EID, f"Unable to send Hk Packet (Status={error.hex})")
        wanted = self._housekeeping.take_registry_request()
        if wanted is not None:
            owner = self._ports.es.get_app_name(wanted.owner) if wanted.owner else ""
            self._ports.sb.transmit_msg(pk.REG_TLM.packet(self._housekeeping.registry_packet(wanted, owner)))
        self._dumps.write_files(self._registry.services_app_id, APP_NAME)

    def _noop(self, packet: bytes) -> bool:
        text = f"No-op Cmd Rcvd: {version_string(APP_NAME)}"
        self._ports.evs.send_event(ev.NOOP_INF_EID, ev.INFORMATION, text)
        return True

    def _reset_counters(self, packet: bytes) -> None:
        self._housekeeping.reset_counters()
        self._ports.evs.send_event(ev.RESET_INF_EID, ev.DEBUG, "Reset Counters command")

    def _dump_registry(self, packet: bytes) -> bool:
        return self._registry_dump.request(pk.DUMP_REGISTRY.read(packet)["DumpFilename"])

    def _error(self, event_id: int, text: str) -> None:
        self._ports.evs.send_event(event_id, ev.ERROR, text)
