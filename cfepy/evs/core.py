"""The generation of events: filters, flood limit, packets, event log and output ports (cfe_evs_utils.c).

`EventServices` adds the calls of applications, and `EvsCommands` the commands of the ground.
"""

from __future__ import annotations

from typing import NamedTuple

from cfepy.config.platform import PlatformConfig
from cfepy.evs import packets as pk
from cfepy.evs.apps import AppEvents
from cfepy.evs.events import ERR_UNREGISTERED_EVS_APP, ERROR, FILTER_MAX_EID, INFORMATION, SQUELCHED_ERR_EID
from cfepy.evs.log import EventLog
from cfepy.msg import PRIMARY_HEADER_SIZE, TLM_HEADER_SIZE, Layout, init
from cfepy.osal.limits import OS_MAX_API_NAME
from cfepy.ports import Ports, application_of
from cfepy.reading.texts import shown, to_bytes
from cfepy.rtos import Kernel
from cfepy.status import CFE_EVS_APP_SQUELCHED, CFE_SUCCESS
from cfepy.writing.console import Console

TRUNCATED = b"$"
PORTS = (1, 2, 3, 4)

U16_MAX = 0xFFFF
_SPARE = bytes(4)
_MORE_THAN_A_MESSAGE = OS_MAX_API_NAME + 18
"""The bytes of a port line in addition to the size of a message (CFE_EVS_MAX_PORT_MSG_LENGTH)."""


def _primary_header(msg_id: int, payload: Layout) -> bytes:
    return bytes(init(msg_id, TLM_HEADER_SIZE + payload.size)[:PRIMARY_HEADER_SIZE])


_LONG_HEADER = _primary_header(pk.LONG_EVENT_MSG_MID, pk.LONG_EVENT)
_SHORT_HEADER = _primary_header(pk.SHORT_EVENT_MSG_MID, pk.SHORT_EVENT)


class SentError(NamedTuple):
    """An ERROR or CRITICAL event: its type and text, its time in virtual ns, and the task that sent it."""

    event_type: int
    text: str
    at_ns: int
    task: str


