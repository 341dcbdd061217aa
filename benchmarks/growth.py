"""Growth of cost: CPU time per message, by the number of nodes, pipes and tasks, of hours and of missions in a process.

`python -m benchmarks growth` prints the figures. `python -m benchmarks.growth PICTURE` measures and draws them, and
`python -m benchmarks.growth PICTURE --of FIGURES` draws earlier figures. Each size is measured in its own process, and
in CPU time, which other programs on the computer disturb less than the wall clock.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from time import process_time

from benchmarks.bus import make_bus, packet, run
from benchmarks.measure import contexts_here, machine
from cfepy.config.platform import PlatformConfig
from cfepy.mission import Mission, MissionSpec
from cfepy.mission.limits import MissionLimits
from cfepy.nodes import NodeConfig, RosConfig
from cfepy.sb import POLL
from cfepy.writing.console import Console

SCRIPT = Path(__file__).parent / "nodes" / "ring" / "member.py"
FIRST_MSG_ID = 0x0880
MESSAGES = 30_000  # of a measurement
BOOT_S = 1.0  # virtual; cFE's own boot takes half of it
HZ, SLOW_HZ = 100, 10
HOUR_S = 3600
REPEATS = 3
LOOK_S = 10  # virtual; interval at which a run collects garbage
MANY = 100
NEIGHBOURS = 10  # missions whose median counts

Row = dict[int, float]
"""Microseconds of CPU a message, by size."""


@contextmanager
def ring(nodes: int, hz: int, context: str) -> Iterator[Mission]:
    """Run a mission whose nodes send each other messages in a circle.

    When it yields, all nodes are up and have sent.
    """
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        (folder / SCRIPT.name).write_bytes(SCRIPT.read_bytes())
        lines = [f"CFE_APP, {SCRIPT.stem}, __main__, N{number}, 100, 4096, 0x0, 0;\n" for number in range(nodes)]
        script = folder / "startup.scr"
        script.write_text("".join(lines) + "!\n", encoding="utf-8")
        configs = {
            f"N{number}": NodeConfig(f"N{number}", name=f"n{number}", args=(str(number), str(nodes), str(hz)))
            for number in range(nodes)
        }
        limits = MissionLimits(nodes=max(nodes, 2))
        spec = MissionSpec("ring", folder, script, None, "linux", RosConfig(nodes=configs, spread=True), limits=limits)
        with Mission(spec, tasks=context, console=Console(quiet=True)) as flight:
            flight.run_for(BOOT_S)
            yield flight


def _delivered(flight: Mission) -> int:
    """Return messages of the ring that have arrived so far.

    Raises:
        RuntimeError: one was lost.
    """
    assert flight.ros is not None
    rows = [flight.cfe.sb.routes[row.msg_id].totals() for row in flight.ros.topics() if row.name.startswith("/ring")]
    if any(limited + overflown for _, _, limited, overflown in rows):
        raise RuntimeError("messages were lost")
    return sum(delivered for delivered, *_ in rows)


def _us_a_message(flight: Mission, seconds: float) -> float:
    before, begin = _delivered(flight), process_time()
    flight.run_for(seconds)
    return (process_time() - begin) * 1e6 / (_delivered(flight) - before)


def nodes(size: int, context: str) -> Row:
    """So many nodes, each sending 100 messages a virtual second, and the looks for garbage that belong to that time."""
    seconds = LOOK_S * max(1, round(MESSAGES / (HZ * size * LOOK_S)))
    with ring(size, HZ, context) as flight:
        return {size: min(_us_a_message(flight, seconds) for _ in range(REPEATS if size < MANY else 1))}


def hours(size: int, context: str) -> Row:
    """Return the cost in each virtual hour of two nodes that send each other 10 messages per virtual second."""
    with ring(2, SLOW_HZ, context) as flight:
        return {hour: _us_a_message(flight, HOUR_S) for hour in range(1, size + 1)}


def missions(size: int, context: str) -> Row:
    """So many missions of two nodes, one after the other: the median of the last ten."""
    costs = []
    for _ in range(size):
        with ring(2, HZ, context) as flight:
            costs.append(_us_a_message(flight, MESSAGES / (20 * HZ)))
    last = sorted(costs[-NEIGHBOURS:])
    return {size: last[len(last) // 2]}


def missions_at_once(size: int, context: str) -> Row:
    """So many missions of two nodes that are all there at once, each going on for a while in turn."""
    with ExitStack() as flights:
        all_of_them = [flights.enter_context(ring(2, HZ, context)) for _ in range(size)]
        seconds = MESSAGES / (2 * HZ * size)
        return {size: min(_turn(all_of_them, seconds) for _ in range(REPEATS))}


def _turn(flights: list[Mission], seconds: float) -> float:
    before, begin = sum(map(_delivered, flights)), process_time()
    for flight in flights:
        flight.run_for(seconds)
    used_s = process_time() - begin
    return used_s * 1e6 / (sum(map(_delivered, flights)) - before)


def _room(pipes: int) -> PlatformConfig:
    """cFE's limits, with room for so many pipes, and as many for one message."""
    most = {"sb_max_pipes": pipes + 1, "os_max_queues": pipes + 1, "sb_max_msg_ids": pipes + 1}
    return PlatformConfig().with_limits({**most, "sb_max_dest_per_pkt": pipes + 1, "sb_buf_memory_bytes": 1 << 28})


