"""`python -m dev.costs`: measures the CPU time of each test, and writes `tests/costs.tsv`.

The quick loop has the tests that are not in that table. Tests that were too expensive the first time are run once more,
and the lower cost counts, because the first test fills caches for the others. With files or folders of tests, only
those are measured, and lines of others are kept.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from dev.costs.meter import FOLDER, measured
from dev.costs.table import DEAR_S, PATH, ROOT, SLOW_S, Table, file_of


def run(folder: Path, words: Sequence[str]) -> None:
    """Run tests, in this environment and with the meter."""
    command = [sys.executable, "-m", "pytest", "-p", "dev.costs.meter", *words]
    subprocess.run(command, cwd=ROOT, env=os.environ | {FOLDER: str(folder)}, check=False)  # failures do not matter


def dear(costs: dict[str, float]) -> list[str]:
    """Return the files with tests that the quick loop would leave out."""
    return sorted({file_of(test) for test, cost in costs.items() if cost >= DEAR_S})


def main() -> None:
    """Measure, list the tests that are too expensive, and write the table."""
    parser = argparse.ArgumentParser(prog="python -m dev.costs", description=__doc__)
    parser.add_argument("paths", nargs="*", metavar="PATH", help="files or folders of tests in place of all of them")
    parser.add_argument("--slow", action="store_true", help="measure the slow tests, once, and write no table")
    parser.add_argument(
        "--most", type=int, default=40, metavar="N", help="how many of the most expensive tests to print"
    )
    options = parser.parse_args()
    paths = [str(Path(path).resolve()) for path in options.paths]
    with tempfile.TemporaryDirectory() as folder:
        run(Path(folder), [*paths, *(["-m", "slow"] if options.slow else [])])
        costs = measured(Path(folder))
        if not options.slow and (again := dear(costs)):
            run(Path(folder), [*again, "-n", str(os.cpu_count() or 1)])
            costs = measured(Path(folder))
    for test in sorted(costs, key=costs.__getitem__, reverse=True)[: options.most]:
        print(f"{costs[test]:8.2f} s  {test}")
    print(f"{sum(costs.values()):8.1f} s of CPU time for {len(costs)} tests")
    if options.slow:
        return
    few = [cost for cost in costs.values() if cost < DEAR_S]
    print(f"{sum(few):8.1f} s for {len(few)} of them in the quick loop")
    print(f"{sum(cost >= SLOW_S for cost in costs.values()):6} need {SLOW_S} s and more, and are slow ones from now on")
    Table.read().merged(costs).write() if PATH.exists() else Table({}).merged(costs).write()


main()
