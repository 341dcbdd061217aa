"""SCH's commands and its telemetry (sch_cmds.c)."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.msg import BAD_CODE, BAD_LENGTH, BAD_MSG_ID, Command, CommandTable, Dispatch, telemetry

from . import events as ev
from . import packets as pk
from .frames import Frames
from .state import VERSION, SchCounters, Tables


class SchCommands:
    """Executes ground commands.

    Args:
        cfe: the app's handle.
        counters, frames, tables: state that commands change and telemetry reports.
    """

    def __init__(self, cfe: Cfe, counters: SchCounters, frames: Frames, tables: Tables) -> None:
        self._cfe = cfe
        self._counters = counters
        self._frames = frames
        self._tables = tables
        self._table = CommandTable(
            (pk.NOOP, self._noop),
            (pk.RESET, self._reset),
            (pk.ENABLE, lambda packet: self._set_entry(pk.ENABLE, packet)),
            (pk.DISABLE, lambda packet: self._set_entry(pk.DISABLE, packet)),
            (pk.ENABLE_GROUP, lambda packet: self._set_group(pk.ENABLE_GROUP, packet)),
            (pk.DISABLE_GROUP, lambda packet: self._set_group(pk.DISABLE_GROUP, packet)),
            (pk.ENABLE_SYNC, self._enable_sync),
            (pk.SEND_DIAG_TLM, self._send_diagnostics),
            (pk.SEND_HK, self._send_housekeeping),
        )

    def handle(self, packet: bytes) -> None:
        """Handle a message, or report the reason for refusing it to the ground.

        Raises:
            CfeError: a table is no longer available.
        """
        evs = self._cfe.evs
        done = self._table.dispatch(packet)
        if done.outcome == BAD_MSG_ID:
            evs.send_err(ev.MD_ERR_EID, f"Msg with Invalid message ID Rcvd -- ID = 0x{done.msg_id:04X}")
        elif done.outcome == BAD_CODE:
            self._counters.commands_failed += 1
            text = f"Invalid command code: ID = 0x{done.msg_id:04X}, CC = {done.fcn_code}"
            evs.send_err(ev.CC_ERR_EID, text)
        elif done.outcome == BAD_LENGTH:
            self._bad_length(done)

    def _bad_length(self, done: Dispatch) -> None:
        what = f"ID = 0x{done.msg_id:04X}, CC = {done.fcn_code}, Exp Len = {done.expected}, Len = {done.length}"
        self._cfe.evs.send_err(ev.CMD_LEN_ERR_EID, f"Cmd Msg with Bad length Rcvd: {what}")
        if done.msg_id == pk.SEND_HK_MID:
            self._tables.renew()
        else:
            self._counters.commands_failed += 1

    # -- commands --------------------------------------------------------------------------------------------------

    def _noop(self, packet: bytes) -> None:
        self._counters.commands_done += 1
        self._cfe.evs.send_info(ev.NOOP_CMD_EID, f"NO-op command. Version {VERSION}")

    def _reset(self, packet: bytes) -> None:
        self._counters.reset()
        frames = self._frames
        frames.valid_count = frames.missed_count = frames.unexpected_count = 0
        self._cfe.evs.send_dbg(ev.RESET_CMD_EID, "RESET command")

    def _set_entry(self, command: Command, packet: bytes) -> None:
        evs, values = self._cfe.evs, command.read(packet)
        slot, entry = values["SlotNumber"], values["EntryNumber"]
        enable = command is pk.ENABLE
        name = "ENABLE" if enable else "DISABLE"
        if slot >= pk.SLOTS or entry >= pk.ENTRIES_PER_SLOT:
            self._counters.commands_failed += 1
            what = f"slot={slot} (<{pk.SLOTS}), entry={entry} (<{pk.ENTRIES_PER_SLOT})"
            event_id = ev.ENABLE_CMD_ARG_ERR_EID if enable else ev.DISABLE_CMD_ARG_ERR_EID
            evs.send_err(event_id, f"{name} cmd: invalid argument, {what}")
            return
        state = self._tables.state(slot, entry)
        if state not in (pk.ENABLED, pk.DISABLED):
            self._counters.commands_failed += 1
            event_id = ev.ENABLE_CMD_ENTRY_ERR_EID if enable else ev.DISABLE_CMD_ENTRY_ERR_EID
            evs.send_err(event_id, f"{name} command: invalid state = {state}, slot = {slot}, entry = {entry}")
            return
        self._tables.set_states([(slot, entry)], pk.ENABLED if enable else pk.DISABLED)
        self._counters.commands_done += 1
        event_id = ev.ENABLE_CMD_EID if enable else ev.DISABLE_CMD_EID
        evs.send_dbg(event_id, f"{name} command: slot = {slot}, entry = {entry}")

    def _set_group(self, command: Command, packet: bytes) -> None:
        evs, groups = self._cfe.evs, command.read(packet)["GroupData"]
        enable = command is pk.ENABLE_GROUP
        name = "ENABLE GROUP" if enable else "DISABLE GROUP"
        members = self._tables.members_of(groups)
        if not groups:
            self._counters.commands_failed += 1
            event_id = ev.ENA_GRP_CMD_ERR_EID if enable else ev.DIS_GRP_CMD_ERR_EID
            evs.send_err(event_id, f"{name} command: invalid argument, no groups selected")
        elif not members:
            self._counters.commands_failed += 1
            event_id = ev.ENA_GRP_NOT_FOUND_ERR_EID if enable else ev.DIS_GRP_NOT_FOUND_ERR_EID
            what = f"Neither Group {groups >> 24} nor Multi-Group 0x{groups & pk.MULTI_GROUP_MASK:06X} found"
            evs.send_err(event_id, f"{name} command: {what}")
        else:
            self._tables.set_states(members, pk.ENABLED if enable else pk.DISABLED)
            self._counters.commands_done += 1
            event_id = ev.ENA_GRP_CMD_EID if enable else ev.DIS_GRP_CMD_EID
            evs.send_dbg(event_id, f"{name} command: match count = {len(members)}")

    def _enable_sync(self, packet: bytes) -> None:
        self._frames.trust_again()
        self._counters.commands_done += 1
        self._cfe.evs.send_dbg(ev.ENA_SYNC_CMD_EID, "Major Frame Synchronization Enabled")

    # -- telemetry -------------------------------------------------------------------------------------------------

    def _send_diagnostics(self, packet: bytes) -> None:
        self._cfe.sb.transmit_msg(telemetry(pk.DIAG_TLM_MID, self._tables.diagnostics()))
        self._counters.commands_done += 1
        self._cfe.evs.send_dbg(ev.SEND_DIAG_CMD_EID, "Transmitting Diagnostic Message")

    def _send_housekeeping(self, packet: bytes) -> None:
        """Also lets filtered events out again, and Table Services at the tables."""
        counters, frames = self._counters, self._frames
        packet = pk.HK_TLM.packet(
            CmdCounter=counters.commands_done & 0xFF,
            ErrCounter=counters.commands_failed & 0xFF,
            SyncToMET=frames.sync_to_met,
            MajorFrameSource=frames.source,
            ScheduleActivitySuccessCount=counters.activities_done & 0xFFFFFFFF,
            ScheduleActivityFailureCount=counters.activities_failed & 0xFFFFFFFF,
            SlotsProcessedCount=counters.slots_processed & 0xFFFFFFFF,
            SkippedSlotsCount=counters.skipped_slots & 0xFFFF,
            MultipleSlotsCount=counters.multiple_slots & 0xFFFF,
            SameSlotCount=counters.same_slot & 0xFFFF,
            BadTableDataCount=counters.bad_table_data & 0xFFFF,
            TableVerifySuccessCount=counters.tables_good & 0xFFFF,
            TableVerifyFailureCount=counters.tables_bad & 0xFFFF,
            TablePassCount=counters.table_passes & 0xFFFFFFFF,
            ValidMajorFrameCount=frames.valid_count & 0xFFFFFFFF,
            MissedMajorFrameCount=frames.missed_count & 0xFFFFFFFF,
            UnexpectedMajorFrameCount=frames.unexpected_count & 0xFFFFFFFF,
            MinorFramesSinceTone=frames.since_tone,
            NextSlotNumber=frames.following,
            LastSyncMETSlot=frames.last_sync_met_slot,
            IgnoreMajorFrame=frames.ignored,
            UnexpectedMajorFrame=frames.unexpected,
        )
        self._cfe.sb.transmit_msg(packet)
        self._cfe.evs.reset_all_filters()
        self._tables.renew()
