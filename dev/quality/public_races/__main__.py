"""`python -m dev.quality.public_races`: fetch public sources with known races, explore them, and report the results."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from dev.corpus.sources import add_fetch, execute
from dev.quality.public_races.races import FILE, PublicRaces, read_races
from dev.quality.public_races.report import PAGE, read_results, write_page, write_results
from dev.quality.public_races.trial import MOST, try_race


def main() -> int:
    """Execute the command line. Returns the exit status."""
    return execute(_parser(), read_races)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m dev.quality.public_races", description=__doc__)
    actions = parser.add_subparsers(required=True)
    add_fetch(actions, _fetch)
    run = actions.add_parser("run", help="explore races, and write results.json and the page")
    run.add_argument("names", nargs="*", metavar="NAME", help=f"races of {FILE.name}; all without a result if none")
    run.add_argument("--sources", type=Path, required=True, help="the folder with the sources")
    run.add_argument("--most", type=int, default=MOST, help=f"schedules of each race ({MOST})")
    run.set_defaults(action=_run)
    report = actions.add_parser("report", help="write the page of results.json")
    report.set_defaults(action=_report)
    return parser


def _fetch(arguments: argparse.Namespace, races: PublicRaces) -> int:
    for each in races.fetch(arguments.folder, arguments.mirrors):
        print(each)
    return 0


def _run(arguments: argparse.Namespace, races: PublicRaces) -> int:
    results = read_results()
    for race in races.chosen(arguments.names):
        if race.flies and (arguments.names or race.name not in results):
            results[race.name] = try_race(race, arguments.sources, arguments.most)
            print(race.name, results[race.name], flush=True)
            write_results(races, results)
    return _report(arguments, races)


def _report(arguments: argparse.Namespace, races: PublicRaces) -> int:
    write_page(races, read_results())
    print(PAGE)
    return 0


if __name__ == "__main__":
    sys.exit(main())
