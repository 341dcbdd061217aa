"""Same mission, same seed, same trace: on both task contexts, in slices, and under any hash seed."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from cfepy.mission import Mission
from cfepy.writing.console import Console
from tests.mission.flights import write_mission

STARTUP = """
    CFE_APP, sample_app,  SAMPLE_APP_Main, SAMPLE,  50, 16384, 0x0, 0;
    CFE_APP, hk,      HK_AppMain,      HK,      90, 16384, 0x0, 0;
    CFE_APP, sch_lab, SCH_LAB_AppMain, SCH_LAB, 80, 16384, 0x0, 0;
    !
"""
PROGRAM = """
import sys
from cfepy.writing.console import Console
from cfepy.mission import Mission
with Mission(sys.argv[1], console=Console(quiet=True), tasks=sys.argv[2]) as mission:
    mission.run_for(float(sys.argv[3]))
    mission.shut_down_nodes()
    print(mission.trace.digest())
"""


@pytest.fixture
def folder(tmp_path: Path) -> str:
    return write_mission(tmp_path, STARTUP)


def digest(folder: str, tasks: str, slices: list[float]) -> str:
    with Mission(folder, console=Console(quiet=True), tasks=tasks) as mission:
        for seconds in slices:
            mission.run_for(seconds)
        return mission.trace.digest()


@pytest.mark.parametrize("seconds", [2, pytest.param(25, marks=pytest.mark.slow)])
def test_threads_greenlets_and_slices_give_one_trace(folder: str, seconds: int) -> None:
    slices = [[seconds], [seconds / 2] * 2, [0.1] * (seconds * 10), [seconds * 0.4, 0.0, seconds * 0.6]]
    assert len({digest(folder, tasks, cut) for tasks in ("thread", "greenlet") for cut in slices}) == 1


def test_two_missions_side_by_side_are_independent(folder: str) -> None:
    alone = digest(folder, "thread", [6.0])
    with (
        Mission(folder, console=Console(quiet=True)) as first,
        Mission(folder, console=Console(quiet=True), tasks="greenlet") as second,
    ):
        for _ in range(6):
            first.run_for(1)
            second.run_for(1)
        assert [first.trace.digest(), second.trace.digest()] == [alone, alone]


def digest_in_process(mission: str, tasks: str, seconds: float, hash_seed: str) -> str:
    environment = os.environ | {"PYTHONHASHSEED": hash_seed}
    command = [sys.executable, "-c", PROGRAM, mission, tasks, str(seconds)]
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout.strip()


@pytest.mark.parametrize("seeds", [["4242"], pytest.param(["0", "1", "77"], marks=pytest.mark.slow)], ids=len)
def test_hash_seed_does_not_change_the_trace(folder: str, seeds: list[str]) -> None:
    assert (
        len({digest_in_process(folder, "thread", 5, seed) for seed in seeds} | {digest(folder, "thread", [5.0])}) == 1
    )


@pytest.mark.slow
def test_hash_seed_does_not_change_the_trace_of_nodes() -> None:
    digests = {digest_in_process("capture", tasks, 1.2, seed) for tasks, seed in (("thread", "7"), ("greenlet", "99"))}
    assert len(digests) == 1


def eventful(hash_seed: int, *arguments: object) -> subprocess.Popen[str]:
    """`tests.mission.eventful` in a process of its own."""
    environment = os.environ | {"PYTHONHASHSEED": str(hash_seed)}
    command = [sys.executable, "-m", "tests.mission.eventful", *map(str, arguments)]
    root = Path(__file__).parents[2]
    return subprocess.Popen(command, cwd=root, env=environment, stdout=subprocess.PIPE, text=True)


@pytest.mark.slow
@pytest.mark.parametrize(("mission", "schedule"), [("lab", []), ("sched", [7]), ("capture", [7])])
def test_resets_and_a_ground_link_do_not_change_determinism(mission: str, schedule: list[int]) -> None:
    flights = [
        eventful(0, mission, "thread", 1, *schedule),
        eventful(1, mission, "greenlet", 1, *schedule),
        eventful(2, mission, "thread", 7, *schedule),
        eventful(3, mission, "greenlet", 13, *schedule),
    ]
    found = {flight.communicate()[0] for flight in flights}
    assert len(found) == 1
    digest, _, resets, down = found.pop().split()
    assert (len(digest), resets) == (32, "2")
    assert (int(down) > 0) == (mission == "lab")
