"""What the ground can do with tables: load, validate, activate, dump, and more (cfe_tbl_task_cmds.c).

LOAD works as in cFE v7.0.1: v7.0.0 refuses every one. Imports only cfepy.config, cfepy.fs, cfepy.msg, cfepy.ports,
cfepy.status and its neighbours here.
"""

from __future__ import annotations

from cfepy.config import PlatformConfig
from cfepy.fs import calculate_crc
from cfepy.msg import command
from cfepy.ports import Ports
from cfepy.status import (
    CFE_ES_CDS_OWNER_ACTIVE_ERR,
    CFE_ES_CDS_WRONG_TYPE_ERR,
    CFE_ES_ERR_NAME_NOT_FOUND,
    CFE_TBL_ERR_INVALID_NAME,
    CfeError,
)
from cfepy.tbl import events as ev
from cfepy.tbl import packets as pk
from cfepy.tbl.critical import CriticalTables
from cfepy.tbl.dumps import DumpRefused, Dumps, select_buffer
from cfepy.tbl.housekeeping import Housekeeping
from cfepy.tbl.loads import Loads
from cfepy.tbl.registry import Registry, Table, Validation
from cfepy.tbl.table_file import Refused, TableFile

APP_NAME = "CFE_TBL"

_NOT_DELETED = {
    CFE_ES_CDS_WRONG_TYPE_ERR: (
        ev.NOT_CRITICAL_TBL_ERR_EID,
        "Table '{}' is in Critical Table Registry but CDS is not tagged as a table",
    ),
    CFE_ES_CDS_OWNER_ACTIVE_ERR: (ev.CDS_OWNER_ACTIVE_ERR_EID, "CDS '{}' owning app is still active"),
    CFE_ES_ERR_NAME_NOT_FOUND: (ev.CDS_NOT_FOUND_ERR_EID, "Unable to locate '{}' in CDS Registry"),
}
"""Event id and text of DELETE_CDS by what the CDS says."""


class TableCommands:
    """The commands about single tables; each returns whether it was carried out."""

    def __init__(
        self,
        ports: Ports,
        config: PlatformConfig,
        registry: Registry,
        loads: Loads,
        dumps: Dumps,
        critical: CriticalTables,
        housekeeping: Housekeeping,
    ) -> None:
        self._ports = ports
        self._config = config
        self._registry = registry
        self._loads = loads
        self._dumps = dumps
        self._critical = critical
        self._housekeeping = housekeeping

    def load(self, packet: bytes) -> bool:
        """Read a table file into the inactive image of its table (CFE_TBL_LoadCmd)."""
        file = TableFile(pk.LOAD.read(packet)["LoadFilename"], self._config)
        table = None
        try:
            self._loads.open(file)
            table = self._registry.find(file.table.table_name)
            if table is None:
                text = "Unable to locate in Table Registry"
                raise Refused(CFE_TBL_ERR_INVALID_NAME, ev.NO_SUCH_TABLE_ERR_EID, text, names_file=False)
            self._loads.reserve(table, from_file=True)
            self._fill(table, file)
        except Refused as refused:
            self._loads.report(refused, self._registry.services_app_id, APP_NAME, file, table)
            return False
        self._housekeeping.last_file_loaded, self._housekeeping.last_table_loaded = file.path, table.name
        where = f"LoadFile,app={APP_NAME},file={file.path},tbl={table.name}"
        self._info(ev.FILE_LOADED_INF_EID, f"{where}:Successful load into '{table.name}' working buffer")
        return True

    def _fill(self, table: Table, file: TableFile) -> None:
        try:
            self._loads.fill_from_file(table, file)
        except Refused:
            self._registry.discard_load(table)
            raise

    def dump(self, packet: bytes) -> bool:
        """Begin to write an image of a table to a file (CFE_TBL_DumpCmd)."""
        values = pk.DUMP.read(packet)
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

    def validate(self, packet: bytes) -> bool:
        """Have an image of a table validated (CFE_TBL_ValidateCmd)."""
        values = pk.VALIDATE.read(packet)
        table = self._table(values["TableName"])
        if table is None:
            return False
        buffer = select_buffer(table, values["ActiveTableFlag"])
        if buffer is None:
            self._error(ev.NO_INACTIVE_BUFFER_ERR_EID, f"No Buffer for Table '{table.name}' present")
            return False
        if self._housekeeping.validations_under_way() >= self._config.tbl_max_num_validations:
            text = "Too many Table Validations have been requested"
            self._error(ev.TOO_MANY_VALIDATIONS_ERR_EID, text)
            return False
        of_active = values["ActiveTableFlag"] == pk.ACTIVE_BUFFER
        self._begin_validation(table, Validation(table.name, calculate_crc(buffer.view()), of_active))
        return True

    def _begin_validation(self, table: Table, request: Validation) -> None:
        if table.validator is None:
            request.performed = True
            self._housekeeping.add_validation(request)
            text = f"Tbl Services assumes '{table.name}' is valid. No Validation Function has been registered"
            self._info(ev.ASSUMED_VALID_INF_EID, text)
            return
        if request.of_active in table.validations:
            return  # the owner has not got round to the request before; one answer serves both
        table.validations[request.of_active] = request
        self._housekeeping.add_validation(request, by_owner=True)
        if self._notify(table):
            text = f"Tbl Services issued validation request for '{table.name}'"
            self._debug(ev.VAL_REQ_MADE_INF_EID, text)

    def activate(self, packet: bytes) -> bool:
        """Let a table's owner switch to the inactive image (CFE_TBL_ActivateCmd)."""
        table = self._named(packet)
        if table is None:
            return False
        name, loading = table.name, table.loading
        if table.dump_only:
            text = f"Illegal attempt to activate dump-only table '{name}'"
            self._error(ev.ACTIVATE_DUMP_ONLY_ERR_EID, text)
            return False
        if loading is None:
            text = f"Cannot activate table '{name}'. No Inactive image available"
            self._error(ev.ACTIVATE_ERR_EID, text)
            return False
        if not loading.is_valid:
            text = f"Cannot activate table '{name}'. Inactive image not Validated"
            self._error(ev.UNVALIDATED_ERR_EID, text)
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
        """Delete the CDS of a critical table that is not registered any more (CFE_TBL_DeleteCDSCmd)."""
        name = pk.DELETE_CDS.read(packet)["TableName"]
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
        """Give up a load that was begun (CFE_TBL_AbortLoadCmd)."""
        table = self._named(packet)
        if table is None:
            return False
        if table.loading is None:
            text = f"Cannot abort load of '{table.name}'. No load started."
            self._error(ev.LOAD_ABORT_ERR_EID, text)
            return False
        self._registry.discard_load(table)
        self._info(ev.LOAD_ABORT_INF_EID, f"Table Load Aborted for '{table.name}'")
        return True

    def _named(self, packet: bytes) -> Table | None:
        return self._table(pk.ACTIVATE.read(packet)["TableName"])

    def _table(self, name: str) -> Table | None:
        table = self._registry.find(name)
        if table is None:
            self._error(ev.NO_SUCH_TABLE_ERR_EID, f"Unable to locate '{name}' in Table Registry")
        return table

    def _notify(self, table: Table) -> bool:
        """Send the owner's notification; False when there is none to send or it could not be sent."""
        if table.notify is None:
            return False
        msg_id, fcn_code, parameter = table.notify
        try:
            packet = command(msg_id, fcn_code, pk.NOTIFY_COMMAND.pack(Parameter=parameter))
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
