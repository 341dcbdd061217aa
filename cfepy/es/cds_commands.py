"""Commands for the critical data store (CFE_ES_DeleteCDSCmd, CFE_ES_DumpCDSRegistryCmd)."""

from __future__ import annotations

from cfepy.es import events as ev
from cfepy.es import packets as pk
from cfepy.es.cds_registry import CdsBlock
from cfepy.es.command_group import CommandGroup, Handlers
from cfepy.es.dump_files import CDS_REGISTRY_FILE, write_dump
from cfepy.status import (
    CFE_ES_CDS_OWNER_ACTIVE_ERR,
    CFE_ES_CDS_WRONG_TYPE_ERR,
    CFE_ES_ERR_NAME_NOT_FOUND,
    CfeError,
)

# Why a block cannot be deleted, to the event that says so.
_REFUSALS = {
    CFE_ES_CDS_WRONG_TYPE_ERR: (
        ev.CDS_DELETE_TBL_ERR_EID,
        "CDS '{name}' is a Critical Table CDS. Must be deleted via TBL Command",
    ),
    CFE_ES_CDS_OWNER_ACTIVE_ERR: (
        ev.CDS_OWNER_ACTIVE_EID,
        "CDS '{name}' not deleted because owning app is active",
    ),
    CFE_ES_ERR_NAME_NOT_FOUND: (ev.CDS_NAME_ERR_EID, "Unable to locate '{name}' in CDS Registry"),
}
_OTHER_REFUSAL = (ev.CDS_DELETE_ERR_EID, "Error while deleting '{name}' from CDS, See SysLog.(Err={status})")


class CdsCommands(CommandGroup):
    """The critical data store."""

    def handlers(self) -> Handlers:
        return (pk.DELETE_CDS, self._delete), (pk.DUMP_CDS_REGISTRY, self._dump_registry)

    def _delete(self, packet: bytes) -> None:
        name = pk.DELETE_CDS.read(packet)["CdsName"]
        try:
            self._es.delete_cds(name)
        except CfeError as error:
            event, text = _REFUSALS.get(error.status, _OTHER_REFUSAL)
            self._replies.reject(event, text.format(name=name, status=error.hex))
            return
        self._replies.accept(ev.CDS_DELETED_INFO_EID, f"Successfully removed '{name}' from CDS")

    def _dump_registry(self, packet: bytes) -> None:
        name = pk.DUMP_CDS_REGISTRY.read(packet)["DumpFilename"]
        write_dump(self._es, self._replies, CDS_REGISTRY_FILE, name, map(_record, self._es.cds_blocks()))


def _record(block: CdsBlock) -> bytes:
    return pk.CDS_REG_DUMP_RECORD.pack(Handle=block.handle, Size=block.user_size, Table=block.is_table, Name=block.name)
