"""Flies seeds on NASA's cFE and puts them on record: `python -m tests.twin.record FILE --seeds 1 2 --flight 80`."""

from __future__ import annotations

import argparse
import itertools
import sys
from pathlib import Path

from tests.twin import recorded
from tests.twin.commands import Commander
from tests.twin.flight import real, simulated
from tests.twin.real import VARIABLE, installed


def fly(built: Path, seed: int, count: int, without: list[str]) -> recorded.Flight:
    """The steps of a seed, and what came of them."""
    flight: recorded.Flight = []
    with real(built) as theirs, simulated(theirs.release) as ours:
        for step in itertools.islice(Commander(seed, without).steps(), count):
            flight.append((step, theirs.fly(step, ours.fly(step))))
    return flight


def main() -> None:
    """Write the file."""
    parser = argparse.ArgumentParser(prog="python -m tests.twin.record", description=__doc__)
    parser.add_argument("file", type=Path)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1])
    parser.add_argument("--flight", type=int, default=60, help="steps of a flight")
    parser.add_argument("--without", nargs="*", default=[], help="names of commands to leave out")
    given = parser.parse_args()
    built = installed()
    if built is None:
        sys.exit(f"{VARIABLE} does not say where the folder of NASA's core-cpu1 is")
    recorded.save(given.file, [fly(built, seed, given.flight, given.without) for seed in given.seeds])


if __name__ == "__main__":
    main()
