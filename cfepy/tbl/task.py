"""The CFE_TBL task: its pipe, dispatch, housekeeping, and the ground's commands on tables.

It replaces cfe_tbl_task.c and cfe_tbl_task_cmds.c: load, validate, activate, dump, and a file about the registry of all
tables. The background task of ES writes that file record by record. Release 7.0.0 refuses to LOAD any table. Release
7.0.1 keeps a failed load in progress until the ground aborts it.

`Housekeeping` counts, keeps the last validation, load, update and dump, and builds values for packets
(CFE_TBL_GetHkData, CFE_TBL_GetTblRegData). It sends no packets.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from cfepy.config.platform import PlatformConfig
from cfepy.core_app import serve
from cfepy.fs import SUBTYPE_TBL_REG, FileWriteEvent, FileWriteMetaData, calculate_crc, dump_file_name
from cfepy.ids import UNDEFINED
from cfepy.msg import BAD_CODE, BAD_LENGTH, BAD_MSG_ID, CommandTable, Dispatch, command, set_size, sys_time_fields
from cfepy.ports import Ports
from cfepy.status import (
    CFE_ES_CDS_OWNER_ACTIVE_ERR,
    CFE_ES_CDS_WRONG_TYPE_ERR,
    CFE_ES_ERR_NAME_NOT_FOUND,
    CFE_TBL_ERR_INVALID_NAME,
    CfeError,
    OsalError,
)
from cfepy.tbl import events as ev
from cfepy.tbl import packets as pk
from cfepy.tbl.buffers import Buffer, BufferMemory
from cfepy.tbl.critical import CriticalTables
from cfepy.tbl.dumps import DumpRefused, Dumps, select_buffer
from cfepy.tbl.loads import SRC_FILE, Loads
from cfepy.tbl.packets import REGISTRY_RECORD
from cfepy.tbl.registry import TableRecord, TableRegistry
from cfepy.tbl.reports import UNKNOWN, Reports
from cfepy.tbl.table_file import LoadFile, Refused, TableStorage
from cfepy.tbl.validations import Validation, Validations

_BYTE = 0xFF
_HALF = 0xFFFF
APP_NAME = "CFE_TBL"
_SIZE_NOT_SET = 7
"""Bytes of a packet whose length field is 0."""
_NOT_DELETED = {
    CFE_ES_CDS_WRONG_TYPE_ERR: (
        ev.NOT_CRITICAL_TBL_ERR_EID,
        "Table '{}' is in Critical Table Registry but CDS is not tagged as a table",
    ),
    CFE_ES_CDS_OWNER_ACTIVE_ERR: (ev.CDS_OWNER_ACTIVE_ERR_EID, "CDS '{}' owning app is still active"),
    CFE_ES_ERR_NAME_NOT_FOUND: (ev.CDS_NOT_FOUND_ERR_EID, "Unable to locate '{}' in CDS Registry"),
}
"""Event id and text of DELETE_CDS by the status of the CDS."""

REGISTRY_FILE = "/ram/cfe_tbl_reg.log"
REGISTRY_DESCRIPTION = "Table Registry"
_DUMP_FAILURES = {
    FileWriteEvent.CREATE_ERROR: (ev.CREATING_DUMP_FILE_ERR_EID, "Error creating dump file '{}'"),
    FileWriteEvent.HEADER_WRITE_ERROR: (ev.WRITE_CFE_HDR_ERR_EID, "Error writing cFE File Header to '{}'"),
    FileWriteEvent.RECORD_WRITE_ERROR: (ev.WRITE_TBL_REG_ERR_EID, "Error writing Registry to '{}'"),
}
PIPE_NAME = "TBL_CMD_PIPE"
PIPE_DEPTH = 12
MAIN_PERF_ID = 3


class Housekeeping:
    """Counters and last values for housekeeping.

    Attributes:
        last_updated: the table that changed last.
        last_file_loaded: the file of the ground's last load.
        last_table_loaded: the table of that load.
    """

    def __init__(self, registry: TableRegistry, memory: BufferMemory, dumps: Dumps, validations: Validations) -> None:
        self._registry = registry
        self._memory = memory
        self._dumps = dumps
        self._validations = validations
        self._updated: dict[str, Any] = {}
        self._registry_fields: dict[str, Any] = {}
        self._last_validation = Validation("", 0, of_active=False)
        self._registry_request: TableRecord | None = None
        self.last_updated: TableRecord | None = None
        self.last_file_loaded = ""
        self.last_table_loaded = ""
        self.reset_counters()

    def reset_counters(self) -> None:
        """Set the counters to 0 for the RESET_COUNTERS command."""
        self._commands = self._errors = 0
        self._validated = self._successes = self._failures = self._requests = 0

    def count_command(self, accepted: bool) -> None:
        """Count an accepted or refused command."""
        self._commands += accepted
        self._errors += not accepted

    def count_request(self) -> None:
        """Count a validation request to an app."""
        self._requests += 1

    def request_registry(self, table: TableRecord) -> None:
        """Send a table's registry entry with the next housekeeping packet."""
        self._registry_request = table

    def take_registry_request(self) -> TableRecord | None:
        """Return the table whose entry was requested, even if it no longer exists, and clear the request."""
        table, self._registry_request = self._registry_request, None
        return table

    def _count_a_validation(self) -> None:
        """Take over one finished validation; the next one waits for the next packet, so that none is missed."""
        done = self._validations.tell()
        if done is None:
            return
        self._last_validation = done
        self._validated += 1
        self._successes += done.result == 0
        self._failures += done.result != 0

    def collect(self) -> dict[str, Any]:
        """Return the fields of packets.HOUSEKEEPING."""
        self._count_a_validation()
        last, table = self._last_validation, self.last_updated
        if table is not None and table.reg_id in self._registry.tables:
            self._updated = {"LastUpdateTime": sys_time_fields(table.last_update), "LastUpdatedTable": table.name}
        values: dict[str, Any] = {
            "CommandCounter": self._commands & _BYTE,
            "CommandErrorCounter": self._errors & _BYTE,
            "NumTables": len(self._registry.tables),
            "NumLoadPending": sum(table.is_loading for table in self._registry.tables),
            "ValidationCounter": self._validated & _HALF,
            "LastValCrc": last.crc,
            "LastValStatus": last.result,
            "ActiveBuffer": last.of_active,
            "LastValTableName": last.table_name,
            "SuccessValCounter": self._successes & _BYTE,
            "FailedValCounter": self._failures & _BYTE,
            "NumValRequests": self._requests & _BYTE,
            "NumFreeSharedBufs": self._memory.free_shared,
            "MemPoolHandle": self._memory.pool_id,
            "LastFileLoaded": self.last_file_loaded,
            "LastFileDumped": self._dumps.last_file,
            "LastTableLoaded": self.last_table_loaded,
        }
        return values | self._updated

    def registry_packet(self, table: TableRecord, owner_name: str) -> dict[str, Any]:
        """Return the fields of packets.REGISTRY_PACKET for one table.

        As in cFE, an unknown field keeps its value from the last packet: all fields for a removed table, CRC and file
        time for a table that was never loaded.
        """
        if table.reg_id not in self._registry.tables:
            return self._registry_fields
        active, inactive = self._registry.active(table), self._registry.inactive(table)
        self._registry_fields = {
            **self._registry_fields,
            **self._common(table, owner_name),
            **({} if active is None else _image(active)),
            "ActiveBufferAddr": active.address if active else 0,
            "InactiveBufferAddr": inactive.address if inactive else 0,
            "ValidationFuncPtr": int(table.validator is not None),
            "Critical": table.critical,
        }
        return self._registry_fields

    def registry_record(self, table: TableRecord, owner_name: str) -> dict[str, Any]:
        """Return the fields of packets.REGISTRY_RECORD for one table."""
        active = self._registry.active(table)
        return {
            **self._common(table, owner_name),
            **(_image(active) if active else {"Crc": 0, "FileTime": sys_time_fields((0, 0))}),
            "NumUsers": len(table.accesses),
            "LoadInProgress": self._registry.place(table),
            "ValidationFunc": table.validator is not None,
            "CriticalTable": table.critical,
        }

    def _common(self, table: TableRecord, owner_name: str) -> dict[str, Any]:
        return {
            "Size": table.size,
            "TimeOfLastUpdate": sys_time_fields(table.last_update),
            "TableLoadedOnce": table.is_loaded,
            "LoadPending": self._registry.is_update_pending(table),
            "DumpOnly": table.dump_only,
            "DoubleBuffered": table.double_buffered,
            "Name": table.name,
            "LastFileLoaded": table.last_file,
            "OwnerAppName": owner_name,
        }


