"""The craft of a console that talks to a computer: any cFS with CI_LAB and TO_LAB over UDP, or a flight of another
terminal.
"""

from __future__ import annotations

from typing import Any, Protocol

from cfepy.cli.ground.command_target import RemoteHost
from cfepy.cli.ground.console.saved import SavedScript
from cfepy.cli.watched_host import Interrupts
from cfepy.ground import Dictionary
from cfepy.io import LiveFlight, UdpListener
from cfepy.io import send as send_datagram
from cfepy.mission import MissionSpec, Seen
from cfepy.msg import PRIMARY_HEADER_SIZE
from cfepy.rtos import Stopwatch
from cfepy.script import Collected, Scene, Since, StandingScript
from cfepy.status import UsageError
from cfepy.units import NS_PER_MS, NS_PER_S

MOST_PACKETS = 50_000
WAIT_S = 0.05
NO_WAIT_S = 1e-4
PIECE_NS = 50 * NS_PER_MS


class ComputerLink(Protocol):
    """The connection with a computer.

    Attributes:
        name: name of the computer.
        is_over: whether the connection has ended.
    """

    name: str
    is_over: bool

    def send(self, packet: bytes, must_arrive: bool) -> str:
        """Send a packet; return the error, or an empty text."""

    def receive(self, seconds: float) -> bytes | None:
        """Return the next packet, or None if none comes in this wall time."""

    def close(self) -> None:
        """Close the connection."""


class UdpLink:
    """The connection with CI_LAB and TO_LAB.

    Args:
        host: the address that commands are sent to.
        listen: the address of this computer at which telemetry arrives.

    Attributes:
        port: the port of this computer at which telemetry arrives.
    """

    is_over = False

    def __init__(self, host: RemoteHost, listen: RemoteHost) -> None:
        self.name = str(host)
        self._host = host
        self._listener = UdpListener(listen.name, listen.port)
        self.port = self._listener.port
        self.receive = self._listener.receive

    def send(self, packet: bytes, must_arrive: bool) -> str:
        """Send a packet. UDP has no receipts, so a failure is only detected if the target is this computer."""
        is_sent = send_datagram(self._host.name, self._host.port, packet)
        return "" if is_sent else f"{self._host}: no receiver is listening"

    def close(self) -> None:
        self._listener.__exit__(None, None, None)


class LiveLink:
    """The connection with a flight of another terminal.

    Args:
        flight: the flight.
    """

    def __init__(self, flight: LiveFlight) -> None:
        self.name = flight.mission
        self.is_over = False
        self._flight = flight
        flight.listen(telemetry=())

    def send(self, packet: bytes, must_arrive: bool) -> str:
        """Put a packet on the Software Bus of the flight."""
        try:
            answer = self._flight.ask({"op": "send", "packet": packet})
        except UsageError as error:
            return str(error)
        except OSError:
            self.is_over = True
            return "the flight has ended"
        return "no application receives it" if must_arrive and not answer["receivers"] else ""

    def receive(self, seconds: float) -> bytes | None:
        try:
            message = self._flight.receive(seconds)
        except OSError:
            self.is_over = True
            return None
        return message[0] if isinstance(message, tuple) else None

    def close(self) -> None:
        self._flight.close()


class RemoteScene(Scene):
    """A scene of a remote computer: its packets, and the time since the session began."""

    def __init__(self, link: ComputerLink, dictionary: Dictionary, packets: Collected, saved: SavedScript) -> None:
        super().__init__(None, dictionary, packets)
        self._link = link
        self._saved = saved
        self._watch = Stopwatch()

    @property
    def now_ns(self) -> int:
        """Wall-clock time in ns since the session began."""
        return self._watch.elapsed_ns()

    def here(self) -> Since:
        return Since(len(self.packets), 0)

    def send(self, packet: bytes, must_arrive: bool) -> str:
        """Send a packet; return the error, or an empty text."""
        self._saved.sent(packet, self.now_ns)
        return self._link.send(packet, must_arrive)

    def learn_topics(self) -> None:
        """Do nothing: the topics of a remote computer are not known."""


class RemoteCraft:
    """A remote computer; use as a context manager.

    Args:
        link: the connection with it.
        spec: the mission whose names are used, or None.
        dictionary: names the packets.
        saved: receives the packets that are sent.
        interrupts: reports whether Ctrl-C was pressed.

    Attributes:
        name: see `Craft`.
        flows: see `Craft`.
        script: see `Craft`.
    """

    flows = True

    def __init__(
        self,
        link: ComputerLink,
        spec: MissionSpec | None,
        dictionary: Dictionary,
        saved: SavedScript,
        interrupts: Interrupts,
    ) -> None:
        self._interrupts = interrupts
        self.name = link.name
        self._link = link
        self._packets = Collected(MOST_PACKETS)
        self._new: list[Seen | str] = []
        self.script = StandingScript(RemoteScene(link, dictionary, self._packets, saved), spec)

    def __enter__(self) -> RemoteCraft:
        return self

    def __exit__(self, *error: Any) -> None:
        self._link.close()

    @property
    def is_over(self) -> bool:
        return self._link.is_over

    @property
    def stands_ns(self) -> int:
        return self.script.scene.now_ns

    @property
    def is_asked(self) -> bool:
        return self._interrupts.asked

    def step(self, until_ns: int) -> bool:
        """Take the packets that arrive."""
        begin_ns = self.stands_ns
        rest_s = min(WAIT_S, max(0, until_ns - begin_ns) / NS_PER_S)
        packet = self._link.receive(max(rest_s, NO_WAIT_S))
        while packet is not None:
            if len(packet) > PRIMARY_HEADER_SIZE:
                seen = Seen(self.stands_ns, packet, self.name)
                self._new.append(seen)
                self._packets.append(seen)
            if self.stands_ns - begin_ns > PIECE_NS:
                break
            packet = self._link.receive(NO_WAIT_S)
        self.script.advance()
        return True

    def stand(self) -> None:
        """Do nothing: arriving packets wait in the socket."""

    def next_event(self) -> int | None:
        return None

    def pace(self, factor: float | None) -> None:
        """Do nothing: a remote computer sets its own pace."""

    def news(self) -> list[Seen | str]:
        """Return the packets since the last call. The console output of a remote computer is not available."""
        news, self._new = self._new, []
        return news
