"""`python -m dev.c.cfe_testcase FOLDER`: flies NASA's functional tests of cFE, and compares with NASA's own run.

One process flies them on threads, on greenlets and on threads again. All three runs must give the same trace.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

from dev.c.cfe_testcase.flight import Result, Segment, fly, make_mission, of_nasa

FLIGHTS = ("thread", "greenlet", "thread")


def main() -> None:
    """Fly, compare and report. Exit status 1 if anything failed."""
    parser = argparse.ArgumentParser(prog="python -m dev.c.cfe_testcase", description=__doc__)
    parser.add_argument("folder", type=Path, help="has cfe_testcase.so and the like: exe/cpu1/cf of a cFS build")
    parser.add_argument("--once", action="store_true", help="fly once, on threads")
    parser.add_argument("--mission", type=Path, help="keep the mission in this folder, for other commands of cfepy")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.mission or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        mission = make_mission(options.folder, folder)
        results = [fly(mission, tasks) for tasks in FLIGHTS[: 1 if options.once else None]]
    sys.exit(report(results))


def report(results: list[Result]) -> int:
    """Print the segments of the first flight beside NASA's, and whether the flights were identical.

    Returns an exit status.
    """
    nasa, first = of_nasa(), results[0]
    print("| segment | passed | failed | by hand | left out | NASA: passed, by hand, left out |")
    print("|---|---|---|---|---|---|")
    for segment in first.segments:
        print(row(segment, nasa.get(segment.number)))
    good = sum(not segment.failed for segment in first.segments)
    print(f"{good} of {len(first.segments)} segments without a failure, of NASA's {len(nasa)}; ", end="")
    print(f"{sum(segment.passed for segment in first.segments)} passed, NASA {sum(each[0] for each in nasa.values())}")
    digests = sorted({result.digest for result in results})
    print(f"{len(results)} flights, digests: {', '.join(digests)}")
    is_complete = first.is_complete and len(first.segments) == len(nasa)
    return 0 if is_complete and good == len(nasa) and len(digests) == 1 else 1


def row(segment: Segment, nasa: tuple[int, int, int] | None) -> str:
    """Return a line of the table, with NASA's counts where they are others."""
    ours = segment.passed, segment.by_hand, segment.left_out
    others = "the same" if nasa == ours else "-" if nasa is None else ", ".join(map(str, nasa))
    name = f"{segment.number} {segment.name}"
    return f"| {name} | {segment.passed} | {segment.failed} | {segment.by_hand} | {segment.left_out} | {others} |"


if __name__ == "__main__":
    main()
