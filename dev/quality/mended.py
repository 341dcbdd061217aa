"""False alarms: the mended form of every mission under many schedules of the default policy. None of them may fail.

The results are kept in `measured_mended.json` piece by piece, so that a campaign of days can be interrupted and
continued. Each piece begins with its own seed and equals the runs of `cfepy explore --first-seed` from there. Schedules
differ from shortly before applications and nodes begin, so that each is a forked process.
"""

from __future__ import annotations

import json
import multiprocessing
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from cfepy.extra.exploration.deadlock import waits_of
from cfepy.extra.exploration.fork_server import ForkingJudge
from cfepy.extra.exploration.missing_points import openings_of
from cfepy.extra.exploration.schedule_kinds import NOTHING_FOUND
from cfepy.extra.exploration.search import make_search
from cfepy.extra.exploration.trial import Trial
from cfepy.extra.exploration.verdict import Verdict
from cfepy.schedules import Schedule
from cfepy.units import NS_PER_S
from dev.quality.bugs import BUGS, SECONDS, Bug, reference_trial
from dev.quality.programs import PROGRAMS, Program, program_trial

MEASURED = Path(__file__).parent / "measured_mended.json"
MOST = 20_000
FROM = ":from=545ms"  # applications of the startup script begin at 550 ms
PIECE = 240  # schedules; a multiple of the number of schedule kinds that take turns

Measured = dict[str, dict[str, list[str] | int]]
"""By mission: `flown`, how many schedules, and `failed`, those that did, with what failed."""

MISSIONS: tuple[Bug, ...] = (*BUGS, *PROGRAMS)


def load() -> Measured:
    """Return the results so far."""
    measured: Measured = json.loads(MEASURED.read_text(encoding="utf-8")) if MEASURED.is_file() else {}
    return measured


def measure(names: list[str], jobs: int, most: int) -> None:
    """Fly the missing pieces, one of each mission in turn.

    Args:
        names: names of the missions; all of them if empty.
        jobs: number of processes.
        most: limit of schedules of each mission.
    """
    measured = load()
    wanted = [each.name for each in MISSIONS if not names or each.name in names]
    with multiprocessing.get_context("spawn").Pool(jobs) as pool:
        for name, flown, failed in pool.imap_unordered(_piece, pieces(measured, wanted, most)):
            known = measured.setdefault(name, {"flown": 0, "failed": []})
            known["flown"] = flown_of(known) + flown
            known["failed"] = failed_of(known) + failed
            ordered = {each.name: measured[each.name] for each in MISSIONS if each.name in measured}
            MEASURED.write_text(json.dumps(ordered, indent=1) + "\n", encoding="utf-8")
            print(f"{name}: {known['flown']}", *failed, sep="\n  ", flush=True)


def pieces(measured: Measured, names: list[str], most: int) -> list[tuple[str, int]]:
    """Return the missing pieces: missions and first seeds, the earlier seeds of all missions first."""
    return sorted(
        ((name, first) for name in names for first in range(flown_of(measured.get(name, {})), most, PIECE)),
        key=lambda piece: piece[1],
    )


def flown_of(known: dict[str, list[str] | int]) -> int:
    """Return how many schedules of a mission were flown."""
    flown = known.get("flown", 0)
    assert isinstance(flown, int)
    return flown


def failed_of(known: dict[str, list[str] | int]) -> list[str]:
    """Return the failed ones."""
    failed = known.get("failed", [])
    assert isinstance(failed, list)
    return failed


def _piece(piece: tuple[str, int]) -> tuple[str, int, list[str]]:
    name, first = piece
    mission = next(each for each in MISSIONS if each.name == name)
    with tempfile.TemporaryDirectory() as folder:
        failed = [
            f"{verdict.schedule}: {verdict.trouble or verdict.failures[0].text}"
            for verdict in verdicts(mission, Path(folder), PIECE, first)
            if verdict.failed or verdict.trouble
        ]
    return name, PIECE, failed


def verdicts(mission: Bug, folder: Path, count: int, first_seed: int = 0) -> Iterator[Verdict]:
    """Yield verdicts of schedules of the default policy on the mended form of a mission.

    Args:
        mission: the mission.
        folder: folder in which the mended form is made.
        count: how many.
        first_seed: seed of the first schedule.
    """
    trial, options = mended_trial(mission, folder)
    judge = ForkingJudge(trial)
    try:
        reference = judge.judge(options)
        assert not reference.trouble, reference.trouble
        openings = NOTHING_FOUND if options.points else openings_of(replace(trial, waits=None), options)
        search = make_search("all", None, reference.decisions, options, first_seed, openings=openings)
        for number in range(count):
            schedule = search.next()
            assert schedule is not None
            verdict = judge.judge(schedule)
            search.tell(number, verdict)
            yield verdict
    finally:
        judge.close()


def mended_trial(mission: Bug, folder: Path) -> tuple[Trial, Schedule]:
    """Return the trial of a mended form, in which no task may wait forever, and the schedule with the common
    options."""
    fixed = mission.write_fixed(folder)
    if isinstance(mission, Program):
        return program_trial(mission, fixed), Schedule.parse(mission.options + FROM)
    trial, options = reference_trial(fixed), Schedule.parse("at" + FROM)
    return replace(trial, waits=waits_of(trial.plan, round(SECONDS * NS_PER_S), options.policy())), options


def sentence(names: list[str]) -> str:
    """Return the sentence for the pages.

    Args:
        names: names of the missions of a page.
    """
    measured = load()
    flown = [flown_of(measured.get(name, {})) for name in names]
    failed = sum(len(failed_of(measured.get(name, {}))) for name in names)
    return (
        f"Each mended form was flown under at least {min(flown):,} schedules of the default policy, {sum(flown):,} in "
        f"all: {failed or 'none'} of them failed"
    )
