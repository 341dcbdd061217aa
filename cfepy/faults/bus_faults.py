"""A Software Bus with faults on messages, either for all receivers or for one of them.

A fault for all receivers happens when the message is sent, after it got its sequence count, so that receivers notice
the gap. A fault for one application or pipe happens when it takes the message out; the others are not affected. The
`MessageSwitchboard` finds and caches the faults for each kind of message.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from cfepy import msg
from cfepy.faults.fault_names import MissionNames, matches, number_as_name
from cfepy.faults.message_faults import MessageFault, pass_through
from cfepy.mission import HOST
from cfepy.msg import get_sequence_count
from cfepy.ports import PEND_FOREVER
from cfepy.sb import BUFFER_BYTES, Destination, Pipe, SoftwareBus
from cfepy.status import CfeError
from cfepy.units import NS_PER_MS

Took = Callable[[bytes | bytearray, Pipe], object]
SEQUENCES = 1 << 14
SMALLEST = 7


class MessageSwitchboard:
    """Faults on messages of a run; none before `begin`.

    Attributes:
        on_take: called for each message that an application takes out of its pipe.
    """

    _names: MissionNames

    def __init__(self) -> None:
        self.on_take: list[Took] = []
        self._for_all: list[MessageFault] = []
        self._for_one: list[MessageFault] = []
        self._known: object = None
        self._found: dict[tuple[int, int], tuple[list[MessageFault], list[MessageFault]]] = {}
        self._senders: dict[tuple[int, int], str] = {}
        self._asks_sender = False

    def begin(self, faults: Sequence[MessageFault], names: MissionNames) -> None:
        """Set the faults of a run.

        Args:
            faults: faults on messages on the bus.
            names: names of messages.
        """
        self._names = names
        self._known = None
        for each in (self.on_take, self._found, self._senders):
            each.clear()
        self._for_all = [fault for fault in faults if fault.receiver is None]
        self._for_one = [fault for fault in faults if fault.receiver is not None]
        self._asks_sender = any(fault.sender is not None for fault in self._for_one)

    def on_send(self, packet: bytes | bytearray, sender: str) -> Sequence[MessageFault]:
        """Return the faults on a message for all of its receivers."""
        found = self._about(packet)[0]
        return [fault for fault in found if fault.sender in (None, sender)] if found else found

    def on_receive(self, packet: bytes, pipe: Pipe) -> Sequence[MessageFault]:
        """Return the faults on a message for the owner of a pipe."""
        found = [fault for fault in self._about(packet)[1] if fault.receiver in (pipe.app_name, pipe.name)]
        if not found or not self._asks_sender:
            return found
        sender = self._senders.get(_stamp(packet))
        return [fault for fault in found if fault.sender in (None, sender)]

    def sent(self, packet: bytes | bytearray, sequence: int, sender: str) -> None:
        """Remember the sender of a message, for faults with both sender and receiver."""
        if self._asks_sender and self._about(packet)[1]:
            self._senders[packet[0] << 8 | packet[1], sequence % SEQUENCES] = sender

    def took(self, packet: bytes, pipe: Pipe) -> None:
        """An application takes a message out of its pipe; the call may never return."""
        for take in self.on_take:
            take(packet, pipe)

    def shown(self, packet: bytes | bytearray) -> str:
        """Return a description of a message."""
        return f"{self._names.of(packet)[0]} #{get_sequence_count(packet)}"

    def is_called(self, packet: bytes | bytearray, target: str) -> bool:
        """Return whether a target of a plan matches a packet."""
        return matches(self._names.of(packet), (number_as_name(target),))

    def _about(self, packet: bytes | bytearray) -> tuple[list[MessageFault], list[MessageFault]]:
        """Return faults on a message for all receivers, and for one of them."""
        version = self._names.version()
        if version != self._known:
            self._known = version
            self._found.clear()
        msg_id = packet[0] << 8 | packet[1]
        key = msg_id, packet[6] if msg_id & 0x1000 and len(packet) > 6 else 0
        found = self._found.get(key)
        if found is None:
            names = self._names.of(packet)
            found = self._found[key] = (
                [fault for fault in self._for_all if _means(fault, names)],
                [fault for fault in self._for_one if _means(fault, names)],
            )
        return found


def _means(fault: MessageFault, names: Sequence[str]) -> bool:
    return matches(names, [number_as_name(target) for target in fault.fault.target])


def _stamp(packet: bytes) -> tuple[int, int]:
    return packet[0] << 8 | packet[1], get_sequence_count(packet)


class Passed(bytes):
    """A message in a pipe that already had its faults."""

    __slots__ = ()


def faulty(base: type[SoftwareBus], switchboard: MessageSwitchboard) -> type[SoftwareBus]:
    """Return a class of Software Bus with faults.

    Args:
        base: the class to start from.
        switchboard: gives the faults of a message.
    """

    class FaultyBus(base):  # type: ignore[misc, valid-type]  # mypy does not follow a class that is an argument
        """A Software Bus with faults on messages."""

        def transmit_msg(self, packet: bytes | bytearray, is_origination: bool = True) -> None:
            size = len(packet)
            if not SMALLEST <= size <= self.config.sb_max_msg_size or not (
                is_origination or msg.get_size(packet) == size
            ):
                super().transmit_msg(packet, is_origination)  # it reports the error
                return
            owner = self.kernel.current.owner
            sender: str = HOST if owner is None else owner.name
            route = self.routes.get(packet[0] << 8 | packet[1])
            if route is None or not route.active:
                super().transmit_msg(packet, is_origination)
                return
            sequence = route.sequence + 1 if is_origination else msg.get_sequence_count(packet)
            switchboard.sent(packet, sequence, sender)
            faults = switchboard.on_send(packet, sender)
            if not faults:
                super().transmit_msg(packet, is_origination)
                return
            if is_origination:
                route.sequence += 1
                packet = _originated(packet, route.sequence, self.ports.time.stamp())
            else:
                route.relayed += 1
            self._pass(bytes(packet), sender, owner, faults)

        def _pass(self, packet: bytes, sender: str, owner: Any, faults: Sequence[MessageFault]) -> None:
            where = f"{switchboard.shown(packet)} sent by {sender}"
            forward = super().transmit_msg

            def send(data: bytes) -> None:
                try:
                    self._send(data, owner, forward)
                except CfeError:
                    if data == packet:
                        raise
                    # Otherwise it was changed, so its sender does not learn that the bus refuses it.

            pass_through(faults, packet, packet[2] & 0xC0, sender, where, send)

        def _send(self, packet: bytes, owner: Any, forward: Callable[[bytes, bool], None]) -> None:
            """Send a message that was already counted, in the name of its sender."""
            task = self.kernel.current
            before, task.owner = task.owner, owner
            route = self.routes.get(packet[0] << 8 | packet[1])
            if route is not None:
                route.relayed -= 1
            try:
                forward(packet, False)
            except CfeError:
                if route is not None:
                    route.relayed += 1
                raise
            finally:
                task.owner = before

        def receive_buffer(self, pipe_id: int, timeout_ms: int = PEND_FOREVER) -> bytes | None:
            end_ns = self.kernel.now + timeout_ms * NS_PER_MS
            while True:
                packet: bytes | None = super().receive_buffer(pipe_id, timeout_ms)
                if packet is None:
                    return None
                pipe = self._pipe_of.get(pipe_id)
                taken = self._taken(packet, pipe) if pipe is not None else packet
                if taken is not None:
                    if pipe is not None:
                        switchboard.took(taken, pipe)
                    return taken
                if timeout_ms > 0:
                    timeout_ms = max(0, -((self.kernel.now - end_ns) // NS_PER_MS))

        def _taken(self, packet: bytes, pipe: Pipe) -> bytes | None:
            """Return the bytes that the receiver gets for a message from its pipe; None if it gets none now."""
            if type(packet) is Passed:
                return bytes(packet)
            faults = switchboard.on_receive(packet, pipe)
            if not faults:
                return packet
            destination = self._destination(packet, pipe)
            _count(destination, puts=-1, gets=-1)
            at_once: list[bytes] = []
            is_open = True

            def deliver(data: bytes) -> None:
                if is_open:
                    at_once.append(data)
                else:
                    self._put_back(pipe, destination, data)

            where = f"{switchboard.shown(packet)} on pipe {pipe.name}"
            pass_through(faults, packet, packet[2] & 0xC0, pipe.name, where, deliver)
            is_open = False
            for data in reversed(at_once[1:]):
                self._queue(pipe, destination, data, pipe.items.appendleft)
            if not at_once:
                return None
            _count(destination, puts=1, gets=1)
            return at_once[0]

        def _destination(self, packet: bytes, pipe: Pipe) -> Destination | None:
            route = self.routes.get(packet[0] << 8 | packet[1])
            if route is None:
                return None
            return next((each for each in (*route.destinations, *route.gone) if each.pipe is pipe), None)

        def _put_back(self, pipe: Pipe, destination: Destination | None, data: bytes) -> None:
            """Put a delayed message into the pipe, in which it had its place."""
            if pipe.is_closed():
                return
            if pipe.waits:
                _count(destination, puts=1)
                self.kernel.make_ready(pipe.waits.pop(0), (Passed(data), destination or Destination(pipe, 1, 0)))
            else:
                self._queue(pipe, destination, data, pipe.items.append)

        def _queue(
            self, pipe: Pipe, destination: Destination | None, data: bytes, add: Callable[[Any], object]
        ) -> None:
            _count(destination, puts=1)
            self._queued_bytes += len(data) + BUFFER_BYTES
            add((Passed(data), destination or Destination(pipe, 1, 0)))

    return FaultyBus


def _originated(packet: bytes | bytearray, sequence: int, stamp: int) -> bytes:
    """Return a packet with the fields that the bus fills in."""
    copy = bytearray(packet)
    msg.set_size(copy, len(copy))
    msg.set_sequence_count(copy, sequence & msg.MAX_SEQUENCE_COUNT)
    msg.origination_action(copy, stamp)
    return bytes(copy)


def _count(destination: Destination | None, puts: int = 0, gets: int = 0) -> None:
    """Correct the counts of a destination, if it still exists."""
    if destination is not None:
        destination.puts += puts
        destination.gets += gets
