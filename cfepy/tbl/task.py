"""The CFE_TBL task: commands from the ground and housekeeping.

Stands for cfe_tbl_task.c and cfe_tbl_task_cmds.c. LOAD works as in cFE v7.0.1: v7.0.0 refuses every one. Imports only
cfepy.config, cfepy.fs, cfepy.msg, cfepy.ports, cfepy.status, cfepy.versions and its neighbours here.
"""

from __future__ import annotations

from cfepy.config import PlatformConfig
from cfepy.fs import FileCategory, FileHeader, get_default_extension, get_default_mount_point, parse_input_file_name_ex
from cfepy.fs.header import SUBTYPE_TBL_REG
from cfepy.msg import CMD_HEADER_SIZE, CommandTable, command, get_user_data, telemetry
from cfepy.msg.dispatch import BAD_CODE, BAD_LENGTH, BAD_MSG_ID, Dispatch
from cfepy.ports import PEND_FOREVER, SYSTEM_CORE_READY, Ports
from cfepy.status import CFE_TBL_ERR_INVALID_NAME, CfeError, OsalError
from cfepy.tbl import events as eid
from cfepy.tbl import packets
from cfepy.tbl.buffers import BufferMemory
from cfepy.tbl.dumps import DumpRefused, Dumps, select_buffer
from cfepy.tbl.housekeeping import Housekeeping
from cfepy.tbl.loads import Files, Loads, Refused, TableFile
from cfepy.tbl.registry import Registry, Table, Validation
from cfepy.versions import version_string

PIPE_NAME = "TBL_CMD_PIPE"
PIPE_DEPTH = 12
REGISTRY_FILE = "/ram/cfe_tbl_reg.log"
REGISTRY_DESCRIPTION = "Table Registry"
APP_NAME = "CFE_TBL"


