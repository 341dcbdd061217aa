"""The progress of a flight that a command looks at: shown on a terminal, and without effect on the run."""

from __future__ import annotations

import io

import pytest

from cfepy.cli import flying_progress
from cfepy.cli.flying_progress import FlyingProgress
from cfepy.pilot import RunPlan, fly
from cfepy.units import NS_PER_S
from cfepy.writing.work_progress import ERASE_LINE, WorkProgress


class Terminal(io.StringIO):
    """A terminal that keeps its output."""

    def isatty(self) -> bool:
        return True


@pytest.fixture
def shown(monkeypatch: pytest.MonkeyPatch) -> Terminal:
    """Return a terminal that shows the progress, on a clock that advances by a second with each look."""
    terminal = Terminal()
    seconds = iter(range(1_000_000))

    def progress(elapsed_ns: object) -> WorkProgress:
        return WorkProgress(lambda: next(seconds) * NS_PER_S, terminal)

    monkeypatch.setattr(flying_progress, "WorkProgress", progress)
    return terminal


def test_flight_shows_its_virtual_time_and_clears_the_line(shown: Terminal) -> None:
    fly(RunPlan(("lab",), seconds=3), host=FlyingProgress())
    lines = shown.getvalue().split(ERASE_LINE)
    assert lines[0] == lines[-1] == ""
    assert lines[-2].startswith("flying: 3.0 of 3 virtual s")


def test_progress_does_not_change_the_trace(shown: Terminal) -> None:
    plan = RunPlan(("lab",), seconds=2)
    assert fly(plan, host=FlyingProgress()).trace == fly(plan).trace
