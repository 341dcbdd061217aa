"""Results of public applications: one line each in results.tsv, and docs/reference/generated/public_apps.md.

beside.tsv has the comparison of each application that flies with NASA's cFE.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from dev.c.public_apps.missions import PublicMissions

FILE = Path(__file__).with_name("results.tsv")
BESIDE_FILE = FILE.with_name("beside.tsv")
PAGE = Path(__file__).parents[3] / "docs/reference/generated/public_apps.md"
AT_ONCE, WITH_OPTION, NOT_BUILT = "at once", "with an option", "no"
ANSWERS, RUNS, LIBRARY, NOT_FLOWN = "answers", "runs", "library", "no"
SAME, DIFFERS, NOT_COMPARED = "same", "differs", "not compared"
_HEAD = """# Public missions and applications

This page lists applications of public missions, with the build and the flight of each. NASA's fifteen applications
do not count. `python -m dev.c.public_apps report` writes the page. To try it yourself:

```
python -m dev.c.public_apps fetch ~/public_apps
python -m dev.c.public_apps run --sources ~/public_apps
```

`fetch` downloads each repository at its commit. None of their code is part of cfepy. The list is
`dev/c/public_apps/missions.json`. Missions with a GPL or AGPL licence are not in it.

| built | applications and libraries |
|---|---|
| at once, with `cfepy build FOLDER` | {at_once} |
| with an option, such as `--cfe` or a folder | {with_option} |
| no | {not_built} |

| flown | applications and libraries |
|---|---|
| answers: it boots, and answers a command with an event or telemetry | {answers} |
| runs: it boots and runs, but does not answer a command without parameters | {runs} |
| a library, which loads with the applications that use it | {libraries} |
| no | {not_flown} |

Each application flies alone, with the libraries of its mission, for 10 virtual seconds. Then each MsgId of its command
pipes gets the command with code 0. Devices that it reads are absent, or send nothing.

| beside NASA's cFE 7.0.1 for Linux | applications |
|---|---|
| same: the same packets and events after the same commands | {same} |
| differs | {differs} |
| not compared | {not_compared} |

`CFEPY_REAL_CFE=FOLDER python -m dev.c.public_apps beside --sources ~/public_apps` compares the applications that fly.
FOLDER is the folder of NASA's executable, inside of its build. The application is built a second time with NASA's
headers. Both get all its commands: without a payload, and with zeros and random bytes of the length that it expects.
Telemetry that counts real time is left out where the table says "events".

| mission | application | built | flown | answer, or reason | beside NASA's cFE |
|---|---|---|---|---|---|
"""
_REPOSITORIES = """
## Repositories

| repository | commit | licence |
|---|---|---|
"""


class Result(NamedTuple):
    """The result of an application: one of the constants for the build and for the flight, and an answer or reason."""

    mission: str
    app: str
    built: str
    flown: str
    text: str


class Beside(NamedTuple):
    """The comparison of an application with NASA's cFE.

    Attributes:
        mission: its mission.
        app: its name.
        outcome: one of the constants.
        commands: commands that were sent.
        packets: packets and events that were the same.
        text: the compared kind of packets, the first difference and its cause, or why it was not compared.
    """

    mission: str
    app: str
    outcome: str
    commands: str
    packets: str
    text: str


def read_beside(file: Path = BESIDE_FILE) -> list[Beside]:
    """Read the comparisons; none if there is no file."""
    if not file.is_file():
        return []
    return [Beside(*line.split("\t")) for line in file.read_text(encoding="utf-8").splitlines()[1:]]


def write_beside(results: Iterable[Beside], file: Path = BESIDE_FILE) -> None:
    """Write the comparisons, in the order of missions and applications."""
    lines = ["\t".join(Beside._fields), *("\t".join(each) for each in results)]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")


def read_results(file: Path = FILE) -> list[Result]:
    """Read the results."""
    return [Result(*line.split("\t")) for line in file.read_text(encoding="utf-8").splitlines()[1:]]


def write_results(results: Iterable[Result], file: Path = FILE) -> None:
    """Write the results, in the order of missions and applications."""
    lines = ["\t".join(Result._fields), *("\t".join(each) for each in results)]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")


def page(missions: PublicMissions, results: Sequence[Result], beside: Sequence[Beside]) -> str:
    """Return the text of the page."""
    compared = {(each.mission, each.app): each for each in beside}

    def count(column: str, value: str) -> int:
        return sum(getattr(each, column) == value for each in results)

    head = _HEAD.format(
        at_once=count("built", AT_ONCE),
        with_option=count("built", WITH_OPTION),
        not_built=count("built", NOT_BUILT),
        answers=count("flown", ANSWERS),
        runs=count("flown", RUNS),
        libraries=count("flown", LIBRARY),
        not_flown=sum(each.flown == NOT_FLOWN and each.built != NOT_BUILT for each in results),
        same=sum(each.outcome == SAME for each in beside),
        differs=sum(each.outcome == DIFFERS for each in beside),
        not_compared=sum(each.outcome == NOT_COMPARED for each in beside),
    )
    rows = [_row(missions, each, compared.get((each.mission, each.app))) for each in results]
    named = {repo for each in missions.missions.values() for repo in (each.repo, *each.parts.values())}
    places = [f"| {name} | {each.commit[:10]} | {each.licence} |" for name, each in missions.repositories.items()]
    assert named <= set(missions.repositories)
    return head + "\n".join(rows) + "\n" + _REPOSITORIES + "\n".join(places) + "\n"


def write_page(missions: PublicMissions, results: Sequence[Result], beside: Sequence[Beside]) -> None:
    """Write the page."""
    PAGE.write_text(page(missions, results, beside), encoding="utf-8")


def _row(missions: PublicMissions, result: Result, beside: Beside | None) -> str:
    built = result.built
    mission = missions.missions[result.mission]
    if built == WITH_OPTION:
        places = [*(["--defs"] if mission.defs else []), *(["--modules"] if mission.modules else [])]
        built = f"with `{' '.join((*mission.options, *places))}`"
    flown = "" if result.built == NOT_BUILT else result.flown
    compared = "" if beside is None else _compared(beside)
    return f"| {result.mission} | {result.app} | {built} | {flown} | {_cell(result.text)} | {compared} |"


def _compared(beside: Beside) -> str:
    if beside.outcome == NOT_COMPARED:
        return f"{NOT_COMPARED}: {_cell(beside.text)}"
    counts = f"{beside.commands} commands, {beside.packets} packets"
    if beside.outcome == SAME:
        return f"{SAME}: {counts}{f' ({_cell(beside.text)})' if beside.text else ''}"
    return f"{DIFFERS} ({counts} the same): {_cell(beside.text)}"


def _cell(text: str) -> str:
    """Return a text for a cell of a table."""
    return text.replace("|", "\\|").replace("<", "&lt;").replace("*", "\\*").replace("_", "\\_")