class TableTask:
    """What the ground can do with tables."""

    def __init__(
        self,
        ports: Ports,
        config: PlatformConfig,
        files: Files,
        registry: Registry,
        loads: Loads,
        dumps: Dumps,
        memory: BufferMemory,
    ) -> None:
        self._ports = ports
        self._config = config
        self._files = files
        self._registry = registry
        self._loads = loads
        self._dumps = dumps
        self._housekeeping = Housekeeping(registry, memory, dumps)
        self._commands = self._command_table()

    def _command_table(self) -> CommandTable:
        table = CommandTable()
        table.add_message(packets.SEND_HK_MID, CMD_HEADER_SIZE, self._send_hk)
        file, name = packets.FILE_COMMAND.size, packets.NAME_COMMAND.size
        for fcn_code, size, handler in (
            (packets.NOOP_CC, 0, self._noop),
            (packets.RESET_COUNTERS_CC, 0, self._reset_counters),
            (packets.LOAD_CC, file, self._load),
            (packets.DUMP_CC, packets.DUMP_COMMAND.size, self._dump),
            (packets.VALIDATE_CC, packets.VALIDATE_COMMAND.size, self._validate),
            (packets.ACTIVATE_CC, name, self._activate),
            (packets.DUMP_REGISTRY_CC, file, self._dump_registry),
            (packets.SEND_REGISTRY_CC, name, self._send_registry),
            (packets.DELETE_CDS_CC, name, self._delete_cds),
            (packets.ABORT_LOAD_CC, name, self._abort_load),
        ):
            table.add(packets.CMD_MID, fcn_code, CMD_HEADER_SIZE + size, handler)
        return table

    def main(self) -> None:
        """The task's main function (CFE_TBL_TaskMain)."""
        ports = self._ports
        self._registry.services_app_id = ports.es.get_app_id()
        ports.evs.register()
        pipe = ports.sb.create_pipe(PIPE_DEPTH, PIPE_NAME)
        ports.sb.subscribe(packets.SEND_HK_MID, pipe)
        ports.sb.subscribe(packets.CMD_MID, pipe)
        text = f"cFE TBL Initialized: {version_string(APP_NAME)}"
        ports.evs.send_event(eid.CFE_TBL_INIT_INF_EID, eid.INFORMATION, text)
        ports.es.wait_for_system_state(SYSTEM_CORE_READY, self._config.es_core_max_startup_ms)
        while True:
            ports.es.increment_task_counter()
            packet = ports.sb.receive_buffer(pipe, PEND_FOREVER)
            if packet is not None:
                self.handle(packet)

    def handle(self, packet: bytes) -> None:
        """Do what one packet from the command pipe asks for (CFE_TBL_TaskPipe)."""
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
            self._error(eid.CFE_TBL_LEN_ERR_EID, text)
        elif done.outcome == BAD_CODE:
            text = f"Invalid command code -- ID = 0x{done.msg_id:X}, CC = {done.fcn_code}"
            self._error(eid.CFE_TBL_CC1_ERR_EID, text)
        elif done.outcome == BAD_MSG_ID:
            self._error(eid.CFE_TBL_MID_ERR_EID, f"Invalid message ID -- ID = 0x{done.msg_id:X}")

    def note_update(self, table: Table) -> None:
        """Remember for housekeeping which table changed last."""
        self._housekeeping.last_updated = table

    # Handlers return True or False for the command or the error counter, None to count nothing.

    def _send_hk(self, packet: bytes) -> None:
        payload = packets.HOUSEKEEPING.pack(self._housekeeping.collect())
        self._ports.sb.transmit_msg(bytes(telemetry(packets.HK_TLM_MID, payload)))
        wanted = self._housekeeping.take_registry_request()
        if wanted is not None:
            values = self._housekeeping.registry_packet(wanted, self._owner_name(wanted))
            payload = packets.REGISTRY_PACKET.pack(values)
            self._ports.sb.transmit_msg(bytes(telemetry(packets.REG_TLM_MID, payload)))
        self._dumps.write_files(self._registry.services_app_id, APP_NAME)

    def _noop(self, packet: bytes) -> bool:
        self._info(eid.CFE_TBL_NOOP_INF_EID, f"No-op Cmd Rcvd: {version_string(APP_NAME)}")
        return True

    def _reset_counters(self, packet: bytes) -> None:
        self._housekeeping.reset_counters()
        self._debug(eid.CFE_TBL_RESET_INF_EID, "Reset Counters command")

    def _load(self, packet: bytes) -> bool:
        file = TableFile(packets.FILE_COMMAND.unpack(get_user_data(packet))["Filename"])
        table = None
        try:
            self._loads.open(file)
            table = self._registry.find(file.table.table_name)
            if table is None:
                text = "Unable to locate in Table Registry"
                raise Refused(CFE_TBL_ERR_INVALID_NAME, eid.CFE_TBL_NO_SUCH_TABLE_ERR_EID, text, names_file=False)
            self._loads.reserve(table, from_file=True)
            self._fill(table, file)
        except Refused as refused:
            self._loads.report(refused, self._registry.services_app_id, APP_NAME, file, table)
            return False
        self._housekeeping.last_file_loaded, self._housekeeping.last_table_loaded = file.path, table.name
        where = f"LoadFile,app={APP_NAME},file={file.path},tbl={table.name}"
        self._info(eid.CFE_TBL_FILE_LOADED_INF_EID, f"{where}:Successful load into '{table.name}' working buffer")
        return True

    def _fill(self, table: Table, file: TableFile) -> None:
        try:
            self._loads.fill_from_file(table, file)
        except Refused:
            self._registry.discard_load(table)
            raise

    def _dump(self, packet: bytes) -> bool:
        values = packets.DUMP_COMMAND.unpack(get_user_data(packet))
        table = self._table(values["TableName"])
        if table is None:
            return False
        try:
            self._dumps.request(table, values["ActiveTableFlag"], values["DumpFilename"])
        except DumpRefused as refused:
            where = f"dump,table={table.name},app={APP_NAME},file={values['DumpFilename']}"
            self._error(refused.event_id, f"{where}:{refused.text}")
            return False
        self._notify(table)
        return True

    def _validate(self, packet: bytes) -> bool:
        values = packets.VALIDATE_COMMAND.unpack(get_user_data(packet))
        table = self._table(values["TableName"])
        if table is None:
            return False
        buffer = select_buffer(table, values["ActiveTableFlag"])
        if buffer is None:
            self._error(eid.CFE_TBL_NO_INACTIVE_BUFFER_ERR_EID, f"No Buffer for Table '{table.name}' present")
            return False
        if self._housekeeping.validations_under_way() >= self._config.tbl_max_num_validations:
            text = "Too many Table Validations have been requested"
            self._error(eid.CFE_TBL_TOO_MANY_VALIDATIONS_ERR_EID, text)
            return False
        buffer.recompute_crc()
        of_active = values["ActiveTableFlag"] == packets.ACTIVE_BUFFER
        self._begin_validation(table, Validation(table.name, buffer.crc, of_active))
        return True

    def _begin_validation(self, table: Table, request: Validation) -> None:
        if table.validator is None:
            request.performed = True
            self._housekeeping.add_validation(request)
            text = f"Tbl Services assumes '{table.name}' is valid. No Validation Function has been registered"
            self._info(eid.CFE_TBL_ASSUMED_VALID_INF_EID, text)
            return
        if table.validation is not None:
            return  # the owner has not got round to the request before; one answer serves both
        table.validation = request
        self._housekeeping.add_validation(request, by_owner=True)
        if self._notify(table):
            text = f"Tbl Services issued validation request for '{table.name}'"
            self._debug(eid.CFE_TBL_VAL_REQ_MADE_INF_EID, text)

    def _activate(self, packet: bytes) -> bool:
        table = self._named(packet)
        if table is None:
            return False
        name, loading = table.name, table.loading
        if table.dump_only:
            text = f"Illegal attempt to activate dump-only table '{name}'"
            self._error(eid.CFE_TBL_ACTIVATE_DUMP_ONLY_ERR_EID, text)
            return False
        if loading is None:
            text = f"Cannot activate table '{name}'. No Inactive image available"
            self._error(eid.CFE_TBL_ACTIVATE_ERR_EID, text)
            return False
        if not loading.is_valid:
            text = f"Cannot activate table '{name}'. Inactive image not Validated"
            self._error(eid.CFE_TBL_UNVALIDATED_ERR_EID, text)
            return False
        loading.activate_requested = True
        if self._notify(table):
            text = f"Tbl Services notifying App that '{name}' has a load pending"
            self._debug(eid.CFE_TBL_LOAD_PEND_REQ_INF_EID, text)
        return True

    def _dump_registry(self, packet: bytes) -> bool:
        kind = FileCategory.BINARY_DATA_DUMP
        wish = packets.FILE_COMMAND.unpack(get_user_data(packet))["Filename"]
        place, ending = get_default_mount_point(kind), get_default_extension(kind)
        try:
            path = parse_input_file_name_ex(wish, REGISTRY_FILE, place, ending)
            existed = self._files.exists(path)
            size, entries = self._write_registry(path)
        except OsalError as error:
            text = f"Error creating dump file '{path}', Status={error.hex}"
            self._error(eid.CFE_TBL_CREATING_DUMP_FILE_ERR_EID, text)
            return True  # NASA counts the command when it is queued, before the file is opened
        except CfeError:
            return False
        if existed:
            text = f"Successfully overwrote '{path}' with Table Registry:Size={size},Entries={entries}"
            self._debug(eid.CFE_TBL_OVERWRITE_REG_DUMP_INF_EID, text)
        else:
            text = f"Successfully dumped Table Registry to '{path}':Size={size},Entries={entries}"
            self._debug(eid.CFE_TBL_WRITE_REG_DUMP_INF_EID, text)
        return True

    def _write_registry(self, path: str) -> tuple[int, int]:
        seconds, subseconds = self._ports.time.now()
        header = FileHeader(
            description=REGISTRY_DESCRIPTION,
            subtype=SUBTYPE_TBL_REG,
            spacecraft_id=self._config.spacecraft_id,
            processor_id=self._config.processor_id,
            application_id=self._registry.services_app_id,
            time_seconds=seconds,
            time_subseconds=subseconds,
        )
        records = [
            packets.REGISTRY_RECORD.pack(self._housekeeping.registry_record(table, self._owner_name(table)))
            for table in self._registry.tables
        ]
        data = header.pack() + b"".join(records)
        self._files.write_file(path, data)
        return len(data), len(records)

    def _send_registry(self, packet: bytes) -> bool:
        table = self._named(packet)
        if table is None:
            return False
        self._housekeeping.request_registry(table)
        text = f"Table Registry entry for '{table.name}' will be telemetered"
        self._debug(eid.CFE_TBL_TLM_REG_CMD_INF_EID, text)
        return True

    def _delete_cds(self, packet: bytes) -> bool:
        name = packets.NAME_COMMAND.unpack(get_user_data(packet))["TableName"]
        if self._registry.find(name) is not None:
            text = f"'{name}' found in Table Registry. CDS cannot be deleted until table is unregistered"
            self._error(eid.CFE_TBL_IN_REGISTRY_ERR_EID, text)
        else:
            text = f"Table '{name}' is not found in Critical Table Registry"
            self._error(eid.CFE_TBL_NOT_IN_CRIT_REG_ERR_EID, text)
        return False

    def _abort_load(self, packet: bytes) -> bool:
        table = self._named(packet)
        if table is None:
            return False
        if table.loading is None:
            text = f"Cannot abort load of '{table.name}'. No load started."
            self._error(eid.CFE_TBL_LOAD_ABORT_ERR_EID, text)
            return False
        self._registry.discard_load(table)
        self._info(eid.CFE_TBL_LOAD_ABORT_INF_EID, f"Table Load Aborted for '{table.name}'")
        return True

    def _named(self, packet: bytes) -> Table | None:
        return self._table(packets.NAME_COMMAND.unpack(get_user_data(packet))["TableName"])

    def _table(self, name: str) -> Table | None:
        table = self._registry.find(name)
        if table is None:
            self._error(eid.CFE_TBL_NO_SUCH_TABLE_ERR_EID, f"Unable to locate '{name}' in Table Registry")
        return table

    def _notify(self, table: Table) -> bool:
        """Send the owner's notification; False when there is none to send or it could not be sent."""
        if table.notify is None:
            return False
        msg_id, fcn_code, parameter = table.notify
        packet = command(msg_id, fcn_code, packets.NOTIFY_COMMAND.pack(Parameter=parameter))
        try:
            self._ports.sb.transmit_msg(bytes(packet))
        except CfeError as error:
            text = f"Manage Notification Pkt Error(Status={error.hex})"
            self._error(eid.CFE_TBL_FAIL_NOTIFY_SEND_ERR_EID, text)
            return False
        return True

    def _owner_name(self, table: Table) -> str:
        return self._ports.es.get_app_name(table.owner) if table.owner else "--UNOWNED--"

    def _debug(self, event_id: int, text: str) -> None:
        self._ports.evs.send_event(event_id, eid.DEBUG, text)

    def _info(self, event_id: int, text: str) -> None:
        self._ports.evs.send_event(event_id, eid.INFORMATION, text)

    def _error(self, event_id: int, text: str) -> None:
        self._ports.evs.send_event(event_id, eid.ERROR, text)
