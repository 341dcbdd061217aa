"""An observer of a mission's Software Bus that sees every packet, including those without a subscriber.

It changes nothing: no subscription, no virtual time, no record in the trace. It continues over resets, because each
processor gets a bus of the class created here.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

from cfepy import msg
from cfepy.attachment import Attachment
from cfepy.msg import PRIMARY_HEADER_SIZE
from cfepy.sb import SoftwareBus

if TYPE_CHECKING:
    from rospy_shim.client.link import Link

HOST = "host"


class Seen(NamedTuple):
    """A packet on the bus: its virtual time in ns, its bytes as subscribers get them, the sending application."""

    at_ns: int
    packet: bytes
    sender: str

    @property
    def msg_id(self) -> int:
        """The packet's MsgId."""
        return self.packet[0] << 8 | self.packet[1]


def hearing(base: type[SoftwareBus], note: Callable[[Link, bytes], object]) -> type[SoftwareBus]:
    """Return a Software Bus class that reports messages that are not sent because their topic has no subscriber.

    Args:
        base: the class to derive from; its own report comes first.
        note: called with the publisher's link and the message.
    """
    before = base.on_unsent

    def tell(link: Link, message: bytes) -> None:
        if before is not None:
            before(link, message)
        note(link, message)

    return type("HeardBus", (base,), {"on_unsent": staticmethod(tell)})


class PacketWatch(Attachment):
    """Reports the packets that are sent.

    Args:
        take: called with each packet before its subscribers get it; it runs inside the simulation, so it must not wait.
        wanted: returns whether it gets a MsgId.
        unsent: whether it gets messages of nodes, too, that are not sent because their topic has no subscriber.
    """

    def __init__(
        self,
        take: Callable[[Seen], object],
        wanted: Callable[[int], bool] = lambda msg_id: True,
        unsent: bool = False,
    ) -> None:
        self._take = take
        self._wanted = wanted
        self._unsent = unsent

    def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        watched = _watched(base, self._take, self._wanted)
        return hearing(watched, self._take_unsent) if self._unsent else watched

    def _take_unsent(self, link: Link, message: bytes) -> None:
        from rospy_shim.types.transport import whole_header

        if self._wanted(link.msg_id):
            packet = message if link.topic is not None and link.topic.raw else whole_header(link.msg_id) + message
            self._take(Seen(link.node.kernel.now, packet, link.node.config.app))


def _watched(
    base: type[SoftwareBus], take: Callable[[Seen], object], wanted: Callable[[int], bool]
) -> type[SoftwareBus]:
    class WatchedBus(base):  # type: ignore[misc, valid-type]  # mypy does not follow a class that is an argument
        """A Software Bus with an observer."""

        def transmit_msg(self, packet: bytes | bytearray, is_origination: bool = True) -> None:
            if self._is_packet(packet) and wanted(packet[0] << 8 | packet[1]):
                owner = self.kernel.current.owner
                name: str = HOST if owner is None else owner.name
                take(Seen(self.kernel.now, self._as_sent(packet) if is_origination else bytes(packet), name))
            super().transmit_msg(packet, is_origination)

        def _is_packet(self, packet: bytes | bytearray) -> bool:
            return bool(PRIMARY_HEADER_SIZE < len(packet) <= self.config.sb_max_msg_size)

        def _as_sent(self, packet: bytes | bytearray) -> bytes:
            """Return the packet as completed at its origin."""
            copy = bytearray(packet)
            route = self.routes.get(copy[0] << 8 | copy[1])
            msg.set_size(copy, len(copy))
            sequence = 0 if route is None else route.sequence + 1
            msg.set_sequence_count(copy, sequence & msg.MAX_SEQUENCE_COUNT)
            msg.origination_action(copy, self.ports.time.stamp())
            return bytes(copy)

    return WatchedBus


def receivers(bus: SoftwareBus, msg_id: int) -> list[str]:
    """Return the names of the applications subscribed to a MsgId now."""
    route = bus.routes.get(msg_id)
    return [] if route is None else list(dict.fromkeys(each.pipe.app_name for each in route.active))
