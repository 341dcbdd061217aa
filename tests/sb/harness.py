"""A Software Bus on a kernel with stand-ins for the other services, and applications made of functions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from cfepy.config import PlatformConfig
from cfepy.msg import telemetry
from cfepy.ports import Ports
from cfepy.rtos import Kernel
from cfepy.sb import SoftwareBus
from cfepy.trace import Trace


@dataclass(eq=False)
class App:
    """Stands for an application of ES."""

    app_id: int
    name: str
    is_core: bool = False


@dataclass
class Events:
    """Keeps what SB reports as (event id, text)."""

    sent: list[tuple[int, str]] = field(default_factory=list)

    def send_event_with_app_id(self, event_id: int, event_type: int, app_id: int, text: str) -> None:
        self.sent.append((event_id, text))

    def ids(self) -> list[int]:
        """Ids of the events that are no debug events of the ordinary course."""
        return [event_id for event_id, _ in self.sent if event_id not in (5, 10, 47, 48)]


class Clock:
    """Spacecraft time 1001000 s."""

    def stamp(self) -> int:
        return 1001000 << 16 | 0x8000


class Memory:
    """Books nothing."""

    def claim(self, owner: str, kind: str, size: int) -> int:
        return 0

    def release(self, token: object) -> None:
        pass


class Bench:
    """A kernel, a bus, and what it reported."""

    def __init__(self, context: str = "thread", **limits: int) -> None:
        self.kernel = Kernel(context, Trace())
        self.events = Events()
        ports = Ports()
        ports.evs, ports.time, ports.memory = self.events, Clock(), Memory()
        self.bus = SoftwareBus(self.kernel, ports, PlatformConfig(**limits))
        ports.sb = self.bus
        self.apps: dict[str, App] = {}

    def spawn(self, name: str, run: Callable[[], object], priority: int = 100) -> None:
        """A task of the application `name`."""
        app = self.apps.setdefault(name, App(len(self.apps) + 1, name))
        self.kernel.spawn(name, run, priority, app)

    def do(self, name: str, run: Callable[[], object]) -> object:
        """Let an application do something now, and give back what it returned or raised."""
        result: list[object] = []

        def body() -> None:
            try:
                result.append(run())
            except Exception as error:
                result.append(error)

        self.spawn(name, body)
        self.kernel.run(self.kernel.now)
        return result[0] if result else None


def packet(msg_id: int, payload: bytes = b"") -> bytes:
    """A telemetry packet."""
    return bytes(telemetry(msg_id, payload))
