"""Time Services on a real kernel, with the smallest stand-ins for its peers."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple, TypeVar

import pytest

from cfepy.config.platform import PlatformConfig
from cfepy.msg import CMD_HEADER_SIZE, TLM_HEADER_SIZE, Layout, command, get_msg_id
from cfepy.ports import Ports
from cfepy.rtos import Kernel, WaitList
from cfepy.time import TimeServices
from cfepy.time import packets as pk

Result = TypeVar("Result")
TIME_ID, APP_ID, OTHER_ID = 0x110004, 0x110006, 0x110007
SECOND_NS = 1_000_000_000
LATENCY_NS = 50_000_000


class App(NamedTuple):
    app_id: int
    name: str
    is_core: bool = False


class World:
    """TIME and its peers; this object is its own ES, bus, event services and board."""

    def __init__(
        self, start_ns: int = 351_000_000, tick_ns: int = 0, kept: dict[str, Any] | None = None, **config: Any
    ) -> None:
        self.kernel = Kernel(tick_ns=tick_ns)
        self.events: list[tuple[int, str]] = []
        self.packets: list[bytes] = []
        self.perf: list[int] = []
        self.lost: set[int] = set()
        self.jumps = 0
        self._pipe: deque[bytes] = deque()
        self._waits = WaitList("pipe")
        self._subscribed: set[int] = set()
        ports = Ports()
        ports.es = ports.sb = ports.evs = self
        self.time = TimeServices(self.kernel, ports, PlatformConfig(**config))
        self.time.clock.on_jump = self._jumped
        self.kernel.run(start_ns)
        self.kept = {} if kept is None else kept
        self.time.early_init(self.kept)
        self.start_ns = self.kernel.now

    def _jumped(self) -> None:
        self.jumps += 1

    # -- peers -----------------------------------------------------------------------------------------------------

    def register(self, filters: object = ()) -> None:
        pass

    def send_event(self, event_id: int, event_type: int, text: str) -> None:
        self.events.append((event_id, text))

    def get_app_id(self) -> int:
        return self.kernel.current.owner.app_id

    def wait_for_system_state(self, state: int, timeout_ms: int) -> None:
        self.kernel.delay(1)

    def increment_task_counter(self) -> None:
        pass

    def perf_log_entry(self, marker: int) -> None:
        self.perf.append(marker)

    def perf_log_exit(self, marker: int) -> None:
        self.perf.append(-marker)

    def create_child_task(
        self, name: str, entry: Callable[[], object], stack: int, priority: int, flags: int = 0
    ) -> int:
        def late() -> None:
            self.kernel.delay(LATENCY_NS)
            entry()

        return self.kernel.spawn(name, late, priority).ident

    def create_pipe(self, depth: int, name: str) -> int:
        return 1

    def subscribe(self, msg_id: int, pipe_id: int) -> None:
        self._subscribed.add(msg_id)

    def subscribe_local(self, msg_id: int, pipe_id: int, msg_limit: int) -> None:
        self._subscribed.add(msg_id)

    def transmit_msg(self, packet: bytes, is_origination: bool = True) -> None:
        self.packets.append(packet)
        msg_id = get_msg_id(packet)
        if msg_id in self._subscribed and msg_id not in self.lost:
            self._pipe.append(packet)
            self.kernel.wake_first(self._waits)

    def receive_buffer(self, pipe_id: int, timeout_ms: int) -> bytes | None:
        if not self._pipe:
            self.kernel.wait_on(self._waits)
        return self._pipe.popleft()

    # -- for tests -------------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Start the tasks."""
        self.kernel.spawn("CFE_TIME", self.time.task_main, 60, App(TIME_ID, "CFE_TIME", True))

    def run(self, seconds: float) -> None:
        """Let virtual time go by."""
        self.kernel.run(self.kernel.now + int(seconds * SECOND_NS))

    def call(self, function: Callable[[], Result], app_id: int = APP_ID) -> Result:
        """Return the result of a function in a task of an application, or raise its exception."""
        results: list[Result] = []
        self.kernel.spawn("caller", lambda: results.append(function()), 100, App(app_id, "APP"))
        self.kernel.run(self.kernel.now)
        return results[0]

    def command(self, code: int, payload: bytes = b"", msg_id: int = pk.CMD_MID) -> None:
        """Give TIME a command."""
        packet = bytes(command(msg_id, code, payload))
        self.call(lambda: self.time.commands.process(packet), TIME_ID)

    def command_counters(self) -> tuple[int, int]:
        replies = self.time.commands.replies
        return replies.command_counter, replies.error_counter

    def housekeeping(self) -> dict[str, Any]:
        """Return the fields of a fresh housekeeping packet."""
        self.command(0, msg_id=pk.SEND_HK_MID)
        return self._last(pk.HK_TLM_MID, pk.HOUSEKEEPING, TLM_HEADER_SIZE)

    def diagnostic(self) -> dict[str, Any]:
        """Return the fields of a fresh diagnostic packet."""
        self.command(pk.SEND_DIAGNOSTIC_CC)
        return self._last(pk.DIAG_TLM_MID, pk.DIAGNOSTIC, TLM_HEADER_SIZE)

    def tone_data(self) -> dict[str, Any]:
        """Return the fields of the last message about a tone."""
        return self._last(pk.DATA_CMD_MID, pk.TONE_DATA, CMD_HEADER_SIZE)

    def _last(self, msg_id: int, layout: Layout, offset: int) -> dict[str, Any]:
        packet = next(packet for packet in reversed(self.packets) if get_msg_id(packet) == msg_id)
        return layout.unpack(packet, offset)


@pytest.fixture
def make() -> Iterator[Callable[..., World]]:
    """Make worlds that end with the test."""
    made: list[World] = []

    def make_world(**options: Any) -> World:
        made.append(World(**options))
        return made[-1]

    yield make_world
    for world in made:
        world.kernel.shutdown()


@pytest.fixture
def world(make: Callable[..., World]) -> World:
    """TIME that was just started, its tasks not yet."""
    return make()
