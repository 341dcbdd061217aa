"""The ground station of procedures: sends commands, keeps the newest telemetry, and lets time pass.

`FlightStation` is connected to a mission that flies in virtual time, `UdpStation` to a computer that CI_LAB and TO_LAB
connect to a network. Both keep the newest packet of each MsgId with its count, so a look at it takes constant time.
"""

from __future__ import annotations

import socket
import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import NamedTuple

from cfepy import msg
from cfepy.extra.procedures.pauses import Pauses
from cfepy.flight import Flight
from cfepy.ground import GroundLink
from cfepy.mission import PACKET, PacketWatch, Seen
from cfepy.osal import Datagram
from cfepy.units import NS_PER_S

CI_PORT, TO_PORT = 1234, 1235
"""The UDP ports of CI_LAB and TO_LAB on processor 1."""
_FIRST_HEADER = 6
_EPSILON_S = 1e-9


class Received(NamedTuple):
    """The newest packet of a MsgId: its bytes, the number received so far, and the time of arrival in s."""

    data: bytes
    number: int
    at: float


class Waited(NamedTuple):
    """The end of a wait.

    Attributes:
        passed: whether the condition was true at a look.
        start: when the wait began, in s.
        taken: the time that passed in s.
        missed: if it was not, when it was true since the test began, in s, and for how long; None if it never was.
    """

    passed: bool
    start: float
    taken: float
    missed: tuple[float, float] | None = None


class Station(ABC):
    """The connection of a procedure to a flight computer.

    Attributes:
        sent: number of commands sent by MsgId and function code.
        last_sent: the newest command by MsgId and function code, with the time in s.
        listeners: functions that get each received packet.
    """

    def __init__(self) -> None:
        self.sent: dict[tuple[int, int], int] = {}
        self.last_sent: dict[tuple[int, int], tuple[bytes, float]] = {}
        self.listeners: list[Callable[[bytes], object]] = []
        self._newest: dict[int, Received] = {}
        self._arrivals: list[tuple[int, Received]] = []
        self._at_start: dict[int, Received] = {}

    @property
    @abstractmethod
    def now(self) -> float:
        """The time in s: since the boot in virtual time, or since the connection."""

    @abstractmethod
    def wait(self, seconds: float) -> None:
        """Let time pass."""

    @abstractmethod
    def _put(self, packet: bytes) -> None:
        """Send the bytes of a packet."""

    def send(self, packet: bytes, is_raw: bool = False) -> None:
        """Send a command with its length and checksum, as an interface of COSMOS for cFS completes it.

        Args:
            packet: the whole command.
            is_raw: whether to send it unchanged.
        """
        data = bytearray(packet)
        if not is_raw and len(data) > _FIRST_HEADER:
            msg.set_size(data, len(data))
            if msg.get_has_secondary_header(data) and len(data) >= msg.CMD_HEADER_SIZE:
                msg.generate_checksum(data)
        code = msg.get_fcn_code(data) if len(data) >= msg.CMD_HEADER_SIZE else 0
        key = msg.get_msg_id(data), code
        self.sent[key] = self.sent.get(key, 0) + 1
        self.last_sent[key] = bytes(data), self.now
        self._put(bytes(data))

    def newest(self, msg_id: int) -> Received | None:
        """Return the newest packet of a MsgId, or None."""
        return self._newest.get(msg_id)

    def take(self, data: bytes) -> None:
        """Keep a received packet as the newest of its MsgId."""
        if len(data) <= _FIRST_HEADER:
            return
        msg_id = data[0] << 8 | data[1]
        before = self._newest.get(msg_id)
        received = self._newest[msg_id] = Received(data, 1 if before is None else before.number + 1, self.now)
        self._arrivals.append((msg_id, received))
        for each in self.listeners:
            each(data)

    def put_newest(self, msg_id: int, data: bytes) -> None:
        """Replace the newest packet of a MsgId without counting one, for `set_tlm`."""
        before = self._newest.get(msg_id)
        self._newest[msg_id] = Received(data, 0 if before is None else before.number, self.now)

    def until(self, condition: Callable[[], bool], timeout: float, poll: float) -> Waited:
        """Let time pass until a condition is true.

        Args:
            condition: checked at once, and then after each interval.
            timeout: time limit in s.
            poll: the interval in s.
        """
        start = self.now
        end = start + timeout
        while not condition():
            left = end - self.now
            if left <= _EPSILON_S:
                return Waited(False, start, self.now - start, self._missed(condition))
            self.wait(min(poll, left))
        return Waited(True, start, self.now - start)

    def begin_test(self) -> None:
        """Begin a test; a failed wait reports whether its condition was true at any time since."""
        self._arrivals, self._at_start = [], dict(self._newest)

    def _missed(self, condition: Callable[[], bool]) -> tuple[float, float] | None:
        """Return when a condition was true that no look saw, and for how long."""
        newest, self._newest = self._newest, dict(self._at_start)
        since = None
        try:
            for msg_id, received in self._arrivals:
                self._newest[msg_id] = received
                is_true = condition()
                if is_true and since is None:
                    since = received.at
                elif since is not None and not is_true:
                    return since, received.at - since
        finally:
            self._newest = newest
        return None


