"""Critical tables: their image is kept in the Critical Data Store and restored after a processor reset.

Each has its own CDS block under the table's name. The critical table registry has the file and time of the load. It is
a CDS block too ("CFE_TBL.CritReg"). The module replaces the critical part of cfe_tbl_internal.c.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

from cfepy.config.platform import PlatformConfig
from cfepy.ids import UNDEFINED
from cfepy.msg import sys_time_fields
from cfepy.ports import Ports
from cfepy.status import (
    CFE_ES_CDS_ALREADY_EXISTS,
    CFE_SUCCESS,
    CFE_TBL_ERR_NEVER_LOADED,
    CFE_TBL_INFO_RECOVERED_TBL,
    CfeError,
)
from cfepy.tbl.packets import CRITICAL_RECORD
from cfepy.tbl.registry import TableRecord, TableRegistry

REGISTRY_NAME = "CFE_TBL.CritReg"


_REMEMBERED = 128  # the whole registry is written whenever one of its records changes


@lru_cache(_REMEMBERED)
def _packed(
    handle: int,
    name: str,
    file_time: tuple[int, int],
    last_update: tuple[int, int],
    last_file: str,
    loaded_once: bool,
) -> bytes:
    return CRITICAL_RECORD.pack(
        CDSHandle=handle,
        FileTime=sys_time_fields(file_time),
        TimeOfLastUpdate=sys_time_fields(last_update),
        LastFileLoaded=last_file,
        Name=name,
        TableLoadedOnce=loaded_once,
    )


@dataclass(slots=True, eq=False)
class CriticalRecord:
    """A record of the registry (CFE_TBL_CritRegRec_t); `handle` is 0 in a free one."""

    handle: int = 0
    name: str = ""
    file_time: tuple[int, int] = (0, 0)
    last_update: tuple[int, int] = (0, 0)
    last_file: str = ""
    loaded_once: bool = False

    def begin(self, handle: int, name: str) -> None:
        """Become the record of a new table; as in cFE, `loaded_once` stays unchanged."""
        self.handle, self.name = handle, name
        self.file_time = self.last_update = (0, 0)
        self.last_file = ""

    def pack(self) -> bytes:
        """Return its bytes in the CDS."""
        return _packed(self.handle, self.name, self.file_time, self.last_update, self.last_file, self.loaded_once)

    def unpack(self, data: bytes, at: int) -> None:
        """Read the record from bytes of the CDS."""
        values = CRITICAL_RECORD.unpack(data, at)
        self.handle, self.name = values["CDSHandle"], values["Name"]
        self.file_time = values["FileTime"]["Seconds"], values["FileTime"]["Subseconds"]
        self.last_update = values["TimeOfLastUpdate"]["Seconds"], values["TimeOfLastUpdate"]["Subseconds"]
        self.last_file, self.loaded_once = values["LastFileLoaded"], values["TableLoadedOnce"]


class CriticalTables:
    """The critical table registry of a mission.

    Args:
        ports: provides the CDS and the system log.
        config: the maximum number of critical tables, and the release.
        registry: provides the tables' buffers.
    """

    def __init__(self, ports: Ports, config: PlatformConfig, registry: TableRegistry) -> None:
        self._ports = ports
        self._registry = registry
        self._loads_stay = config.release.load_of_recovered_table_stays
        self._records = [CriticalRecord() for _ in range(config.tbl_max_critical_tables)]
        self._handle = 0

    def early_init(self) -> None:
        """Find the registry in the CDS, or create it; without a CDS there are no critical tables."""
        size = len(self._records) * CRITICAL_RECORD.size
        try:
            self._handle, status = self._ports.es.register_cds_ex(size, REGISTRY_NAME, critical_table=True)
        except CfeError as error:
            self._log("EarlyInit", f"Failed to create Critical Table Registry (Err={error.hex})")
            return
        if status != CFE_ES_CDS_ALREADY_EXISTS:
            self._save("EarlyInit", "Failed to save Critical Table Registry")
            return
        try:
            data = self._ports.es.restore_from_cds(self._handle)
        except CfeError as error:
            self._log("EarlyInit", f"Failed to recover Critical Table Registry (Err={error.hex})")
            return
        for number, record in enumerate(self._records):
            record.unpack(data, number * CRITICAL_RECORD.size)

    def register(self, table: TableRecord) -> int:
        """Make a new table critical, and restore its valid image from before a reset, if there is one.

        Returns:
            CFE_SUCCESS, or CFE_TBL_INFO_RECOVERED_TBL.

        Raises:
            CfeError: if the CDS has no room for it, or there is no CDS; the table then stays an ordinary one.
        """
        handle, status = self._ports.es.register_cds_ex(table.size, table.name, critical_table=True)
        table.cds_handle, table.critical = handle, True
        if status == CFE_ES_CDS_ALREADY_EXISTS and self._restore(table):
            return CFE_TBL_INFO_RECOVERED_TBL
        record = self._of(0)
        if record is None:
            function = "RegisterWithCriticalTableRegistry"
            self._log(function, f"Failed to find a free Crit Tbl Reg Rec for '{table.name}'")
        else:
            record.begin(handle, table.name)
            self._save("RegisterWithCriticalTableRegistry", "Unable to update Critical Table Registry in CDS")
        return CFE_SUCCESS

    def _restore(self, table: TableRecord) -> bool:
        """Restore a table's image from the CDS (CFE_TBL_RestoreTableDataFromCDS); return False if there is none.

        As in cFE, the size of the content is not set. So until the next load the CRC of the restored image is 0, the
        CRC of no bytes, and a dump is empty. If there is no image, and always with release 7.0.0, the load begun for it
        stays in progress.
        """
        function = "RestoreTableDataFromCDS"
        buffer = self._registry.working_buffer(table)
        if buffer is None:
            return False
        try:
            table.image(buffer)[:] = self._ports.es.restore_from_cds(table.cds_handle)
        except CfeError as error:
            self._log(function, f"Failed to recover '{table.name}' from CDS (ErrCode={error.hex})")
            return False
        record = self._of(table.cds_handle)
        if record is None or not record.loaded_once:
            self._log(function, f"Failed to recover '{table.name}' info from CDS TblReg")
            return False
        buffer.source, buffer.file_time = record.last_file, record.file_time
        table.set_active(buffer)
        if not self._loads_stay:
            table.next_id = UNDEFINED
        table.note_load(record.last_file, record.last_update)
        buffer.recompute_crc()
        table.tell_users()
        return True

    def save(self, table: TableRecord) -> None:
        """Save the active image of a critical table; a failure is logged and does not affect the table."""
        active, function = self._registry.active(table), "UpdateCriticalTblCDS"
        try:
            if active is None:
                raise CfeError(CFE_TBL_ERR_NEVER_LOADED, f"{table.name!r} was never loaded")
            self._ports.es.copy_to_cds(table.cds_handle, table.image(active))
        except CfeError as error:
            self._log(function, f"Unable to update Critical Table '{table.name}' in CDS (Err={error.hex})")
            return
        record = self._of(table.cds_handle)
        if record is None:
            self._log(function, f"Error finding '{table.name}' in Critical Table Registry")
            return
        record.file_time, record.last_update = active.file_time, table.last_update
        record.last_file, record.loaded_once = table.last_file, True
        self._save(function, "Unable to update Critical Table Registry in CDS")

    def find(self, name: str) -> CriticalRecord | None:
        """Return the record of a table's full name, even after its CDS was deleted, or None."""
        return next((record for record in self._records if record.name == name), None)

    def delete(self, record: CriticalRecord) -> None:
        """Delete the CDS of a table that is no longer registered; the registry is written with its next change.

        Raises:
            CfeError: CFE_ES_CDS_WRONG_TYPE_ERR, CFE_ES_CDS_OWNER_ACTIVE_ERR, CFE_ES_ERR_NAME_NOT_FOUND.
        """
        self._ports.es.delete_cds(record.name, called_by_tbl_services=True)
        record.handle = 0

    def _of(self, handle: int) -> CriticalRecord | None:
        return next((record for record in self._records if record.handle == handle), None)

    def _save(self, function: str, complaint: str) -> None:
        try:
            self._ports.es.copy_to_cds(self._handle, b"".join(record.pack() for record in self._records))
        except CfeError as error:
            self._log(function, f"{complaint} (Err={error.hex})")

    def _log(self, function: str, text: str) -> None:
        self._ports.syslog.write_to_sys_log(f"CFE_TBL_{function}: {text}")
