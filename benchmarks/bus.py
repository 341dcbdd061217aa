"""The Software Bus: one task, two tasks, one to many. Traced, with limits, statistics and stamps, as in a mission."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from benchmarks import floor
from benchmarks.measure import rate
from cfepy.config.platform import PlatformConfig
from cfepy.msg import telemetry
from cfepy.osal import Osal
from cfepy.ports import Ports
from cfepy.psp import BoardProfile, MemoryBudget
from cfepy.rtos import Kernel
from cfepy.sb import POLL, SoftwareBus
from cfepy.time import TimeServices
from cfepy.trace import Trace

PACKET_BYTES = 64
WIDTH = 16


class _Silent:
    """Event services without a listener."""

    def send_event_with_app_id(self, event_id: int, event_type: int, app_id: int, text: str) -> None:
        pass


def make_bus(context: str, config: PlatformConfig | None = None) -> SoftwareBus:
    """Return a bus on its own kernel, with a spacecraft clock. `config` replaces cFE's limits."""
    kernel, ports, config = Kernel(context, Trace()), Ports(), config or PlatformConfig()
    ports.evs, ports.memory = _Silent(), MemoryBudget(BoardProfile("linux"))  # type: ignore[assignment]
    ports.time, ports.queues = TimeServices(kernel, ports, config), Osal(kernel, config)
    return SoftwareBus(kernel, ports, config)


def packet(msg_id: int) -> bytes:
    """Return a telemetry packet of 64 bytes."""
    return bytes(telemetry(msg_id, bytes(PACKET_BYTES - 16)))


def run(bus: SoftwareBus, *tasks: Callable[[], object]) -> None:
    """Let tasks run to their end."""
    for task in tasks:
        bus.kernel.spawn(task.__name__, task)
    bus.kernel.run()
    bus.kernel.shutdown()


def one_task(context: str, count: int = 300_000) -> int:
    """One task sends to itself and receives."""
    bus = make_bus(context)

    def task() -> None:
        pipe = bus.create_pipe(10, "PIPE")
        bus.subscribe(0x0881, pipe)
        transmit, receive, message = bus.transmit_msg, bus.receive_buffer, packet(0x0881)
        for _ in range(count):
            transmit(message)
            receive(pipe, POLL)

    run(bus, task)
    return count


def ping_pong(context: str, count: int = 100_000) -> int:
    """Measure two tasks of one priority that send each other a packet.

    A round trip is two messages and two task switches.
    """
    bus = make_bus(context)
    there, back = bus.create_pipe(10, "THERE"), bus.create_pipe(10, "BACK")
    bus.subscribe(0x0881, there)
    bus.subscribe(0x0882, back)

    def pong() -> None:
        transmit, receive, message = bus.transmit_msg, bus.receive_buffer, packet(0x0882)
        for _ in range(count):
            receive(there)
            transmit(message)

    def ping() -> None:
        transmit, receive, message = bus.transmit_msg, bus.receive_buffer, packet(0x0881)
        for _ in range(count):
            transmit(message)
            receive(back)

    run(bus, pong, ping)
    return count


def fan_out(context: str, count: int = 20_000) -> int:
    """Send one packet into 16 pipes, all read by the sending task. Counts deliveries."""
    bus = make_bus(context)
    pipes = [bus.create_pipe(10, f"PIPE{number}") for number in range(WIDTH)]
    for pipe in pipes:
        bus.subscribe(0x0881, pipe)

    def task() -> None:
        transmit, receive, message = bus.transmit_msg, bus.receive_buffer, packet(0x0881)
        for _ in range(count):
            transmit(message)
            for pipe in pipes:
                receive(pipe, POLL)

    run(bus, task)
    return count * WIDTH


def fan_out_tasks(context: str, count: int = 5_000) -> int:
    """Send one packet to 16 tasks, each waiting on its pipe. Counts deliveries, each of which is a task switch."""
    bus = make_bus(context)
    pipes = [bus.create_pipe(10, f"PIPE{number}") for number in range(WIDTH)]
    for pipe in pipes:
        bus.subscribe(0x0881, pipe)

    def sender() -> None:
        message = packet(0x0881)
        for _ in range(count):
            bus.transmit_msg(message)
            bus.kernel.yield_cpu()

    def receiver_of(pipe: int) -> Callable[[], None]:
        def receiver() -> None:
            for _ in range(count):
                bus.receive_buffer(pipe)

        return receiver

    run(bus, *(receiver_of(pipe) for pipe in pipes), sender)
    return count * WIDTH


def bus(contexts: tuple[str, ...]) -> dict[str, float]:
    """Return figures by name: rates in 1/s, and ratios to the floor measured in the same run."""
    figures: dict[str, float] = {"floor.queue_and_header": rate(floor.queue_and_header)}
    for context in contexts:
        figures[f"floor.hand_overs.{context}"] = rate(partial(floor.hand_overs, context))
        for measure in (one_task, ping_pong, fan_out, fan_out_tasks):
            figures[f"{measure.__name__}.{context}"] = rate(partial(measure, context))
        one, floor_one = figures[f"one_task.{context}"], figures["floor.queue_and_header"]
        figures[f"one_task.{context}.times_floor"] = floor_one / one
        pair = figures[f"floor.hand_overs.{context}"]
        figures[f"ping_pong.{context}.times_floor"] = pair / figures[f"ping_pong.{context}"]
    return figures
