"""One flight for all tests of this folder that only look at its results."""

from __future__ import annotations

from typing import Any, NamedTuple

import pytest

from cfepy.extra.reports.collector import Collector
from cfepy.extra.reports.page import About, page_of
from cfepy.ground.series import SeriesRecorder
from cfepy.pilot.pilot import Flown
from tests.extra.reports import looked_at


class Shown(NamedTuple):
    """A flight, its collected and recorded data, its page, and its trace for Perfetto."""

    mission: str
    flown: Flown
    collector: Collector
    recorder: SeriesRecorder
    page: str
    events: list[dict[str, Any]]


@pytest.fixture(scope="session")
def shown(tmp_path_factory: pytest.TempPathFactory) -> Shown:
    mission = looked_at.busy_mission(tmp_path_factory.mktemp("busy"))
    collector, recorder = Collector(), SeriesRecorder()
    flown = looked_at.fly(mission, collector, recorder)
    page = page_of(flown, collector, About(f"cfepy run --for 3 {mission}", "fifo", mission), recorder)
    _, events = looked_at.perfetto(mission)
    return Shown(mission, flown, collector, recorder, page, events)
