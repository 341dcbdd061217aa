"""Event Services on a real kernel, with the smallest stand-ins for its peers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple, TypeVar

import pytest

from cfepy.config.platform import PlatformConfig
from cfepy.evs import EventServices
from cfepy.evs import packets as pk
from cfepy.fs.services import FileServices
from cfepy.msg import TLM_HEADER_SIZE, command, get_msg_id
from cfepy.osal import FileSystem, Osal
from cfepy.ports import Ports
from cfepy.rtos import Kernel
from cfepy.status import CFE_ES_ERR_NAME_NOT_FOUND, CFE_ES_ERR_RESOURCEID_NOT_VALID, CfeError
from cfepy.writing.console import Console

Result = TypeVar("Result")
EVS_ID, APP_ID, MUTE_ID = 0x110001, 0x110006, 0x110007


class App(NamedTuple):
    app_id: int
    name: str
    is_core: bool = False


class Sent(NamedTuple):
    """A long event that went onto the bus."""

    app: str
    event_id: int
    event_type: int
    text: str


class World:
    """EVS and its peers; this object is its own ES, bus, clock and system log."""

    def __init__(self, config: PlatformConfig | None = None) -> None:
        self.kernel = Kernel()
        self.apps = {app.app_id: app for app in (App(EVS_ID, "CFE_EVS", True), App(APP_ID, "HK"), App(MUTE_ID, "MUTE"))}
        self.packets: list[bytes] = []
        self.log: list[str] = []
        self.perf: list[int] = []
        self.console = Console(quiet=True)
        ports = Ports()
        ports.es = ports.sb = ports.syslog = ports.time = self
        self.kept: dict[str, Any] = {}
        self.files = FileSystem()
        osal = Osal(self.kernel, console=self.console, files=self.files)
        config = config or PlatformConfig()
        ports.fs = FileServices(osal, ports, config, lambda: None)
        self.evs = EventServices(self.kernel, ports, config, self.console, osal)

    # -- peers -----------------------------------------------------------------------------------------------------

    def get_app_id(self) -> int:
        return self.kernel.current.owner.app_id

    def get_app_name(self, app_id: int) -> str:
        if app_id not in self.apps:
            raise CfeError(CFE_ES_ERR_RESOURCEID_NOT_VALID, hex(app_id))
        return self.apps[app_id].name

    def get_app_id_by_name(self, name: str) -> int:
        for app in self.apps.values():
            if app.name == name:
                return app.app_id
        raise CfeError(CFE_ES_ERR_NAME_NOT_FOUND, name)

    def wait_for_system_state(self, state: int, timeout_ms: int) -> None:
        self.kernel.delay(1)

    def increment_task_counter(self) -> None:
        pass

    def perf_log_entry(self, marker: int) -> None:
        self.perf.append(marker)

    def perf_log_exit(self, marker: int) -> None:
        self.perf.append(-marker)

    def create_pipe(self, depth: int, name: str) -> int:
        return 1

    def subscribe(self, msg_id: int, pipe_id: int) -> None:
        pass

    def receive_buffer(self, pipe_id: int, timeout_ms: int) -> bytes | None:
        self.kernel.delay(1 << 60)
        return None

    def transmit_msg(self, packet: bytes, is_origination: bool = True) -> None:
        self.packets.append(packet)

    def write_to_sys_log(self, text: str) -> None:
        self.log.append(text)

    def now(self) -> tuple[int, int]:
        return 1001000 + self.kernel.now // 10**9, 0x80000000

    def stamp(self) -> int:
        return self.now()[0] << 16 | 0x8000

    def text(self) -> str:
        return f"T{self.now()[0]}"

    def print_(self, time: tuple[int, int]) -> str:
        return f"T{time[0]}"

    # -- for tests -------------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Run the task of EVS up to its main loop."""
        self.evs.early_init(self.kept)
        self.kernel.spawn("CFE_EVS", self.evs.task_main, 61, self.apps[EVS_ID])
        self.kernel.run(self.kernel.now + 1000)
        self.packets.clear()
        self.console.lines.clear()

    def call(self, function: Callable[[], Result], app_id: int = APP_ID) -> Result:
        """Return the result of a function in a task of an application, or raise its exception."""
        results: list[Result] = []
        self.kernel.spawn("caller", lambda: results.append(function()), 100, self.apps[app_id])
        self.kernel.run(self.kernel.now + 1000)
        return results[0]

    def send(self, event_id: int, event_type: int = 2, text: str = "hello") -> None:
        """Send an event of HK."""
        self.call(lambda: self.evs.send_event(event_id, event_type, text))

    def command(self, code: int, payload: bytes = b"", msg_id: int = pk.CMD_MID) -> None:
        """Give EVS a command."""
        self.call(lambda: self.evs.commands.process(bytes(command(msg_id, code, payload))), EVS_ID)

    def sent(self) -> list[Sent]:
        """Return the long events on the bus."""
        return [_event(packet) for packet in self.packets if get_msg_id(packet) == pk.LONG_EVENT_MSG_MID]

    def housekeeping(self) -> dict[str, object]:
        """Return the fields of a fresh housekeeping packet."""
        self.command(0, msg_id=pk.SEND_HK_MID)
        packet = self.packets[-1]
        assert get_msg_id(packet) == pk.HK_TLM_MID
        return pk.HOUSEKEEPING.unpack(packet, TLM_HEADER_SIZE)


def _event(packet: bytes) -> Sent:
    fields = pk.LONG_EVENT.unpack(packet, TLM_HEADER_SIZE)
    packet_id = fields["PacketID"]
    return Sent(packet_id["AppName"], packet_id["EventID"], packet_id["EventType"], fields["Message"])


@pytest.fixture
def fresh() -> Iterator[World]:
    """EVS before anything started."""
    world = World()
    yield world
    world.kernel.shutdown()


@pytest.fixture
def world(fresh: World) -> World:
    """EVS running, the application HK registered without filters, and MUTE not registered."""
    fresh.start()
    fresh.call(fresh.evs.register)
    return fresh
