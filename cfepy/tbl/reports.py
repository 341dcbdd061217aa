"""The events about loads, dumps, validations and activations, with the texts of each release of cFE.

Release 7.0.1 sends them from one place (CFE_TBL_SendTransactionEvents): first the operation, then the caller and the
table. For commands about one table the caller has no name, and a missing table is not reported. Release 7.0.0 has
different texts for most of them. For the file of a dump it prints a pointer that it never set.
"""

from __future__ import annotations

from cfepy.config.platform import PlatformConfig
from cfepy.ports import Ports
from cfepy.tbl import events as ev
from cfepy.tbl.dumps import DumpRefused
from cfepy.tbl.registry import TableRecord, TableRegistry
from cfepy.tbl.table_file import LoadFile, Refused

UNKNOWN = "[unknown]"
_NULL = "(null)"


class Reports:
    """The events of Table Services.

    Args:
        ports: provides Event Services.
        config: the release.
        registry: has the AppId of Table Services.
    """

    def __init__(self, ports: Ports, config: PlatformConfig, registry: TableRegistry) -> None:
        self._ports = ports
        self._is_7_0_0 = config.is_cfe_7_0_0
        self._registry = registry

    def send(self, event_id: int, event_type: int, text: str) -> None:
        """Send an event (CFE_EVS_SendEventWithAppID)."""
        self._ports.evs.send_event_with_app_id(event_id, event_type, self._registry.services_app_id, text)

    # -- loads --

    def load_refused(self, refused: Refused, caller: str, table: TableRecord | None) -> None:
        """Report a refused load from any source (CFE_TBL_SendLoadBasicEventHelper).

        Args:
            refused: the refusal.
            caller: name of the calling app.
            table: the table, if it was found.
        """
        name = UNKNOWN if table is None else table.name
        self.send(refused.event_id, ev.ERROR, f"Load,app={caller},tbl={name}:{refused.text}")

    def file_refused(self, refused: Refused, caller: str, file: LoadFile, table: TableRecord | None) -> None:
        """Report a file that cannot be loaded (CFE_TBL_SendLoadFileEventHelper).

        Args:
            refused: the refusal.
            caller: name of the calling app.
            file: the file.
            table: the table, if it was found.
        """
        if self._is_7_0_0 and refused.event_id == ev.LOAD_FILENAME_LONG_ERR_EID:
            return
        text, names_file = refused.text, refused.names_file
        if not self._is_7_0_0 and refused.event_id == ev.NO_SUCH_TABLE_ERR_EID:
            text, names_file = f"Tbl Hdr has invalid name: '{file.table.table_name}'", True
        name = self._table_of(file, table)
        where = f"file={file.path},tbl={name}" if names_file else f"tbl={name}"
        self.send(refused.event_id, ev.ERROR, f"LoadFile,app={caller},{where}:{text}")

    def loaded(self, file: LoadFile, caller: str, table: TableRecord) -> None:
        """Report that a file is in the working buffer."""
        name = self._table_of(file, table)
        where = f"LoadFile,app={caller},file={file.path},tbl={name}"
        into = f"'{name}' working buffer" if self._is_7_0_0 else "working buffer"
        self.send(ev.FILE_LOADED_INF_EID, ev.INFORMATION, f"{where}:Successful load into {into}")

    def _table_of(self, file: LoadFile, table: TableRecord | None) -> str:
        """Return the table name for an event: release 7.0.0 takes it from the file, 7.0.1 from the table."""
        if self._is_7_0_0:
            return file.table_name
        return UNKNOWN if table is None else table.name

    # -- commands about one table --

    def no_such_table(self, name: str) -> None:
        """Report a name that is not in the registry."""
        self.send(ev.NO_SUCH_TABLE_ERR_EID, ev.ERROR, f"Unable to locate '{name}' in Table Registry")

    def no_such_table_for(self, name: str) -> None:
        """Report an unknown name in VALIDATE and ACTIVATE; release 7.0.1 does not report it."""
        if self._is_7_0_0:
            self.no_such_table(name)

    def dump(self, event_id: int, event_type: int, table_name: str, file_name: str, text: str) -> None:
        """Report a dump (CFE_TBL_SendDumpEventHelper)."""
        operation, file = ("dump", _NULL) if self._is_7_0_0 else ("Dump", file_name)
        self.send(event_id, event_type, f"{operation},table={table_name},app=,file={file}:{text}")

    def dump_refused(self, refused: DumpRefused, table: TableRecord, which: int, file_name: str) -> None:
        """Report a refused dump, if there is an event for it."""
        if refused.event_id == ev.ILLEGAL_BUFF_PARAM_ERR_EID:
            self.bad_selection(table, which)
        if refused.event_id:
            self.dump(refused.event_id, ev.ERROR, table.name, file_name, refused.text)

    def bad_selection(self, table: TableRecord, which: int) -> None:
        """Report, only in release 7.0.0, a number that is neither the active nor the inactive buffer."""
        if self._is_7_0_0 and which > 1:
            text = f"Cmd for Table '{table.name}' had illegal buffer parameter (0x{which:08X})"
            self.send(ev.ILLEGAL_BUFF_PARAM_ERR_EID, ev.ERROR, text)

    def no_buffer_to_validate(self, table: TableRecord, which: int) -> None:
        """Report that there is no image to validate."""
        if self._is_7_0_0:
            self.bad_selection(table, which)
            self.send(ev.NO_INACTIVE_BUFFER_ERR_EID, ev.ERROR, f"No Buffer for Table '{table.name}' present")
            return
        self._about("Validate", ev.ILLEGAL_BUFF_PARAM_ERR_EID, table, f"Request had {_ILLEGAL} (0x{which:08X})")

    def too_many_validations(self, table: TableRecord) -> None:
        """Report that there is no free slot for another validation."""
        text = "Too many Table Validations have been requested"
        if self._is_7_0_0:
            self.send(ev.TOO_MANY_VALIDATIONS_ERR_EID, ev.ERROR, text)
        else:
            self._about("Validate", ev.TOO_MANY_VALIDATIONS_ERR_EID, table, text)

    def validation_in_progress(self, table: TableRecord, number: int) -> None:
        """Report that the owner already has a request (release 7.0.1)."""
        text = f"Validation already in progress, id={number:x}"
        self._about("Validate", ev.VALIDATION_IN_PROGRESS_ERR_EID, table, text)

    def assumed_valid(self, table: TableRecord) -> None:
        """Report that there is no validator."""
        if self._is_7_0_0:
            text = f"Tbl Services assumes '{table.name}' is valid. No Validation Function has been registered"
            self.send(ev.ASSUMED_VALID_INF_EID, ev.INFORMATION, text)
            return
        text = "No Validation Function has been registered, assumed valid"
        self._about("Validate", ev.ASSUMED_VALID_INF_EID, table, text, ev.INFORMATION)

    def not_activated(self, event_id: int, table: TableRecord) -> None:
        """Report why an image cannot be activated, by the event's id."""
        what, why = _NOT_ACTIVATED[event_id]
        if self._is_7_0_0:
            self.send(event_id, ev.ERROR, f"{what} table '{table.name}'. {why}" if why else f"{what} '{table.name}'")
        else:
            self._about("Activate", event_id, table, f"{what} table, {why}" if why else what)

    def _about(self, operation: str, event_id: int, table: TableRecord, text: str, event_type: int = ev.ERROR) -> None:
        self.send(event_id, event_type, f"{operation},app=,tbl={table.name}:{text}")


_ILLEGAL = "illegal buffer parameter"
_NOT_ACTIVATED = {
    ev.ACTIVATE_DUMP_ONLY_ERR_EID: ("Illegal attempt to activate dump-only table", ""),
    ev.ACTIVATE_ERR_EID: ("Cannot activate", "No Inactive image available"),
    ev.UNVALIDATED_ERR_EID: ("Cannot activate", "Inactive image not Validated"),
}
"""The texts of these events, with the reasons, by event id."""
