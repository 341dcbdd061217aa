"""`fail: OS_QueuePut` at the pipes of the Software Bus: the put fails, and CFE_SB reports it like NASA's."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from cfepy.faults import Targets, random_plan
from cfepy.mission import Mission
from cfepy.sb import SoftwareBus
from tests.faults.worlds import fly, row, told, values

PUT: dict[str, Any] = {"fail": "OS_QueuePut"}
INTO_TAKER = PUT | {"app": "SOURCE", "object": "TAKER_PIPE"}
BOTH = pytest.mark.parametrize("tasks", ["thread", "greenlet"])


def numbers(mission: Mission, app: str = "TAKER", most: int = 5) -> list[int]:
    return values(mission, app)[:most]


def sb_events(mission: Mission) -> list[str]:
    """Return CFE_SB's events about lost messages."""
    return [line for line in mission.console.lines if "Pipe Overflow" in line or "Pipe Write Err" in line]


@BOTH
def test_failed_put_into_a_pipe_acts_like_a_full_pipe(tmp_path: Path, tasks: str) -> None:
    mission = fly(tmp_path, INTO_TAKER | {"number": 3}, tasks=tasks)  # numbers and orders take turns
    assert numbers(mission) == [0, 2, 3, 4, 5]
    assert numbers(mission, "OTHER") == [0, 1, 2, 3, 4]
    assert told(mission, "TAKER got")[0].endswith("got 3 after 1")  # it had its sequence count
    (event,) = sb_events(mission)
    assert "25" in event
    assert "Pipe Overflow,MsgId 0x883,pipe TAKER_PIPE,sender SOURCE" in event
    sb = mission.cfe.sb
    assert (sb.counters.pipe_overflow_error, sb.counters.internal_error, sb.counters.msg_limit_error) == (1, 0, 0)
    route = sb.routes[0x883]
    assert (route.totals()[2], route.totals()[3]) == (0, 1)
    assert next(pipe for pipe in sb.pipes if pipe.name == "TAKER_PIPE").dropped == 1
    assert row(mission, "fail-1")["times"] == 1
    text = "lets os.queue_put of SOURCE into pipe TAKER_PIPE fail with OS_QUEUE_FULL"
    assert row(mission, "fail-1")["details"] == [text]


@BOTH
def test_another_status_is_a_write_error(tmp_path: Path, tasks: str) -> None:
    mission = fly(tmp_path, INTO_TAKER | {"number": 3, "status": "OS_ERR_INVALID_ID"}, tasks=tasks)
    (event,) = sb_events(mission)
    assert "26" in event
    assert "Pipe Write Err,MsgId 0x883,pipe TAKER_PIPE,sender SOURCE,stat" in event
    assert numbers(mission) == [0, 2, 3, 4, 5]
    sb = mission.cfe.sb
    assert (sb.counters.pipe_overflow_error, sb.counters.internal_error) == (0, 1)
    assert next(pipe for pipe in sb.pipes if pipe.name == "TAKER_PIPE").dropped == 1


def test_each_put_is_counted(tmp_path: Path) -> None:
    """The newest subscriber gets a message first: OTHER, then TAKER."""
    mission = fly(tmp_path, PUT | {"app": "SOURCE", "number": [1, 6]})
    assert numbers(mission, "OTHER") == [1, 2, 3, 4, 5]
    assert numbers(mission) == [0, 2, 3, 4, 5]
    assert row(mission, "fail-1")["times"] == 2


def test_faults_count_occasions_independently(tmp_path: Path) -> None:
    mission = fly(tmp_path, INTO_TAKER | {"number": 3}, INTO_TAKER | {"number": 5})
    assert numbers(mission) == [0, 3, 4, 5, 6]
    assert [row(mission, f"fail-{number}")["times"] for number in (1, 2)] == [1, 1]


def test_all_puts_of_a_sender_into_a_pipe(tmp_path: Path) -> None:
    plain = len(values(fly(tmp_path), "OTHER"))
    mission = fly(tmp_path, PUT | {"app": "SOURCE", "object": "TAKER_PIPE"})
    assert not values(mission)
    assert len(values(mission, "OTHER")) == plain
    assert row(mission, "fail-1")["times"] == 2 * plain


def test_a_random_plan_lets_puts_into_pipes_fail() -> None:
    targets = Targets(apps=("A",), pipes=("P", "Q"))
    plans = [random_plan(seed, targets, "high").faults for seed in range(60)]
    puts = [fault for faults in plans for fault in faults if fault.target == ("os.queue_put",)]
    assert {fault.options["object"] for fault in puts} == {"P", "Q"}


def test_events_about_failed_puts_fail_without_an_endless_loop(tmp_path: Path) -> None:
    """Every put fails, including the put of the event about it. This causes no endless loop."""
    mission = fly(tmp_path, PUT | {"after": 1.8})
    assert values(mission) == [0, 1, 2]
    assert row(mission, "fail-1")["times"] > 10
    assert sb_events(mission)


def test_put_fault_that_never_matched_has_a_reason(tmp_path: Path) -> None:
    mission = fly(tmp_path, PUT | {"object": "NO_PIPE"}, PUT | {"app": "TAKER", "object": "OTHER_PIPE"})
    reasons = [each["never"] for each in mission.record.rows("faults")]
    assert reasons == ["no matching task called os.queue_put"] * 2
    assert not sb_events(mission)
    assert values(mission) == values(fly(tmp_path))


def test_put_fault_works_with_other_faults_and_resets(tmp_path: Path) -> None:
    faults = [{"duplicate": "NUMBER_TLM", "number": 2, "to": "OTHER"}, INTO_TAKER | {"number": [3, 25]}]
    mission = fly(tmp_path, *faults, {"reset": "processor", "at": 1.98}, seconds=5)
    assert numbers(mission, "OTHER", 4) == [0, 1, 1, 2]
    assert row(mission, "fail-1")["times"] == 2
    assert len(mission.record.resets) == 1


def test_put_faults_give_one_trace_on_threads_and_greenlets(tmp_path: Path) -> None:
    fault = PUT | {"probability": 0.2, "status": "OS_ERROR"}
    digests = {fly(tmp_path, fault, tasks=tasks).trace.digest() for tasks in ("thread", "greenlet", "thread")}
    assert len(digests) == 1
    assert fly(tmp_path).trace.digest() not in digests


def test_fault_of_another_call_does_not_change_the_bus(tmp_path: Path) -> None:
    assert type(fly(tmp_path, {"fail": "OS_write"}).cfe.sb) is SoftwareBus
