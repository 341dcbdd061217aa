"""The ground commands about one application: its event types, its counter, its filters (cfe_evs_task.c).

Handlers return True when they did what the command says, False when they refused. Imports no other service.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from cfepy.evs import events as ev
from cfepy.evs import packets as pk
from cfepy.evs.apps import AppEvents
from cfepy.evs.core import EventCore
from cfepy.evs.replies import Replies
from cfepy.ids import ES_APPID_BASE, get_base
from cfepy.msg import Command, CommandTable
from cfepy.status import CfeError

Fields = Mapping[str, Any]
Handler = Callable[[AppEvents, str, Fields], bool]

_NAME_SIZE = 20
_NOT_FOUND_PREFIX = {
    pk.DISABLE_APP_EVENTS_CC: "Disable App Events Command: ",
    pk.RESET_APP_COUNTER_CC: "Reset Event Counter Command: ",
}
"""What two commands say before "Unable to retrieve"."""

_NOT_REGISTERED_SUFFIX = {pk.DISABLE_APP_EVENT_TYPE_CC: ","}
_NO_FILTER_SUFFIX = {pk.SET_FILTER_CC: " "}
"""NASA's slips of the pen, which ground tools may look for."""


class AppCommands:
    """Handles the commands.

    Args:
        core: the state that commands change.
        replies: sends the answers.
    """

    def __init__(self, core: EventCore, replies: Replies) -> None:
        self._core = core
        self._replies = replies

    def add_to(self, table: CommandTable) -> None:
        """Have a table call the handlers."""
        for command, handler in (
            (pk.ENABLE_APP_EVENT_TYPE, self._enable_types),
            (pk.DISABLE_APP_EVENT_TYPE, self._disable_types),
            (pk.ENABLE_APP_EVENTS, self._enable),
            (pk.DISABLE_APP_EVENTS, self._disable),
            (pk.RESET_APP_COUNTER, self._reset_counter),
            (pk.SET_FILTER, self._set_filter),
            (pk.RESET_FILTER, self._reset_filter),
            (pk.RESET_ALL_FILTERS, self._reset_all_filters),
            (pk.ADD_EVENT_FILTER, self._add_filter),
            (pk.DELETE_EVENT_FILTER, self._delete_filter),
        ):
            table.handle(command, self._for_app(command, handler))

    def _for_app(self, command: Command, handler: Handler) -> Callable[[bytes], bool]:
        """A handler that looks the named application up first (EVS_GetApplicationInfo)."""
        code = command.code or 0

        def find_and_handle(packet: bytes) -> bool:
            fields = command.read(packet)
            name = fields["AppName"][: _NAME_SIZE - 1]
            app = self._find(name, code)
            return app is not None and handler(app, name, fields)

        return find_and_handle

    def _find(self, name: str, code: int) -> AppEvents | None:
        try:
            app_id = self._core.ports.es.get_app_id_by_name(name)
        except CfeError:
            text = f"{_NOT_FOUND_PREFIX.get(code, '')}Unable to retrieve application ID for {name}: CC = {code}"
            self._replies.refuse(ev.ERR_NOAPPIDFOUND_EID, text)
            return None
        app = self._core.apps.get(app_id)
        if app is None and get_base(app_id) != ES_APPID_BASE:
            text = f"Illegal application ID retrieved for {name}: CC = {code}"
            self._replies.refuse(ev.ERR_ILLAPPIDRANGE_EID, text)
        elif app is None:
            text = f"{name} not registered with EVS{_NOT_REGISTERED_SUFFIX.get(code, '')}: CC = {code}"
            self._replies.refuse(ev.ERR_APPNOREGS_EID, text)
        return app

    # -- events as a whole -----------------------------------------------------------------------------------------

    def _enable_types(self, app: AppEvents, name: str, fields: Fields) -> bool:
        mask = fields["BitMask"]
        if not self._replies.is_mask(mask, pk.ENABLE_APP_EVENT_TYPE_CC):
            return False
        app.types |= mask
        text = f"Enable App Event Type Command Received with AppName = {name}, EventType Bit Mask = 0x{mask:02x}"
        return self._replies.done(ev.ENAAPPEVTTYPE_EID, text)

    def _disable_types(self, app: AppEvents, name: str, fields: Fields) -> bool:
        mask = fields["BitMask"]
        if not self._replies.is_mask(mask, pk.DISABLE_APP_EVENT_TYPE_CC):
            return False
        app.types &= ~mask
        text = f"Disable App Event Type Command Received with AppName = {name}, EventType Bit Mask = 0x{mask:02x}"
        return self._replies.done(ev.DISAPPENTTYPE_EID, text)

    def _enable(self, app: AppEvents, name: str, fields: Fields) -> bool:
        app.active = True
        return self._replies.done(ev.ENAAPPEVT_EID, f"Enable App Events Command Received with AppName = {name}")

    def _disable(self, app: AppEvents, name: str, fields: Fields) -> bool:
        app.active = False
        return self._replies.done(ev.DISAPPEVT_EID, f"Disable App Events Command Received with AppName = {name}")

    def _reset_counter(self, app: AppEvents, name: str, fields: Fields) -> bool:
        app.sent = app.squelch.dropped = 0
        return self._replies.done(ev.RSTEVTCNT_EID, f"Reset Event Counter Command Received with AppName = {name}")

    # -- filters ---------------------------------------------------------------------------------------------------

    def _no_filter(self, name: str, event_id: int, code: int) -> bool:
        text = f"{name} Event ID {event_id} not registered for filtering: CC = {code}{_NO_FILTER_SUFFIX.get(code, '')}"
        return self._replies.refuse(ev.ERR_EVTIDNOREGS_EID, text)

    def _set_filter(self, app: AppEvents, name: str, fields: Fields) -> bool:
        event_id, mask = fields["EventID"], fields["Mask"]
        slot = app.filters.find(event_id)
        if slot is None:
            return self._no_filter(name, event_id, pk.SET_FILTER_CC)
        slot.mask = mask
        text = f"Set Filter Mask Command Received with AppName={name}, EventID=0x{event_id:08x}, Mask=0x{mask:04x}"
        return self._replies.done(ev.SETFILTERMSK_EID, text)

    def _reset_filter(self, app: AppEvents, name: str, fields: Fields) -> bool:
        event_id = fields["EventID"]
        slot = app.filters.find(event_id)
        if slot is None:
            return self._no_filter(name, event_id, pk.RESET_FILTER_CC)
        slot.count = 0
        text = f"Reset Filter Command Received with AppName = {name}, EventID = 0x{event_id:08x}"
        return self._replies.done(ev.RSTFILTER_EID, text)

    def _reset_all_filters(self, app: AppEvents, name: str, fields: Fields) -> bool:
        app.filters.reset()
        return self._replies.done(ev.RSTALLFILTER_EID, f"Reset All Filters Command Received with AppName = {name}")

    def _add_filter(self, app: AppEvents, name: str, fields: Fields) -> bool:
        event_id, mask = fields["EventID"], fields["Mask"]
        which = f"AppName = {name}, EventID = 0x{event_id:08x}"
        if app.filters.find(event_id) is not None:
            text = f"Add Filter Command:{which} is already registered for filtering"
            return self._replies.refuse(ev.EVT_FILTERED_EID, text)
        if not app.filters.add(event_id, mask):
            most = self._core.config.evs_max_event_filters
            text = f"Add Filter Command: number of registered filters has reached max = {most}"
            return self._replies.refuse(ev.ERR_MAXREGSFILTER_EID, text)
        return self._replies.done(ev.ADDFILTER_EID, f"Add Filter Command Received with {which}, Mask = 0x{mask:04x}")

    def _delete_filter(self, app: AppEvents, name: str, fields: Fields) -> bool:
        event_id = fields["EventID"]
        slot = app.filters.find(event_id)
        if slot is None:
            return self._no_filter(name, event_id, pk.DELETE_EVENT_FILTER_CC)
        app.filters.remove(slot)
        text = f"Delete Filter Command Received with AppName = {name}, EventID = 0x{event_id:08x}"
        return self._replies.done(ev.DELFILTER_EID, text)
