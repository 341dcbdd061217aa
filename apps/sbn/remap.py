"""The filter Remap: replaces or drops MsgIds on the way to and from a peer (sbn_f_remap.c)."""

from __future__ import annotations

from typing import Any

from cfepy.app import Cfe
from cfepy.msg import get_msg_id, set_msg_id
from cfepy.status import CFE_TBL_INFO_UPDATED, CfeError

from . import events as ev
from . import packets as pk

Key = tuple[int, int, int]
"""Processor, spacecraft, MsgId."""


class Remap:
    """The filter, with its table.

    Args:
        cfe: the app's handle.
        base_eid: base of its event ids.
    """

    def __init__(self, cfe: Cfe, base_eid: int) -> None:
        self._cfe = cfe
        self._base_eid = base_eid
        self._to: dict[Key, int] = {}
        self._from: dict[Key, int] = {}
        self._sends_others = False
        self._handle: int | None = None

    def load(self) -> None:
        """Register the table and load it from its file. Without a table, nothing passes."""
        tbl, table = self._cfe.tbl, pk.REMAP_TABLE
        try:
            self._handle = tbl.register(table.own_name, table.size, validate=_validate)
            tbl.load(self._handle, table.file)
            tbl.notify_by_message(self._handle, pk.CMD_MID, pk.TBL.code or 0, 0)
            self._take()
        except CfeError:
            text = f"unable to load remap tbl {table.file}"
            self._cfe.evs.send_err(self._base_eid + ev.REMAP_TBL_EID, text)
            return
        self._cfe.evs.send_info(self._base_eid, "SBN_F_Remap Lib Initialized.")

    def manage(self) -> None:
        """Take a table that the ground has loaded."""
        if self._handle is not None and self._cfe.tbl.manage(self._handle) == CFE_TBL_INFO_UPDATED:
            self._take()

    def unload(self) -> None:
        """Give the table back."""
        if self._handle is not None:
            self._cfe.tbl.unregister(self._handle)
            self._handle = None

    def _take(self) -> None:
        assert self._handle is not None
        image, _ = self._cfe.tbl.get_address(self._handle)
        table: dict[str, Any] = pk.REMAP.unpack(image)
        self._cfe.tbl.release_address(self._handle)
        self._sends_others = table["RemapDefaultFlag"] == pk.REMAP_DEFAULT_SEND
        self._to, self._from = {}, {}
        for entry in table["Entries"]:
            peer = entry["ProcessorID"], entry["SpacecraftID"]
            if not entry["FromMID"]:
                break
            self._to.setdefault((*peer, entry["FromMID"]), entry["ToMID"])
            self._from.setdefault((*peer, entry["ToMID"]), entry["FromMID"])

    def filter(self, packet: bytes, processor_id: int, spacecraft_id: int) -> bytes | None:
        """Return the filtered packet to or from a peer, or None if it is dropped."""
        msg_id = get_msg_id(packet)
        other = self._to.get((processor_id, spacecraft_id, msg_id), msg_id if self._sends_others else 0)
        if not other or other == msg_id:
            return packet if other else None
        changed = bytearray(packet)
        set_msg_id(changed, other)
        return bytes(changed)

    def wanted(self, msg_id: int, processor_id: int, spacecraft_id: int) -> int:
        """Return the MsgId on this processor's bus for a MsgId that a peer subscribes to."""
        return self._from.get((processor_id, spacecraft_id, msg_id), msg_id)


def _validate(table: memoryview) -> int:
    flag = pk.REMAP.unpack(table)["RemapDefaultFlag"]
    return 0 if flag in (pk.REMAP_DEFAULT_IGNORE, pk.REMAP_DEFAULT_SEND) else -1