def _image(active: Buffer) -> dict[str, Any]:
    return {"Crc": active.crc, "FileTime": sys_time_fields(active.file_time)}


class Parts(NamedTuple):
    """The parts that the task works with."""

    registry: TableRegistry
    loads: Loads
    dumps: Dumps
    memory: BufferMemory
    critical: CriticalTables
    validations: Validations
    reports: Reports


class TableCommands:
    """The commands about single tables; each handler returns whether the command was carried out."""

    def __init__(self, ports: Ports, config: PlatformConfig, parts: Parts, housekeeping: Housekeeping) -> None:
        self._ports = ports
        self._config = config
        self._registry, self._loads, self._dumps, _, self._critical, self._validations, self._reports = parts
        self._housekeeping = housekeeping

    def load(self, packet: bytes) -> bool:
        """Read a table file into the inactive image of its table (CFE_TBL_LoadCmd)."""
        file = LoadFile(pk.LOAD.read_name(packet, "LoadFilename"), self._config, stays_open=True)
        table = None
        try:
            self._loads.open(file)
            table = self._registry.find(file.table.table_name)
            if table is None:
                text = "Unable to locate in Table Registry"
                raise Refused(CFE_TBL_ERR_INVALID_NAME, ev.NO_SUCH_TABLE_ERR_EID, text, names_file=False)
            if self._config.release.load_reserves_buffer:  # otherwise no buffer is found to load into
                self._loads.reserve(table, SRC_FILE)
            self._loads.fill_from_file(table, file)
        except Refused as refused:
            self._reports.file_refused(refused, APP_NAME, file, table)
            return False
        self._housekeeping.last_file_loaded, self._housekeeping.last_table_loaded = file.path, table.name
        self._reports.loaded(file, APP_NAME, table)
        return True

    def dump(self, packet: bytes) -> bool:
        """Start to write an image of a table to a file (CFE_TBL_DumpCmd)."""
        values = pk.DUMP.read(packet)
        path = pk.DUMP.read_name(packet, "DumpFilename")
        table = self._table(pk.DUMP.read_name(packet, "TableName"))
        if table is None:
            return False
        try:
            self._dumps.request(table, values["ActiveTableFlag"], path)
        except DumpRefused as refused:
            self._reports.dump_refused(refused, table, values["ActiveTableFlag"], path)
            if refused.event_id == UNDEFINED:  # the snapshot could not be taken, but its owner is notified anyway
                self._notify(table)
            return False
        self._notify(table)
        return True

    def validate(self, packet: bytes) -> bool:
        """Request the validation of an image of a table (CFE_TBL_ValidateCmd)."""
        values = pk.VALIDATE.read(packet)
        name, which = pk.VALIDATE.read_name(packet, "TableName"), values["ActiveTableFlag"]
        table = self._registry.find(name)
        if table is None:
            self._reports.no_such_table_for(name)
            return False
        before = self._validations.asked(table)
        if before is not None:
            self._reports.validation_in_progress(table, before.number)
            return True
        buffer = select_buffer(self._registry, table, which)
        if buffer is None:
            self._reports.no_buffer_to_validate(table, which)
            return False
        if self._validations.is_full:
            self._reports.too_many_validations(table)
            return False
        self._begin_validation(table, buffer, which == pk.ACTIVE_BUFFER)
        return True

    def _begin_validation(self, table: TableRecord, buffer: Buffer, of_active: bool) -> None:
        release = self._config.release
        crc = buffer.crc if release.validation_has_crc_of_load else calculate_crc(buffer.view())
        request = Validation(table.name, crc, of_active)
        if table.validator is not None:
            self._validations.ask(table, request)
            self._housekeeping.count_request()
            if self._notify(table):
                text = f"Tbl Services issued validation request for '{table.name}'"
                self._debug(ev.VAL_REQ_MADE_INF_EID, text)
            return
        if release.validation_without_function_marks:
            buffer.is_valid = True
        else:  # it is reported in housekeeping
            request.performed = True
            self._validations.add(request)
        self._reports.assumed_valid(table)

    def activate(self, packet: bytes) -> bool:
        """Allow a table's owner to switch to the inactive image (CFE_TBL_ActivateCmd)."""
        name = pk.ACTIVATE.read_name(packet, "TableName")
        table = self._registry.find(name)
        if table is None:
            self._reports.no_such_table_for(name)
            return False
        loading = None if table.dump_only else self._registry.loading(table)
        if loading is None or not loading.is_valid:
            event_id = ev.ACTIVATE_ERR_EID if loading is None else ev.UNVALIDATED_ERR_EID
            self._reports.not_activated(ev.ACTIVATE_DUMP_ONLY_ERR_EID if table.dump_only else event_id, table)
            return False
        loading.activate_requested = True
        if self._notify(table):
            text = f"Tbl Services notifying App that '{name}' has a load pending"
            self._debug(ev.LOAD_PEND_REQ_INF_EID, text)
        return True

    def send_registry(self, packet: bytes) -> bool:
        """Send a table's registry entry with the next housekeeping (CFE_TBL_SendRegistryCmd)."""
        table = self._named(packet)
        if table is None:
            return False
        self._housekeeping.request_registry(table)
        text = f"Table Registry entry for '{table.name}' will be telemetered"
        self._debug(ev.TLM_REG_CMD_INF_EID, text)
        return True

    def delete_cds(self, packet: bytes) -> bool:
        """Delete the CDS of a critical table that is no longer registered (CFE_TBL_DeleteCDSCmd)."""
        name = pk.DELETE_CDS.read_name(packet, "TableName")
        if self._registry.find(name) is not None:
            text = f"'{name}' found in Table Registry. CDS cannot be deleted until table is unregistered"
            self._error(ev.IN_REGISTRY_ERR_EID, text)
            return False
        record = self._critical.find(name)
        if record is None:
            text = f"Table '{name}' is not found in Critical Table Registry"
            self._error(ev.NOT_IN_CRIT_REG_ERR_EID, text)
            return False
        try:
            self._critical.delete(record)
        except CfeError as error:
            other = ev.CDS_DELETE_ERR_EID, "Error while deleting '{}' from CDS, See SysLog.(Err={})"
            event_id, text = _NOT_DELETED.get(error.status, other)
            self._error(event_id, text.format(name, error.hex))
            return False
        self._info(ev.CDS_DELETED_INFO_EID, f"Successfully removed '{name}' from CDS")
        return True

    def abort_load(self, packet: bytes) -> bool:
        """Abort a load in progress (CFE_TBL_AbortLoadCmd)."""
        table = self._named(packet)
        if table is None:
            return False
        if not table.is_loading or table.dump_only:
            text = f"Cannot abort load of '{table.name}'. No load started."
            self._error(ev.LOAD_ABORT_ERR_EID, text)
            return False
        self._registry.discard_load(table)
        self._info(ev.LOAD_ABORT_INF_EID, f"Table Load Aborted for '{table.name}'")
        return True

    def _named(self, packet: bytes) -> TableRecord | None:
        return self._table(pk.ACTIVATE.read_name(packet, "TableName"))

    def _table(self, name: str) -> TableRecord | None:
        table = self._registry.find(name)
        if table is None:
            self._reports.no_such_table(name)
        return table

    def _notify(self, table: TableRecord) -> bool:
        """Send the owner's notification; return whether it was sent, or counts as sent."""
        release = self._config.release
        if table.notify is None:
            return release.notification_always_counts
        msg_id, fcn_code, parameter = table.notify
        try:
            packet = command(msg_id, fcn_code, pk.NOTIFY_COMMAND.pack(Parameter=parameter))
            if not release.notification_is_whole:  # the size of this message is never set
                packet = packet[:_SIZE_NOT_SET]
                set_size(packet, _SIZE_NOT_SET)
            self._ports.sb.transmit_msg(bytes(packet))
        except CfeError as error:
            text = f"Manage Notification Pkt Error(Status={error.hex})"
            self._error(ev.FAIL_NOTIFY_SEND_ERR_EID, text)
            return False
        return True

    def _debug(self, event_id: int, text: str) -> None:
        self._ports.evs.send_event(event_id, ev.DEBUG, text)

    def _info(self, event_id: int, text: str) -> None:
        self._ports.evs.send_event(event_id, ev.INFORMATION, text)

    def _error(self, event_id: int, text: str) -> None:
        self._ports.evs.send_event(event_id, ev.ERROR, text)


