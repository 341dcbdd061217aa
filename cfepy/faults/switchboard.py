"""Which faults a message on the bus meets, found once for each kind of message and kept. Imports its neighbours."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from cfepy.faults.messages import MessageFault
from cfepy.faults.names import Names, matches, number_as_name
from cfepy.msg import get_sequence_count
from cfepy.sb.pipe import Pipe

Took = Callable[[bytes | bytearray, Pipe], object]
SEQUENCES = 1 << 14


class MessageSwitchboard:
    """The faults on messages of a run; none before `begin`.

    Attributes:
        on_take: called for each message that an application takes out of its pipe.
    """

    _names: Names

    def __init__(self) -> None:
        self.on_take: list[Took] = []
        self._for_all: list[MessageFault] = []
        self._for_one: list[MessageFault] = []
        self._known: object = None
        self._found: dict[tuple[int, int], tuple[list[MessageFault], list[MessageFault]]] = {}
        self._senders: dict[tuple[int, int], str] = {}
        self._asks_sender = False

    def begin(self, faults: Sequence[MessageFault], names: Names) -> None:
        """Take the faults of a run.

        Args:
            faults: those that are about messages on the bus.
            names: what messages are called.
        """
        self._names = names
        self._known = None
        for each in (self.on_take, self._found, self._senders):
            each.clear()
        self._for_all = [fault for fault in faults if fault.receiver is None]
        self._for_one = [fault for fault in faults if fault.receiver is not None]
        self._asks_sender = any(fault.sender is not None for fault in self._for_one)

    def on_send(self, packet: bytes | bytearray, sender: str) -> Sequence[MessageFault]:
        """The faults that are about a message for all of its receivers."""
        found = self._about(packet)[0]
        return [fault for fault in found if fault.sender in (None, sender)] if found else found

    def on_receive(self, packet: bytes, pipe: Pipe) -> Sequence[MessageFault]:
        """The faults that are about a message for the owner of a pipe."""
        found = [fault for fault in self._about(packet)[1] if fault.receiver in (pipe.app_name, pipe.name)]
        if not found or not self._asks_sender:
            return found
        sender = self._senders.get(_stamp(packet))
        return [fault for fault in found if fault.sender in (None, sender)]

    def sent(self, packet: bytes | bytearray, sequence: int, sender: str) -> None:
        """Remember who sent a message, for faults that ask for both sender and receiver."""
        if self._asks_sender and self._about(packet)[1]:
            self._senders[packet[0] << 8 | packet[1], sequence % SEQUENCES] = sender

    def took(self, packet: bytes, pipe: Pipe) -> None:
        """An application takes a message out of its pipe; it may never come back from that."""
        for take in self.on_take:
            take(packet, pipe)

    def shown(self, packet: bytes | bytearray) -> str:
        """A message in words."""
        return f"{self._names.of(packet)[0]} #{get_sequence_count(packet)}"

    def is_called(self, packet: bytes | bytearray, target: str) -> bool:
        """Whether a target of a plan means a packet."""
        return matches(self._names.of(packet), (number_as_name(target),))

    def _about(self, packet: bytes | bytearray) -> tuple[list[MessageFault], list[MessageFault]]:
        """Faults on a message for all receivers, and for one of them."""
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
