"""Coordinate frames: the wall time of a tf2 lookup through a chain of ten frames, in a node."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter

from cfepy.mission import Mission
from cfepy.writing.console import Console

NODES = Path(__file__).parent / "nodes" / "frames"
REPEATS = 5
LINE = 100  # lookups for each line that the node prints
START_S = 1.5  # virtual; shortly after it, the node makes its first lookup
LOOKING_S = 0.0002  # virtual; a lookup takes none, but checking whether to continue does


def lookup_us(context: str) -> float:
    """Return the wall time of a lookup in us."""
    with Mission(str(NODES), tasks=context, console=Console(quiet=True)) as flight:
        flight.run_for(START_S)
        while not _looked(flight):
            flight.run_for(LOOKING_S)
        return min(_once(flight) for _ in range(REPEATS))


def _once(flight: Mission) -> float:
    before, begin = _looked(flight), perf_counter()
    flight.run_for(LOOKING_S)
    return (perf_counter() - begin) / (_looked(flight) - before) / LINE * 1e6


def _looked(flight: Mission) -> int:
    return flight.console.lines.count("[looker] looked")


def frames(contexts: tuple[str, ...]) -> dict[str, float]:
    """Return times in us of a lookup, by context."""
    return {f"lookup_us.{context}": lookup_us(context) for context in contexts}