class RegistryDump:
    """The dump of the registry; only one can be in progress."""

    def __init__(self, ports: Ports, registry: TableRegistry, housekeeping: Housekeeping, files: TableStorage) -> None:
        self._ports = ports
        self._registry = registry
        self._housekeeping = housekeeping
        self._files = files
        self._existed = False
        self._job = FileWriteMetaData("", SUBTYPE_TBL_REG, REGISTRY_DESCRIPTION, self._record, self._ended)

    def request(self, wish: str) -> bool:
        """Start a dump.

        Args:
            wish: name of the file; empty for the default, and completed if it lacks a folder or an extension.

        Returns:
            Whether the dump could be queued; as in cFE, no event reports a failure.
        """
        if self._job.is_pending:
            return False
        try:
            self._job.file_name = dump_file_name(wish, REGISTRY_FILE)
            self._existed = self._exists(self._job.file_name)
            self._ports.fs.background_file_dump_request(self._job)
        except CfeError:
            return False
        return True

    def _exists(self, path: str) -> bool:
        try:
            return self._files.exists(path)
        except OsalError:
            return False

    def _record(self, number: int) -> tuple[bytes, bool]:
        """Return the record in a slot of the registry (no bytes for a free slot), and whether it is the last."""
        table = self._registry.tables.at(number)
        is_last = number >= self._registry.tables.capacity - 1
        if table is None:
            return b"", is_last
        owner = self._ports.es.get_app_name(table.owner) if table.owner else "--UNOWNED--"
        return REGISTRY_RECORD.pack(self._housekeeping.registry_record(table, owner)), is_last

    def _ended(self, event: FileWriteEvent, status: int, record: int, size: int, position: int) -> None:
        path = self._job.file_name
        if event in _DUMP_FAILURES:
            event_id, text = _DUMP_FAILURES[event]
            self._send(event_id, ev.ERROR, f"{text.format(path)}, Status=0x{status & 0xFFFFFFFF:08X}")
        elif self._existed:
            text = f"Successfully overwrote '{path}' with Table Registry:Size={position},Entries={record}"
            self._send(ev.OVERWRITE_REG_DUMP_INF_EID, ev.DEBUG, text)
        else:
            text = f"Successfully dumped Table Registry to '{path}':Size={position},Entries={record}"
            self._send(ev.WRITE_REG_DUMP_INF_EID, ev.DEBUG, text)

    def _send(self, event_id: int, event_type: int, text: str) -> None:
        self._ports.evs.send_event_with_app_id(event_id, event_type, self._registry.services_app_id, text)