class EventCore:
    """State of Event Services, and the generation of events; see `EventServices` for the arguments.

    Attributes:
        apps: the registered applications by AppId.
        unregistered: AppIds of senders that are not registered, each reported once.
        own_app_id: AppId of CFE_EVS itself; 0 until its task runs.
        log: the event log.
        ports_mask: the enabled output ports, one bit each.
        format_mode: FORMAT_SHORT or FORMAT_LONG, for the packet on the bus.
        sent: number of events sent since the counters were reset, at most 65535.
        truncated: number of events with a truncated text, likewise.
        unregistered_count: number of applications reported as unregistered, likewise.
        counts: number of events sent in this run, by event type, for reports.
        errors_by_app: ERROR and CRITICAL events sent in this run by application name, for reports.
        first_errors: the first of these events, by application name and event id.
    """

    def __init__(self, kernel: Kernel, ports: Ports, config: PlatformConfig, console: Console) -> None:
        self.kernel = kernel
        self.ports = ports
        self.config = config
        self.apps: dict[int, AppEvents] = {}
        self.unregistered: set[int] = set()
        self.own_app_id = 0
        self.log = EventLog(config.evs_log_max, config.evs_default_log_mode)
        self.ports_mask = config.evs_port_default
        self.format_mode = config.evs_default_msg_format_mode
        self.sent = self.truncated = self.unregistered_count = 0
        self.counts: dict[int, int] = {}
        self.errors_by_app: dict[str, int] = {}
        self.first_errors: dict[tuple[str, int], SentError] = {}
        self._console = console

    def dispatch(
        self, app: AppEvents, event_id: int, event_type: int, text: str, time: tuple[int, int] | None = None
    ) -> int:
        """Send an event of an application, unless its filters or its flood limit suppress it.

        Args:
            app: the application of the event.
            event_id: 0 to 65535.
            event_type: 1 to 4.
            text: the text.
            time: spacecraft time of the event; None for now.

        Returns:
            CFE_SUCCESS, even if a filter suppressed the event, or CFE_EVS_APP_SQUELCHED.
        """
        if self._is_filtered(app, event_id, event_type):
            return CFE_SUCCESS
        admitted, announce = app.squelch.admit(self.kernel.now)
        if announce:
            self.send_own(SQUELCHED_ERR_EID, ERROR, f"Events squelched, AppName = {app.name}")
        if not admitted:
            return CFE_EVS_APP_SQUELCHED
        self._generate(app, event_id, event_type, text, time)
        return CFE_SUCCESS

    def send_own(self, event_id: int, event_type: int, text: str) -> None:
        """Send an event of Event Services itself, without a flood limit; do nothing before its task runs."""
        app = self.apps.get(self.own_app_id)
        if app is not None and not self._is_filtered(app, event_id, event_type):
            self._generate(app, event_id, event_type, text, None)

    def report_unregistered(self, name: str) -> None:
        """Count and report an application that sends events without being registered."""
        self.unregistered_count += 1
        text = f"App {name} not registered with Event Services. Unable to send event."
        self.send_own(ERR_UNREGISTERED_EVS_APP, ERROR, text)
        self.ports.syslog.write_to_sys_log(f"EVS_NotRegistered: {text}")

    def _types_for(self, app: AppEvents) -> int:
        """Return the event types that are enabled for an event of an application (CFE_EVS_GetTypeEnable).

        They are the types of the application whose task sends it. This may be another application, because SB sends
        events from the tasks of all applications. It has none if it is not registered. A ROS node never is; the types
        of the event's own application count in its task.
        """
        owner = application_of(self.kernel.current.owner)
        sender = self.apps.get(owner.app_id) if owner is not None else None
        if sender is None:
            return app.types if getattr(owner, "is_node", False) else 0
        return sender.types

    def _is_filtered(self, app: AppEvents, event_id: int, event_type: int) -> bool:
        is_filtered, is_locked = app.judge(event_id, event_type, self._types_for(app))
        if is_locked:
            text = (
                f"Max filter count reached, AppName = {app.name}, EventID = 0x{event_id:08x}: Filter locked until reset"
            )
            self.send_own(FILTER_MAX_EID, INFORMATION, text)
        return is_filtered

    def _generate(
        self, app: AppEvents, event_id: int, event_type: int, text: str, time: tuple[int, int] | None
    ) -> None:
        """Build the packets and pass them to log, ports and bus, in this order (EVS_GenerateEventTelemetry)."""
        message, is_cut = self._fit(text)
        clock = self.ports.time
        stamp = clock.stamp() if time is None else time[0] << 16 | time[1] >> 16
        secondary_header = stamp.to_bytes(6, "big") + _SPARE
        packet_id = {
            "AppName": app.name,
            "EventID": event_id,
            "EventType": event_type,
            "SpacecraftID": self.config.spacecraft_id,
            "ProcessorID": self.config.processor_id,
        }
        packet = b"".join((_LONG_HEADER, secondary_header, pk.LONG_EVENT.pack(PacketID=packet_id, Message=message)))
        self.log.add(packet)
        if self.ports_mask:
            self._write_ports(clock.text() if time is None else clock.print_(time), app.name, event_id, message)
        if self.format_mode == pk.FORMAT_SHORT:
            packet = b"".join((_SHORT_HEADER, secondary_header, pk.SHORT_EVENT.pack(PacketID=packet_id)))
        if event_type >= ERROR:
            self._note_error(app.name, event_id, event_type, message)
        self.ports.sb.transmit_msg(packet)
        self._count(app, event_type, is_cut)

    def _note_error(self, app_name: str, event_id: int, event_type: int, message: bytes) -> None:
        self.errors_by_app[app_name] = self.errors_by_app.get(app_name, 0) + 1
        if (app_name, event_id) not in self.first_errors:
            text, task = message.decode("utf-8", "replace"), self.kernel.current.name
            self.first_errors[app_name, event_id] = SentError(event_type, text, self.kernel.now, task)

    def _fit(self, text: str) -> tuple[bytes, bool]:
        """Return the bytes of a text as a C string that fits the packet, and whether it was truncated."""
        data = to_bytes(text).partition(b"\0")[0]
        room = self.config.evs_max_message_length - 1
        if len(data) <= room:
            return data, False
        return data[: room - 1] + TRUNCATED, True

    def _write_ports(self, time: str, app_name: str, event_id: int, message: bytes) -> None:
        origin = f"{self.config.spacecraft_id}/{self.config.processor_id}/{shown(app_name)}"
        whole = f"{time} {origin} {event_id}: ".encode() + message
        line = whole[: self.config.evs_max_message_length + _MORE_THAN_A_MESSAGE].decode("utf-8", "replace")
        for port in PORTS:
            if self.ports_mask >> port - 1 & 1:
                self._console.write(f"EVS Port{port} {line}")

    def _count(self, app: AppEvents, event_type: int, is_cut: bool) -> None:
        self.sent = min(U16_MAX, self.sent + 1)
        app.sent = min(U16_MAX, app.sent + 1)
        self.truncated += is_cut
        self.counts[event_type] = self.counts.get(event_type, 0) + 1
