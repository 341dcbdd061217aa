"""`python -m dev.corpus`: fetch the sources of public nodes, run them, report the results."""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
from pathlib import Path

from cfepy.status import UsageError
from dev.corpus.flight import Flight
from dev.corpus.likeness import differences
from dev.corpus.pool import run_all
from dev.corpus.report import PAGE, write_page
from dev.corpus.ros_flight import RosFlight
from dev.corpus.scenarios import Corpus, Scenario, read_corpus
from dev.corpus.sources import ENVIRONMENT, FETCH, Sources, add_fetch, execute
from dev.corpus.verdict import Verdict, judge


def main() -> int:
    """Execute the command line. Returns the exit status."""
    return execute(_parser(), read_corpus)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m dev.corpus", description=__doc__)
    actions = parser.add_subparsers(required=True)
    add_fetch(actions)
    for name, action in (("run", _run), ("report", _report), ("fly", _fly), ("beside", _beside)):
        sub = actions.add_parser(name, help=(action.__doc__ or "").splitlines()[0])
        sub.add_argument("ids", nargs="*", metavar="ID", help="scenarios; all when none is given")
        sub.add_argument("--sources", type=Path, default=os.environ.get(ENVIRONMENT), help=f"default: ${ENVIRONMENT}")
        sub.add_argument("--jobs", type=int, default=1, help="how many at a time")
        sub.add_argument("--tasks", choices=("thread", "greenlet"), default="thread")
        sub.set_defaults(action=action)
    return parser


def _run(arguments: argparse.Namespace, corpus: Corpus) -> int:
    """Run scenarios, each in its own process, and print the results."""
    verdicts = _verdicts(arguments, corpus)
    for verdict in verdicts:
        print(f"{'ok  ' if verdict.passed else 'FAIL'} {verdict.wall_s:5.2f} s  {verdict.id}  {verdict.reason}")
    passed = sum(verdict.passed for verdict in verdicts)
    print(f"{passed} of {len(verdicts)} do what they must")
    return 0 if passed == len(verdicts) else 1


def _report(arguments: argparse.Namespace, corpus: Corpus) -> int:
    """Run scenarios and write the page about them."""
    write_page(corpus, _verdicts(arguments, corpus))
    print(PAGE)
    return 0


def _fly(arguments: argparse.Namespace, corpus: Corpus) -> int:
    """Run scenarios in this process and show the nodes' output."""
    sources = _sources(arguments)
    good = True
    for scenario in corpus.chosen(arguments.ids):
        with tempfile.TemporaryDirectory() as folder:
            outcome = Flight(scenario, sources, Path(folder), arguments.tasks).run()
        verdict = judge(scenario, outcome)
        print(f"{outcome.out}\n{outcome.helpers_out}\nN={outcome.counts} R={outcome.remarks} rc={outcome.status}")
        print(f"{scenario.id}: {verdict.reason or 'ok'}, {outcome.wall_s:.2f} s")
        good = good and verdict.passed
    return 0 if good else 1


def _beside(arguments: argparse.Namespace, corpus: Corpus) -> int:
    """Run scenarios here and on this computer's ROS 1, and show the differences."""
    sources = _sources(arguments)
    alike = True
    for scenario in corpus.chosen(arguments.ids):
        with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as other:
            there = RosFlight(scenario, sources, Path(folder)).run()
            here = Flight(scenario, sources, Path(other), arguments.tasks).run()
        found = differences(there, here)
        print(f"{scenario.id}: {len(found) or 'no'} differences")
        for name, (on_ros, on_cfepy) in found.items():
            print(f"  {name}\n    ROS   {on_ros}\n    cfepy {on_cfepy}")
        alike = alike and not found
    return 0 if alike else 1


def _verdicts(arguments: argparse.Namespace, corpus: Corpus) -> list[Verdict]:
    scenarios = corpus.chosen(arguments.ids)
    sources = _sources(arguments)
    ready = [scenario for scenario in scenarios if not sources.missing(scenario)]
    by_id = run_all(ready, sources, arguments.jobs, arguments.tasks)
    return [by_id.get(scenario.id) or _absent(scenario, sources) for scenario in scenarios]


def _absent(scenario: Scenario, sources: Sources) -> Verdict:
    return Verdict(scenario.id, sources.missing(scenario), 0.0)


def _sources(arguments: argparse.Namespace) -> Sources:
    if arguments.sources is None:
        raise UsageError(f"say where the sources are: --sources FOLDER, or {ENVIRONMENT}; `{FETCH}` gets them")
    return Sources(Path(arguments.sources))


if __name__ == "__main__":
    sys.exit(main())