def pipes(size: int, context: str) -> Row:
    """So many pipes, each with a message of its own, and one task that writes and reads one after the other."""
    bus = make_bus(context, _room(size))
    spent: list[float] = []

    def task() -> None:
        made = [bus.create_pipe(10, f"P{number}") for number in range(size)]
        packets = [packet(FIRST_MSG_ID + number) for number in range(size)]
        for number, pipe in enumerate(made):
            bus.subscribe(FIRST_MSG_ID + number, pipe)
        transmit, receive, both = bus.transmit_msg, bus.receive_buffer, list(zip(made, packets, strict=True))
        for _ in range(REPEATS):
            begin = process_time()
            for _ in range(MESSAGES // size):
                for pipe, message in both:
                    transmit(message)
                    receive(pipe, POLL)
            spent.append(process_time() - begin)

    run(bus, task)
    return {size: min(spent) * 1e6 / (MESSAGES // size * size)}


def fan_out(size: int, context: str) -> Row:
    """One message into so many pipes, all read by the task that sent it: the cost of a delivery."""
    bus = make_bus(context, _room(size))
    spent: list[float] = []

    def task() -> None:
        made = [bus.create_pipe(10, f"P{number}") for number in range(size)]
        for pipe in made:
            bus.subscribe(FIRST_MSG_ID, pipe)
        transmit, receive, message = bus.transmit_msg, bus.receive_buffer, packet(FIRST_MSG_ID)
        for _ in range(REPEATS):
            begin = process_time()
            for _ in range(MESSAGES // size):
                transmit(message)
                for pipe in made:
                    receive(pipe, POLL)
            spent.append(process_time() - begin)

    run(bus, task)
    return {size: min(spent) * 1e6 / (MESSAGES // size * size)}


def waiting_tasks(size: int, context: str) -> Row:
    """So many tasks that wait on a pipe each, and one that wakes them one after the other: a message and a switch."""
    bus = make_bus(context, _room(size))
    made = [bus.create_pipe(10, f"P{number}") for number in range(size)]
    for number, pipe in enumerate(made):
        bus.subscribe(FIRST_MSG_ID + number, pipe)
    rounds, spent = MESSAGES // size, list[float]()

    def receiver_of(pipe: int) -> Callable[[], None]:
        def receiver() -> None:
            for _ in range(rounds * REPEATS):
                bus.receive_buffer(pipe)

        return receiver

    def sender() -> None:
        packets = [packet(FIRST_MSG_ID + number) for number in range(size)]
        for _ in range(REPEATS):
            begin = process_time()
            for _ in range(rounds):
                for message in packets:
                    bus.transmit_msg(message)
                    bus.kernel.yield_cpu()
            spent.append(process_time() - begin)

    run(bus, *map(receiver_of, made), sender)
    return {size: min(spent) * 1e6 / (rounds * size)}


COUNTS = (1, 2, 5, 10, 20, 50, 100, 200)
KINDS: Mapping[str, tuple[Callable[[int, str], Row], tuple[int, ...], str]] = {
    "nodes": (nodes, (*COUNTS, 500), "nodes in a ring"),
    "pipes": (pipes, (*COUNTS, 500, 1000), "pipes, one task"),
    "fan_out": (fan_out, (*COUNTS, 500, 1000), "pipes of one message, a delivery"),
    "waiting_tasks": (waiting_tasks, (*COUNTS, 500, 1000), "tasks that wait on a pipe"),
    "hours": (hours, (24,), "virtual hours"),
    "missions": (missions, COUNTS, "missions, one after the other"),
    "missions_at_once": (missions_at_once, COUNTS, "missions at once"),
}
"""What measures, the sizes, and what the picture calls them."""


def growth(contexts: tuple[str, ...]) -> dict[str, float]:
    """Return figures by name: microseconds of CPU per message as KIND.CONTEXT.SIZE, each with MiB of the process."""
    figures: dict[str, float] = {}
    for kind, (_, sizes, _) in KINDS.items():
        for context in contexts:
            for size in sizes:
                row, mib = _in_process(kind, size, context)
                figures.update({f"{kind}.{context}.{each}": us for each, us in row.items()})
                figures[f"{kind}_mib.{context}.{size}"] = mib
    return figures


def _in_process(kind: str, size: int, context: str) -> tuple[dict[str, float], float]:
    command = [sys.executable, "-m", "benchmarks.growth", "--measure", kind, str(size), context]
    print(f"  {kind} {size} {context}", file=sys.stderr)
    row, mib = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
    return row, mib


def draw(figures: Mapping[str, float], file: str) -> None:
    """The figures of `growth` as a picture, a panel for each kind."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(12, 6), layout="constrained")
    axes = figure.subplots(2, 4).flat
    for axis, (kind, (_, sizes, title)) in zip(axes, KINDS.items(), strict=False):
        for context, line in (("thread", "o-"), ("greenlet", "s-")):
            mark = f"{kind}.{context}."
            row = {int(name.removeprefix(mark)): us for name, us in figures.items() if name.startswith(mark)}
            axis.plot(list(row), list(row.values()), line, label=f"{context}s", markersize=4)
        if len(sizes) > 1:
            axis.set_xscale("log")
        axis.set_ylim(bottom=0)
        axis.set_title(title, fontsize=10)
        axis.grid(alpha=0.3)
    legend, memory = axes[0], list(figure.axes)[-1]
    legend.legend()
    legend.set_ylabel("CPU time a message, us")
    figure.axes[4].set_ylabel("CPU time a message, us")
    for kind in ("nodes", "missions", "missions_at_once"):
        mark = f"{kind}_mib.greenlet."
        row = {int(name.removeprefix(mark)): mib for name, mib in figures.items() if name.startswith(mark)}
        memory.plot(list(row), list(row.values()), ".-", label=KINDS[kind][2])
    memory.set_ylim(bottom=0)
    memory.set_title("memory, MiB, by number", fontsize=10)
    memory.grid(alpha=0.3)
    memory.legend(fontsize=8)
    figure.savefig(file, dpi=80, metadata={"Software": None})


def main() -> None:
    """Measure and draw, or one measurement for another process."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.growth", description="Draw where cost grows.")
    parser.add_argument("picture", nargs="?", metavar="PICTURE", help="the file to draw")
    parser.add_argument("--of", metavar="FIGURES", help="a file of python -m benchmarks growth --json")
    parser.add_argument("--measure", nargs=3, metavar=("KIND", "SIZE", "CONTEXT"), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.measure:
        kind, size, context = options.measure
        row = KINDS[kind][0](int(size), context)
        print(json.dumps([row, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024]))
        return
    if options.picture is None:
        parser.error("which file is it to draw?")
    if options.of is None:
        print(json.dumps(machine(), indent=2), file=sys.stderr)
        figures = growth(contexts_here())
    else:
        figures = json.loads(Path(options.of).read_text(encoding="utf-8"))["growth"]
    draw(figures, options.picture)


if __name__ == "__main__":
    main()
