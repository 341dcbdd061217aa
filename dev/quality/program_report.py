"""The table of further programs: the measurements of each, kept in a file, and the page made from it."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

from cfepy.extra.exploration import verdict
from cfepy.schedules import Schedule
from dev.quality import mended
from dev.quality.measure import Median, hunts, median
from dev.quality.programs import PROGRAMS, Program, program_trial

MEASURED = Path(__file__).parent / "measured_programs.json"
PAGE = Path(__file__).parents[2] / "docs" / "reference" / "generated" / "benchmarks_exploration.md"
DEFAULT = "all"
SCHEDULES = 200
MOST = 10_000  # of the one search that anyone can repeat
TRIALS = 3
FOUND, MEDIAN, RACES = "found", "median", "races"

Measured = dict[str, dict[str, Any]]
"""By program: the first schedule that fails, or None, what `Median` is made of, whether a race is told."""


def load() -> Measured:
    """Return the measurements so far."""
    measured: Measured = json.loads(MEASURED.read_text(encoding="utf-8")) if MEASURED.is_file() else {}
    return measured


def measure(names: list[str]) -> None:
    """Measure the missing programs one by one, then write the page.

    Args:
        names: names of the programs; all of them if empty.
    """
    measured = load()
    wanted = [program for program in PROGRAMS if not names or program.name in names]
    for column in (FOUND, MEDIAN, RACES):
        for program in wanted:
            if column not in measured.get(program.name, {}):
                value = _measured(column, program)
                measured.setdefault(program.name, {})[column] = value
                ordered = {each.name: measured[each.name] for each in PROGRAMS if each.name in measured}
                MEASURED.write_text(json.dumps(ordered, indent=1) + "\n", encoding="utf-8")
                print(f"{program.name}: {column}: {value}", flush=True)
    write(measured)


def write(measured: Measured) -> None:
    """Write the page, if nothing is missing."""
    if complete(measured):
        PAGE.write_text(page(measured), encoding="utf-8")


def _measured(column: str, program: Program) -> Any:
    """One cell."""
    if column == FOUND:
        return first_failing(program, MOST)
    if column == MEDIAN:
        return median(program_trial(program), DEFAULT, TRIALS, TRIALS * SCHEDULES).to_dict()
    return tells_race(program)


def first_failing(program: Program, most: int) -> int | None:
    """Return the number, from 1, of the first schedule of the default policy that shows the mistake, or None.

    Args:
        program: the program.
        most: limit of schedules.
    """
    (hunt,) = hunts(program_trial(program), DEFAULT, 1)
    for number in range(1, most + 1):
        found = hunt.step()
        assert found is not None
        if found.failed:
            assert found.failures[0].kind in program.kinds, found.failures
            return number
    return None


def tells_race(program: Program) -> bool:
    """Return whether one run under fifo with `--races` reports a data race."""
    trial = program_trial(program)
    failures = replace(trial, plan=replace(trial.plan, races=True)).run(Schedule()).failures
    return any(failure.kind == verdict.RACE for failure in failures)


# -- evaluation ------------------------------------------------------------------------------------------------------


def complete(measured: Measured) -> bool:
    """Return whether every cell has been measured."""
    return all(set(measured.get(program.name, {})) == {FOUND, MEDIAN, RACES} for program in PROGRAMS)


def missed(measured: Measured) -> list[Program]:
    """Return the programs whose mistake none of the first SCHEDULES shows."""
    return [program for program in PROGRAMS if (measured[program.name][FOUND] or MOST) > SCHEDULES]


def page(measured: Measured) -> str:
    """Return the page of documentation."""
    heads = ["program", "in", "written after", "shows as", "needs", "first", "median", "`--races`", "published"]
    lines = ["|".join(["", *heads, ""]), "|".join(["", *["---"] * len(heads), ""])]
    lines += [_row(measured[program.name], program) for program in PROGRAMS]
    not_found = missed(measured)
    return _PAGE.format(
        count=len(PROGRAMS),
        others=sum(bool(program.origin) for program in PROGRAMS),
        trials=TRIALS,
        schedules=SCHEDULES,
        found=len(PROGRAMS) - len(not_found),
        later=sum(measured[program.name][FOUND] is not None for program in PROGRAMS),
        most=MOST,
        often=sum(Median(**each[MEDIAN]).found for each in measured.values()),
        missed=", ".join(f"`{program.name}`" for program in not_found) or "none",
        mended=mended.sentence([program.name for program in PROGRAMS]),
        table="\n".join(lines),
    )


def _row(known: dict[str, Any], program: Program) -> str:
    asked = f"`{program.asked()}`" if program.asked() else ""
    shows = " or ".join(program.kinds)
    cells = [f"`{program.name}`: {program.text}", program.world, program.origin, shows, asked]
    return "|".join(
        [
            "",
            *cells,
            _number(known[FOUND]),
            str(Median(**known[MEDIAN])),
            "yes" if known[RACES] else "",
            program.published,
            "",
        ]
    )


def _number(found: int | None) -> str:
    return f"> {MOST}" if found is None else str(found)


_PAGE = """# Benchmark programs of other tools

<!-- made by `python -m dev.quality programs`; change the code in dev/quality instead -->

Tools that search schedules are compared by programs with one known mistake each. SCTBench has the most of them. The
papers and documents of CHESS, Coyote and shuttle have some, and courses on TLA+ use well-known protocols.
`tests/quality/missions` has {others} of these programs, rewritten as ROS nodes and cFE applications with the same
threads, locks and messages. With further races of such software there are {count} programs, in addition to the
[planted bugs](planted_bugs.md). Each has a mended form.

The columns are:

- "first": the first schedule that shows the mistake with `cfepy explore` and no `--policy`. You can repeat this search.
- "median": the median of {trials} searches with different seeds. `> {schedules}` means that at least half of the
  searches found nothing within {schedules} schedules.
- "needs": further options of the command, such as points between calls, tasks of lower priority first, or a fault whose
  time is explored.
- "`--races`": whether a single run under `fifo` reports a data race.
- "published": the number of runs in which Maple found the original (Yu, Narayanasamy, Pereira, Pokam: OOPSLA 2012), or
  that Maple ended without finding it. The source is mapleRes.txt in the repository mc-imperial/sctbench. The cell is
  empty if there is no comparable number.

The first search finds {found} of {count} within {schedules} schedules and {later} within {most:,}. In the median of
the searches, {often} are found within {schedules}. The first search does not find these programs within {schedules}
schedules: {missed}.

{mended}.

{table}

Some mistakes are hard to find. `two_stages_many` has twenty threads, and two of them must overlap in one way before any
other gets as far. `lock_free_stack` needs five switches, each at one of a few places among 150. `safe_stack` needs as
many. It needed over 200 schedules before `random` used long stretches of one task with `--points`.

Two changes made the other mistakes easier to find. The start and the join of a thread in Python's `threading` had a
dozen points; `bank_account` had 40 decisions under `fifo` and now has 14. `abreast` lets threads proceed side by side
once all are started, including two or three threads that do different things.

SCTBench is the work of Thomson, Donaldson and Betts: Concurrency Testing Using Schedule Bounding: an Empirical Study
(PPoPP 2014). With 49 of its programs they found that PCT of depth 3 misses only one bug (Concurrency Testing Using
Controlled Schedulers: An Empirical Study, ACM TOPC 2016).

To search for one of the mistakes, run:

```
cfepy explore tests/quality/missions/reorder_three --for 1.3 --points attributes
```
"""
