"""`python -m dev.c.osal_tests SOURCES [TEST ...]`: builds and flies OSAL's own tests, and prints a table."""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

from dev.c.osal_tests.build import Builder
from dev.c.osal_tests.flight import Result, fly


def main() -> None:
    """Build, fly, report."""
    parser = argparse.ArgumentParser(prog="python -m dev.c.osal_tests", description=__doc__)
    parser.add_argument("sources", type=Path, help="OSAL's sources (github.com/nasa/osal, v7.0.0)")
    parser.add_argument("tests", nargs="*", help="names of tests, such as queue-test; all when none is given")
    parser.add_argument("--tasks", default="thread", choices=("thread", "greenlet"))
    parser.add_argument("--show", action="store_true", help="show all that the tests say")
    options = parser.parse_args()
    sources = options.sources.resolve()
    with tempfile.TemporaryDirectory() as folder:
        results = fly_all(sources, Path(folder), options.tests, options.tasks, options.show)
    report(results)


def fly_all(sources: Path, folder: Path, names: list[str], tasks: str, shows: bool) -> list[Result]:
    """Fly each test in a folder of its own."""
    builder = Builder(sources, folder / "include")
    results = []
    for test in builder.tests():
        if names and test.name not in names:
            continue
        place = folder / test.name
        place.mkdir()
        builder.build(test, place)
        result = fly(place, test.name, tasks)
        results.append(result)
        if shows:
            print("\n".join(result.lines))
        print(row(result), flush=True)
    return results


def row(result: Result) -> str:
    """Return a line of the table."""
    good = sum(segment.passes for segment in result.segments)
    counts = " | ".join(str(result.count(kind)) for kind in ("PASS", "FAIL", "MIR"))
    ended = "" if result.is_complete else " (not to its end)"
    return f"| {result.name}{ended} | {good} of {len(result.segments)} | {counts} |"


def report(results: list[Result]) -> None:
    """Print the failed tests and the totals."""
    for result in results:
        for segment in result.segments:
            for failure in segment.failures:
                print(f"{result.name}, {segment.name}: {failure}")
    segments = [segment for result in results for segment in result.segments]
    good = sum(segment.passes for segment in segments)
    print(f"{good} of {len(segments)} segments without FAIL")


if __name__ == "__main__":
    main()
