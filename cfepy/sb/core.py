"""The common base of all parts of the Software Bus: its tables and counters, and its reports by events.

An event travels on the bus itself, so reporting a failed transmission can fail in the same way. As in NASA's code
(CFE_SB_RequestToSendEvent), a task does not send an event while it is already sending the same one.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field, fields

from cfepy.config.platform import PlatformConfig
from cfepy.ids import SB_PIPEID_BASE, IdTable
from cfepy.interpreter.compiled import mypyc_attr
from cfepy.msg import Packet
from cfepy.osal import ObjectSizes
from cfepy.ports import Ports, application_of
from cfepy.rtos import CpuCosts, Kernel
from cfepy.sb import events as ev
from cfepy.sb.pipe import Pipe
from cfepy.sb.routing import PutHook, Route, RoutingTable
from cfepy.status import CFE_SB_BAD_ARGUMENT, CFE_SB_MAX_PIPES_MET, CFE_SB_MSG_TOO_BIG, CfeError


@dataclass(slots=True)
class BusCounters:
    """The counters of SB's housekeeping packet (CFE_SB_HousekeepingTlm_Payload_t)."""

    command: int = 0
    command_error: int = 0
    no_subscribers: int = 0
    msg_send_error: int = 0
    msg_receive_error: int = 0
    internal_error: int = 0
    create_pipe_error: int = 0
    subscribe_error: int = 0
    pipe_opts_error: int = 0
    duplicate_subscriptions: int = 0
    get_pipe_id_by_name_error: int = 0
    pipe_overflow_error: int = 0
    msg_limit_error: int = 0

    def reset(self) -> None:
        """Set all counters to 0 except two that NASA's code keeps (CFE_SB_ResetCounters)."""
        kept = {"pipe_opts_error", "get_pipe_id_by_name_error"}
        for each in fields(self):
            if each.name not in kept:
                setattr(self, each.name, 0)


@dataclass(slots=True)
class Peaks:
    """The high-water marks of SB's statistics packet."""

    msg_ids: int = 0
    pipes: int = 0
    memory: int = 0
    subscriptions: int = 0
    buffers: int = 0


@dataclass(slots=True)
class Unrouted:
    """Messages whose MsgId has never had a subscriber, by MsgId."""

    sent: dict[int, int] = field(default_factory=dict)


