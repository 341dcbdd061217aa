"""The craft of a console that talks to a remote computer over UDP: any cFS with CI_LAB and TO_LAB."""

from __future__ import annotations

from typing import Any

from cfepy.cli.ground.command_target import RemoteHost
from cfepy.cli.ground.console.saved import SavedScript
from cfepy.cli.watched_host import Interrupts
from cfepy.ground import Dictionary
from cfepy.io import UdpListener
from cfepy.io import send as send_datagram
from cfepy.mission import MissionSpec, Seen
from cfepy.msg import PRIMARY_HEADER_SIZE
from cfepy.rtos import Stopwatch
from cfepy.script import Collected, Scene, Since, StandingScript
from cfepy.units import NS_PER_MS, NS_PER_S

MOST_PACKETS = 50_000
WAIT_S = 0.05
NO_WAIT_S = 1e-4
PIECE_NS = 50 * NS_PER_MS


class RemoteScene(Scene):
    """A scene of a remote computer: its packets, and the time since the session began."""

    def __init__(self, host: RemoteHost, dictionary: Dictionary, packets: Collected, saved: SavedScript) -> None:
        super().__init__(None, dictionary, packets)
        self._host = host
        self._saved = saved
        self._watch = Stopwatch()

    @property
    def now_ns(self) -> int:
        """Wall-clock time in ns since the session began."""
        return self._watch.elapsed_ns()

    def here(self) -> Since:
        return Since(len(self.packets), 0)

    def send(self, packet: bytes, must_arrive: bool) -> str:
        """Send a packet. UDP has no receipts, so a failure is only detected if the target is this computer."""
        self._saved.sent(packet, self.now_ns)
        return (
            "" if send_datagram(self._host.name, self._host.port, packet) else f"{self._host}: no receiver is listening"
        )

    def learn_topics(self) -> None:
        """Do nothing: the topics of a remote computer are not known."""


class RemoteCraft:
    """A remote computer; use as a context manager.

    Args:
        host: the address that commands are sent to.
        listen: the address of this computer at which telemetry arrives.
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
    is_over = False

    def __init__(
        self,
        host: RemoteHost,
        listen: RemoteHost,
        spec: MissionSpec | None,
        dictionary: Dictionary,
        saved: SavedScript,
        interrupts: Interrupts,
    ) -> None:
        self._interrupts = interrupts
        self.name = str(host)
        self._packets = Collected(MOST_PACKETS)
        self._new: list[Seen | str] = []
        self.script = StandingScript(RemoteScene(host, dictionary, self._packets, saved), spec)
        self._listener = UdpListener(listen.name, listen.port)

    def __enter__(self) -> RemoteCraft:
        self._listener.__enter__()
        return self

    def __exit__(self, *error: Any) -> None:
        self._listener.__exit__(*error)

    @property
    def port(self) -> int:
        """The port of this computer at which telemetry arrives."""
        return self._listener.port

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
        packet = self._listener.receive(max(rest_s, NO_WAIT_S))
        while packet is not None:
            if len(packet) > PRIMARY_HEADER_SIZE:
                seen = Seen(self.stands_ns, packet, self.name)
                self._new.append(seen)
                self._packets.append(seen)
            if self.stands_ns - begin_ns > PIECE_NS:
                break
            packet = self._listener.receive(NO_WAIT_S)
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
