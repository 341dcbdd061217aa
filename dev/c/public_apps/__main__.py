"""`python -m dev.c.public_apps`: fetch public missions, build and fly their applications, and report the results.

`beside` also flies them on NASA's cFE, whose folder is in CFEPY_REAL_CFE.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from dev.c.public_apps.comparison import compare_mission
from dev.c.public_apps.flight import flown
from dev.c.public_apps.missions import PublicMissions, read_missions
from dev.c.public_apps.results import (
    ANSWERS,
    PAGE,
    RUNS,
    read_beside,
    read_results,
    write_beside,
    write_page,
    write_results,
)
from dev.c.public_apps.trial import try_mission
from dev.corpus.sources import Sources, add_fetch, execute
from dev.twin.compare import real_folder


def main() -> int:
    """Execute the command line. Returns the exit status."""
    return execute(_parser(), read_missions)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m dev.c.public_apps", description=__doc__)
    actions = parser.add_subparsers(required=True)
    add_fetch(actions)
    run = actions.add_parser("run", help="build and fly missions, and write results.tsv")
    run.add_argument("names", nargs="*", metavar="NAME", help="missions; all when none is given")
    run.add_argument("--sources", type=Path, required=True, help="the folder with the sources")
    run.set_defaults(action=_run)
    beside = actions.add_parser("beside", help="fly missions on NASA's cFE, too, and write beside.tsv")
    beside.add_argument("names", nargs="*", metavar="NAME", help="missions; all when none is given")
    beside.add_argument("--sources", type=Path, required=True, help="the folder with the sources")
    beside.set_defaults(action=_beside)
    fly = actions.add_parser("fly", help="fly the last application of a mission folder, and print the result as JSON")
    fly.add_argument("folder", type=Path)
    fly.set_defaults(action=_fly)
    report = actions.add_parser("report", help="write the page of results.tsv")
    report.set_defaults(action=_report)
    return parser


def _run(arguments: argparse.Namespace, missions: PublicMissions) -> int:
    order = list(missions.missions)
    for mission in missions.chosen(arguments.names):
        results = [each for each in read_results() if each.mission != mission.name]
        for result in try_mission(mission, Sources(arguments.sources)):
            print(*result, sep=" | ", flush=True)
            results.append(result)
        write_results(sorted(results, key=lambda each: (order.index(each.mission), each.app)))
    return 0


def _beside(arguments: argparse.Namespace, missions: PublicMissions) -> int:
    order = list(missions.missions)
    flying = {(each.mission, each.app) for each in read_results() if each.flown in (ANSWERS, RUNS)}
    for mission in missions.chosen(arguments.names):
        wanted = [app for name, app in flying if name == mission.name]
        results = [each for each in read_beside() if each.mission != mission.name]
        for result in compare_mission(mission, Sources(arguments.sources), real_folder(), wanted):
            print(*result, sep=" | ", flush=True)
            results.append(result)
        write_beside(sorted(results, key=lambda each: (order.index(each.mission), each.app)))
    return 0


def _fly(arguments: argparse.Namespace, missions: PublicMissions) -> int:
    print(json.dumps(flown(arguments.folder)._asdict()))
    return 0


def _report(arguments: argparse.Namespace, missions: PublicMissions) -> int:
    write_page(missions, read_results(), read_beside())
    print(PAGE)
    return 0


if __name__ == "__main__":
    sys.exit(main())
