"""What guidance by coverage is worth: how soon planted bugs are found, and how much is covered, beside other policies.

`measured_coverage.json` is written after every cell, so a run that is interrupted has lost at most one of them.
"""

from __future__ import annotations

import json
import statistics
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from cfepy.exploration.campaign import Search
from cfepy.exploration.coverage import OUTCOMES, Coverage
from cfepy.exploration.greybox import GreyboxSearch
from cfepy.exploration.search import GREYBOX, SeededSearch, make_search
from cfepy.exploration.trial import Trial
from cfepy.rtos import Schedule
from dev.quality.bugs import BUGS, Bug, reference_trial
from dev.quality.measure import LONGEST, Hunt
from dev.quality.programs import PROGRAMS, Program, program_trial

MEASURED = Path(__file__).parent / "measured_coverage.json"
PAGE = Path(__file__).parents[2] / "docs" / "benchmarks_coverage.md"
MISSIONS = (*BUGS, *PROGRAMS)
POLICIES = ("all", GREYBOX)
HEADS = {"all": "default", "pct": "PCT 3"}
SEARCHES = 3
SCHEDULES = 200
COVERED = ("work_stealing", "bank_account", "philosophers_six", "leader_election", "lost_update")
AFTER = (30, 100)
FOUND, SEEN = "found", "seen"
WIDE = ("random", "pct", GREYBOX)

Measured = dict[str, dict[str, Any]]
"""By what was measured and mission, by policy: the first schedules that fail, or outcomes and pairs."""


def measure(names: Sequence[str]) -> None:
    """Measure what is missing, one after the other, then write the page of what there is.

    Args:
        names: of the missions; all of them when empty.
    """
    measured: Measured = json.loads(MEASURED.read_text(encoding="utf-8")) if MEASURED.is_file() else {}
    for kind, mission, policy in _cells():
        cells = measured.setdefault(f"{kind} {mission.name}", {})
        if policy not in cells and (not names or mission.name in names):
            cells[policy] = _cell(kind, mission, policy)
            MEASURED.write_text(json.dumps(measured, indent=1) + "\n", encoding="utf-8")
            print(kind, mission.name, policy, cells[policy], flush=True)
    PAGE.write_text(page(measured), encoding="utf-8")


def _cells() -> list[tuple[str, Bug, str]]:
    """What is measured: of which mission, with which policy."""
    found = [(FOUND, mission, policy) for mission in (*PROGRAMS, *BUGS) for policy in POLICIES]
    return found + [(SEEN, mission, policy) for mission in MISSIONS if mission.name in COVERED for policy in WIDE]


def _cell(kind: str, mission: Bug, policy: str) -> Any:
    trial = program_trial(mission) if isinstance(mission, Program) else reference_trial(mission.folder)
    if kind == SEEN:
        return seen(trial, policy)
    return [first(trial, policy, seed * LONGEST, SCHEDULES) for seed in range(SEARCHES)]


def search_of(trial: Trial, policy: str, first_seed: int) -> tuple[Trial, Search, Coverage]:
    """A search, the trial whose verdicts it needs, and what is covered at its beginning.

    Args:
        trial: of a mission; the options of its schedule are those of all.
        policy: one of POLICIES.
        first_seed: of the search.
    """
    options = replace(trial.plan.schedule, kind="at")
    watched = replace(trial, usual=frozenset(), keep_widths=True)
    reference = watched.fly(options)
    coverage = Coverage.beside(reference.verdict.covered, reference.code)
    search = make_search(policy, None, reference.verdict.decisions, options, first_seed)
    if policy != GREYBOX:
        return trial, search, coverage
    assert isinstance(search, SeededSearch)
    guided = GreyboxSearch(search, coverage, reference.verdict, options, first_seed)
    return replace(watched, usual=coverage.usual), guided, coverage


def first(trial: Trial, policy: str, first_seed: int, most: int) -> int | None:
    """Which schedule, counted from 1, is the first that fails; None for none of so many."""
    flown, search, _ = search_of(trial, policy, first_seed)
    hunt = Hunt(flown, search)
    for number in range(1, most + 1):
        found = hunt.step()
        assert found is not None
        if found.failed:
            return number
    return None


