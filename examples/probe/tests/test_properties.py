"""Whatever comes: input that Hypothesis makes up."""

from __future__ import annotations

from itertools import accumulate
from pathlib import Path
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st

from cfepy.testing import Missions
from cfepy.testing.strategies import fault_plans, messages, packets, schedules, tables

MISSION = Path(__file__).parents[1] / "mission"
few = settings(max_examples=5, deadline=None)


@few
@given(messages=st.lists(messages("std_msgs/Float64", data=st.floats(0, 20)), max_size=4), schedule=schedules())
def test_the_total_is_the_sum(mission: Missions, messages: list[Any], schedule: str) -> None:
    flight = mission(MISSION, schedule=schedule)
    flight.run_until_operational()
    for message in messages:
        flight.publish("/add", message)
    flight.run_for(0.5)
    totals = [count.total for count in flight.messages("/count")]
    assert totals == list(accumulate(each.data for each in messages))  # not sum(), which rounds otherwise


@few
@given(packet=packets(0x18A0, malformed=True) | packets(0x18A0))
def test_no_command_kills_the_heater(mission: Missions, packet: bytes) -> None:
    flight = mission(MISSION)
    flight.run_until_operational()
    flight.send(packet)
    flight.run_for(2)
    assert flight.deaths == []


@few
@given(rows=tables("HEATER.Limits", mission=MISSION))
def test_a_table_is_taken_or_refused(mission: Missions, rows: list[dict[str, int]]) -> None:
    flight = mission(MISSION)
    flight.run_until_operational()
    good = rows[0]["Low"] < rows[0]["High"]
    try:
        flight.load_table("HEATER.Limits", rows)
    except AssertionError:
        assert not good
    else:
        assert good


@few
@given(faults=fault_plans(messages=["/add", "/count"], apps=["HEATER"]))
def test_the_mission_goes_on_whatever_is_lost(mission: Missions, faults: Any) -> None:
    flight = mission(MISSION, faults=faults)
    flight.run_until_operational()
    flight.publish("/add", data=1.0)
    flight.run_for(3)
    assert flight.app("COUNTER").state == "RUNNING"
