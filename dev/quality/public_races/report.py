"""Results of public races: results.json, and docs/reference/generated/public_races.md made from it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

from dev.quality.public_races.races import PublicRace, PublicRaces
from dev.quality.public_races.trial import FIFO, MOST, SHRINK_S, Found, Result

FILE = Path(__file__).with_name("results.json")
PAGE = Path(__file__).parents[3] / "docs/reference/generated/public_races.md"
Results = dict[str, Result]


def read_results(file: Path = FILE) -> Results:
    """Read the results, by the names of the races."""
    if not file.is_file():
        return {}
    return {name: Result.from_dict(each) for name, each in json.loads(file.read_text(encoding="utf-8")).items()}


def write_results(races: PublicRaces, results: Results, file: Path = FILE) -> None:
    """Write the results, in the order of the list."""
    data = {name: results[name].to_dict() for name in races.races if name in results}
    file.write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")


def write_page(races: PublicRaces, results: Results) -> None:
    """Write the page."""
    PAGE.write_text(page(races, results), encoding="utf-8")


def page(races: PublicRaces, results: Mapping[str, Result]) -> str:
    """Return the text of the page."""
    flown = [each for each in races.races.values() if each.name in results]
    found = [each for each in flown if results[each.name].found]
    missed = [each for each in flown if not results[each.name].found]
    grounded = [each for each in races.races.values() if not each.flies]
    schedules = [one.schedules for each in found if (one := results[each.name].found)]
    alarms = [each for each in flown if results[each.name].false_alarm]
    text = _HEAD.format(
        races=len(flown),
        most=MOST,
        shrink=SHRINK_S,
        found=len(found),
        hundred=sum(each <= 100 for each in schedules),
        mended=sum(results[each.name].mended for each in flown),
        alarms=f"Of the mended forms, {len(alarms)} failed" if alarms else "No mended form failed",
    )
    text += "\n".join(_row(each, results[each.name]) for each in flown)
    text += _CAUSES + "\n".join(_story(each, one) for each in found if (one := results[each.name].found))
    if missed:
        text += _MISSED + "\n".join(_missed(each, results[each.name]) for each in missed)
    if alarms:
        text += _ALARMS + "\n".join(_alarm(each, results[each.name].false_alarm) for each in alarms)
    if grounded:
        text += _GROUNDED + "\n".join(
            f"| {each.repo} | {each.report} | {each.text} | {each.reason} |" for each in grounded
        )
    return text + _SOURCES + "\n".join(_source(races, each) for each in flown) + "\n"


def _row(race: PublicRace, result: Result) -> str:
    mended = f"fails in {result.mended}" if result.false_alarm else str(result.mended)
    one = result.found
    cells = [f"`{race.name}`", race.text]
    if one is None:
        return "| " + " | ".join([*cells, f"> {result.schedules}", "", "", mended]) + " |"
    number = "0" if one.policy == FIFO else str(one.schedules)
    return "| " + " | ".join([*cells, number, one.policy, _shrunk(one), mended]) + " |"


def _shrunk(found: Found) -> str:
    if found.policy == FIFO:
        return "none needed"
    changes = f" and {found.changes} other" if found.changes else ""
    return f"{found.switches}{changes}"


def _story(race: PublicRace, found: Found) -> str:
    cause = _plain(found.cause) or "(cfepy names no cause)"
    return f"| `{race.name}` | {_plain(found.failure)} | {cause} |"


def _missed(race: PublicRace, result: Result) -> str:
    other = result.with_options
    options = f"`{' '.join(race.options)}`"
    also = f" With {options}, schedule {other.schedules} shows it." if other else ""
    if race.options and not other:
        also = f" {options} does not find it in {result.schedules} schedules either."
    return f"- `{race.name}`: {race.reason}.{also}"


def _alarm(race: PublicRace, failure: str) -> str:
    return f"- `{race.name}`: {_plain(failure)}{f'. {race.reason}' if race.reason else ''}."


def _source(races: PublicRaces, race: PublicRace) -> str:
    files = ", ".join(race.files)
    cells = [f"`{race.name}`", race.repo, races.licences[race.repo], race.report]
    return "| " + " | ".join([*cells, race.before[:10], race.after[:10], files]) + " |"


def _plain(text: str) -> str:
    return text.replace("|", "\\|").replace("<", "&lt;").replace("*", "\\*").replace("_", "\\_")


_HEAD = """# Public races

<!-- made by `python -m dev.quality.public_races report`; change the code in dev/quality/public_races instead -->

This page lists races that users of public software reported, and how soon `cfepy explore` finds each of them. The
software flies unmodified, in two forms: before the fix and after it. A small mission of ours sends it messages and
checks its answers. None of the public code is part of cfepy. To repeat the search:

```
python -m dev.quality.public_races fetch ~/public_races
python -m dev.quality.public_races run --sources ~/public_races
```

`fetch` downloads each repository at both commits. The list is `dev/quality/public_races/races.yaml`. Repositories with
a GPL or AGPL licence are not in it.

The search uses the defaults of the command, with at most {most:,} schedules, and shrinks each failure for at most
{shrink} s. It finds {found} of {races} races, {hundred} of them within 100 schedules. {alarms}, in {mended:,} schedules
together.

`rosbridge_service_id`, `dynamic_reconfigure_types`, `tf2_reset` and the races not found were flown with the
[special kinds](../../how_to/explore_schedules.md#special-kinds) of schedules. The other numbers are older: before, one
schedule of four had no points at shared data.

The columns are:

- "schedules": the number of schedules up to the first failure. 0 means that the default schedule `fifo` fails already.
  "> N" means that none of N schedules failed, and that the search ended there.
- "policy": the policy of the schedule that fails, with the depth of `pct`.
- "shrunk": the preemptions that the shrunk schedule needs, and its other changes of order.
- "mended": the schedules of the mended form: at least 100, and as many as the mistake needed.

| race | mistake | schedules | policy | shrunk | mended |
|---|---|---|---|---|---|
"""
_CAUSES = """

## Reported causes

| race | failure | cause, as cfepy reports it |
|---|---|---|
"""
_MISSED = """

## Races not found

"""
_ALARMS = """

## Failures of mended forms

"""
_GROUNDED = """

## Races that are not flown

cfepy implements cFE, OSAL, the PSP, rospy and the master itself. So it cannot find races inside NASA's or ROS's code of
these parts.

| repository | report | mistake | reason |
|---|---|---|---|
"""
_SOURCES = """

## Sources

| race | repository | licence | report | before | after | files of the fix |
|---|---|---|---|---|---|---|
"""
