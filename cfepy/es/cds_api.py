"""The Critical Data Store as applications, Table Services and ground commands use it (CFE_ES_*CDS*).

Imports only cfepy.ids, cfepy.status and its neighbours here.
"""

from __future__ import annotations

from cfepy.es import events as ev
from cfepy.es.cds import CriticalDataStore
from cfepy.es.cds_registry import CdsBlock
from cfepy.es.tables import EsCore
from cfepy.ids import name_size
from cfepy.status import (
    CFE_ES_CDS_INVALID_NAME,
    CFE_ES_CDS_INVALID_SIZE,
    CFE_ES_CDS_OWNER_ACTIVE_ERR,
    CFE_ES_CDS_WRONG_TYPE_ERR,
    CFE_ES_ERR_RESOURCEID_NOT_VALID,
    CFE_ES_NOT_IMPLEMENTED,
    CFE_SUCCESS,
    CfeError,
)

MAX_NAME_LENGTH = 16
"""Characters of a block's own name (CFE_MISSION_ES_CDS_MAX_NAME_LENGTH)."""


class CdsHandle(int):
    """A CDS handle; an int with what CFE_ES_RegisterCDS had to say.

    Attributes:
        status: CFE_SUCCESS for a new block, CFE_ES_CDS_ALREADY_EXISTS for one that may hold data from before.
    """

    status: int = CFE_SUCCESS

    @classmethod
    def with_status(cls, handle: int, status: int) -> CdsHandle:
        """A handle and its status in one."""
        made = cls(handle)
        made.status = status
        return made


class CdsApi(EsCore):
    """The CDS part of Executive Services."""

    cds: CriticalDataStore | None = None

    def cds_early_init(self) -> None:
        """Find or make the CDS, before any task runs (CFE_ES_CDS_EarlyInit)."""
        self.cds = CriticalDataStore(self.psp, self.config.es_cds_max_num_entries, self.write_to_sys_log)
        self.cds.early_init()

    def register_cds(self, block_size: int, name: str) -> CdsHandle:
        """Reserve a block for the calling application, or find it as it was before a reset (CFE_ES_RegisterCDS).

        Args:
            block_size: bytes. Another size than before makes a new block.
            name: at most 16 characters; the full name is "APP.name".

        Returns:
            The handle; `handle.status` is CFE_SUCCESS or CFE_ES_CDS_ALREADY_EXISTS.

        Raises:
            CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID (the caller is no application), CFE_ES_NOT_IMPLEMENTED (there is
                no CDS), CFE_ES_CDS_INVALID_NAME, CFE_ES_CDS_INVALID_SIZE, CFE_ES_NO_RESOURCE_IDS_AVAILABLE,
                CFE_ES_ERR_MEM_BLOCK_SIZE; an event tells the ground too.
        """
        app = self.app_of_caller()
        if app is None:
            self.write_to_sys_log("CFE_ES_RegisterCDS: Bad AppId context")
            raise CfeError(CFE_ES_ERR_RESOURCEID_NOT_VALID, "CDS blocks belong to applications")
        try:
            return self._register(block_size, name, app.name)
        except CfeError as error:
            text = f"{app.name} Failed to Register CDS '{name}', Status={error.hex}"
            self.ports.evs.send_event_with_app_id(ev.CDS_REGISTER_ERR_EID, ev.ERROR, app.app_id, text)
            raise

    def _register(self, block_size: int, name: str, app_name: str) -> CdsHandle:
        if self.cds is None or not self.cds.is_available:
            self.write_to_sys_log("CFE_ES_RegisterCDS: CDS not available")
        elif not 0 < name_size(name) <= MAX_NAME_LENGTH:
            self.write_to_sys_log(f"CFE_ES_RegisterCDS: CDS Name ({name}) is either too long, or an empty string")
            raise CfeError(CFE_ES_CDS_INVALID_NAME, f"CDS name {name!r}: 1 to {MAX_NAME_LENGTH} characters")
        try:
            handle, status = self.register_cds_ex(block_size, f"{app_name}.{name}", critical_table=False)
            return CdsHandle.with_status(handle, status)
        except CfeError as error:
            if error.status == CFE_ES_CDS_INVALID_SIZE:
                self.write_to_sys_log(f"CFE_ES_RegisterCDS: CDS {name} has invalid size ({block_size})")
            raise

    def register_cds_ex(self, block_size: int, full_name: str, critical_table: bool) -> tuple[int, int]:
        """Reserve or find a block under its full name (CFE_ES_RegisterCDSEx).

        Args:
            block_size: bytes.
            full_name: "APP.Name".
            critical_table: whether Table Services keep a table in it.

        Returns:
            The handle, and CFE_SUCCESS or CFE_ES_CDS_ALREADY_EXISTS.

        Raises:
            CfeError: as `register_cds`.
        """
        return self._store().register(block_size, full_name, critical_table)

    def copy_to_cds(self, handle: int, data: bytes | bytearray | memoryview) -> None:
        """Save a block's data (CFE_ES_CopyToCDS).

        Args:
            handle: of the block.
            data: as many bytes as the block has.

        Raises:
            CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID, CFE_ES_BAD_ARGUMENT (another number of bytes),
                CFE_ES_POOL_BLOCK_INVALID, CFE_ES_CDS_INVALID_SIZE (the block is damaged).
        """
        self._store().write(handle, data)

    def restore_from_cds(self, handle: int) -> bytes:
        """A block's data as they were saved (CFE_ES_RestoreFromCDS).

        Raises:
            CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID, CFE_ES_CDS_BLOCK_CRC_ERR (the data are damaged),
                CFE_ES_POOL_BLOCK_INVALID, CFE_ES_CDS_INVALID_SIZE (the block is).
        """
        return self._store().read(handle)

    def get_cds_block_id_by_name(self, full_name: str) -> int:
        """Handle of a block, by its full name, or CFE_ES_ERR_NAME_NOT_FOUND (CFE_ES_GetCDSBlockIDByName)."""
        return self._store().named(full_name).handle

    def get_cds_block_name(self, handle: int) -> str:
        """Full name of a block, or CFE_ES_ERR_RESOURCEID_NOT_VALID (CFE_ES_GetCDSBlockName)."""
        return self._store().get(handle).name

    def delete_cds(self, full_name: str, called_by_tbl_services: bool = False) -> None:
        """Delete a block whose owner is gone (CFE_ES_DeleteCDS).

        Args:
            full_name: "APP.Name".
            called_by_tbl_services: who deletes; critical tables are theirs, all else is not.

        Raises:
            CfeError: CFE_ES_ERR_NAME_NOT_FOUND, CFE_ES_CDS_WRONG_TYPE_ERR, CFE_ES_CDS_OWNER_ACTIVE_ERR.
        """
        store = self._store()
        block = store.named(full_name)
        if block.is_table != called_by_tbl_services:
            raise CfeError(CFE_ES_CDS_WRONG_TYPE_ERR, f"{full_name!r} is {'' if block.is_table else 'not '}a table's")
        owner = full_name.partition(".")[0]
        if self.app_named(owner) is not None:
            raise CfeError(CFE_ES_CDS_OWNER_ACTIVE_ERR, f"{owner} still runs")
        store.delete(full_name)

    def cds_blocks(self) -> list[CdsBlock]:
        """What is in the CDS, in the order of its registry; nothing when there is no CDS."""
        return [] if self.cds is None else list(self.cds)

    def _store(self) -> CriticalDataStore:
        if self.cds is None or not self.cds.is_available:
            raise CfeError(CFE_ES_NOT_IMPLEMENTED, "this processor has no Critical Data Store")
        return self.cds
