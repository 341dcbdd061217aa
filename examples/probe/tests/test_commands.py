"""HEATER, as the ground sees it: commands, events, telemetry, its table."""

from __future__ import annotations

import re

import pytest

from cfepy.testing import ExpectationError, Flight


def test_noop_is_answered_with_an_event(probe: Flight) -> None:
    probe.send("HEATER_NOOP")
    probe.expect_event("HEATER", 1, within=0.1)
    probe.expect_telemetry("HEATER_HK_TLM", Accepted=1, within=2)


def test_a_target_within_the_limits_is_taken(probe: Flight) -> None:
    probe.send("HEATER_SET_TARGET", Celsius=25.5)
    probe.expect_event("HEATER", text=re.compile(r"target 2\d\.5"))
    assert probe.telemetry("HEATER_HK_TLM")["Target"] == 25.5


def test_a_target_out_of_the_limits_is_refused(probe: Flight) -> None:
    probe.send("HEATER_SET_TARGET", Celsius=41)
    event = probe.expect_event("HEATER", type="ERROR")
    assert event.text == "HEATER: 41 is out of limits"
    probe.expect_no_event("HEATER", 2, within=1)


def test_the_limits_are_a_table(probe: Flight) -> None:
    probe.load_table("HEATER.Limits", {"Low": 0, "High": 100})
    probe.send("HEATER_SET_TARGET", Celsius=99)
    probe.expect_event("HEATER", 2)


def test_limits_the_wrong_way_round_are_refused(probe: Flight) -> None:
    with pytest.raises(ExpectationError, match="HEATER validation failed"):
        probe.load_table("HEATER.Limits", {"Low": 100, "High": 0})


def test_nothing_dies(probe: Flight) -> None:
    probe.run_for(60)
    assert probe.app("HEATER").state == "RUNNING"
    assert probe.deaths == []
    assert probe.results.problems == []
