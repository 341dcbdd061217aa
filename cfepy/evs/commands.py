"""The ground commands of Event Services: event types, ports, filters, format, log (cfe_evs_task.c, cfe_evs_dispatch.c).

A handler returns True when it did what the command says, False when it refused, None when the command is not to be
counted. Imports no other service.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from cfepy.evs import events as ev
from cfepy.evs import packets as pk
from cfepy.evs.apps import ALL_TYPES, AppEvents
from cfepy.evs.core import EventCore
from cfepy.evs.files import EventFiles
from cfepy.evs.log import DISCARD, OVERWRITE
from cfepy.evs.telemetry import housekeeping
from cfepy.ids import ES_APPID_BASE, get_base
from cfepy.msg import CMD_HEADER_SIZE, CommandTable, Dispatch, Layout, telemetry
from cfepy.msg.dispatch import BAD_CODE, BAD_MSG_ID, DONE
from cfepy.status import CfeError
from cfepy.versions import version_string

Fields = Mapping[str, Any]
Handler = Callable[[Fields], bool | None]
AppHandler = Callable[[AppEvents, str, Fields], bool | None]

_NAME_SIZE = 20
_LOOKUP_PREFIX = {
    pk.CFE_EVS_DISABLE_APP_EVENTS_CC: "Disable App Events Command: ",
    pk.CFE_EVS_RESET_APP_COUNTER_CC: "Reset Event Counter Command: ",
}
"""What two commands say before "Unable to retrieve"."""


class EvsCommands:
    """Handles the packets of the command pipe.

    Args:
        core: the state that commands change.
        write_file: writes bytes to a path; None leaves out the commands that dump to files.

    Attributes:
        count: commands that were done.
        errors: commands that were refused.
    """

    def __init__(self, core: EventCore, write_file: Callable[[str, bytes], object] | None) -> None:
        self.count = 0
        self.errors = 0
        self._core = core
        self._table = CommandTable()
        self._table.add_message(pk.CFE_EVS_SEND_HK_MID, CMD_HEADER_SIZE, self._send_housekeeping)
        self._add_general()
        self._add_for_apps()
        if write_file is not None:
            files = EventFiles(core, write_file)
            self._add(pk.CFE_EVS_WRITE_APP_DATA_FILE_CC, pk.FILE_COMMAND, files.write_app_data)
            self._add(pk.CFE_EVS_WRITE_LOG_DATA_FILE_CC, pk.FILE_COMMAND, files.write_log)

    def _add(self, code: int, layout: Layout | None, handler: Handler) -> None:
        size = CMD_HEADER_SIZE + (layout.size if layout is not None else 0)

        def unpack_and_handle(packet: bytes) -> bool | None:
            return handler(layout.unpack(packet, CMD_HEADER_SIZE) if layout is not None else {})

        self._table.add(pk.CFE_EVS_CMD_MID, code, size, unpack_and_handle)

    def _add_general(self) -> None:
        for code, layout, handler in (
            (pk.CFE_EVS_NOOP_CC, None, self._noop),
            (pk.CFE_EVS_RESET_COUNTERS_CC, None, self._reset_counters),
            (pk.CFE_EVS_SET_EVENT_FORMAT_MODE_CC, pk.FORMAT_COMMAND, self._set_format),
            (pk.CFE_EVS_SET_LOG_MODE_CC, pk.LOG_MODE_COMMAND, self._set_log_mode),
            (pk.CFE_EVS_CLEAR_LOG_CC, None, self._clear_log),
            (pk.CFE_EVS_ENABLE_EVENT_TYPE_CC, pk.BIT_MASK_COMMAND, self._enable_types),
            (pk.CFE_EVS_DISABLE_EVENT_TYPE_CC, pk.BIT_MASK_COMMAND, self._disable_types),
            (pk.CFE_EVS_ENABLE_PORTS_CC, pk.BIT_MASK_COMMAND, self._enable_ports),
            (pk.CFE_EVS_DISABLE_PORTS_CC, pk.BIT_MASK_COMMAND, self._disable_ports),
        ):
            self._add(code, layout, handler)

    def _add_for_apps(self) -> None:
        for code, layout, handler in (
            (pk.CFE_EVS_ENABLE_APP_EVENT_TYPE_CC, pk.APP_MASK_COMMAND, self._enable_app_types),
            (pk.CFE_EVS_DISABLE_APP_EVENT_TYPE_CC, pk.APP_MASK_COMMAND, self._disable_app_types),
            (pk.CFE_EVS_ENABLE_APP_EVENTS_CC, pk.APP_COMMAND, self._enable_app),
            (pk.CFE_EVS_DISABLE_APP_EVENTS_CC, pk.APP_COMMAND, self._disable_app),
            (pk.CFE_EVS_RESET_APP_COUNTER_CC, pk.APP_COMMAND, self._reset_app_counter),
            (pk.CFE_EVS_SET_FILTER_CC, pk.APP_FILTER_COMMAND, self._set_filter),
            (pk.CFE_EVS_RESET_FILTER_CC, pk.APP_EVENT_COMMAND, self._reset_filter),
            (pk.CFE_EVS_RESET_ALL_FILTERS_CC, pk.APP_COMMAND, self._reset_all_filters),
            (pk.CFE_EVS_ADD_EVENT_FILTER_CC, pk.APP_FILTER_COMMAND, self._add_filter),
            (pk.CFE_EVS_DELETE_EVENT_FILTER_CC, pk.APP_EVENT_COMMAND, self._delete_filter),
        ):
            self._add(code, layout, self._for_app(code, handler))

    # -- dispatch --------------------------------------------------------------------------------------------------

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
            self._error(ev.CFE_EVS_ERR_MSGID_EID, f"Invalid command packet, Message ID = 0x{done.msg_id:08X}")
        elif done.outcome == BAD_CODE:
            text = f"Invalid command code -- ID = 0x{done.msg_id:08x}, CC = {done.fcn_code}"
            self._error(ev.CFE_EVS_ERR_CC_EID, text)
        else:
            self._error(ev.CFE_EVS_LEN_ERR_EID, done.length_text())

    def _done(self, event_id: int, text: str) -> bool:
        self._core.send_own(event_id, ev.DEBUG, text)
        return True

    def _error(self, event_id: int, text: str) -> bool:
        self._core.send_own(event_id, ev.ERROR, text)
        return False

    def _is_mask(self, mask: int, code: int) -> bool:
        if 0 < mask <= ALL_TYPES:
            return True
        return self._error(ev.CFE_EVS_ERR_INVALID_BITMASK_EID, f"Bit Mask = 0x{mask:08x} out of range: CC = {code}")

    # -- commands about all ----------------------------------------------------------------------------------------

    def _noop(self, fields: Fields) -> bool:
        text = f"No-op Cmd Rcvd: {version_string('CFE_EVS')}"
        self._core.send_own(ev.CFE_EVS_NOOP_EID, ev.INFORMATION, text)
        return True

    def _reset_counters(self, fields: Fields) -> None:
        core = self._core
        self.count = self.errors = core.sent = core.truncated = core.unregistered_count = 0
        self._done(ev.CFE_EVS_RSTCNT_EID, "Reset Counters Command Received")

    def _send_housekeeping(self, packet: bytes) -> None:
        payload = pk.HOUSEKEEPING.pack(housekeeping(self._core, self.count, self.errors))
        self._core.ports.sb.transmit_msg(bytes(telemetry(pk.CFE_EVS_HK_TLM_MID, payload)))

    def _set_format(self, fields: Fields) -> bool:
        mode = fields["MsgFormat"]
        if mode not in (pk.FORMAT_SHORT, pk.FORMAT_LONG):
            text = f"Set Event Format Mode Command: Invalid Event Format Mode = 0x{mode:02x}"
            return self._error(ev.CFE_EVS_ERR_ILLEGALFMTMOD_EID, text)
        self._core.format_mode = mode
        text = f"Set Event Format Mode Command Received with Mode = 0x{mode:02x}"
        return self._done(ev.CFE_EVS_SETEVTFMTMOD_EID, text)

    def _set_log_mode(self, fields: Fields) -> bool:
        mode = fields["LogMode"]
        if mode not in (OVERWRITE, DISCARD):
            return self._error(ev.CFE_EVS_ERR_LOGMODE_EID, f"Set Log Mode Command Error: Log Mode = {mode}")
        self._core.log.mode = mode
        return self._done(ev.CFE_EVS_LOGMODE_EID, f"Set Log Mode Command: Log Mode = {mode}")

    def _clear_log(self, fields: Fields) -> bool:
        self._core.log.clear()
        return True

    def _enable_types(self, fields: Fields) -> bool:
        mask = fields["BitMask"]
        if not self._is_mask(mask, pk.CFE_EVS_ENABLE_EVENT_TYPE_CC):
            return False
        for app in self._core.apps.values():
            app.types |= mask
        text = f"Enable Event Type Command Received with Event Type Bit Mask = 0x{mask:02x}"
        return self._done(ev.CFE_EVS_ENAEVTTYPE_EID, text)

    def _disable_types(self, fields: Fields) -> bool:
        mask = fields["BitMask"]
        if not self._is_mask(mask, pk.CFE_EVS_DISABLE_EVENT_TYPE_CC):
            return False
        for app in self._core.apps.values():
            app.types &= ~mask
        text = f"Disable Event Type Command Received with Event Type Bit Mask = 0x{mask:02x}"
        return self._done(ev.CFE_EVS_DISEVTTYPE_EID, text)

    def _enable_ports(self, fields: Fields) -> bool:
        mask = fields["BitMask"]
        if not self._is_mask(mask, pk.CFE_EVS_ENABLE_PORTS_CC):
            return False
        self._core.ports_mask |= mask
        return self._done(ev.CFE_EVS_ENAPORT_EID, f"Enable Ports Command Received with Port Bit Mask = 0x{mask:02x}")

    def _disable_ports(self, fields: Fields) -> bool:
        mask = fields["BitMask"]
        if not self._is_mask(mask, pk.CFE_EVS_DISABLE_PORTS_CC):
            return False
        self._core.ports_mask &= ~mask
        return self._done(ev.CFE_EVS_DISPORT_EID, f"Disable Ports Command Received with Port Bit Mask = 0x{mask:02x}")

    # -- commands about one application ----------------------------------------------------------------------------

    def _for_app(self, code: int, handler: AppHandler) -> Handler:
        """A handler that looks the named application up first (EVS_GetApplicationInfo)."""

        def find_and_handle(fields: Fields) -> bool | None:
            name = fields["AppName"][: _NAME_SIZE - 1]
            app = self._find(name, code)
            return False if app is None else handler(app, name, fields)

        return find_and_handle

    def _find(self, name: str, code: int) -> AppEvents | None:
        try:
            app_id = self._core.ports.es.get_app_id_by_name(name)
        except CfeError:
            text = f"{_LOOKUP_PREFIX.get(code, '')}Unable to retrieve application ID for {name}: CC = {code}"
            self._error(ev.CFE_EVS_ERR_NOAPPIDFOUND_EID, text)
            return None
        app = self._core.apps.get(app_id)
        if app is None and get_base(app_id) != ES_APPID_BASE:
            text = f"Illegal application ID retrieved for {name}: CC = {code}"
            self._error(ev.CFE_EVS_ERR_ILLAPPIDRANGE_EID, text)
        elif app is None:
            self._error(ev.CFE_EVS_ERR_APPNOREGS_EID, f"{name} not registered with EVS: CC = {code}")
        return app

    def _enable_app_types(self, app: AppEvents, name: str, fields: Fields) -> bool:
        mask = fields["BitMask"]
        if not self._is_mask(mask, pk.CFE_EVS_ENABLE_APP_EVENT_TYPE_CC):
            return False
        app.types |= mask
        text = f"Enable App Event Type Command Received with AppName = {name}, EventType Bit Mask = 0x{mask:02x}"
        return self._done(ev.CFE_EVS_ENAAPPEVTTYPE_EID, text)

    def _disable_app_types(self, app: AppEvents, name: str, fields: Fields) -> bool:
        mask = fields["BitMask"]
        if not self._is_mask(mask, pk.CFE_EVS_DISABLE_APP_EVENT_TYPE_CC):
            return False
        app.types &= ~mask
        text = f"Disable App Event Type Command Received with AppName = {name}, EventType Bit Mask = 0x{mask:02x}"
        return self._done(ev.CFE_EVS_DISAPPENTTYPE_EID, text)

    def _enable_app(self, app: AppEvents, name: str, fields: Fields) -> bool:
        app.active = True
        return self._done(ev.CFE_EVS_ENAAPPEVT_EID, f"Enable App Events Command Received with AppName = {name}")

    def _disable_app(self, app: AppEvents, name: str, fields: Fields) -> bool:
        app.active = False
        return self._done(ev.CFE_EVS_DISAPPEVT_EID, f"Disable App Events Command Received with AppName = {name}")

    def _reset_app_counter(self, app: AppEvents, name: str, fields: Fields) -> bool:
        app.sent = app.squelch.dropped = 0
        return self._done(ev.CFE_EVS_RSTEVTCNT_EID, f"Reset Event Counter Command Received with AppName = {name}")

    # -- commands about filters ------------------------------------------------------------------------------------

    def _unknown_filter(self, name: str, event_id: int, code: int) -> bool:
        text = f"{name} Event ID {event_id} not registered for filtering: CC = {code}"
        return self._error(ev.CFE_EVS_ERR_EVTIDNOREGS_EID, text)

    def _set_filter(self, app: AppEvents, name: str, fields: Fields) -> bool:
        event_id, mask = fields["EventID"], fields["Mask"]
        slot = app.filters.find(event_id)
        if slot is None:
            return self._unknown_filter(name, event_id, pk.CFE_EVS_SET_FILTER_CC)
        slot.mask = mask
        text = f"Set Filter Mask Command Received with AppName={name}, EventID=0x{event_id:08x}, Mask=0x{mask:04x}"
        return self._done(ev.CFE_EVS_SETFILTERMSK_EID, text)

    def _reset_filter(self, app: AppEvents, name: str, fields: Fields) -> bool:
        event_id = fields["EventID"]
        slot = app.filters.find(event_id)
        if slot is None:
            return self._unknown_filter(name, event_id, pk.CFE_EVS_RESET_FILTER_CC)
        slot.count = 0
        text = f"Reset Filter Command Received with AppName = {name}, EventID = 0x{event_id:08x}"
        return self._done(ev.CFE_EVS_RSTFILTER_EID, text)

    def _reset_all_filters(self, app: AppEvents, name: str, fields: Fields) -> bool:
        app.filters.reset()
        return self._done(ev.CFE_EVS_RSTALLFILTER_EID, f"Reset All Filters Command Received with AppName = {name}")

    def _add_filter(self, app: AppEvents, name: str, fields: Fields) -> bool:
        event_id, mask = fields["EventID"], fields["Mask"]
        which = f"AppName = {name}, EventID = 0x{event_id:08x}"
        if app.filters.find(event_id) is not None:
            text = f"Add Filter Command:{which} is already registered for filtering"
            return self._error(ev.CFE_EVS_EVT_FILTERED_EID, text)
        if not app.filters.add(event_id, mask):
            most = self._core.config.evs_max_event_filters
            text = f"Add Filter Command: number of registered filters has reached max = {most}"
            return self._error(ev.CFE_EVS_ERR_MAXREGSFILTER_EID, text)
        return self._done(ev.CFE_EVS_ADDFILTER_EID, f"Add Filter Command Received with {which}, Mask = 0x{mask:04x}")

    def _delete_filter(self, app: AppEvents, name: str, fields: Fields) -> bool:
        event_id = fields["EventID"]
        slot = app.filters.find(event_id)
        if slot is None:
            return self._unknown_filter(name, event_id, pk.CFE_EVS_DELETE_EVENT_FILTER_CC)
        app.filters.remove(slot)
        text = f"Delete Filter Command Received with AppName = {name}, EventID = 0x{event_id:08x}"
        return self._done(ev.CFE_EVS_DELFILTER_EID, text)