@mypyc_attr(allow_interpreted_subclasses=True)
class BusCore:
    """Tables and helpers; the base class of `SoftwareBus`.

    Args:
        kernel: the kernel of the processor.
        ports: the other services.
        config: limits.
        costs: virtual CPU time of calls; None for no time.
        sizes: RAM of pipes; None for no RAM.

    Attributes:
        routing: the routing table; `routes` is its dictionary.
        subscriptions: number of pairs of MsgId and pipe.
        outlets: number of outlets created so far (`cfepy.sb.direct_subscriber`).
        reporting: whether each subscription is reported to other processors.
        put_hook: called before each put into a pipe; None on a bus without observers and faults.
    """

    def __init__(
        self,
        kernel: Kernel,
        ports: Ports,
        config: PlatformConfig,
        costs: CpuCosts | None = None,
        sizes: ObjectSizes | None = None,
    ) -> None:
        self.kernel = kernel
        self.ports = ports
        self.config = config
        self.sizes = sizes or ObjectSizes()
        self.costs = costs if costs is not None and (costs.call_ns or costs.byte_ps) else None
        self.counters = BusCounters()
        self.peaks = Peaks()
        self.pipes: IdTable[Pipe] = IdTable(SB_PIPEID_BASE, config.sb_max_pipes, full=CFE_SB_MAX_PIPES_MET)
        self.routing = RoutingTable(config.sb_max_msg_ids, config.sb_highest_valid_msg_id)
        self.routes: dict[int, Route] = self.routing.routes
        self.subscriptions = 0
        self.outlets = 0
        self.reporting = False
        self.put_hook: PutHook | None = None
        self.unrouted = Unrouted()
        self.app_id = 0  # AppId of the SB application, the sender of its events
        self._sending: set[tuple[int, int]] = set()

    def caller_name(self) -> str:
        """Return the name of the calling task as in SB's events: "APP", "APP.TASK" for a child task, or "Unknown". The
        system log reports an unknown one (CFE_SB_GetAppTskName).
        """
        task = self.kernel.current
        if task.owner is not None and application_of(task.owner) is None:
            self.ports.syslog.write_to_sys_log("CFE_ES_GetTaskInfo: Task ID Not Active: 0")
            return "Unknown"
        app: str | None = getattr(task.owner, "name", None)
        if app is None or app == task.name:
            return task.name
        return f"{app}.{task.name}"

    def report(self, event_id: int, event_type: int, text: str) -> None:
        """Send an event of SB. Before its task runs the event is lost, because events need an application."""
        with suppress(CfeError):
            self.ports.evs.send_event_with_app_id(event_id, event_type, self.app_id, text)

    def report_once(self, event_id: int, event_type: int, text: str) -> None:
        """Send an event of SB, unless the calling task is already sending the same one."""
        key = (self.kernel.current.ident, event_id)
        if key in self._sending:
            return
        self._sending.add(key)
        try:
            self.report(event_id, event_type, text)
        finally:
            self._sending.discard(key)

    def send_error(self, event_id: int, status: int, text: str) -> CfeError:
        """Report that a message cannot be sent; return the error to raise."""
        self.counters.msg_send_error += 1
        self.report_once(event_id, ev.ERROR, text)
        return CfeError(status, text)

    def check_header(self, packet: Packet, size: int) -> None:
        """Check length, MsgId and size of a packet before it is sent, in this order.

        Args:
            packet: the packet.
            size: bytes of it to send.

        Raises:
            CfeError: CFE_SB_BAD_ARGUMENT, CFE_SB_MSG_TOO_BIG.
        """
        limit = self.config.sb_max_msg_size
        if len(packet) < 7:
            text = f"Send Err:Bad input argument,Arg 0x0,App {self.caller_name()}"
            raise self.send_error(ev.SEND_BAD_ARG_EID, CFE_SB_BAD_ARGUMENT, text)
        msg_id = packet[0] << 8 | packet[1]
        if not self.is_valid_msg_id(msg_id):
            text = f"Send Err:Invalid MsgId(0x{msg_id:x})in msg,App {self.caller_name()}"
            raise self.send_error(ev.SEND_INV_MSGID_EID, CFE_SB_BAD_ARGUMENT, text)
        if size > limit:
            app = self.caller_name()
            text = f"Send Err:Msg Too Big MsgId=0x{msg_id:x},app={app},size={size},MaxSz={limit}"
            raise self.send_error(ev.MSG_TOO_BIG_EID, CFE_SB_MSG_TOO_BIG, text)

    def find_pipe(self, pipe_id: int) -> Pipe | None:
        """Return the pipe of an id, or None."""
        return self.pipes.find(pipe_id)

    def report_nameless(self, pipe_id: int) -> str:
        """Send the event of CFE_SB_GetPipeName for an unknown pipe id; return its text."""
        text = f"Pipe Id Error:Bad Argument,Id={pipe_id},Requestor {self.caller_name()}"
        self.report(ev.GETPIPENAME_ID_ERR_EID, ev.ERROR, text)
        return text

    def is_foreign(self, pipe: Pipe) -> bool:
        """Return whether the calling application is not the owner of a pipe."""
        return pipe.owner is not self.kernel.current.owner

    def is_valid_msg_id(self, msg_id: int) -> bool:
        """Return whether a MsgId is in 1..CFE_PLATFORM_SB_HIGHEST_VALID_MSGID (CFE_SB_IsValidMsgId)."""
        return 0 < msg_id <= self.config.sb_highest_valid_msg_id
