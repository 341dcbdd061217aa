"""`python -m dev.peers`: fetch public test files of ROS packages, run them, report the results."""

from __future__ import annotations

import argparse
import os
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from cfepy.status import UsageError
from dev.corpus.sources import Sources, add_fetch, execute
from dev.peers.flight import Verdict, run
from dev.peers.peers import Peers, read_peers
from dev.peers.report import PAGE, row, write_page

ENVIRONMENT = "CFEPY_PEERS_SOURCES"


def main() -> int:
    """Execute the command line. Returns the exit status."""
    return execute(_parser(), read_peers)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m dev.peers", description=__doc__)
    actions = parser.add_subparsers(required=True)
    add_fetch(actions)
    for name, action in (("run", _run), ("report", _report)):
        sub = actions.add_parser(name, help=(action.__doc__ or "").splitlines()[0])
        sub.add_argument("names", nargs="*", metavar="NAME", help="test files, or how their names begin; else all")
        sub.add_argument("--sources", type=Path, default=os.environ.get(ENVIRONMENT), help=f"default: ${ENVIRONMENT}")
        sub.add_argument("--jobs", type=int, default=1, help="how many at a time")
        sub.add_argument("--verbose", action="store_true", help="show the output of failing tests")
        sub.set_defaults(action=action)
    return parser


def _run(arguments: argparse.Namespace, peers: Peers) -> int:
    """Run test files and print the results."""
    verdicts = _verdicts(arguments, peers)
    good = sum(verdict.good for verdict in verdicts)
    print(f"{good} of {len(verdicts)} files pass as on ROS; {sum(each.passed for each in verdicts)} tests passed")
    return 0 if good == len(verdicts) else 1


def _report(arguments: argparse.Namespace, peers: Peers) -> int:
    """Run test files and write the page about them."""
    write_page(peers, _verdicts(arguments, peers))
    print(PAGE)
    return 0


def _verdicts(arguments: argparse.Namespace, peers: Peers) -> list[Verdict]:
    if arguments.sources is None:
        how = f"say where the sources are: --sources FOLDER, or {ENVIRONMENT}; `python -m dev.peers fetch` gets them"
        raise UsageError(how)
    sources, verdicts = Sources(Path(arguments.sources)), []
    with ThreadPoolExecutor(arguments.jobs) as pool:
        for verdict in pool.map(lambda peer: run(peer, sources), peers.chosen(arguments.names)):
            print(row(verdict), flush=True)
            if arguments.verbose:
                for name, said in verdict.failing.items():
                    print(f"--- {name}\n{said}")
            verdicts.append(verdict)
    return verdicts


if __name__ == "__main__":
    sys.exit(main())
