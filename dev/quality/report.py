"""The table of planted bugs: the measurements, kept in a file that a later run continues, and the page made from it.

`measured.json` is written after every cell, so an interrupted run loses at most two of them.
"""

from __future__ import annotations

import json
import multiprocessing
import statistics
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from dev.quality import mended
from dev.quality.bugs import BUGS, Bug, by_name, reference_trial
from dev.quality.measure import LONGEST, POLICIES, TRIALS, Median, median, simplest
from dev.quality.shrinking import Shrunk, shrunk

MEASURED = Path(__file__).parent / "measured.json"
PAGE = Path(__file__).parents[2] / "docs" / "reference" / "generated" / "planted_bugs.md"
SHRUNK = "shrunk"
DEFAULT = "all"

HEADINGS = {
    "random": "random",
    "pct 1": "PCT 1",
    "pct 2": "PCT 2",
    "pct 3": "PCT 3",
    "hold": "hold",
    "dfs 2": "DFS",
    "all": "default",
}

Measured = dict[str, dict[str, dict[str, Any]]]
"""By bug and by policy, or SHRUNK, what `Median` and `Shrunk` are made of."""


def load() -> Measured:
    """Return the measurements so far."""
    measured: Measured = json.loads(MEASURED.read_text(encoding="utf-8")) if MEASURED.is_file() else {}
    return measured


def save(measured: Measured) -> None:
    """Keep it, in the order of the bugs and policies."""
    columns = (*POLICIES, SHRUNK)
    ordered = {
        bug.name: {column: measured[bug.name][column] for column in columns if column in measured[bug.name]}
        for bug in BUGS
        if bug.name in measured
    }
    MEASURED.write_text(json.dumps(ordered, indent=1) + "\n", encoding="utf-8")


def measure(names: list[str], jobs: int, most: int) -> None:
    """Measure the missing cells, then write the page if none is missing.

    Args:
        names: names of the bugs; all of them if empty.
        jobs: number of processes.
        most: limit of schedules for one cell of the table.
    """
    measured = load()
    with multiprocessing.get_context("spawn").Pool(jobs) as pool:
        _keep(measured, pool.imap_unordered(_cell, [(*cell, most) for cell in _missing(measured, names, most)]))
        _keep(measured, pool.imap_unordered(_shrink, list(_missing_shrinks(measured, names))))
    write(measured)


def write(measured: Measured) -> None:
    """Write the page, if nothing is missing."""
    if complete(measured):
        PAGE.write_text(page(measured), encoding="utf-8")


def _keep(measured: Measured, cells: Iterator[tuple[str, str, dict[str, Any]]]) -> None:
    """Take cells as they come."""
    for name, column, found in cells:
        measured.setdefault(name, {})[column] = found
        save(measured)
        print(f"{name}: {column}: {_text(column, found)}", flush=True)


def _missing(measured: Measured, names: list[str], most: int) -> Iterator[tuple[str, str]]:
    """Cells without a number, or with one that was given up where more schedules are allowed now."""
    for policy in sorted(POLICIES, key=lambda policy: policy != DEFAULT):
        for bug in BUGS:
            found = measured.get(bug.name, {}).get(policy)
            if (not names or bug.name in names) and (found is None or Median(**found).could_go_on(most)):
                yield bug.name, policy


def _missing_shrinks(measured: Measured, names: list[str]) -> Iterator[tuple[str, str]]:
    """Yield the bugs whose schedules are to be shrunk, each with the default policy or the first one to find it."""
    for name, columns in measured.items():
        if (not names or name in names) and SHRUNK not in columns:
            yield name, shown_by(measured, name)


def shown_by(measured: Measured, name: str) -> str:
    """Return the policy whose schedules are to be shrunk."""
    return DEFAULT if Median(**measured[name][DEFAULT]).found else best(measured, name)[0]


def _cell(job: tuple[str, str, int]) -> tuple[str, str, dict[str, Any]]:
    name, policy, most = job
    return name, policy, median(reference_trial(by_name(name).folder), policy, most=most).to_dict()


