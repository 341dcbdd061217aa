"""The progress of a campaign, as shown to a user."""

from __future__ import annotations

import io

import pytest

from cfepy.extra.exploration.progress import (
    BarProgress,
    CampaignMeter,
    NoProgress,
    PlainProgress,
    duration,
    make_progress,
)
from cfepy.units import NS_PER_S


class Wall:
    """A wall clock that tests set."""

    def __init__(self) -> None:
        self.seconds = 0.0

    def elapsed_ns(self) -> int:
        return round(self.seconds * NS_PER_S)


@pytest.fixture
def wall() -> Wall:
    return Wall()


def count(meter: CampaignMeter | PlainProgress | BarProgress, good: int, bad: int = 0) -> None:
    for failed in [False] * good + [True] * bad:
        meter.arrived(failed)


def test_rate_and_time_left(wall: Wall) -> None:
    meter = CampaignMeter(1000, elapsed_ns=wall.elapsed_ns)
    assert meter.text() == "0 of 1000 schedules, 0 failed"
    count(meter, 98, 2)
    wall.seconds = 0.5
    assert (meter.rate, meter.left_s) == (0.0, None)
    wall.seconds = 2.0
    assert (meter.rate, meter.left_s) == (50.0, 18.0)
    assert meter.text() == "100 of 1000 schedules, 2 failed, 50.0/s, 0:00:18 left"
    count(meter, 900)
    assert meter.text() == "1000 of 1000 schedules, 2 failed, 500.0/s"


def test_rate_excludes_schedules_of_an_earlier_run(wall: Wall) -> None:
    meter = CampaignMeter(1000, resumed=400, elapsed_ns=wall.elapsed_ns)
    wall.seconds = 2.0
    count(meter, 400)
    assert (meter.rate, meter.left_s) == (0.0, None)
    count(meter, 100)
    assert (meter.rate, meter.left_s) == (50.0, 10.0)


def test_time_budget_limits_the_time_left(wall: Wall) -> None:
    meter = CampaignMeter(None, elapsed_ns=wall.elapsed_ns, budget_s=60)
    wall.seconds = 2.0
    count(meter, 100)
    assert meter.text() == "100 schedules, 0 failed, 50.0/s, 0:00:58 left"
    assert meter.share == pytest.approx(2 / 60)
    meter = CampaignMeter(1000, elapsed_ns=wall.elapsed_ns, budget_s=60)
    count(meter, 100)
    assert meter.text() == "100 of 1000 schedules, 0 failed, 50.0/s, 0:00:18 left"
    assert meter.share == pytest.approx(0.1)


def test_durations() -> None:
    assert [duration(seconds) for seconds in (0.4, 59.6, 3599, 90061)] == ["0:00:00", "0:01:00", "0:59:59", "25:01:01"]


def test_a_log_gets_a_line_every_ten_seconds(wall: Wall) -> None:
    stream = io.StringIO()
    progress = PlainProgress(CampaignMeter(300, elapsed_ns=wall.elapsed_ns), stream)
    for _ in range(250):
        wall.seconds += 0.1
        progress.arrived(False)
    progress.close()
    assert stream.getvalue().splitlines() == [
        "100 of 300 schedules, 0 failed, 10.0/s, 0:00:20 left",
        "200 of 300 schedules, 0 failed, 10.0/s, 0:00:10 left",
    ]


def test_a_terminal_gets_a_bar(wall: Wall, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "100")
    stream = io.StringIO()
    stream.isatty = lambda: True  # type: ignore[method-assign]
    progress = make_progress(stream, 10)
    assert isinstance(progress, BarProgress)
    count(progress, 9, 1)
    progress.close()
    assert "10 of 10 schedules, 1 failed" in stream.getvalue()


def test_progress_depends_on_the_stream() -> None:
    assert isinstance(make_progress(io.StringIO(), 10), PlainProgress)
    assert isinstance(make_progress(None, 10), NoProgress)