class TableTask:
    """The core application CFE_TBL."""

    def __init__(self, ports: Ports, config: PlatformConfig, files: TableStorage, parts: Parts) -> None:
        self._ports = ports
        self._config = config
        self._registry = registry = parts.registry
        self._dumps = parts.dumps
        self._reports = parts.reports
        self._housekeeping = Housekeeping(registry, parts.memory, parts.dumps, parts.validations)
        self._registry_dump = RegistryDump(ports, registry, self._housekeeping, files)
        commands = TableCommands(ports, config, parts, self._housekeeping)
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
        """Run the task's main function (CFE_TBL_TaskMain)."""
        ports = self._ports
        ports.es.perf_log_entry(MAIN_PERF_ID)
        self._registry.services_app_id = ports.es.get_app_id()
        ports.evs.register()
        pipe = ports.sb.create_pipe(PIPE_DEPTH, PIPE_NAME)
        ports.sb.subscribe(pk.SEND_HK_MID, pipe)
        ports.sb.subscribe(pk.CMD_MID, pipe)
        text = f"cFE TBL Initialized: {self._config.release.text(APP_NAME)}"
        ports.evs.send_event(ev.INIT_INF_EID, ev.INFORMATION, text)
        serve(ports, self._config, pipe, MAIN_PERF_ID, self.handle)

    def handle(self, packet: bytes) -> None:
        """Handle a packet from the command pipe (CFE_TBL_TaskPipe).

        A handler returns True for the command counter, False for the error counter, None for neither.
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

    def note_update(self, table: TableRecord) -> None:
        """Record the last changed table for housekeeping."""
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
        for dump, event_id, event_type, text in self._dumps.write_files(self._registry.services_app_id):
            self._reports.dump(event_id, event_type, UNKNOWN, dump.file_name, text)

    def _noop(self, packet: bytes) -> bool:
        text = f"No-op Cmd Rcvd: {self._config.release.text(APP_NAME)}"
        self._ports.evs.send_event(ev.NOOP_INF_EID, ev.INFORMATION, text)
        return True

    def _reset_counters(self, packet: bytes) -> None:
        self._housekeeping.reset_counters()
        self._ports.evs.send_event(ev.RESET_INF_EID, ev.DEBUG, "Reset Counters command")

    def _dump_registry(self, packet: bytes) -> bool:
        return self._registry_dump.request(pk.DUMP_REGISTRY.read(packet)["DumpFilename"])

    def _error(self, event_id: int, text: str) -> None:
        self._ports.evs.send_event(event_id, ev.ERROR, text)
