"""A finished mission leaves nothing in its process, without an explicit call of the garbage collector."""

from __future__ import annotations

import gc
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator

import pytest

from cfepy.extra.exploration.trial import Trial
from cfepy.interpreter import garbage
from cfepy.interpreter.garbage import collect_every
from cfepy.mission import Mission, read_mission
from cfepy.nodes import Universe
from cfepy.pilot import RunPlan
from cfepy.rtos import Kernel
from cfepy.schedules import Schedule
from cfepy.writing.console import Console
from tests.conftest import RUNS_IN_MEMORY

FLIGHTS = 6
SECONDS = 0.65  # capture's nodes have begun
PARTS = (Mission, Kernel, Universe)


@pytest.fixture(scope="module", autouse=True)
def no_collector() -> Iterator[None]:
    """Prevent collections by chance, and collect garbage at the end of each mission."""
    before = gc.get_threshold()
    gc.set_threshold(0)
    collect_every(1)
    yield
    collect_every(RUNS_IN_MEMORY)
    gc.set_threshold(*before)
    gc.unfreeze()


@pytest.fixture(autouse=True)
def nothing_else() -> None:
    """Ignore the remains of other tests."""
    gc.collect()
    gc.freeze()


def parts() -> Counter[str]:
    """Return how many parts of missions there are, without those that were there before the test."""
    return Counter(type(each).__name__ for each in gc.get_objects() for kind in PARTS if isinstance(each, kind))


def fly(seconds: float = SECONDS, tasks: str = "thread") -> Mission:
    with Mission(read_mission("capture"), console=Console(quiet=True), tasks=tasks) as mission:
        mission.run_for(seconds)
    return mission


@pytest.mark.parametrize("flights", [2, pytest.param(FLIGHTS, marks=pytest.mark.slow)])
@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_missions_do_not_accumulate(tasks: str, flights: int) -> None:
    for _ in range(flights):
        fly(tasks=tasks)
    found = parts()
    assert found["Mission"] <= 1  # the last one, for which no collection has run since
    assert found["Kernel"] <= 1
    assert found["Universe"] <= 4  # each flight makes four of them


def test_garbage_is_collected_after_every_nth_mission() -> None:
    collect_every(3)
    try:
        looks = gc.get_stats()[-1]["collections"]
        for _ in range(6):
            fly(0.1)
        assert gc.get_stats()[-1]["collections"] == looks + 2
    finally:
        collect_every(1)


def test_uncollected_garbage_is_not_frozen(monkeypatch: pytest.MonkeyPatch) -> None:
    fly(0.1)
    gc.collect()
    of_one_run = len(gc.get_objects())
    gc.freeze()
    monkeypatch.setattr(garbage, "MOST_OBJECTS", 3 * of_one_run + 1000)
    monkeypatch.setattr(garbage, "_runs", 0)
    before = gc.get_freeze_count()
    collect_every(8)
    try:
        for _ in range(8):
            fly(0.1)
    finally:
        collect_every(1)
    assert gc.get_freeze_count() <= before


def test_frozen_missions_do_not_accumulate(monkeypatch: pytest.MonkeyPatch) -> None:
    """A run that has more than MOST_OBJECTS freezes its own objects, which are garbage after it."""
    gc.unfreeze()
    gc.collect()
    others = sum(isinstance(each, Kernel) for each in gc.get_objects())
    monkeypatch.setattr(garbage, "MOST_OBJECTS", 100)
    monkeypatch.setattr(garbage, "MOST_GROWTH", 2_000)
    monkeypatch.setattr(garbage, "_kept", 0)
    for _ in range(12):
        fly(0.1)
    gc.unfreeze()
    assert sum(isinstance(each, Kernel) for each in gc.get_objects()) - others <= 5


@pytest.mark.slow
def test_observed_missions_do_not_accumulate() -> None:
    """Their kernels and buses have classes of their own."""
    for seed in range(FLIGHTS):
        Trial(RunPlan(("capture",), seconds=SECONDS)).run(Schedule(seed=seed))
    found = parts()
    assert found["Mission"] <= 1
    assert found["WrappingKernel"] <= 1


def test_finished_mission_can_be_inspected() -> None:
    first = fly()
    fly(0.1)  # at its end garbage is looked for
    assert first.booted is not None
    assert first.console.lines
    assert first.record.history
    assert first.cfe.sb.routes
    assert first.files.list_dir("/cf")
    assert first.ros.topics()


def test_disabled_garbage_collector_stays_disabled() -> None:
    gc.disable()
    try:
        looks = gc.get_stats()[-1]["collections"]
        fly(0.1)
        assert not gc.isenabled()
        assert gc.get_stats()[-1]["collections"] == looks
    finally:
        gc.enable()


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_unclosed_mission_ends_when_it_is_deleted(tasks: str) -> None:
    mission = Mission(read_mission("capture"), console=Console(quiet=True), tasks=tasks)
    mission.run_for(SECONDS)
    kernel, watch = mission.kernel, mission.stall_watch
    assert len(kernel.tasks) > 10
    with pytest.warns(ResourceWarning, match="mission capture was not closed"):
        del mission
    assert not kernel.tasks
    assert not watch.is_on


def test_closed_mission_refuses_to_run() -> None:
    mission = fly(0.1)
    with pytest.raises(RuntimeError, match="this mission is closed"):
        mission.run_for(0.1)


def test_python_ends_with_an_open_mission() -> None:
    code = f"from cfepy.mission import Mission\nmission = Mission('capture')\nmission.run_for({SECONDS})"
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False)
    assert (ended.returncode, ended.stderr) == (0, "")
