"""The Software Bus: subscribing, transmitting and receiving (cfe_sb_api.c).

A message is one immutable bytes object, shared by all its pipes. It cannot change in transit, so the interpreter does
the work of C's reference-counted buffers. Transmitting never waits. This is the hot path of every mission: it creates
no object except the packet and its queue entry, and handles the usual case first.

While reports are on, other processors get each subscription that is not local, as it is made (`tell_one`), or all of
them at once (`tell_all`).
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any, ClassVar

from cfepy.config.platform import PlatformConfig
from cfepy.interpreter.compiled import mypyc_attr
from cfepy.msg import CMD_HEADER_SIZE, compute_checksum
from cfepy.osal import NOBODY, ObjectSizes
from cfepy.ports import PEND_FOREVER, Ports
from cfepy.rtos import FOREVER, TIMEOUT, CpuCosts, Kernel
from cfepy.sb import events as ev
from cfepy.sb import packets as pk
from cfepy.sb.buffers import BUFFER_BYTES, DESTINATION_BYTES
from cfepy.sb.core import BusCore
from cfepy.sb.pipe import Pipe
from cfepy.sb.pipes import PipeServices
from cfepy.sb.routing import GLOBAL, LOCAL, SECONDARY, Destination, Route
from cfepy.status import (
    CFE_SB_BAD_ARGUMENT,
    CFE_SB_BUF_ALOC_ERR,
    CFE_SB_MAX_DESTS_MET,
    CFE_SB_MAX_MSGS_MET,
    CFE_SB_PIPE_RD_ERR,
    CFE_SUCCESS,
    OS_ERR_INVALID_ID,
    CfeError,
)
from cfepy.trace import BATCH, LARGE, UNSENT

DEFAULT_QOS = 0
POLL = 0
LOST_MS = 1
"""Milliseconds of a time-out for which `SoftwareBus.receive_buffer` does not wait."""
SECONDARY_BIT = SECONDARY >> 8
UNSENT_PACKET = UNSENT + b"\0"
FIRST_SEGMENT = 0x40  # bits of the sequence flags in byte 2: the first packet of a message
unpack_primary = struct.Struct(">HH").unpack_from
pack_telemetry = struct.Struct(">HHH6s").pack


def tell_one(bus: BusCore, msg_id: int, pipe_id: int, qos: int) -> None:
    """Report a subscription, if reports are on (CFE_SB_SendSubscriptionReport).

    Args:
        bus: the bus.
        msg_id: the MsgId.
        pipe_id: the pipe.
        qos: see `SubscriptionServices.subscribe_ex`.
    """
    if not bus.reporting:
        return
    quality = {"Priority": qos & 0xFF, "Reliability": qos >> 8 & 0xFF}
    status = _send(bus, pk.ONESUB_TLM.packet(SubType=pk.SUBSCRIPTION, MsgId=msg_id, Qos=quality, Pipe=pipe_id))
    text = f"Sending Subscription Report Msg=0x{msg_id:x},Pipe={pipe_id},Stat=0x{status:x}"
    bus.report(ev.SUBSCRIPTION_RPT_EID, ev.DEBUG, text)


def tell_all(bus: BusCore) -> None:
    """Report all MsgIds wanted from other processors, 20 per packet (CFE_SB_SendPrevSubsCmd).

    As in NASA's code, the entries have no pipe and no quality, and TotalSegments stays 0.
    """
    wanted = [each.msg_id for each in bus.routes.values() if any(one.scope == GLOBAL for one in each.destinations)]
    most = pk.SUB_ENTRIES_PER_PKT
    for segment, start in enumerate(range(0, len(wanted), most), 1):
        entries = [{"MsgId": msg_id} for msg_id in wanted[start : start + most]]
        status = _send(bus, pk.ALLSUBS_TLM.packet(PktSegment=segment, Entries=len(entries), Entry=entries))
        is_full = len(entries) == most
        text = f"{'Full' if is_full else 'Partial'} Sub Pkt {segment} Sent,Entries={len(entries)},Stat=0x{status:x}"
        bus.report(ev.FULL_SUB_PKT_EID if is_full else ev.PART_SUB_PKT_EID, ev.DEBUG, text)


def _send(bus: BusCore, packet: bytes) -> int:
    """Transmit a packet; return the status as an unsigned number."""
    try:
        bus.ports.sb.transmit_msg(packet)
    except CfeError as error:
        return error.status & 0xFFFFFFFF
    return CFE_SUCCESS


@mypyc_attr(allow_interpreted_subclasses=True)
class SubscriptionServices(PipeServices):
    """The CFE_SB_Subscribe* and CFE_SB_Unsubscribe* functions."""

    def subscribe(self, msg_id: int, pipe_id: int) -> None:
        """Subscribe a pipe to a MsgId, with the default message limit of 4 (CFE_SB_Subscribe)."""
        self._subscribe(msg_id, pipe_id, self.config.sb_default_msg_limit, GLOBAL)

    def subscribe_ex(self, msg_id: int, pipe_id: int, qos: int = DEFAULT_QOS, msg_limit: int = 4) -> None:
        """Subscribe a pipe to a MsgId (CFE_SB_SubscribeEx).

        Args:
            msg_id: the MsgId.
            pipe_id: a pipe of the calling application.
            qos: priority, and reliability times 256 (CFE_SB_Qos_t); reported to other processors, not used on this one.
            msg_limit: maximum number of messages of this MsgId in the pipe.

        Raises:
            CfeError: CFE_SB_BAD_ARGUMENT, CFE_SB_MAX_MSGS_MET (MsgIds), CFE_SB_MAX_DESTS_MET (pipes of the MsgId),
                CFE_SB_BUF_ALOC_ERR (the message pool has no room).
        """
        self._subscribe(msg_id, pipe_id, msg_limit, GLOBAL, qos)

    def subscribe_local(self, msg_id: int, pipe_id: int, msg_limit: int) -> None:
        """Subscribe a pipe to a MsgId without a report to other processors; see `subscribe_ex`
        (CFE_SB_SubscribeLocal).
        """
        self._subscribe(msg_id, pipe_id, msg_limit, LOCAL)

    def unsubscribe(self, msg_id: int, pipe_id: int) -> None:
        """Unsubscribe a pipe from a MsgId (CFE_SB_Unsubscribe); waiting messages stay.

        Raises:
            CfeError: CFE_SB_BAD_ARGUMENT for an invalid MsgId or pipe. A missing subscription is an event, not an
                error.
        """
        self._unsubscribe(msg_id, pipe_id, GLOBAL)

    def unsubscribe_local(self, msg_id: int, pipe_id: int) -> None:
        """Unsubscribe a pipe from a MsgId; see `unsubscribe` (CFE_SB_UnsubscribeLocal)."""
        self._unsubscribe(msg_id, pipe_id, LOCAL)

    def _unsubscribe(self, msg_id: int, pipe_id: int, scope: int) -> None:
        app = self.caller_name()
        pipe = self.find_pipe(pipe_id)
        if pipe is None:
            text = f"Unsubscribe Err:Invalid Pipe Id Msg=0x{msg_id:x},Pipe={pipe_id},app={app}"
            raise self._refused(ev.UNSUB_INV_PIPE_EID, text)
        if self.is_foreign(pipe):
            text = f"Unsubscribe Err:Caller({app}) is not the owner of pipe {pipe_id},Msg=0x{msg_id:x}"
            raise self._refused(ev.UNSUB_INV_CALLER_EID, text)
        if not self.is_valid_msg_id(msg_id):
            text = f"Unsubscribe Err:Bad Arg,MsgId 0x{msg_id:x},PipeId {pipe_id},app {app},scope {scope}"
            raise self._refused(ev.UNSUB_ARG_ERR_EID, text)
        self._remove(msg_id, pipe, app)

    def _remove(self, msg_id: int, pipe: Pipe, app: str) -> None:
        route = self.routes.get(msg_id)
        destination = route.find(pipe) if route is not None else None
        if route is None or destination is None:
            text = f"Unsubscribe Err:No subs for Msg 0x{msg_id:x} on {pipe.name},app {app}"
            self.report(ev.UNSUB_NO_SUBS_EID, ev.INFORMATION, text)
            return
        self.remove_destination(route, destination)
        text = f"Subscription Removed:Msg 0x{msg_id:x} on pipe {pipe.pipe_id},app {app}"
        self.report(ev.SUBSCRIPTION_REMOVED_EID, ev.DEBUG, text)

    def _subscribe(self, msg_id: int, pipe_id: int, limit: int, scope: int, qos: int = DEFAULT_QOS) -> None:
        pipe = self._check_subscription(msg_id, pipe_id, scope)
        app = self.caller_name()
        route = self._route_for(msg_id, pipe, app)
        if route.find(pipe) is not None:
            self.counters.duplicate_subscriptions += 1
            text = f"Duplicate Subscription,MsgId 0x{msg_id:x} on {pipe.name} pipe,app {app}"
            self.report(ev.DUP_SUBSCRIP_EID, ev.INFORMATION, text)
        else:
            self._add(route, pipe, limit & 0xFFFF, scope)  # C has 16 bits
            text = f"Subscription Rcvd:MsgId 0x{msg_id:x} on PipeId {pipe_id},app {app}"
            self.report(ev.SUBSCRIPTION_RCVD_EID, ev.DEBUG, text)
        if scope == GLOBAL:
            tell_one(self, msg_id, pipe_id, qos)

    def _route_for(self, msg_id: int, pipe: Pipe, app: str) -> Route:
        """Return the route of a MsgId, and create it if it is missing."""
        if msg_id not in self.routes and not self.routing.add_route(msg_id):
            limit_text = f"Max Msgs({self.config.sb_max_msg_ids})In Use"
            text = f"Subscribe Err:{limit_text},MsgId 0x{msg_id:x},pipe {pipe.name},app {app}"
            raise self._subscribe_error(ev.MAX_MSGS_MET_EID, CFE_SB_MAX_MSGS_MET, text)
        self.peaks.msg_ids = len(self.routes)
        return self.routes[msg_id]

    def _add(self, route: Route, pipe: Pipe, limit: int, scope: int) -> None:
        most = self.config.sb_max_dest_per_pkt
        if len(route.destinations) >= most:
            where = f"For Msg 0x{route.msg_id:x},pipe {pipe.name},app {self.caller_name()}"
            text = f"Subscribe Err:Max Dests({most})In Use {where}"
            raise self._subscribe_error(ev.MAX_DESTS_MET_EID, CFE_SB_MAX_DESTS_MET, text)
        try:
            block = self.take_block(DESTINATION_BYTES)
        except CfeError as error:
            text = f"Subscribe Err:Request for Destination Blk failed for Msg 0x{route.msg_id:x}"
            raise self._subscribe_error(ev.DEST_BLK_ERR_EID, error.status, text) from error
        route.add(Destination(pipe, limit, scope, block))
        self.subscriptions += 1
        self.peaks.subscriptions = max(self.peaks.subscriptions, self.subscriptions)
        self.note_growth()

    def _check_subscription(self, msg_id: int, pipe_id: int, scope: int) -> Pipe:
        app = self.caller_name()
        pipe = self.find_pipe(pipe_id)
        if pipe is None:
            self.report_nameless(pipe_id)  # NASA's code looks up the name before it sends any event
            text = f"Subscribe Err:Invalid Pipe Id,Msg=0x{msg_id:x},PipeId={pipe_id},App {app}"
            raise self._subscribe_error(ev.SUB_INV_PIPE_EID, CFE_SB_BAD_ARGUMENT, text)
        if self.is_foreign(pipe):
            text = f"Subscribe Err:Caller({app}) is not the owner of pipe {pipe_id},Msg=0x{msg_id:x}"
            raise self._subscribe_error(ev.SUB_INV_CALLER_EID, CFE_SB_BAD_ARGUMENT, text)
        if not self.is_valid_msg_id(msg_id):
            text = f"Subscribe Err:Bad Arg,MsgId 0x{msg_id:x},PipeId {pipe_id},app {app},scope {scope}"
            raise self._subscribe_error(ev.SUB_ARG_ERR_EID, CFE_SB_BAD_ARGUMENT, text)
        return pipe

    def _subscribe_error(self, event_id: int, status: int, text: str) -> CfeError:
        self.counters.subscribe_error += 1
        self.report(event_id, ev.ERROR, text)
        return CfeError(status, text)

    def _refused(self, event_id: int, text: str) -> CfeError:
        self.report(event_id, ev.ERROR, text)
        return CfeError(CFE_SB_BAD_ARGUMENT, text)


@mypyc_attr(allow_interpreted_subclasses=True)
class SoftwareBus(SubscriptionServices):
    """The Software Bus of one processor; see `BusCore` for the arguments.

    A message that no pipe gets is in the trace too, see `unsent`. On an observed bus, `on_unsent` is called with each
    message that a ROS publisher does not send for lack of subscribers: sender, bytes.
    """

    on_unsent: ClassVar[Callable[[Any, bytes], object] | None] = None

    def __init__(
        self,
        kernel: Kernel,
        ports: Ports,
        config: PlatformConfig,
        costs: CpuCosts | None = None,
        sizes: ObjectSizes | None = None,
    ) -> None:
        super().__init__(kernel, ports, config, costs, sizes)
        self._stamped_at = -1
        self._time = bytes(6)
        self._max_size = config.sb_max_msg_size
        self._pipe_of = self.pipes.records
        self._record = kernel.record
        self._records = kernel.trace.records if kernel.trace is not None else []
        self._flush = kernel.trace.flush if kernel.trace is not None else _nothing

    def listen(self, listener: Callable[[bytes], object]) -> None:
        """Call `listener` with each packet from now on, before any pipe gets it."""
        record = self._record

        def both(item: bytes) -> None:
            listener(item)
            if record is not None:
                record(item)

        self._record = both

    # -- transmitting ----------------------------------------------------------------------------------------------

    def transmit_msg(self, packet: bytes | bytearray, is_origination: bool = True) -> None:
        """Send a packet to every pipe subscribed to its MsgId (CFE_SB_TransmitMsg).

        Args:
            packet: a whole CCSDS packet with cFE's headers.
            is_origination: fill in the sequence count, and the time of telemetry or the checksum of a command; False
                sends the packet unchanged (from a ground link or another processor).

        Raises:
            CfeError: CFE_SB_BAD_ARGUMENT (no packet, invalid MsgId or length), CFE_SB_MSG_TOO_BIG, CFE_SB_BUF_ALOC_ERR
                (no room in the pool, or the caller belongs to no application, as the callback of an OSAL timer). A full
                pipe and a reached message limit are events, not errors; other pipes still get the message.
        """
        size = len(packet)
        if not 6 < size <= self._max_size:
            if size > 6:
                self.unsent(UNSENT_PACKET + packet)
            self.check_header(packet, size)
        kernel = self.kernel
        if kernel.current.owner is NOBODY:  # a buffer belongs to an application
            raise self._no_buffer(packet)
        msg_id, bits = unpack_primary(packet)
        route = self.routes.get(msg_id)
        if route is None:
            if not is_origination:
                self.check_header(packet, _claimed_size(packet))
            self._no_route(packet)
            return
        if self._queued_bytes + size > self._known_bytes and self.pool_is_full(packet):
            raise self._no_buffer(packet)
        if not is_origination:
            packet = self._relayed(route, packet)
        else:
            sequence = route.sequence + 1
            route.sequence = sequence
            bits = bits & 0xC000 | sequence & 0x3FFF
            if route.is_telemetry and size > 11:
                now = kernel.now
                if now != self._stamped_at:
                    self._stamp(now)
                packet = pack_telemetry(msg_id, bits, size - 7, self._time) + packet[12:]
            else:
                packet = self._originated(packet, bits)
        if self._record is not None:
            self._record(packet)
        if self.costs is not None:
            kernel.charge(self.costs.of(size))
        hook = self.put_hook
        failures: Failures | None = None
        for destination in route.active:
            pipe = destination.pipe
            if pipe.unheard:
                if kernel.current.owner in pipe.unheard:
                    continue
                if pipe.is_filled:
                    failures = _overflowed(failures, destination)
                    continue
            puts = destination.puts
            if puts - destination.gets >= (destination.limit if hook is None else hook.limit(destination)):
                failures = _limited(failures, destination)
                continue
            waits = pipe.waits
            if waits:
                if not pipe.peak:
                    pipe.peak = 1
                if hook is not None:
                    hook.put(destination)
                destination.puts = puts + 1
                kernel.make_ready(waits.pop(0), (packet, destination))
                continue
            items = pipe.items
            waiting = len(items)
            if waiting >= pipe.depth:
                if not (pipe.keeps_newest and waiting):
                    failures = _overflowed(failures, destination)
                    continue
                waiting = self._make_room(pipe, size)
                puts = destination.puts
            if hook is not None:
                hook.put(destination)
            self._queued_bytes += size + BUFFER_BYTES
            destination.puts = puts + 1
            items.append((packet, destination))
            if waiting >= pipe.peak:
                pipe.peak = waiting + 1
        if failures is not None:
            self._report_failures(msg_id, failures)

    def _stamp(self, now: int) -> None:
        """Cache the spacecraft time of this instant in the format of the header."""
        self._time = self.ports.time.stamp().to_bytes(6, "big")
        self._stamped_at = now

    def forget_time(self) -> None:
        """Invalidate the cached time, because the spacecraft time was set."""
        self._stamped_at = -1

    def _originated(self, packet: bytes | bytearray, bits: int) -> bytes:
        """Return a command, or a packet without a secondary header, completed at its origin."""
        header = packet[:2] + (bits << 16 | len(packet) - 7).to_bytes(4, "big")
        if packet[0] & SECONDARY_BIT and len(packet) >= CMD_HEADER_SIZE:
            command = bytearray(header + packet[6:])
            command[7] = 0
            command[7] = compute_checksum(command)
            return bytes(command)
        return bytes(header + packet[6:])

    def _relayed(self, route: Route, packet: bytes | bytearray) -> bytes:
        """Return a packet from elsewhere unchanged."""
        claimed = _claimed_size(packet)
        if claimed != len(packet):
            self.unsent(UNSENT_PACKET + packet)
            self.check_header(packet, claimed)
            text = f"Send Err:Bad input argument,Arg 0x0,App {self.caller_name()}"
            raise self.send_error(ev.SEND_BAD_ARG_EID, CFE_SB_BAD_ARGUMENT, text)
        route.relayed += 1
        return bytes(packet)

    def _make_room(self, pipe: Pipe, size: int) -> int:
        """Make room for a packet in a full pipe that `keeps_newest`; return the number of packets left."""
        if pipe.spill is not None and pipe.spill(size):
            return len(pipe.items)
        return self._drop_oldest(pipe)

    def _drop_oldest(self, pipe: Pipe) -> int:
        """Remove the oldest message with all its segments from a pipe; return the number of packets left."""
        items = pipe.items
        begins = False
        while items and not begins:
            packet, destination = items.popleft()
            self._queued_bytes -= len(packet) + BUFFER_BYTES
            destination = destination.counted_at()
            destination.puts -= 1
            destination.overflow_drops += 1
            begins = bool(items) and items[0][0][2] & FIRST_SEGMENT != 0
        if self._record is not None:
            self._record(pipe.drop_mark)
        return len(items)

    # -- messages that wait elsewhere ----------------------------------------------------------------------------------

    def set_aside(self, pipe: Pipe) -> list[Waiting]:
        """Take the messages out of a pipe and its memory; they count as waiting, and observers do not notice.

        ROS subscribers do so with messages that, on ROS, wait in sockets.
        """
        waiting = list(pipe.items)
        pipe.items.clear()
        self._queued_bytes -= sum(len(packet) + BUFFER_BYTES for packet, _ in waiting)
        return waiting

    def put_back(self, pipe: Pipe, waiting: list[Waiting]) -> None:
        """Put messages from `set_aside` in front of a pipe, even if it then holds more than its depth."""
        pipe.items.extendleft(reversed(waiting))
        self._queued_bytes += sum(len(packet) + BUFFER_BYTES for packet, _ in waiting)

    def discard(self, pipe: Pipe, waiting: list[Waiting]) -> None:
        """Drop messages from `set_aside`, like a pipe that `keeps_newest`."""
        others = self.set_aside(pipe)
        self.put_back(pipe, waiting)
        while pipe.items:
            self._drop_oldest(pipe)
        self.put_back(pipe, others)

    # -- receiving -------------------------------------------------------------------------------------------------

    def receive_buffer(self, pipe_id: int, timeout_ms: int = PEND_FOREVER) -> bytes | None:
        """Take the oldest message from a pipe (CFE_SB_ReceiveBuffer).

        Args:
            pipe_id: any pipe; its owner is not checked, as in NASA's code.
            timeout_ms: POLL (0), PEND_FOREVER (-1), or a time of which the bus waits one ms less: cFE makes it
                absolute, and rounds the rest down to whole ms when some of it has passed
                (CFE_SB_MessageTxn_GetOsTimeout). So 1 is like POLL.

        Returns:
            The packet, or None if none came.

        Raises:
            CfeError: CFE_SB_BAD_ARGUMENT (pipe, timeout), CFE_SB_PIPE_RD_ERR (the pipe was deleted during the wait).
        """
        pipe = self._pipe_of.get(pipe_id)
        if pipe is None or timeout_ms < PEND_FOREVER:
            raise self._receive_error(pipe_id, timeout_ms)
        if self.costs is not None:
            self.kernel.charge(self.costs.call_ns)
        items = pipe.items
        packet: bytes
        destination: Destination
        if items:
            packet, destination = items.popleft()
            self._queued_bytes -= len(packet) + BUFFER_BYTES
        elif POLL <= timeout_ms <= POLL + LOST_MS:
            return None
        elif pipe.is_called:
            pipe.is_called = False
            return None
        else:
            item = self.kernel.wait_on(pipe.waits, FOREVER if timeout_ms < 0 else (timeout_ms - LOST_MS) * 1_000_000)
            if item is TIMEOUT:
                return None
            if item is None:
                raise self._read_error(pipe)
            packet, destination = item
        if destination.kin is not None:
            destination = destination.counted_at()
        destination.gets += 1
        if self._record is not None:
            self._record(pipe.receive_mark)
            if len(self._records) > BATCH:
                self._flush()
        return packet

    # -- errors --------------------------------------------------------------------------------------------------------

    def unsent(self, record: bytes) -> None:
        """Record a message that the bus does not carry, so that the digest of a run covers everything published.

        Args:
            record: a record of the kind UNSENT.
        """
        if self.kernel.record is None:
            return
        self.kernel.record(record)
        if len(record) > LARGE or len(self._records) > BATCH:
            self._flush()

    def _no_route(self, packet: bytes | bytearray) -> None:
        self.unsent(UNSENT_PACKET + packet)
        self.check_header(packet, len(packet))
        msg_id = packet[0] << 8 | packet[1]
        self.counters.no_subscribers += 1
        self.unrouted.sent[msg_id] = self.unrouted.sent.get(msg_id, 0) + 1
        text = f"No subscribers for MsgId 0x{msg_id:x},sender {self.caller_name()}"
        self.report_once(ev.SEND_NO_SUBS_EID, ev.INFORMATION, text)

    def _no_buffer(self, packet: bytes | bytearray) -> CfeError:
        self.unsent(UNSENT_PACKET + packet)
        where = f"MsgId 0x{packet[0] << 8 | packet[1]:x},app {self.caller_name()},size {len(packet)}"
        return self.send_error(ev.GET_BUF_ERR_EID, CFE_SB_BUF_ALOC_ERR, f"Send Err:Request for Buffer Failed. {where}")

    def _report_failures(self, msg_id: int, failures: Failures) -> None:
        self.counters.msg_send_error += 1
        for event_id, destination in failures:
            if self._record is not None:
                self._record(destination.pipe.drop_mark)
            self._report_failure(event_id, msg_id, destination.pipe)

    def _report_failure(self, event_id: int, msg_id: int, pipe: Pipe) -> None:
        where = f"MsgId 0x{msg_id:x},pipe {pipe.name},sender {self.caller_name()}"
        if event_id == ev.MSGID_LIM_ERR_EID:
            self.counters.msg_limit_error += 1
            pipe.send_errors += 1
            self.report_once(event_id, ev.ERROR, f"Msg Limit Err,{where}")
        elif not pipe.is_closed():
            self.counters.pipe_overflow_error += 1
            pipe.overflows += 1
            self.report_once(event_id, ev.ERROR, f"Pipe Overflow,{where}")
        else:
            self._report_write_error(msg_id, pipe, OS_ERR_INVALID_ID)

    def _report_write_error(self, msg_id: int, pipe: Pipe, status: int) -> None:
        self.counters.internal_error += 1
        where = f"MsgId 0x{msg_id:x},pipe {pipe.name},sender {self.caller_name()}"
        self.report_once(ev.Q_WR_ERR_EID, ev.ERROR, f"Pipe Write Err,{where},stat {status}")

    def _receive_error(self, pipe_id: int, timeout_ms: int) -> CfeError:
        self.counters.msg_receive_error += 1
        app = self.caller_name()
        if timeout_ms < PEND_FOREVER:
            text = f"Rcv Err:Bad Input Arg:BufPtr 0x0,pipe [n/a],t/o {timeout_ms},app {app}"
            self.report_once(ev.RCV_BAD_ARG_EID, ev.ERROR, text)
        else:
            text = f"Rcv Err:PipeId {pipe_id} does not exist,app {app}"
            self.report_once(ev.BAD_PIPEID_EID, ev.ERROR, text)
        return CfeError(CFE_SB_BAD_ARGUMENT, text)

    def _read_error(self, pipe: Pipe) -> CfeError:
        self.counters.internal_error += 1
        text = f"Pipe Read Err,pipe {pipe.name},app {self.caller_name()},stat -1"
        self.report_once(ev.Q_RD_ERR_EID, ev.ERROR, text)
        return CfeError(CFE_SB_PIPE_RD_ERR, text)


Failures = list[tuple[int, Destination]]
Waiting = tuple[bytes, Destination]
"""A packet in a pipe."""


def _limited(failures: Failures | None, destination: Destination) -> Failures:
    """Count a message refused because of a message limit; return the failures to report, including this one."""
    destination.limit_drops += 1
    return [*(failures or ()), (ev.MSGID_LIM_ERR_EID, destination)]


def _overflowed(failures: Failures | None, destination: Destination) -> Failures:
    """Count a message refused because of a full pipe; return the failures to report, including this one."""
    destination.overflow_drops += 1
    return [*(failures or ()), (ev.Q_FULL_ERR_EID, destination)]


def _nothing() -> None:
    """Do nothing: the flush of a run without a trace."""


def _claimed_size(packet: bytes | bytearray) -> int:
    """Return the size of a packet according to its header."""
    return (packet[4] << 8 | packet[5]) + 7
