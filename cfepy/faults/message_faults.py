"""Faults on one message: lost, duplicated, delayed, reordered, changed.

A fault receives the bytes and a function that sends them, which it can call at any time and repeatedly. So faults of
several kinds can apply to the same message, on the bus or as a datagram on the network. A long ROS message is sent in
segments; a fault applies to all of them, unless its unit is the segment.
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
    """Objects of the run for all faults on messages: time, agenda, report, names."""

    def __init__(self, kernel: Kernel, agenda: Agenda, report: FaultReport, names: MissionNames) -> None:
        self.kernel = kernel
        self.agenda = agenda
        self.report = report
        self.names = names


class MessageFault(ABC):
    """A fault on messages during the run.

    Args:
        fault: the fault in the plan.
        gate: when it happens.
        setting: objects of the run.
    """

    def __init__(self, fault: Fault, gate: Gate, setting: Setting) -> None:
        self.fault = fault
        self.gate = gate
        self.setting = setting
        self.sender: str | None = fault.options.get("from")
        self.receiver: str | None = fault.options.get("to")
        self._by_segment = fault.options.get("unit") == "segment"
        self._struck: dict[object, bool] = {}  # by stream: whether the current segmented message is affected

    def strikes(self, data: bytes, flags: int, stream: object) -> bool:
        """Return whether it happens to a message or a segment.

        Args:
            data: the message.
            flags: its sequence flags; `WHOLE` without segmentation.
            stream: identifies senders whose segments may be interleaved.
        """
        if flags != WHOLE and flags != FIRST and not self._by_segment:
            return self._struck.get(stream, False)
        struck = self.gate.opens(self.setting.kernel.now) and self.is_possible(data)
        if flags == FIRST:
            self._struck[stream] = struck
        return struck

    def tell(self, flags: int, where: str) -> None:
        """Report an occurrence, once for a long message.

        Args:
            flags: the message's sequence flags.
            where: description of the message.
        """
        if flags in (WHOLE, FIRST) or self._by_segment:
            self.setting.report.happened(self.fault, f"{self.words()} {where}")

    def is_possible(self, data: bytes) -> bool:
        """Return whether it can happen to this message; if not, the reason is reported."""
        return True

    def words(self) -> str:
        """Return its description for the report."""
        return f"{self.fault.kind}s"

    @abstractmethod
    def act(self, data: bytes, flags: int, send: Send) -> None:
        """Apply it to a message."""

    def passed(self, flags: int) -> None:  # noqa: B027  # most kinds have nothing to do then
        """A message to which it could apply was sent, affected or not."""


class DropMessage(MessageFault):
    """The message is lost."""

    def act(self, data: bytes, flags: int, send: Send) -> None:
        """Send nothing."""


class DuplicateMessage(MessageFault):
    """The message is sent more than once; a long message again as a whole after its last segment."""

    def __init__(self, fault: Fault, gate: Gate, setting: Setting) -> None:
        super().__init__(fault, gate, setting)
        self._copies = fault.options.get("copies", 1)
        self._parts: list[bytes] = []

    def act(self, data: bytes, flags: int, send: Send) -> None:
        """Send it repeatedly."""
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
    """The message is delayed; all segments of a message by the same time."""

    def __init__(self, fault: Fault, gate: Gate, setting: Setting) -> None:
        super().__init__(fault, gate, setting)
        self._least, self._most = fault.options["by"]
        self._by = self._least

    def strikes(self, data: bytes, flags: int, stream: object) -> bool:
        if self._least != self._most and (flags in (WHOLE, FIRST) or self._by_segment):
            self._by = self.gate.random.randint(self._least, self._most)
        return super().strikes(data, flags, stream)

    def words(self) -> str:
        """Return the description with the time."""
        return f"delays by {self._by / 1e9:g} s"

    def act(self, data: bytes, flags: int, send: Send) -> None:
        """Send it later."""
        self.setting.agenda.add(self.setting.kernel.now + self._by, lambda: send(data))


class ReorderMessage(MessageFault):
    """The message is sent after later ones, or after a time if there are none."""

    def __init__(self, fault: Fault, gate: Gate, setting: Setting) -> None:
        super().__init__(fault, gate, setting)
        self._past = fault.options.get("past", 1)
        self._within = fault.options.get("within", DEFAULT_WITHIN_NS)
        self._held: list[list[Any]] = []  # number of messages to wait for, and a function that then sends it

    def act(self, data: bytes, flags: int, send: Send) -> None:
        """Hold it back."""
        held = [self._past + 1, lambda: send(data)]  # one more, since this message counts too
        self._held.append(held)
        self.setting.agenda.add(self.setting.kernel.now + self._within, lambda: self._let_go(held))

    def passed(self, flags: int) -> None:
        """Count another message."""
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
    """The message is changed: bits, bytes or fields; for a long message, in its first segment."""

    def is_possible(self, data: bytes) -> bool:
        """Return whether it has the fields to set."""
        try:
            if "fields" in self.fault.options:
                self.setting.names.edit(data, self.fault.options["fields"])
        except UsageError as error:
            self.setting.report.missed(self.fault, error.text)
            return False
        return True

    def words(self) -> str:
        """Return the description of the change."""
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
        """Return the number of bytes that random bits do not affect: the headers, or the primary one for a packet
        without data.
        """
        size = get_header_size(data)
        return size if size < len(data) else PRIMARY_HEADER_SIZE


class CorruptDatagram(CorruptMessage):
    """The same for a datagram, which has only data."""

    def _header(self, data: bytes) -> int:
        return 0

    def _changed(self, data: bytes) -> bytes:
        return damaged(data, 0, self.fault.options, self.gate.random)


def damaged(data: bytes, start: int, options: Any, random: Random) -> bytes:
    """Return the bytes with some bits inverted, or some bytes set.

    Args:
        data: the bytes.
        start: random bits are after this number of bytes, if there are more.
        options: `bytes`, positions to values, for existing positions; else `bits`, the number of bits, 1 by default.
        random: chooses the bits.
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
    """Return a command with a correct checksum; telemetry has none."""
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
    """Send a message through faults, in their order; each may delay, duplicate or change it for the next.

    Args:
        faults: the faults on this message.
        data: the message.
        flags: its sequence flags.
        stream: identifies the sender.
        where: description of the message.
        send: used by the last one for sending.
    """
    # each is asked, independent of the others
    struck = [fault for fault in faults if fault.strikes(data, flags, stream)]
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
    """Apply faults to every datagram of a mission's network; a target "udp:1234" means those to that port."""
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
