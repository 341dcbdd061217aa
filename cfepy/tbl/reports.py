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


class Reports:
    """The events of Table Services.

    Args:
        ports: provides Event Services.
        config: the release.
        registry: has the AppId of Table Services.
    """

    def __init__(self, ports: Ports, config: PlatformConfig, registry: TableRegistry) -> None:
        self._ports = ports
        self._release = config.release
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
        if refused.event_id == ev.LOAD_FILENAME_LONG_ERR_EID and not self._release.reports_long_path:
            return
        text, names_file = refused.text, refused.names_file
        if refused.event_id == ev.NO_SUCH_TABLE_ERR_EID:
            text = self._release.file_for_no_table.format(table=file.table.table_name)
            names_file = names_file or self._release.names_file_without_table
        name = self._table_of(file, table)
        where = f"file={file.path},tbl={name}" if names_file else f"tbl={name}"
        self.send(refused.event_id, ev.ERROR, f"LoadFile,app={caller},{where}:{text}")

    def loaded(self, file: LoadFile, caller: str, table: TableRecord) -> None:
        """Report that a file is in the working buffer."""
        name = self._table_of(file, table)
        where = f"LoadFile,app={caller},file={file.path},tbl={name}"
        self.send(ev.FILE_LOADED_INF_EID, ev.INFORMATION, f"{where}:{self._release.loaded.format(table=name)}")

    def _table_of(self, file: LoadFile, table: TableRecord | None) -> str:
        """Return the table name for an event, from the file or from the table."""
        if self._release.names_table_of_file:
            return file.table_name
        return UNKNOWN if table is None else table.name

    # -- commands about one table --

    def no_such_table(self, name: str) -> None:
        """Report a name that is not in the registry."""
        self.send(ev.NO_SUCH_TABLE_ERR_EID, ev.ERROR, f"Unable to locate '{name}' in Table Registry")

    def no_such_table_for(self, name: str) -> None:
        """Report an unknown name in VALIDATE and ACTIVATE, in the releases that do so."""
        if self._release.reports_unknown_table:
            self.no_such_table(name)

    def dump(self, event_id: int, event_type: int, table_name: str, file_name: str, text: str) -> None:
        """Report a dump (CFE_TBL_SendDumpEventHelper)."""
        self.send(event_id, event_type, self._release.dump.format(table=table_name, file=file_name, text=text))

    def dump_refused(self, refused: DumpRefused, table: TableRecord, which: int, file_name: str) -> None:
        """Report a refused dump, if there is an event for it."""
        if refused.event_id == ev.ILLEGAL_BUFF_PARAM_ERR_EID:
            self.bad_selection(table, which)
        if refused.event_id:
            self.dump(refused.event_id, ev.ERROR, table.name, file_name, refused.text)

    def bad_selection(self, table: TableRecord, which: int) -> None:
        """Report a number that is neither the active nor the inactive buffer, in the releases that do so."""
        if self._release.reports_bad_buffer_number and which > 1:
            text = f"Cmd for Table '{table.name}' had illegal buffer parameter (0x{which:08X})"
            self.send(ev.ILLEGAL_BUFF_PARAM_ERR_EID, ev.ERROR, text)

    def no_buffer_to_validate(self, table: TableRecord, which: int) -> None:
        """Report that there is no image to validate."""
        self.bad_selection(table, which)
        text = self._release.no_buffer.format(table=table.name, which=which)
        self.send(self._release.no_buffer_event, ev.ERROR, text)

    def too_many_validations(self, table: TableRecord) -> None:
        """Report that there is no free slot for another validation."""
        text = self._release.too_many_validations.format(table=table.name)
        self.send(ev.TOO_MANY_VALIDATIONS_ERR_EID, ev.ERROR, text)

    def validation_in_progress(self, table: TableRecord, number: int) -> None:
        """Report that the owner already has a request."""
        text = f"Validate,app=,tbl={table.name}:Validation already in progress, id={number:x}"
        self.send(ev.VALIDATION_IN_PROGRESS_ERR_EID, ev.ERROR, text)

    def assumed_valid(self, table: TableRecord) -> None:
        """Report that there is no validator."""
        text = self._release.assumed_valid.format(table=table.name)
        self.send(ev.ASSUMED_VALID_INF_EID, ev.INFORMATION, text)

    def not_activated(self, event_id: int, table: TableRecord) -> None:
        """Report why an image cannot be activated, by the event's id."""
        release = self._release
        texts = {
            ev.ACTIVATE_DUMP_ONLY_ERR_EID: release.activate_dump_only,
            ev.ACTIVATE_ERR_EID: release.activate_nothing,
            ev.UNVALIDATED_ERR_EID: release.activate_unvalidated,
        }
        self.send(event_id, ev.ERROR, texts[event_id].format(table=table.name))
