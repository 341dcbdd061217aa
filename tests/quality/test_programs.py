"""Programs of other benchmarks: the default schedule shows no bug except hangs, and mended ones never fail."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.schedules import Schedule
from dev.quality.measure import as_deviations, find
from dev.quality.mended import verdicts
from dev.quality.program_report import PAGE, load, missed, page
from dev.quality.programs import PROGRAMS, Program, program_trial

EACH = pytest.mark.parametrize("program", PROGRAMS, ids=[program.name for program in PROGRAMS])
FOUND = pytest.mark.parametrize(
    "program", [pytest.param(each, id=each.name) for each in PROGRAMS if each not in missed(load())]
)
"""Those that were found when it was measured."""


def test_page_matches_the_measurements() -> None:
    assert PAGE.read_text(encoding="utf-8") == page(load()), "run python -m dev.quality programs"


def test_most_bugs_are_found() -> None:
    measured = load()
    assert set(measured) == {program.name for program in PROGRAMS}
    assert len(missed(measured)) <= len(PROGRAMS) // 4


def test_many_programs_come_from_other_benchmarks() -> None:
    assert sum(bool(program.origin) for program in PROGRAMS) >= 25


@pytest.mark.slow
@EACH
def test_fifo_shows_only_bugs_that_hang(program: Program) -> None:
    trial = program_trial(program)
    plain, asked = trial.run(Schedule()), trial.run(Schedule("at"))
    assert bool(plain.failures) == program.hangs
    assert not plain.trouble
    assert asked.trace == plain.trace


@pytest.mark.slow
@FOUND
def test_bug_is_found_by_default_and_reproduced_on_greenlets_and_threads(program: Program) -> None:
    found = find(program_trial(program), "all")
    assert found is not None
    assert found.failures[0].kind in program.kinds
    schedule = as_deviations(found)
    for tasks in ("greenlet", "thread"):
        again = program_trial(program, tasks=tasks).run(schedule)
        assert again.failures == found.failures
        assert again.trace == found.trace


@pytest.mark.slow
@EACH
def test_mended_program_never_fails(program: Program, tmp_path: Path) -> None:
    assert not [verdict for verdict in verdicts(program, tmp_path, 10) if verdict.failed or verdict.trouble]
