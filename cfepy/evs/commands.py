"""The ground commands of Event Services: dispatch, and those about all applications (cfe_evs_task.c).

A handler returns True when it did what the command says, False when it refused, None when the command is not to be
counted. Commands about one application are in `cfepy.evs.app_commands`. Imports no other service.
"""

from __future__ import annotations

from cfepy.evs import events as ev
from cfepy.evs import packets as pk
from cfepy.evs.app_commands import AppCommands
from cfepy.evs.core import EventCore
from cfepy.evs.files import EventFiles
from cfepy.evs.log import DISCARD, OVERWRITE
from cfepy.evs.replies import Replies
from cfepy.evs.telemetry import housekeeping
from cfepy.msg import CommandTable, Dispatch
from cfepy.msg.dispatch import BAD_CODE, BAD_MSG_ID, DONE
from cfepy.versions import version_string


class EvsCommands:
    """Handles the packets of the command pipe.

    Args:
        core: the state that commands change.
        files: the commands that write files.

    Attributes:
        count: commands that were done.
        errors: commands that were refused.
    """

    def __init__(self, core: EventCore, files: EventFiles) -> None:
        self.count = 0
        self.errors = 0
        self._core = core
        self._replies = Replies(core)
        self._table = CommandTable(
            (pk.SEND_HK, self._send_housekeeping),
            (pk.NOOP, self._noop),
            (pk.RESET_COUNTERS, self._reset_counters),
            (pk.SET_EVENT_FORMAT_MODE, self._set_format),
            (pk.SET_LOG_MODE, self._set_log_mode),
            (pk.CLEAR_LOG, self._clear_log),
            (pk.ENABLE_EVENT_TYPE, self._enable_types),
            (pk.DISABLE_EVENT_TYPE, self._disable_types),
            (pk.ENABLE_PORTS, self._enable_ports),
            (pk.DISABLE_PORTS, self._disable_ports),
            (pk.WRITE_APP_DATA_FILE, files.write_app_data),
            (pk.WRITE_LOG_DATA_FILE, files.write_log),
        )
        AppCommands(core, self._replies).add_to(self._table)

    def process(self, packet: bytes) -> None:
        """Handle one packet of the pipe (CFE_EVS_ProcessCommandPacket)."""
        done = self._table.dispatch(packet)
        if done.outcome != DONE:
            self._reject(done)
        elif done.result is not None:
            self.count += bool(done.result)
            self.errors += not done.result

    def _reject(self, done: Dispatch) -> None:
        self.errors += 1
        if done.outcome == BAD_MSG_ID:
            self._replies.refuse(ev.ERR_MSGID_EID, f"Invalid command packet, Message ID = 0x{done.msg_id:08X}")
        elif done.outcome == BAD_CODE:
            text = f"Invalid command code -- ID = 0x{done.msg_id:08x}, CC = {done.fcn_code}"
            self._replies.refuse(ev.ERR_CC_EID, text)
        else:
            self._replies.refuse(ev.LEN_ERR_EID, done.length_text())

    def _noop(self, packet: bytes) -> bool:
        self._core.send_own(ev.NOOP_EID, ev.INFORMATION, f"No-op Cmd Rcvd: {version_string('CFE_EVS')}")
        return True

    def _reset_counters(self, packet: bytes) -> None:
        core = self._core
        self.count = self.errors = core.sent = core.truncated = core.unregistered_count = 0
        self._replies.done(ev.RSTCNT_EID, "Reset Counters Command Received")

    def _send_housekeeping(self, packet: bytes) -> None:
        fields = housekeeping(self._core, self.count, self.errors)
        self._core.ports.sb.transmit_msg(pk.HK_TLM.packet(fields))

    def _set_format(self, packet: bytes) -> bool:
        mode = pk.SET_EVENT_FORMAT_MODE.read(packet)["MsgFormat"]
        if mode not in (pk.FORMAT_SHORT, pk.FORMAT_LONG):
            text = f"Set Event Format Mode Command: Invalid Event Format Mode = 0x{mode:02x}"
            return self._replies.refuse(ev.ERR_ILLEGALFMTMOD_EID, text)
        self._core.format_mode = mode
        text = f"Set Event Format Mode Command Received with Mode = 0x{mode:02x}"
        return self._replies.done(ev.SETEVTFMTMOD_EID, text)

    def _set_log_mode(self, packet: bytes) -> bool:
        mode = pk.SET_LOG_MODE.read(packet)["LogMode"]
        if mode not in (OVERWRITE, DISCARD):
            return self._replies.refuse(ev.ERR_LOGMODE_EID, f"Set Log Mode Command Error: Log Mode = {mode}")
        self._core.log.mode = mode
        return self._replies.done(ev.LOGMODE_EID, f"Set Log Mode Command: Log Mode = {mode}")

    def _clear_log(self, packet: bytes) -> bool:
        self._core.log.clear()
        return True

    def _enable_types(self, packet: bytes) -> bool:
        mask = pk.ENABLE_EVENT_TYPE.read(packet)["BitMask"]
        if not self._replies.is_mask(mask, pk.ENABLE_EVENT_TYPE_CC):
            return False
        for app in self._core.apps.values():
            app.types |= mask
        text = f"Enable Event Type Command Received with Event Type Bit Mask = 0x{mask:02x}"
        return self._replies.done(ev.ENAEVTTYPE_EID, text)

    def _disable_types(self, packet: bytes) -> bool:
        mask = pk.DISABLE_EVENT_TYPE.read(packet)["BitMask"]
        if not self._replies.is_mask(mask, pk.DISABLE_EVENT_TYPE_CC):
            return False
        for app in self._core.apps.values():
            app.types &= ~mask
        text = f"Disable Event Type Command Received with Event Type Bit Mask = 0x{mask:02x}"
        return self._replies.done(ev.DISEVTTYPE_EID, text)

    def _enable_ports(self, packet: bytes) -> bool:
        mask = pk.ENABLE_PORTS.read(packet)["BitMask"]
        if not self._replies.is_mask(mask, pk.ENABLE_PORTS_CC):
            return False
        self._core.ports_mask |= mask
        return self._replies.done(ev.ENAPORT_EID, f"Enable Ports Command Received with Port Bit Mask = 0x{mask:02x}")

    def _disable_ports(self, packet: bytes) -> bool:
        mask = pk.DISABLE_PORTS.read(packet)["BitMask"]
        if not self._replies.is_mask(mask, pk.DISABLE_PORTS_CC):
            return False
        self._core.ports_mask &= ~mask
        return self._replies.done(ev.DISPORT_EID, f"Disable Ports Command Received with Port Bit Mask = 0x{mask:02x}")
