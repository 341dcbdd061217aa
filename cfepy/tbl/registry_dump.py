"""The registry of all tables as a file (DUMP_REGISTRY), written record by record by the background task of ES.

Imports only cfepy.fs, cfepy.ports, cfepy.status and its neighbours here.
"""

from __future__ import annotations

from cfepy.fs import dump_file_name
from cfepy.fs.background import FileWriteEvent, FileWriteMetaData
from cfepy.fs.header import SUBTYPE_TBL_REG
from cfepy.ports import Ports
from cfepy.status import CfeError, OsalError
from cfepy.tbl import events as ev
from cfepy.tbl.housekeeping import Housekeeping
from cfepy.tbl.packets import REGISTRY_RECORD
from cfepy.tbl.registry import Registry
from cfepy.tbl.table_file import Files

DEFAULT_FILE = "/ram/cfe_tbl_reg.log"
DESCRIPTION = "Table Registry"

_FAILURES = {
    FileWriteEvent.CREATE_ERROR: (ev.CREATING_DUMP_FILE_ERR_EID, "Error creating dump file '{}'"),
    FileWriteEvent.HEADER_WRITE_ERROR: (ev.WRITE_CFE_HDR_ERR_EID, "Error writing cFE File Header to '{}'"),
    FileWriteEvent.RECORD_WRITE_ERROR: (ev.WRITE_TBL_REG_ERR_EID, "Error writing Registry to '{}'"),
}


class RegistryDump:
    """The one dump of the registry that may be under way."""

    def __init__(self, ports: Ports, registry: Registry, housekeeping: Housekeeping, files: Files) -> None:
        self._ports = ports
        self._registry = registry
        self._housekeeping = housekeeping
        self._files = files
        self._existed = False
        self._job = FileWriteMetaData("", SUBTYPE_TBL_REG, DESCRIPTION, self._record, self._ended)

    def request(self, wish: str) -> bool:
        """Begin a dump.

        Args:
            wish: name of the file; empty for the usual one, and completed where it lacks a folder or an ending.

        Returns:
            Whether the dump could be queued; no event tells of it if not, as in cFE.
        """
        if self._job.is_pending:
            return False
        try:
            self._job.file_name = dump_file_name(wish, DEFAULT_FILE)
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
        """The record in a slot of the registry, nothing for a free one, and whether it is the last."""
        table = self._registry.tables.at(number)
        is_last = number >= self._registry.tables.capacity - 1
        if table is None:
            return b"", is_last
        owner = self._ports.es.get_app_name(table.owner) if table.owner else "--UNOWNED--"
        return REGISTRY_RECORD.pack(self._housekeeping.registry_record(table, owner)), is_last

    def _ended(self, event: FileWriteEvent, status: int, record: int, size: int, position: int) -> None:
        path = self._job.file_name
        if event in _FAILURES:
            event_id, text = _FAILURES[event]
            self._send(event_id, ev.ERROR, f"{text.format(path)}, Status=0x{status & 0xFFFFFFFF:08X}")
        elif self._existed:
            text = f"Successfully overwrote '{path}' with Table Registry:Size={position},Entries={record}"
            self._send(ev.OVERWRITE_REG_DUMP_INF_EID, ev.DEBUG, text)
        else:
            text = f"Successfully dumped Table Registry to '{path}':Size={position},Entries={record}"
            self._send(ev.WRITE_REG_DUMP_INF_EID, ev.DEBUG, text)

    def _send(self, event_id: int, event_type: int, text: str) -> None:
        self._ports.evs.send_event_with_app_id(event_id, event_type, self._registry.services_app_id, text)
