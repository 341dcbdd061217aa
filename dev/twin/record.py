"""Flies seeds on NASA's cFE and records them: `python -m dev.twin.record FILE --seeds 1 2 --flight 80`."""

from __future__ import annotations

import argparse
from pathlib import Path

from dev.twin import recorded
from dev.twin.__main__ import fly
from dev.twin.compare import real_folder


def main() -> None:
    """Write the file."""
    parser = argparse.ArgumentParser(prog="python -m dev.twin.record", description=__doc__)
    parser.add_argument("file", type=Path)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1])
    parser.add_argument("--flight", type=int, default=60, help="steps of a flight")
    parser.add_argument("--without", nargs="*", default=[], help="names of commands to leave out")
    given = parser.parse_args()
    built = real_folder()
    flights = (fly(built, seed, given.flight, given.without) for seed in given.seeds)
    recorded.save(given.file, [[(flown.step, flown.observed) for flown in flight] for flight in flights])


if __name__ == "__main__":
    main()