class BusTelemetry:
    """The observer of a mission's bus for a station that is not connected through TO_LAB."""

    def __init__(self) -> None:
        self.take: Callable[[bytes], object] | None = None
        self.watch = PacketWatch(self._seen, unsent=True)

    def _seen(self, seen: Seen) -> None:
        if self.take is not None and not seen.packet[0] & 0x10:
            self.take(seen.packet)


class FlightStation(Station):
    """A station of a mission in virtual time, which stays connected over resets.

    With CI_LAB and TO_LAB, commands and telemetry are UDP datagrams, so the procedure has to enable TO_LAB's output as
    on a real computer. Otherwise commands go on the Software Bus and all telemetry on it is received.

    Args:
        flight: the mission.
        telemetry: the observer of its bus, which was attached at the boot.
        through_lab: whether to use CI_LAB and TO_LAB; None if both are in the startup script.
        pauses: gives each pause its additional time.
    """

    def __init__(self, flight: Flight, telemetry: BusTelemetry, through_lab: bool | None, pauses: Pauses) -> None:
        super().__init__()
        self._pauses = pauses
        self.flight = flight
        names = {app.name for app in flight.mission.cfe.es.apps}
        self.through_lab = {"CI_LAB", "TO_LAB"} <= names if through_lab is None else through_lab
        self.lost = 0
        if self.through_lab:
            self._link = GroundLink(flight.mission, self._datagram)
        else:
            telemetry.take = self.take

    @property
    def now(self) -> float:
        return self.flight.mission.kernel.now / NS_PER_S

    def wait(self, seconds: float) -> None:
        self.flight.run_for(seconds + self._pauses.additional())

    def _put(self, packet: bytes) -> None:
        self.flight.touched = True
        if not self.through_lab:
            self.flight.mission.outside.act(PACKET, packet)
        elif not self._link.send(packet, CI_PORT):
            self.lost += 1  # as on a network, when no application has the port

    def _datagram(self, datagram: Datagram) -> None:
        if datagram.target.port == TO_PORT:
            self.take(datagram.data)


class UdpStation(Station):
    """A station of a computer on a network, in real time.

    Args:
        host: its address.
        command_port: the port of CI_LAB.
        telemetry_port: the port to which TO_LAB sends.
    """

    def __init__(self, host: str, command_port: int = CI_PORT, telemetry_port: int = TO_PORT) -> None:
        super().__init__()
        self._place = host, command_port
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind(("", telemetry_port))
        self._start = time.monotonic()

    @property
    def now(self) -> float:
        return time.monotonic() - self._start

    def wait(self, seconds: float) -> None:
        end = time.monotonic() + seconds
        while True:
            left = end - time.monotonic()
            self._socket.settimeout(max(left, 1e-6))
            try:
                self.take(self._socket.recv(65536))
            except TimeoutError:
                pass
            if left <= 0:
                return

    def _put(self, packet: bytes) -> None:
        self._socket.sendto(packet, self._place)

    def close(self) -> None:
        """Give the port back."""
        self._socket.close()
