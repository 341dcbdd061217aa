"""The ground commands of Event Services (cfe_evs_task.c): dispatch, handlers, replies, housekeeping and files.

A handler returns True if it carried out the command, False if it refused it, None if the command is not counted.
`EvsCommands` has the commands about all applications. `AppEventCommands` has those about one application: its event
types, its counter, its filters. `EventFiles` writes the event log and the data of applications.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from cfepy.evs import events as ev
from cfepy.evs import packets as pk
from cfepy.evs.apps import ALL_TYPES, AppEvents
from cfepy.evs.core import EventCore
from cfepy.evs.log import DISCARD, OVERWRITE
from cfepy.evs.packets import APPS_IN_HOUSEKEEPING
from cfepy.fs import HEADER_SIZE, SUBTYPE_EVS_APPDATA, SUBTYPE_EVS_EVENTLOG, dump_file_name, init_header
from cfepy.ids import ES_APPID_BASE, get_base, to_index
from cfepy.msg import BAD_CODE, BAD_MSG_ID, DONE, Command, CommandTable, Dispatch
from cfepy.osal import OS_FILE_FLAG_CREATE, OS_FILE_FLAG_TRUNCATE, OS_WRITE_ONLY, Osal
from cfepy.status import CfeError, OsalError

Fields = Mapping[str, Any]
Handler = Callable[[AppEvents, str, Fields], bool]
_NOT_FOUND_PREFIX = {
    pk.DISABLE_APP_EVENTS_CC: "Disable App Events Command: ",
    pk.RESET_APP_COUNTER_CC: "Reset Event Counter Command: ",
}
"""The text of two commands before "Unable to retrieve"."""

_NOT_REGISTERED_SUFFIX = {pk.DISABLE_APP_EVENT_TYPE_CC: ","}
_NO_FILTER_SUFFIX = {pk.SET_FILTER_CC: " "}
"""Typing errors of NASA's texts, which ground tools may depend on."""

DEFAULT_LOG_FILE = "/ram/cfe_evs.log"
DEFAULT_APP_DATA_FILE = "/ram/cfe_evs_app.dat"


class CommandReplies:
    """Sends the reply events; each method returns the result for the command's handler.

    Args:
        core: sends the events.
    """

    def __init__(self, core: EventCore) -> None:
        self._core = core

    def done(self, event_id: int, text: str) -> bool:
        """Confirm a command; return True."""
        self._core.send_own(event_id, ev.DEBUG, text)
        return True

    def refuse(self, event_id: int, text: str) -> bool:
        """Report why a command is refused; return False."""
        self._core.send_own(event_id, ev.ERROR, text)
        return False

    def is_mask(self, mask: int, code: int) -> bool:
        """Return whether a mask has only bits of the four event types or ports; send an event otherwise
        (EVS_IsInvalidBitMask).
        """
        if 0 < mask <= ALL_TYPES:
            return True
        return self.refuse(ev.ERR_INVALID_BITMASK_EID, f"Bit Mask = 0x{mask:08x} out of range: CC = {code}")


def apps_by_slot(core: EventCore) -> list[AppEvents]:
    """Return the registered applications in the order of their slots in ES's table."""
    slots = core.config.es_max_applications
    return sorted(core.apps.values(), key=lambda app: to_index(app.app_id, ES_APPID_BASE, slots))


def housekeeping(core: EventCore, commands: int, errors: int) -> Mapping[str, object]:
    """Return the fields of the housekeeping packet; 8-bit counters wrap.

    Args:
        core: the state.
        commands: command counter.
        errors: command error counter.
    """
    return {
        "CommandCounter": commands & 0xFF,
        "CommandErrorCounter": errors & 0xFF,
        "MessageFormatMode": core.format_mode,
        "MessageTruncCounter": core.truncated & 0xFF,
        "UnregisteredAppCounter": core.unregistered_count & 0xFF,
        "OutputPort": core.ports_mask,
        "LogFullFlag": int(core.log.is_full),
        "LogMode": core.log.mode,
        "MessageSendCounter": core.sent,
        "LogOverflowCounter": core.log.overflow & 0xFFFF,
        "LogEnabled": 1,
        "AppData": [
            {
                "AppID": app.app_id,
                "AppMessageSentCounter": app.sent,
                "AppEnableStatus": int(app.active),
                "AppMessageSquelchedCounter": app.squelch.dropped,
            }
            for app in apps_by_slot(core)[:APPS_IN_HOUSEKEEPING]
        ],
    }