def seen(trial: Trial, policy: str) -> list[tuple[int, int]]:
    """Outcomes and pairs after each number of schedules of AFTER, those of fifo as well."""
    _, search, coverage = search_of(trial, policy, 0)
    watched = replace(trial, usual=coverage.usual, keep_widths=True)
    found = []
    for number in range(max(AFTER)):
        schedule = search.next()
        assert isinstance(schedule, Schedule)
        verdict = watched.run(schedule)
        search.tell(number, verdict)
        if policy != GREYBOX:  # which takes it itself
            coverage.take(number, verdict.covered)
        if number + 1 in AFTER:
            found.append((coverage.counts().get(OUTCOMES, 0), sum(coverage.pairs.values())))
    return found


# -- what it comes to ------------------------------------------------------------------------------------------------


def median(firsts: Sequence[int | None]) -> int | None:
    """That of several searches; None when half of them or more found nothing."""
    if sum(each is not None for each in firsts) * 2 <= len(firsts):
        return None
    return statistics.median_low([SCHEDULES + 1 if each is None else each for each in firsts])


def page(measured: Measured) -> str:
    """The page of documentation."""
    every = {each.name: measured.get(f"{FOUND} {each.name}", {}) for each in MISSIONS}
    firsts = {name: cells for name, cells in every.items() if cells.keys() == set(POLICIES)}
    covered = [name for name in COVERED if measured.get(f"{SEEN} {name}", {}).keys() == set(WIDE)]
    rows = [f"|`{name}`|{'|'.join(_cells_of(cells))}|" for name, cells in firsts.items()]
    return _PAGE.format(
        count=len(firsts),
        all=len(MISSIONS),
        searches=SEARCHES,
        schedules=SCHEDULES,
        heads="|".join(HEADS.get(each, each) for each in POLICIES),
        lines="|".join("---" for _ in POLICIES),
        table="\n".join(rows),
        sums="\n".join(_sum(policy, firsts) for policy in POLICIES),
        covered="\n".join(_covered(measured, name) for name in covered),
        after="|".join(f"{HEADS.get(policy, policy)}, {count}" for policy in WIDE for count in AFTER),
        after_lines="|".join("---" for _ in range(len(WIDE) * len(AFTER))),
    )


def _cells_of(cells: dict[str, list[int | None]]) -> list[str]:
    medians = [median(cells[policy]) for policy in POLICIES]
    least = min((each for each in medians if each is not None), default=None)
    return [
        f"**{_text(each, SCHEDULES)}**" if each == least is not None else _text(each, SCHEDULES) for each in medians
    ]


def _text(found: int | None, most: int) -> str:
    return f"> {most}" if found is None else str(found)


def _sum(policy: str, firsts: dict[str, dict[str, list[int | None]]]) -> str:
    medians = [median(cells[policy]) for cells in firsts.values()]
    found = sum(each is not None for each in medians)
    every = sum(each is not None for cells in firsts.values() for each in cells[policy])
    middle = statistics.median(SCHEDULES + 1 if each is None else each for each in medians)
    return f"|{HEADS.get(policy, policy)}|{found}|{every} of {len(firsts) * SEARCHES}|{middle:g}|"


def _covered(measured: Measured, name: str) -> str:
    cells = measured[f"{SEEN} {name}"]
    return f"|`{name}`|{'|'.join(f'{out}, {pairs}' for policy in WIDE for out, pairs in cells[policy])}|"


_PAGE = """# What guidance by coverage is worth

<!-- made by `python -m dev.quality coverage`; change the code in dev/quality instead -->

`cfepy explore --policy greybox` ([exploration.md](exploration.md#coverage)) beside the default, on {count} of the {all}
missions of [planted_bugs.md](planted_bugs.md) and [benchmarks_exploration.md](benchmarks_exploration.md). The numbers
are the first schedule that shows the mistake, in the median of {searches} searches with seeds of their own;
`> {schedules}` where two of them or more had found nothing in {schedules} schedules. The best of each row is bold. All
else is as in those two pages.

|policy|missions found in the median|searches that found|median of the medians|
|---|---|---|---|
{sums}

## Mission by mission

|mission|{heads}|
|---|{lines}|
{table}

## How much is covered

Distinct outcomes, and ordered pairs of uses by two tasks, after so many schedules, failing ones as well:

|mission|{after}|
|---|{after_lines}|
{covered}
"""
