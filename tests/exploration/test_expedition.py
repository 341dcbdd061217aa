"""An exploration as a whole: the command's options are those of `Expedition`, and its defaults too."""

from __future__ import annotations

import argparse
from pathlib import Path

import pytest

from cfepy.cli import explore as room
from cfepy.exploration import Expedition
from cfepy.exploration.expedition import DEFAULT_PROBES, DEFAULT_SEEDS
from cfepy.pilot import RunPlan
from cfepy.status import UsageError

ODOMETER = str(Path(__file__).parents[1] / "quality" / "missions" / "lost_update")
PLAN = RunPlan((ODOMETER,), seconds=1.3, tasks="greenlet")


def options() -> argparse.Namespace:
    parser = argparse.ArgumentParser()
    room.add(parser.add_subparsers())
    return parser.parse_args(["explore", "capture"])


def test_the_command_has_its_defaults() -> None:
    parsed, usual = options(), Expedition(PLAN)
    assert (parsed.seeds, parsed.shrink) == (DEFAULT_SEEDS, DEFAULT_PROBES)
    for name in (
        "seeds",
        "policy",
        "depth",
        "first_seed",
        "any_priority",
        "until_failure",
        "events",
        "jobs",
        "cluster",
    ):
        assert getattr(parsed, name) == getattr(usual, name), name
    assert (parsed.seeds, parsed.shrink, parsed.longest) == (usual.seeds, usual.shrink, usual.longest_s)
    assert (parsed.hold, getattr(parsed, "from"), parsed.no_stuck) == (usual.hold_s, usual.from_s, not usual.stuck)
    assert parsed.connect is usual.connect_s


def test_a_failure_is_shrunk_and_told_with_its_timeline() -> None:
    report = Expedition(PLAN, seeds=8, jobs=1, until_failure=True).run()
    told = report.findings[0]
    assert "WHEELS" in told.finding.failure.title
    assert told.shrunk is not None
    assert told.shrunk.verdict.preemptions == 1
    assert any("PREEMPTED" in line for line in told.timeline)
    assert report.to_dict()["failures"][0]["shrunk"]["schedule"] == str(told.shrunk.verdict.schedule)


def test_a_time_that_cannot_be_is_told_by_the_option() -> None:
    with pytest.raises(UsageError, match="--hold"):
        Expedition(PLAN, hold_s=-1).run()