class EvsCommands:
    """Handles the packets of the command pipe.

    Args:
        core: the state that commands change.
        files: the commands that write files.

    Attributes:
        count: number of accepted commands.
        errors: number of refused commands.
    """

    def __init__(self, core: EventCore, files: EventFiles) -> None:
        self.count = 0
        self.errors = 0
        self._core = core
        self._replies = CommandReplies(core)
        self._table = CommandTable(
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
        self._table.handle(pk.SEND_HK, self._send_housekeeping, any_length=True)  # NASA's code does not check it
        AppEventCommands(core, self._replies).add_to(self._table)

    def process(self, packet: bytes) -> None:
        """Handle a packet of the pipe (CFE_EVS_ProcessCommandPacket)."""
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
        self._core.send_own(ev.NOOP_EID, ev.INFORMATION, f"No-op Cmd Rcvd: {self._core.config.release.text('CFE_EVS')}")
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
            app.set_types(mask, enabled=True)
        text = f"Enable Event Type Command Received with Event Type Bit Mask = 0x{mask:02x}"
        return self._replies.done(ev.ENAEVTTYPE_EID, text)

    def _disable_types(self, packet: bytes) -> bool:
        mask = pk.DISABLE_EVENT_TYPE.read(packet)["BitMask"]
        if not self._replies.is_mask(mask, pk.DISABLE_EVENT_TYPE_CC):
            return False
        for app in self._core.apps.values():
            app.set_types(mask, enabled=False)
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


class AppEventCommands:
    """Handles the commands about one application.

    Args:
        core: the state that commands change.
        replies: sends the replies.
    """

    def __init__(self, core: EventCore, replies: CommandReplies) -> None:
        self._core = core
        self._replies = replies

    def add_to(self, table: CommandTable) -> None:
        """Add the handlers to a command table."""
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
        """Return a handler that first looks up the named application (EVS_GetApplicationInfo)."""
        code = command.code or 0

        def find_and_handle(packet: bytes) -> bool:
            fields = command.read(packet)
            name = command.read_name(packet, "AppName")
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
        app.set_types(mask, enabled=True)
        text = f"Enable App Event Type Command Received with AppName = {name}, EventType Bit Mask = 0x{mask:02x}"
        return self._replies.done(ev.ENAAPPEVTTYPE_EID, text)

    def _disable_types(self, app: AppEvents, name: str, fields: Fields) -> bool:
        mask = fields["BitMask"]
        if not self._replies.is_mask(mask, pk.DISABLE_APP_EVENT_TYPE_CC):
            return False
        app.set_types(mask, enabled=False)
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


class EventFiles:
    """Handles the two commands that write files.

    Args:
        core: the state to write.
        osal: writes the files.
    """

    def __init__(self, core: EventCore, osal: Osal) -> None:
        self._core = core
        self._osal = osal
        self._replies = CommandReplies(core)

    def write_log(self, packet: bytes) -> bool:
        """Write the event log: the cFE header and the long event packets, the oldest first."""
        name = pk.WRITE_LOG_DATA_FILE.read(packet)["LogFilename"]
        return self._in_file(name, DEFAULT_LOG_FILE, "Write Log File", ev.ERR_CRLOGFILE_EID, self._write_log)

    def _write_log(self, path: str, descriptor: int) -> bool:
        written = self._write_header(descriptor, "cFE EVS Log File", SUBTYPE_EVS_EVENTLOG)
        if written != HEADER_SIZE:
            what = f"WriteHdr RC: {written}, Expected: {HEADER_SIZE}, filename = {path}"
            return self._replies.refuse(ev.WRITE_HEADER_ERR_EID, f"Write File Header to Log File Error: {what}")
        entries = self._core.log.entries()
        for entry in entries:
            status = self._write(descriptor, entry)
            if status != len(entry):
                text = f"Write Log File Command Error: OS_write = {status}, filename = {path}"
                return self._replies.refuse(ev.ERR_WRLOGFILE_EID, text)
        text = f"Write Log File Command: {len(entries)} event log entries written to {path}"
        return self._replies.done(ev.WRLOG_EID, text)

    def write_app_data(self, packet: bytes) -> bool:
        """Write the data of applications: the cFE header and a record for each registered application."""
        name = pk.WRITE_APP_DATA_FILE.read(packet)["AppDataFilename"]
        return self._in_file(name, DEFAULT_APP_DATA_FILE, "Write App Data", ev.ERR_CRDATFILE_EID, self._write_app_data)

    def _write_app_data(self, path: str, descriptor: int) -> bool:
        written = self._write_header(descriptor, "EVS Application Data File", SUBTYPE_EVS_APPDATA)
        if written != HEADER_SIZE:
            return False  # NASA's code sends no event here
        apps = apps_by_slot(self._core)
        for count, app in enumerate(apps):
            record = _app_record(app)
            status = self._write(descriptor, record)
            if status != len(record):
                where = f"At entry = {count}, OS_write = {status}, filename = {path}"
                return self._replies.refuse(ev.ERR_WRDATFILE_EID, f"Write App Data Command Error: {where}")
        text = f"Write App Data Command: {len(apps)} application data entries written to {path}"
        return self._replies.done(ev.WRDAT_EID, text)

    def _in_file(self, name: str, default: str, command: str, failed: int, write: Callable[[str, int], bool]) -> bool:
        """Create a file and call `write` with its path and descriptor; return its result, or False after an error."""
        opened = self._open(name, default, command, failed)
        if opened is None:
            return False
        try:
            return write(*opened)
        finally:
            self._osal.close(opened[1])

    def _open(self, name: str, default: str, command: str, failed: int) -> tuple[str, int] | None:
        """Return the path and descriptor of a new file, or None after an error event."""
        try:
            path = dump_file_name(name, default)
        except CfeError as error:
            self._replies.refuse(failed, f"{command} Command Error: CFE_FS_ParseInputFileNameEx() = {error.hex}")
            return None
        try:
            flags = OS_FILE_FLAG_CREATE | OS_FILE_FLAG_TRUNCATE
            return path, self._osal.open_create(path, flags, OS_WRITE_ONLY)
        except OsalError as error:
            text = f"{command} Command Error: OS_OpenCreate = {error.status}, filename = {path}"
            self._replies.refuse(failed, text)
            return None

    def _write_header(self, descriptor: int, description: str, subtype: int) -> int:
        """Write the file header; return the number of bytes written, or the status of a failure."""
        try:
            return self._core.ports.fs.write_header(descriptor, init_header(description, subtype))
        except CfeError as error:
            return error.status

    def _write(self, descriptor: int, data: bytes) -> int:
        """Write data; return the number of bytes written, or the status of a failure."""
        try:
            return self._osal.write(descriptor, data)
        except OsalError as error:
            return error.status


def _app_record(app: AppEvents) -> bytes:
    return pk.APP_DATA_RECORD.pack(
        AppName=app.name,
        ActiveFlag=int(app.active),
        EventTypesActiveFlag=app.types,
        EventCount=app.sent,
        SquelchedCount=app.squelch.dropped,
        Filters=[{"EventID": slot.event_id, "Mask": slot.mask, "Count": slot.count} for slot in app.filters.slots],
    )