def _shrink(job: tuple[str, str]) -> tuple[str, str, dict[str, Any]]:
    name, policy = job
    bug = by_name(name)
    verdicts = simplest(reference_trial(bug.folder), policy)
    assert verdicts, f"{policy} does not find {name}"
    return name, SHRUNK, shrunk(bug, verdicts).to_dict()


def _text(column: str, found: dict[str, Any]) -> str:
    return str(Shrunk(**found).preemptions) if column == SHRUNK else str(Median(**found))


# -- evaluation ------------------------------------------------------------------------------------------------------


def complete(measured: Measured) -> bool:
    """Return whether every cell has been measured."""
    return all(bug.name in measured and set(measured[bug.name]) == {*POLICIES, SHRUNK} for bug in BUGS)


def medians(measured: Measured, name: str) -> dict[str, Median]:
    """Return the measurements of a bug, by policy."""
    return {policy: Median(**found) for policy, found in measured[name].items() if policy != SHRUNK}


def best(measured: Measured, name: str) -> tuple[str, Median]:
    """Return the policy that finds a bug first, and how soon."""
    return min(medians(measured, name).items(), key=lambda each: (not each[1].found, each[1].schedules))


def median_of_default(measured: Measured) -> float:
    """Return the median, over all bugs, of the schedules that the default policy needs.

    A bug not found counts as the longest.
    """
    found = [medians(measured, bug.name)[DEFAULT] for bug in BUGS]
    return statistics.median(each.schedules if each.found else LONGEST for each in found)


def page(measured: Measured) -> str:
    """Return the page of documentation."""
    heads = ["bug", "in", "shows as", *(HEADINGS.get(each, each) for each in POLICIES), "preemptions"]
    lines = ["|".join(["", *heads, ""]), "|".join(["", *["---"] * len(heads), ""])]
    lines += [_row(measured, bug) for bug in BUGS]
    return _INTRODUCTION.format(
        count=len(BUGS),
        trials=TRIALS,
        longest=LONGEST,
        median=f"{median_of_default(measured):g}",
        mended=mended.sentence([bug.name for bug in BUGS]),
        table="\n".join(lines),
    )


def _row(measured: Measured, bug: Bug) -> str:
    found = medians(measured, bug.name)
    least = best(measured, bug.name)[1].schedules
    cells = [_emphasised(found[policy], least) for policy in POLICIES]
    preemptions = Shrunk(**measured[bug.name][SHRUNK])
    return "|".join(["", f"`{bug.name}`: {bug.text}", bug.world, " or ".join(bug.kinds), *cells, str(preemptions), ""])


def _emphasised(found: Median, least: int) -> str:
    return f"**{found}**" if found.found and found.schedules == least else str(found)


_INTRODUCTION = """# Planted bugs

<!-- made by `python -m dev.quality report`; change the code in dev/quality instead -->

This page shows how many schedules `cfepy explore` needs to find a race. `tests/quality/missions` has {count} small
missions of ROS nodes and cFE applications. Each has one common timing mistake, written in the usual way: no sleep makes
the failure more likely. The default schedule (`fifo`) shows none of the mistakes. Each mission also has a mended form.

{mended}.
`python -m dev.quality mended` continues this check.

The numbers are the schedules until the bug is found: the median of {trials} trials with different seeds. `> N` means
that at least half of the trials found nothing within N schedules. The measurement of a policy can be continued up to
{longest} schedules, see below. The columns of the policies are:

- PCT and DFS have their depth. DFS tries one and two preemptions systematically. It has no seeds, so there is one
  trial.
- "hold" is the policy random that also delays tasks until the next timer, if the timer is due within 1 ms.
- "abreast" lets tasks proceed side by side.
- "default" is `cfepy explore` without `--policy`. Random, hold, PCT of the depths 1 to 3 and abreast take turns. Its
  median over all bugs is {median} schedules.

The best number of each row is bold. "preemptions" are the deviations that are left after shrinking: the number of
preemptions, and after the plus sign the number of times that a task other than the first ready one runs.

{table}

`python -m dev.quality report` measures the bugs that `dev/quality/measured.json` does not have yet, continues the
measurements that are shorter than `--most` schedules, and writes this page. Delete the file first if you changed the
policies.

To search for one of the bugs, run:

```
cfepy explore tests/quality/missions/lost_update --for 1.3
```
"""
