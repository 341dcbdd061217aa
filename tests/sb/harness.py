"""A Software Bus on a kernel with stand-ins for the other services, and applications made of functions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from cfepy.config.platform import PlatformConfig
from cfepy.fs.background import FileWriteEvent, FileWriteMetaData
from cfepy.msg import telemetry
from cfepy.osal import Osal
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
    """Keeps SB's events as (event id, text)."""

    sent: list[tuple[int, str]] = field(default_factory=list)

    def send_event_with_app_id(self, event_id: int, event_type: int, app_id: int, text: str) -> None:
        self.sent.append((event_id, text))

    def ids(self) -> list[int]:
        """Return the ids of the events, except for debug events of normal operation."""
        return [event_id for event_id, _ in self.sent if event_id not in (5, 10, 47, 48)]


class Clock:
    """Spacecraft time 1001000 s."""

    def stamp(self) -> int:
        return 1001000 << 16 | 0x8000

    def now(self) -> tuple[int, int]:
        return 1001000, 0x80000000


class Memory:
    """Books nothing."""

    def claim(self, owner: str, kind: str, size: int) -> int:
        return 0

    def release(self, token: object) -> None:
        pass


class Log:
    """Keeps the lines of the system log."""

    def __init__(self) -> None:
        self.lines: list[str] = []

    def write_to_sys_log(self, text: str) -> None:
        self.lines.append(text)


class Files:
    """Keeps data to be written. `write` writes it at once, without a header."""

    def __init__(self) -> None:
        self.waiting: list[FileWriteMetaData] = []

    def background_file_dump_request(self, meta: FileWriteMetaData) -> None:
        meta.is_pending = True
        self.waiting.append(meta)

    def write(self) -> bytes:
        """Write the oldest."""
        meta = self.waiting.pop(0)
        data, number, is_last = b"", 0, False
        while not is_last:
            record, is_last = meta.get_data(number)
            data += record
            number += 1
        meta.is_pending = False
        meta.on_event(FileWriteEvent.COMPLETE, 0, number, 0, len(data))
        return data


class Bench:
    """A kernel, a bus, and its events."""

    def __init__(self, context: str = "thread", bus: type[SoftwareBus] = SoftwareBus, **limits: Any) -> None:
        self.kernel = Kernel(context, Trace())
        self.events = Events()
        ports = Ports()
        self.log, self.files = Log(), Files()
        ports.evs, ports.time, ports.memory = self.events, Clock(), Memory()
        ports.syslog, ports.fs = self.log, self.files  # type: ignore[assignment]  # what SB asks of them
        config = PlatformConfig(**limits)
        ports.queues = Osal(self.kernel, config)
        self.bus = bus(self.kernel, ports, config)
        ports.sb = self.bus
        self.apps: dict[str, App] = {}

    def spawn(self, name: str, run: Callable[[], object], priority: int = 100) -> None:
        """A task of the application `name`."""
        app = self.apps.setdefault(name, App(len(self.apps) + 1, name))
        self.kernel.spawn(name, run, priority, app)

    def do(self, name: str, run: Callable[[], object]) -> object:
        """Let an application call a function now. Returns the result or raises the exception."""
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
    """Return a telemetry packet."""
    return bytes(telemetry(msg_id, payload))
