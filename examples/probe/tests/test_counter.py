"""The node: topics, its service, its parameter, what it prints; and what it makes of a message that is lost."""

from __future__ import annotations

from cfepy.testing import Flight, Missions


def test_it_adds_up(probe: Flight) -> None:
    probe.publish("/add", data=1.5)
    probe.publish("/add", probe.message_class("std_msgs/Float64")(2.0))
    probe.expect_message("/count", lambda count: count.total == 3.5, number=2, within=0.1)
    assert [count.number for count in probe.messages("/count")] == [1, 2]


def test_reset_begins_anew(probe: Flight) -> None:
    probe.publish("/add", data=4.0)
    probe.expect_message("/count", total=4.0)
    assert probe.call_service("/reset").success
    probe.publish("/add", data=1.0)
    probe.expect_message("/count", number=1, total=1.0)


def test_the_limit_is_a_parameter(probe: Flight) -> None:
    assert probe.param("/counter/limit") == 100.0
    probe.set_param("/counter/limit", 0.5)
    probe.publish("/add", data=1.0)
    probe.expect_console("1 would be too much", within=0.1)
    probe.expect_no_message("/count", within=1)


def test_it_says_that_it_counts(probe: Flight) -> None:
    assert probe.stdout("counter") == ["counting"]


def test_a_lost_message_is_not_counted(mission: Missions) -> None:
    flight = mission("../mission", faults="../mission/faults.yaml")
    flight.run_until_operational()
    flight.publish("/add", data=1.0)
    flight.publish("/add", data=2.0)
    assert flight.expect_message("/count").total == 2.0
