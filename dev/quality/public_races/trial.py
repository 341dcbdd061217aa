"""A trial of a race: `cfepy explore` with its defaults, on the public sources before and after the fix."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from cfepy.status import UsageError
from dev.quality.public_races.races import AFTER, BEFORE, MISSIONS, PublicRace

MOST = 1000  # schedules of the form with the mistake
LEAST_MENDED = 100  # schedules of the mended form, if the mistake was found sooner
SHRINK_S = 20  # wall time; most are shrunk in less
FIFO = "fifo"


@dataclass(frozen=True, slots=True)
class Found:
    """A failure that the search found.

    Attributes:
        schedules: how many schedules it took.
        policy: the policy of the schedule that fails, such as "pct 3"; FIFO if no other order is needed.
        switches: preemptions left after shrinking.
        changes: other changes of order left after shrinking.
        failure: the failure, as the command names it.
        cause: the cause, as the command names it; empty without one.
    """

    schedules: int
    policy: str
    switches: int
    changes: int
    failure: str
    cause: str


@dataclass(frozen=True, slots=True)
class Result:
    """The result of a race.

    Attributes:
        found: the failure that the defaults find; None if they find none.
        schedules: schedules flown with the mistake.
        with_options: the failure that the options of the list find, after the defaults found none.
        mended: schedules flown of the mended form.
        false_alarm: a failure of the mended form; empty if there is none.
    """

    found: Found | None
    schedules: int
    with_options: Found | None
    mended: int
    false_alarm: str

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        return asdict(self)

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Result:
        """Read plain data."""
        found, other = data["found"], data["with_options"]
        return cls(**{**data, "found": found and Found(**found), "with_options": other and Found(**other)})


def try_race(race: PublicRace, sources: Path, most: int = MOST, missions: Path = MISSIONS) -> Result:
    """Search for a race in its sources, and fly the mended form under as many schedules.

    Args:
        race: a race that flies.
        sources: the folder of `fetch`.
        most: limit of schedules.
        missions: the folder with the missions.
    """
    with tempfile.TemporaryDirectory() as scratch:
        folder = race.lay_out(sources, BEFORE, Path(scratch) / BEFORE, missions)
        found, flown = _search(folder, race.seconds, most, ())
        options = race.options if found is None else ()
        other = _search(folder, race.seconds, most, options)[0] if options else None
        mended = race.lay_out(sources, AFTER, Path(scratch) / AFTER, missions)
        alarm, count = _search(mended, race.seconds, min(most, max(LEAST_MENDED, flown if found else 0)), options)
        return Result(found, flown, other, count, alarm.failure if alarm else "")


def _search(folder: Path, seconds: float, most: int, options: tuple[str, ...]) -> tuple[Found | None, int]:
    """Explore a mission until the first failure. Returns it, and the number of schedules."""
    report = folder.parent / "report.json"
    command = ["explore", folder.name, "--for", str(seconds), "--seeds", str(most), "--until-failure", "--quiet"]
    command += ["--shrink-time", str(SHRINK_S), "--json", str(report), *options]
    done = subprocess.run([sys.executable, "-m", "cfepy", *command], cwd=folder.parent, capture_output=True, text=True)
    if done.returncode not in (0, 1) or not report.is_file():
        raise UsageError(f"`cfepy {' '.join(command)}` failed: {done.stderr[-500:]}", file=str(folder))
    data = json.loads(report.read_text(encoding="utf-8"))
    failures = data["failures"]
    return (found_of(failures[0], data["schedules"]) if failures else None), data["schedules"]


def found_of(failure: dict[str, Any], schedules: int) -> Found:
    """Return the recorded parts of a failure in the JSON of `cfepy explore`."""
    shrunk = failure["shrunk"] or {"preemptions": 0, "moves": []}
    switches = shrunk["preemptions"]
    return Found(
        schedules=0 if failure["under_fifo"] else schedules,
        policy=FIFO if failure["under_fifo"] else policy_of(failure["first_schedule"]),
        switches=switches,
        changes=len(shrunk["moves"]) - switches,
        failure=f"{failure['kind']}: {failure['who']}: {failure['text']}",
        cause=failure["cause"],
    )


def policy_of(schedule: str) -> str:
    """Return the policy of a schedule, with the depth of pct: "pct:10:3:479" is "pct 3"."""
    kind, *rest = schedule.split(":")
    return f"{kind} {rest[1]}" if kind == "pct" else kind
