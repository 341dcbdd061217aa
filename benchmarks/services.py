"""Services between two nodes: the wall time of a call, from the caller's request to its answer."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from time import perf_counter

from cfepy.mission import Mission, read_mission
from cfepy.nodes import NodeConfig
from cfepy.writing.console import Console

NODES = Path(__file__).parent / "nodes" / "services"
REPEATS = 5
CALLING_S = 0.01  # virtual


def call_us(context: str, *, persistent: bool) -> float:
    """Return the wall time of a call in us. `persistent` keeps the connection from call to call."""
    return min(_once(context, ("persistent",) if persistent else ()) for _ in range(REPEATS))


def _once(context: str, arguments: tuple[str, ...]) -> float:
    spec = read_mission(str(NODES))
    caller = NodeConfig("caller", args=arguments)
    spec = replace(spec, ros=replace(spec.ros, nodes={**spec.ros.nodes, "CALLER": caller}))
    with Mission(spec, tasks=context, console=Console(quiet=True)) as flight:
        flight.run_for(1)
        while not _calls(flight):
            flight.run_for(CALLING_S)
        before, begin = _calls(flight), perf_counter()
        flight.run_for(CALLING_S)
        return (perf_counter() - begin) / (_calls(flight) - before) * 1e6


def _calls(flight: Mission) -> int:
    assert flight.ros is not None
    route = flight.cfe.sb.routes.get(flight.ros.graph.services["/add"].answer_id)
    return route.sent if route is not None else 0


def services(contexts: tuple[str, ...]) -> dict[str, float]:
    """Return times in us of a call, by context and kind of proxy."""
    figures = {}
    for context in contexts:
        figures[f"call_us.{context}"] = call_us(context, persistent=False)
        figures[f"persistent_call_us.{context}"] = call_us(context, persistent=True)
    return figures
