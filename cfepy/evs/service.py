"""Event Services as applications and the other services call them (cfe_evs.h), and the task CFE_EVS.

The generation of events and their destinations are in `cfepy.evs.core`.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from cfepy.config.platform import PlatformConfig
from cfepy.core_app import serve
from cfepy.evs import packets as pk
from cfepy.evs.apps import AppEvents
from cfepy.evs.commands import EventFiles, EvsCommands
from cfepy.evs.core import U16_MAX, EventCore
from cfepy.evs.events import CRITICAL, DEBUG, ERROR, INFORMATION, STARTUP_EID
from cfepy.evs.log import DISCARD, OVERWRITE, EventLog
from cfepy.ids import ES_APPID_BASE, get_base
from cfepy.osal import Osal
from cfepy.ports import Caller, Ports, application_of
from cfepy.reading.texts import without_addresses
from cfepy.rtos import Kernel
from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_EVS_APP_ILLEGAL_APP_ID,
    CFE_EVS_APP_NOT_REGISTERED,
    CFE_EVS_EVT_NOT_REGISTERED,
    CFE_EVS_INVALID_PARAMETER,
    CFE_EVS_UNKNOWN_FILTER,
    CfeError,
)
from cfepy.writing.console import Console

PIPE_DEPTH = 32
PIPE_NAME = "EVS_CMD_PIPE"
MAIN_PERF_ID = 2
EVENT_FILTER_BINARY = 0
"""The only filter scheme (CFE_EVS_EventFilter_BINARY)."""

KEPT = "EVS"
"""The key of the event log among the objects that outlive a processor reset."""

_U32_MAX = 0xFFFFFFFF


class EventServices(EventCore):
    """The events of one processor.

    A call that sends an event returns CFE_SUCCESS, even if a filter suppressed the event. It returns
    CFE_EVS_APP_SQUELCHED if the flood limit suppressed it; an application need not handle that as an error.

    Args:
        kernel: the kernel of the processor; its virtual time refills the flood limits.
        ports: the other services.
        config: limits and defaults.
        console: the output of the output ports.
        osal: writes the files that commands request.
    """

    def __init__(
        self,
        kernel: Kernel,
        ports: Ports,
        config: PlatformConfig,
        console: Console,
        osal: Osal,
    ) -> None:
        super().__init__(kernel, ports, config, console)
        self.commands = EvsCommands(self, EventFiles(self, osal))

    # -- life ------------------------------------------------------------------------------------------------------

    def early_init(self, kept: dict[str, Any]) -> None:
        """Prepare the event log, before any task exists (CFE_EVS_EarlyInit).

        Args:
            kept: objects that outlive a processor reset; "EVS" is the earlier event log. The call stores the log there
                again.
        """
        log: EventLog | None = kept.get(KEPT)
        if log is None:
            text = "Event Log cleared following power-on reset"
        elif log.mode not in (OVERWRITE, DISCARD):
            text = f"Event Log cleared, {log.summary()}"
        else:
            self.log = log
            text = f"Event Log restored, {log.summary()}"
        kept[KEPT] = self.log
        self.ports.syslog.write_to_sys_log(f"CFE_EVS_EarlyInit: {text}")

    def task_main(self) -> None:
        """Run the task CFE_EVS (CFE_EVS_TaskMain)."""
        ports = self.ports
        ports.es.perf_log_entry(MAIN_PERF_ID)
        self.register()
        pipe = ports.sb.create_pipe(PIPE_DEPTH, PIPE_NAME)
        ports.sb.subscribe(pk.CMD_MID, pipe)
        ports.sb.subscribe(pk.SEND_HK_MID, pipe)
        self.own_app_id = ports.es.get_app_id()
        self.send_own(STARTUP_EID, INFORMATION, f"cFE EVS Initialized: {self.config.release.text('CFE_EVS')}")
        serve(ports, self.config, pipe, MAIN_PERF_ID, self.commands.process)

    def cleanup_app(self, app_id: int) -> None:
        """Remove an ended application (CFE_EVS_CleanUpApp)."""
        self.apps.pop(app_id, None)
        self.unregistered.discard(app_id)

    # -- registration and filters ----------------------------------------------------------------------------------

    def register(self, filters: Iterable[tuple[int, int]] = (), filter_scheme: int = EVENT_FILTER_BINARY) -> None:
        """Register the calling application, or register it again with all counters at 0 (CFE_EVS_Register).

        Args:
            filters: (event id, mask) pairs. An event passes if its count, from 0, and the mask have no bit in common.
                Mask 0xFFFC passes the first four events, 0x0001 every other one. Only the first `evs_max_event_filters`
                pairs are used.
            filter_scheme: must be EVENT_FILTER_BINARY, the only scheme.

        Raises:
            CfeError: CFE_EVS_APP_ILLEGAL_APP_ID outside of an application, CFE_EVS_UNKNOWN_FILTER, CFE_ES_BAD_ARGUMENT
                for a filter that is not two 16-bit numbers. After an error, the application is no longer registered.
        """
        caller = self._caller()
        self.apps.pop(caller.app_id, None)
        # as NASA's code, which clears the record first: the application is reported again
        self.unregistered.discard(caller.app_id)
        if filter_scheme != EVENT_FILTER_BINARY:
            raise CfeError(
                CFE_EVS_UNKNOWN_FILTER, f"invalid filter scheme {filter_scheme!r}; expected 0, the binary scheme"
            )
        wanted = list(filters)
        for pair in wanted:
            _check_filter(pair)
        limit = self.config.evs_max_event_filters
        if len(wanted) > limit:
            self.ports.syslog.write_to_sys_log(f"CFE_EVS_Register: Filter limit truncated to {limit}")
        self.apps[caller.app_id] = AppEvents(caller.app_id, caller.name, self.config, wanted)

    def reset_filter(self, event_id: int) -> None:
        """Set the count of an event's filter to 0 (CFE_EVS_ResetFilter).

        Raises:
            CfeError: CFE_EVS_APP_ILLEGAL_APP_ID, CFE_EVS_APP_NOT_REGISTERED, CFE_EVS_EVT_NOT_REGISTERED.
        """
        slot = self._registered_caller().filters.find(event_id)
        if slot is None:
            raise CfeError(CFE_EVS_EVT_NOT_REGISTERED, f"event {event_id} has no filter")
        slot.count = 0

    def reset_all_filters(self) -> None:
        """Set the counts of all filters of the calling application to 0 (CFE_EVS_ResetAllFilters).

        Raises:
            CfeError: CFE_EVS_APP_ILLEGAL_APP_ID, CFE_EVS_APP_NOT_REGISTERED.
        """
        self._registered_caller().filters.reset()

    # -- events ----------------------------------------------------------------------------------------------------

    def send_event(self, event_id: int, event_type: int, text: str, *values: object) -> int:
        """Send an event of the calling application (CFE_EVS_SendEvent; the macro CFE_EVS_Send is `send`).

        Args:
            event_id: 0 to 65535.
            event_type: DEBUG 1, INFORMATION 2, ERROR 3 or CRITICAL 4; other types are never sent.
            text: the text; at most 121 bytes fit, and a truncated text ends with "$".
            values: values formatted into the text as by printf; without values, "%" is literal.

        Returns:
            CFE_SUCCESS or CFE_EVS_APP_SQUELCHED.

        Raises:
            CfeError: CFE_EVS_APP_ILLEGAL_APP_ID outside of an application, CFE_EVS_APP_NOT_REGISTERED,
                CFE_EVS_INVALID_PARAMETER for an invalid text or id, or values that do not fit the text.
        """
        caller = application_of(self.kernel.current.owner)
        app = self.apps.get(caller.app_id) if caller is not None else None
        if app is None:
            app = self._registered_caller(report=True)
        return self.dispatch(app, event_id, event_type, _checked(event_id, text, values))

    send = send_event

    def send_event_with_app_id(self, event_id: int, event_type: int, app_id: int, text: str, *values: object) -> int:
        """Send an event in the name of an application (CFE_EVS_SendEventWithAppID).

        Args:
            event_id: see `send_event`.
            event_type: see `send_event`.
            app_id: the application of the event, whose filters apply. The enabled types of the calling application
                apply.
            text: see `send_event`.
            values: see `send_event`.

        Returns:
            CFE_SUCCESS or CFE_EVS_APP_SQUELCHED.

        Raises:
            CfeError: CFE_EVS_APP_ILLEGAL_APP_ID for an id that is not an AppId, CFE_EVS_APP_NOT_REGISTERED,
                CFE_EVS_INVALID_PARAMETER.
        """
        app = self.apps.get(app_id)
        if app is None:
            if get_base(app_id) != ES_APPID_BASE:
                raise CfeError(CFE_EVS_APP_ILLEGAL_APP_ID, f"0x{app_id:x} is not an AppId")
            raise self._not_registered(app_id)
        return self.dispatch(app, event_id, event_type, _checked(event_id, text, values))

    def send_timed_event(
        self, time: tuple[int, int], event_id: int, event_type: int, text: str, *values: object
    ) -> int:
        """Send an event with another time than now (CFE_EVS_SendTimedEvent).

        The log and the console show this time; the bus stamps its copy again.

        Args:
            time: (seconds, subseconds of 2**-32 s) of spacecraft time.
            event_id: see `send_event`.
            event_type: see `send_event`.
            text: see `send_event`.
            values: see `send_event`.

        Returns:
            CFE_SUCCESS or CFE_EVS_APP_SQUELCHED.

        Raises:
            CfeError: see `send_event`.
        """
        app = self._registered_caller(report=True)
        text = _checked(event_id, text, values)
        if not all(0 <= part <= _U32_MAX for part in time):
            raise CfeError(CFE_EVS_INVALID_PARAMETER, f"invalid time {time}; both parts must be numbers of 32 bits")
        return self.dispatch(app, event_id, event_type, text, time)

    def send_dbg(self, event_id: int, text: str, *values: object) -> int:
        """Send a DEBUG event (CFE_EVS_SendDbg); see `send_event`."""
        return self.send_event(event_id, DEBUG, text, *values)

    def send_info(self, event_id: int, text: str, *values: object) -> int:
        """Send an INFORMATION event (CFE_EVS_SendInfo); see `send_event`."""
        return self.send_event(event_id, INFORMATION, text, *values)

    def send_err(self, event_id: int, text: str, *values: object) -> int:
        """Send an ERROR event (CFE_EVS_SendErr); see `send_event`."""
        return self.send_event(event_id, ERROR, text, *values)

    def send_crit(self, event_id: int, text: str, *values: object) -> int:
        """Send a CRITICAL event (CFE_EVS_SendCrit); see `send_event`."""
        return self.send_event(event_id, CRITICAL, text, *values)

    # -- the caller ----------------------------------------------------------------------------------------------------

    def _caller(self) -> Caller:
        caller = application_of(self.kernel.current.owner)
        if caller is None:
            raise CfeError(CFE_EVS_APP_ILLEGAL_APP_ID, "the caller must be a task of an application")
        return caller

    def _registered_caller(self, report: bool = False) -> AppEvents:
        caller = self._caller()
        app = self.apps.get(caller.app_id)
        if app is not None:
            return app
        if report:
            raise self._not_registered(caller.app_id)
        raise CfeError(CFE_EVS_APP_NOT_REGISTERED, f"{caller.name} must call evs.register first")

    def _not_registered(self, app_id: int) -> CfeError:
        """Return the error for an application that is not registered, and report it the first time
        (EVS_NotRegistered).
        """
        name = self._name_of(app_id)
        if app_id not in self.unregistered:
            self.unregistered.add(app_id)
            self.report_unregistered(name)
        who = name or f"AppId 0x{app_id:x}"
        return CfeError(CFE_EVS_APP_NOT_REGISTERED, f"{who} is not registered: evs.register comes before its events")

    def _name_of(self, app_id: int) -> str:
        try:
            return self.ports.es.get_app_name(app_id)
        except CfeError:
            return ""  # there is no such application


def _checked(event_id: int, text: str, values: tuple[object, ...]) -> str:
    """Return the text of an event with its values inserted."""
    if not isinstance(text, str):
        raise CfeError(CFE_EVS_INVALID_PARAMETER, f"the text of event {event_id!r} must be a str, not {text!r}")
    if not isinstance(event_id, int) or not 0 <= event_id <= U16_MAX:
        raise CfeError(CFE_EVS_INVALID_PARAMETER, f"event id must be 0 to {U16_MAX}, not {event_id!r}")
    try:
        return without_addresses(text % values if values else text)
    except (TypeError, ValueError) as error:
        raise CfeError(CFE_EVS_INVALID_PARAMETER, f"the format {text!r} does not match {values}: {error}") from None


def _check_filter(pair: tuple[int, int]) -> None:
    is_pair = isinstance(pair, (tuple, list)) and len(pair) == 2
    if not is_pair or not all(isinstance(value, int) and 0 <= value <= U16_MAX for value in pair):
        raise CfeError(CFE_ES_BAD_ARGUMENT, f"a filter must be (event id, mask), two numbers of 16 bits, not {pair!r}")
