"""`python -m dev.quality report`: measure how soon the planted bugs are found, and write planted_bugs.md.

`python -m dev.quality programs` does the same with programs known from other tools (benchmarks_exploration.md). Both
pages are in docs/reference/generated.

`python -m dev.quality edits` prints how many of their shrunk schedules still fail after small edits
(docs/how_to/explore_schedules.md).

`python -m dev.quality mended` flies the mended forms under many schedules, in search of false alarms (both pages).

`python -m dev.quality stories` writes down the reported cause of each of them (`stories.txt`).
"""

from __future__ import annotations

import argparse

from dev.quality import program_report, report
from dev.quality.bugs import BUGS
from dev.quality.edits import measure as measure_edits
from dev.quality.measure import MOST
from dev.quality.mended import MOST as MOST_MENDED
from dev.quality.mended import measure as measure_mended
from dev.quality.programs import PROGRAMS
from dev.quality.stories import write


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(prog="python -m dev.quality", description=__doc__)
    commands = parser.add_subparsers(required=True, dest="command")
    planted = commands.add_parser("report", help="measure the missing results, and write the page")
    planted.add_argument("bugs", nargs="*", choices=[[], *(bug.name for bug in BUGS)], help="only these")
    planted.add_argument("--jobs", type=int, default=2, help="processes (2)")
    planted.add_argument("--most", type=int, default=MOST, help=f"schedules for one cell of the table ({MOST})")
    stories = commands.add_parser("stories", help="tell the cause of each bug anew")
    stories.add_argument("bugs", nargs="*", choices=[[], *(bug.name for bug in BUGS)], help="only these")
    programs = commands.add_parser("programs", help="measure the missing programs, and write their page")
    programs.add_argument("programs", nargs="*", choices=[[], *(each.name for each in PROGRAMS)], help="only these")
    edits = commands.add_parser("edits", help="fly the planted bugs after small edits, and print the table")
    edits.add_argument("bugs", nargs="*", choices=[[], *(bug.name for bug in BUGS)], help="only these")
    mended = commands.add_parser("mended", help="fly the mended forms on, from where it was ended")
    missions = [each.name for each in (*BUGS, *PROGRAMS)]
    mended.add_argument("missions", nargs="*", choices=[[], *missions], help="only these")
    mended.add_argument("--jobs", type=int, default=2, help="processes (2)")
    mended.add_argument("--most", type=int, default=MOST_MENDED, help=f"schedules of each mission ({MOST_MENDED})")
    given = parser.parse_args()
    if given.command == "report":
        report.measure(given.bugs, given.jobs, given.most)
    elif given.command == "programs":
        program_report.measure(given.programs)
    elif given.command == "edits":
        measure_edits(given.bugs)
    elif given.command == "mended":
        measure_mended(given.missions, given.jobs, given.most)
        report.write(report.load())
        program_report.write(program_report.load())
    else:
        write(given.bugs)


if __name__ == "__main__":
    main()
