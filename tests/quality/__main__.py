"""`python -m tests.quality report`: measure how soon the planted bugs are found, and write docs/planted_bugs.md."""

from __future__ import annotations

import argparse

from tests.quality.bugs import BUGS
from tests.quality.measure import MOST
from tests.quality.report import measure


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(prog="python -m tests.quality", description=__doc__)
    commands = parser.add_subparsers(required=True)
    report = commands.add_parser("report", help="measure what is missing, and write the page")
    report.add_argument("bugs", nargs="*", choices=[[], *(bug.name for bug in BUGS)], help="only these")
    report.add_argument("--jobs", type=int, default=2, help="processes (2)")
    report.add_argument("--most", type=int, default=MOST, help=f"schedules for one cell of the table ({MOST})")
    given = parser.parse_args()
    measure(given.bugs, given.jobs, given.most)


if __name__ == "__main__":
    main()
