"""Many small nodes in one mission: the time of their boot, and their memory; `python -m benchmarks.crowd`."""

from __future__ import annotations

import resource
import subprocess
import sys
import tempfile
from pathlib import Path
from time import perf_counter

from cfepy.mission import Mission, MissionSpec
from cfepy.mission.limits import MissionLimits
from cfepy.nodes import NodeConfig, RosConfig
from cfepy.writing.console import Console

SCRIPT = Path(__file__).parent / "nodes" / "member.py"
NODES = 500
BOOT_S = 1.0  # virtual; cFE's own boot takes half of it
REPEATS = 3


def crowd(contexts: tuple[str, ...]) -> dict[str, float]:
    """Return figures of 500 nodes that publish and subscribe, by name: seconds to boot, and MiB of the process.

    Each run has its own process, so that its memory is measured alone. The boot of nodes that also log comes second.
    """
    figures: dict[str, float] = {}
    for context in contexts:
        for name, talks in (("", False), ("_logging", True)):
            runs = [_in_process(context, talks) for _ in range(REPEATS)]
            figures[f"boot_500_nodes{name}_s.{context}"] = min(seconds for seconds, _ in runs)
            figures[f"memory_500_nodes{name}_mib.{context}"] = min(mib for _, mib in runs)
    return figures


def boot(folder: Path, nodes: int, context: str, talks: bool) -> float:
    """Boot a mission until every node has published once. Returns the wall time in s.

    Args:
        folder: an empty folder.
        nodes: how many.
        context: kind of tasks.
        talks: each node logs a line.

    Raises:
        RuntimeError: not all of them started.
    """
    (folder / SCRIPT.name).write_bytes(SCRIPT.read_bytes())
    lines = [f"CFE_APP, {SCRIPT.stem}, __main__, N{number}, 100, 4096, 0x0, 0;\n" for number in range(nodes)]
    script = folder / "startup.scr"
    script.write_text("".join(lines) + "!\n", encoding="utf-8")
    configs = {
        f"N{number}": NodeConfig(f"N{number}", name=f"n{number}", args=(str(number), str(nodes), str(int(talks))))
        for number in range(nodes)
    }
    ros, limits = RosConfig(nodes=configs, spread=True), MissionLimits(nodes=nodes)
    spec = MissionSpec("crowd", folder, script, None, "linux", ros, limits=limits)
    begin = perf_counter()
    with Mission(spec, tasks=context, console=Console(quiet=True)) as flight:
        flight.run_for(BOOT_S)
        seconds = perf_counter() - begin
        assert flight.ros is not None
        sent = [row for row in flight.ros.topics() if row.name.startswith("/ring") and row.publishers]
        if len(flight.ros.graph.nodes) != nodes or len(sent) != nodes:
            raise RuntimeError(f"of {nodes} nodes {len(flight.ros.graph.nodes)} are there, {len(sent)} publish")
        return seconds


def _in_process(context: str, talks: bool) -> tuple[float, float]:
    """(seconds, MiB) of one run."""
    command = [sys.executable, "-m", "benchmarks.crowd", context, str(int(talks))]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    seconds, mib = done.stdout.split()
    return float(seconds), float(mib)


if __name__ == "__main__":
    chosen, logging = sys.argv[1:] if len(sys.argv) == 3 else ("thread", "0")
    with tempfile.TemporaryDirectory() as place:
        taken = boot(Path(place), NODES, chosen, logging == "1")
    print(taken, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)
