"""What can happen to one message on its way: lost, doubled, late, out of order, changed.

A fault gets the bytes and a function that sends them on, which it calls as often and as late as it likes. So faults of
several kinds can strike the same message, and it does not matter whether it is on the bus or a datagram on the network.
A long ROS message goes out in segments; a fault strikes all of them alike, unless its unit is the segment.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from random import Random
from typing import Any

from cfepy.faults.fault_names import MissionNames, matches
from cfepy.faults.fault_plan import Fault
from cfepy.faults.fault_report import FaultReport
from cfepy.faults.timing import Agenda, Gate
from cfepy.msg import CMD_HEADER_SIZE, PRIMARY_HEADER_SIZE, generate_checksum, get_header_size
from cfepy.rtos import Kernel
from cfepy.status import UsageError
from cfepy.units import NS_PER_S

Send = Callable[[bytes], object]
WHOLE, FIRST, LAST = 0xC0, 0x40, 0x80  # sequence flags in byte 2 of a packet
DEFAULT_WITHIN_NS = NS_PER_S


class Setting:
    """What all faults on messages need of the run: time, agenda, report, names."""

    def __init__(self, kernel: Kernel, agenda: Agenda, report: FaultReport, names: MissionNames) -> None:
        self.kernel = kernel
        self.agenda = agenda
        self.report = report
        self.names = names


class MessageFault(ABC):
    """A fault on messages while it runs.

    Args:
        fault: what the plan says.
        gate: when it happens.
        setting: of the run.
    """

    def __init__(self, fault: Fault, gate: Gate, setting: Setting) -> None:
        self.fault = fault
        self.gate = gate
        self.setting = setting
        self.sender: str | None = fault.options.get("from")
        self.receiver: str | None = fault.options.get("to")
        self._by_segment = fault.options.get("unit") == "segment"
        self._struck: dict[object, bool] = {}  # by stream: whether the message that is under way in segments is struck

    def strikes(self, data: bytes, flags: int, stream: object) -> bool:
        """Whether it happens to a message, or to the segment of one.

        Args:
            data: the message.
            flags: its sequence flags; `WHOLE` for what is no segment.
            stream: tells senders apart whose segments may mingle.
        """
        if flags != WHOLE and flags != FIRST and not self._by_segment:
            return self._struck.get(stream, False)
        struck = self.gate.opens(self.setting.kernel.now) and self.is_possible(data)
        if flags == FIRST:
            self._struck[stream] = struck
        return struck

    def tell(self, flags: int, where: str) -> None:
        """It happens: report it, of a long message once.

        Args:
            flags: the message's sequence flags.
            where: the message in words.
        """
        if flags in (WHOLE, FIRST) or self._by_segment:
            self.setting.report.happened(self.fault, f"{self.words()} {where}")

    def is_possible(self, data: bytes) -> bool:
        """Whether it can happen to this message; when not, it has told the report why."""
        return True

    def words(self) -> str:
        """What it does, for the report."""
        return f"{self.fault.kind}s"

    @abstractmethod
    def act(self, data: bytes, flags: int, send: Send) -> None:
        """Do it to a message that it strikes."""

    def passed(self, flags: int) -> None:  # noqa: B027  # most kinds have nothing to do then
        """A message that it is about went on, struck or not."""


class DropMessage(MessageFault):
    """It gets lost."""

    def act(self, data: bytes, flags: int, send: Send) -> None:
        """Nothing is sent."""


class DuplicateMessage(MessageFault):
    """It comes more than once: of a long message, the whole of it again after its last segment."""

    def __init__(self, fault: Fault, gate: Gate, setting: Setting) -> None:
        super().__init__(fault, gate, setting)
        self._copies = fault.options.get("copies", 1)
        self._parts: list[bytes] = []

    def act(self, data: bytes, flags: int, send: Send) -> None:
        """Send it, and again."""
        send(data)
        if self._by_segment or flags == WHOLE:
            parts = [data]
        else:
            self._parts = [data] if flags == FIRST else [*self._parts, data]
            parts = self._parts if flags == LAST else []
        for _ in range(self._copies):
            for part in parts:
                send(part)


class DelayMessage(MessageFault):
    """It comes later; the segments of a message all by the same time."""

    def __init__(self, fault: Fault, gate: Gate, setting: Setting) -> None:
        super().__init__(fault, gate, setting)
        self._least, self._most = fault.options["by"]
        self._by = self._least

    def strikes(self, data: bytes, flags: int, stream: object) -> bool:
        if self._least != self._most and (flags in (WHOLE, FIRST) or self._by_segment):
            self._by = self.gate.random.randint(self._least, self._most)
        return super().strikes(data, flags, stream)

    def words(self) -> str:
        """With the time."""
        return f"delays by {self._by / 1e9:g} s"

    def act(self, data: bytes, flags: int, send: Send) -> None:
        """Send it later."""
        self.setting.agenda.add(self.setting.kernel.now + self._by, lambda: send(data))


class ReorderMessage(MessageFault):
    """It comes after later ones, or after a time when none come."""

    def __init__(self, fault: Fault, gate: Gate, setting: Setting) -> None:
        super().__init__(fault, gate, setting)
        self._past = fault.options.get("past", 1)
        self._within = fault.options.get("within", DEFAULT_WITHIN_NS)
        self._held: list[list[Any]] = []  # messages to let pass, and what then sends it

    def act(self, data: bytes, flags: int, send: Send) -> None:
        """Keep it."""
        held = [self._past + 1, lambda: send(data)]  # one more, since this message counts as well
        self._held.append(held)
        self.setting.agenda.add(self.setting.kernel.now + self._within, lambda: self._let_go(held))

    def passed(self, flags: int) -> None:
        """One more message has gone by."""
        if flags in (WHOLE, LAST) or self._by_segment:
            for held in self._held[:]:
                held[0] -= 1
                if held[0] <= 0:
                    self._let_go(held)

    def _let_go(self, held: list[Any]) -> None:
        if held in self._held:
            self._held.remove(held)
            held[1]()


class CorruptMessage(MessageFault):
    """It comes changed: bits, bytes or fields of it; of a long message, its first segment."""

    def is_possible(self, data: bytes) -> bool:
        """Whether it has the fields that are to be set."""
        try:
            if "fields" in self.fault.options:
                self.setting.names.edit(data, self.fault.options["fields"])
        except UsageError as error:
            self.setting.report.missed(self.fault, error.text)
            return False
        return True

    def words(self) -> str:
        """What it does."""
        return "corrupts"

    def act(self, data: bytes, flags: int, send: Send) -> None:
        """Send it changed."""
        if flags in (WHOLE, FIRST) or self._by_segment:
            data = self._changed(data)
        send(data)

    def _changed(self, data: bytes) -> bytes:
        options = self.fault.options
        if "fields" in options:
            data = self.setting.names.edit(data, options["fields"])
        else:
            data = damaged(data, self._header(data), options, self.gate.random)
        if options.get("checksum", "fix" if "fields" in options else "keep") == "fix":
            return _with_checksum(data)
        return data

    def _header(self, data: bytes) -> int:
        """Bytes that random bits leave alone: the headers, of a packet without data only the primary one."""
        size = get_header_size(data)
        return size if size < len(data) else PRIMARY_HEADER_SIZE


class CorruptDatagram(CorruptMessage):
    """The same of a datagram, all of which is data."""

    def _header(self, data: bytes) -> int:
        return 0

    def _changed(self, data: bytes) -> bytes:
        return damaged(data, 0, self.fault.options, self.gate.random)


def damaged(data: bytes, start: int, options: Any, random: Random) -> bytes:
    """Bytes with some bits turned over, or some bytes set.

    Args:
        data: the bytes.
        start: random bits lie behind so many bytes, if there are more.
        options: `bytes`, positions to values, where there is such a position; else `bits`, how many, 1 by default.
        random: where the bits are.
    """
    changed = bytearray(data)
    if "bytes" in options:
        for position, value in options["bytes"].items():
            if -len(changed) <= position < len(changed):
                changed[position] = value
        return bytes(changed)
    first = start if start < len(changed) else 0
    places = range(first * 8, len(changed) * 8)
    for place in random.sample(places, min(options.get("bits", 1), len(places))):
        changed[place // 8] ^= 1 << place % 8
    return bytes(changed)


def _with_checksum(packet: bytes) -> bytes:
    """A command whose checksum is right again; telemetry has none."""
    if packet[0] & 0x18 != 0x18 or len(packet) < CMD_HEADER_SIZE:
        return packet
    command = bytearray(packet)
    generate_checksum(command)
    return bytes(command)


MESSAGE_FAULTS: dict[str, type[MessageFault]] = {
    "drop": DropMessage,
    "duplicate": DuplicateMessage,
    "delay": DelayMessage,
    "reorder": ReorderMessage,
    "corrupt": CorruptMessage,
}


DATAGRAM_FAULTS: dict[str, type[MessageFault]] = {**MESSAGE_FAULTS, "corrupt": CorruptDatagram}


def pass_through(
    faults: Sequence[MessageFault], data: bytes, flags: int, stream: object, where: str, send: Send
) -> None:
    """Send a message through faults, in their order; each of them may keep, double or change it for the next.

    Args:
        faults: those that are about this message.
        data: the message.
        flags: its sequence flags.
        stream: tells senders apart.
        where: the message in words.
        send: what the last one sends with.
    """
    struck = [fault for fault in faults if fault.strikes(data, flags, stream)]  # each is asked, whatever others do
    for number, fault in enumerate(struck):
        fault.tell(flags, where)
        if isinstance(fault, DropMessage):
            for other in struck[number + 1 :]:
                other.setting.report.missed(other.fault, f"{fault.fault.name} has dropped the message before")
            struck = struck[: number + 1]
            break
    for fault in reversed(struck):
        send = _through(fault, flags, send)
    send(data)
    for fault in faults:
        fault.passed(flags)


def _through(fault: MessageFault, flags: int, send: Send) -> Send:
    return lambda data: fault.act(data, flags, send)


def strike_datagrams(network: Any, faults: Sequence[MessageFault]) -> None:
    """Let every datagram of a mission's network meet faults; a target "udp:1234" is those to that port."""
    original = network.send

    def send(datagram: Any) -> bool:
        name = f"udp:{datagram.target.port}"
        about = [fault for fault in faults if matches((name,), fault.fault.target)]
        if not about:
            return bool(original(datagram))
        taken: list[bool] = []
        where = f"a datagram of {len(datagram.data)} bytes to {name}"
        pass_through(
            about, datagram.data, WHOLE, name, where, lambda data: taken.append(original(datagram._replace(data=data)))
        )
        return all(taken)

    network.send = send
