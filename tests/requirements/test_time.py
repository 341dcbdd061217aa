"""Time Services, requirement by requirement: commands and telemetry (cTIME2000 to 2014, 2019)."""

from __future__ import annotations

import pytest

from cfepy.evs import DEBUG, ERROR
from cfepy.evs import packets as evs_packets
from cfepy.msg import Command
from cfepy.time import CLOCK_VALID, SysTime, add, subtract
from cfepy.time import packets as pk
from tests.requirements.clock import HALF, Fly, diagnostic, housekeeping, to_next_second, told
from tests.requirements.covers import covers
from tests.requirements.flight import Flight


@pytest.fixture
def flight(fly: Fly) -> Flight:
    return fly(pk.HK_TLM_MID, pk.DIAG_TLM_MID, pk.DATA_CMD_MID)


def test_cTIME2000_housekeeping(flight: Flight) -> None:
    flight.send(pk.ADD_ONE_HZ_ADJUSTMENT, Seconds=0, Subseconds=0x100)
    flight.send(pk.SET_STATE, ClockState=CLOCK_VALID)
    to_next_second(flight)
    time = flight.cfe.time
    before = time.get_met()
    values = housekeeping(flight)
    assert before <= tuple(values["MET"].values()) < time.get_met()
    assert values["ClockStateFlags"] == time.get_clock_info() == 0xB3E0
    assert values["ClockStateAPI"] == CLOCK_VALID
    assert values["LeapSeconds"] == 37
    assert values["STCF"] == {"Seconds": 1_000_000, "Subseconds": 0x100}
    assert values["AdjustmentFactor"] == {"Seconds": 0, "Subseconds": 0x100}
    assert (values["CommandCounter"], values["CommandErrorCounter"]) == (2, 0)


def test_cTIME2001_noop(flight: Flight) -> None:
    version = "CFE_TIME v7.0.0+dev0 (Draco) v7.0.0 Official Release, EDS disabled"
    assert flight.send(pk.NOOP) == told(4, f"No-op Cmd Rcvd: {version}")


def test_cTIME2002_counters_are_set_to_zero(flight: Flight) -> None:
    flight.send(evs_packets.ENABLE_APP_EVENT_TYPE, AppName="CFE_TIME", BitMask=1)
    flight.send(pk.NOOP)
    flight.send(Command("unknown", pk.CMD_MID, 99))
    values = housekeeping(flight)
    assert (values["CommandCounter"], values["CommandErrorCounter"]) == (1, 1)
    assert flight.send(pk.RESET_COUNTERS) == told(5, "Reset Counters command", DEBUG)
    values = housekeeping(flight)
    assert (values["CommandCounter"], values["CommandErrorCounter"]) == (0, 0)
    counters = {name: value for name, value in diagnostic(flight).items() if name.endswith("Counter")}
    assert set(counters.values()) == {0}
    assert len(counters) == 10


@covers("cTIME2003", "cTIME2004")
def test_cTIME2003_command_counters(flight: Flight) -> None:
    valid = (pk.NOOP, pk.SEND_DIAGNOSTIC, pk.SET_STATE, pk.SET_TIME, pk.SET_MET, pk.SET_STCF, pk.SET_LEAP_SECONDS)
    adjusting = (pk.ADD_ADJUST, pk.SUB_ADJUST, pk.ADD_ONE_HZ_ADJUSTMENT, pk.SUB_ONE_HZ_ADJUSTMENT)
    for count, command in enumerate((*valid, *adjusting), 1):
        flight.send(command)
        assert housekeeping(flight)["CommandCounter"] == count, command.name
    invalid = "Invalid command code -- ID = 0x1805, CC = 99"
    assert flight.send(Command("unknown", pk.CMD_MID, 99)) == told(27, invalid, ERROR)
    length = "Invalid msg length: ID = 0x1805,  CC = 0, Len = 10, Expected = 8"
    assert flight.send(Command("too long", pk.CMD_MID, 0, pk.STATE_COMMAND)) == told(49, length, ERROR)
    assert flight.send(pk.SET_STATE, ClockState=2) == told(30, "Invalid Clock State = 0x2", ERROR)
    values = housekeeping(flight)
    assert (values["CommandCounter"], values["CommandErrorCounter"]) == (11, 3)
    for number, command in enumerate((pk.SET_SOURCE, pk.SET_SIGNAL, pk.ADD_DELAY, pk.SUB_DELAY), 4):
        (event,) = flight.send(command)  # not for a server without other sources
        assert event.event_type == ERROR
        values = housekeeping(flight)
        assert (values["CommandCounter"], values["CommandErrorCounter"]) == (11, number)


def test_cTIME2005_leap_seconds(flight: Flight) -> None:
    assert flight.send(pk.SET_LEAP_SECONDS, LeapSeconds=-5) == told(17, "Set Leap Seconds = -5")
    assert flight.cfe.time.get_leap_seconds() == -5


def test_cTIME2006_stcf(flight: Flight) -> None:
    text = "Set STCF -- secs = 2000000, usecs = 500000, ssecs = 0x80000000"
    assert flight.send(pk.SET_STCF, Seconds=2_000_000, MicroSeconds=500_000) == told(14, text)
    assert flight.cfe.time.get_stcf() == (2_000_000, HALF)


@pytest.mark.parametrize("utc", [False, True])
def test_cTIME2007_current_time(fly: Fly, utc: bool) -> None:
    """The time in the command is TAI, or UTC where that is the spacecraft's time."""
    flight = fly(time_cfg_default_utc=utc)
    flight.run_for(0.4)
    met = flight.cfe.time.get_met()
    text = "Set Time -- secs = 3000000, usecs = 0, ssecs = 0x0"
    assert flight.send(pk.SET_TIME, Seconds=3_000_000) == told(12, text)
    assert flight.cfe.time.get_time().seconds == 3_000_000
    assert subtract(flight.cfe.time.get_met(), met) < SysTime(0, HALF)
    assert add(flight.cfe.time.get_stcf(), met) == (3_000_037 if utc else 3_000_000, 0)


@pytest.mark.parametrize(("command", "after"), [("ADD", (1_000_001, 0)), ("SUB", (999_999, 0))])
def test_cTIME2009_stcf_is_adjusted_every_second(flight: Flight, command: str, after: tuple[int, int]) -> None:
    """Each second's adjustment stays until another command removes it, and no tone reverts it."""
    adjust: Command = getattr(pk, f"{command}_ONE_HZ_ADJUSTMENT")
    direction = 1 if command == "ADD" else 2
    text = f"STCF 1Hz Adjust -- secs = 0, ssecs = 0x40000000, dir[1=Pos, 2=Neg] = {direction}"
    assert flight.send(adjust, Seconds=0, Subseconds=0x40000000) == told(16, text)
    flight.run_for(4)
    assert flight.cfe.time.get_stcf() == after
    flight.send(adjust, Seconds=0, Subseconds=0)
    flight.run_for(4)
    assert flight.cfe.time.get_stcf() == after


def test_cTIME2010_tone_signal(fly: Fly) -> None:
    flight = fly(pk.HK_TLM_MID, pk.DIAG_TLM_MID, time_cfg_signal=True)
    assert flight.send(pk.SET_SIGNAL, ToneSource=2) == told(9, "Set Tone Source = REDUNDANT")
    assert diagnostic(flight)["ClockSignal"] == 2
    assert flight.send(pk.SET_SIGNAL, ToneSource=1) == told(9, "Set Tone Source = PRIMARY")
    assert diagnostic(flight)["ClockSignal"] == 1
    fixed = fly()
    text = "Set Signal commands invalid without CFE_PLATFORM_TIME_CFG_SIGNAL set to TRUE"
    assert fixed.send(pk.SET_SIGNAL, ToneSource=2) == told(41, text, ERROR)


def test_cTIME2011_diagnostics(flight: Flight) -> None:
    flight.send(pk.ADD_ADJUST, Seconds=5, MicroSeconds=0)
    flight.send(pk.SUB_ONE_HZ_ADJUSTMENT, Seconds=1, Subseconds=0)
    to_next_second(flight)
    values = diagnostic(flight)
    assert len(flight.packets[0]) == 216
    since = values["TimeSinceTone"]["Subseconds"]
    assert since == pytest.approx(0.1 * 2**32, rel=0.1)
    times = {
        "AtToneMET": (1004, 0),
        "AtToneSTCF": (1_000_004, 0),
        "AtToneDelay": (0, 0),
        "AtToneLatch": (4, 0),
        "TimeSinceTone": (0, since),
        "CurrentLatch": (4, since),
        "CurrentMET": (1004, since),
        "CurrentTAI": (1_001_008, since),
        "CurrentUTC": (1_000_971, since),
        "OneTimeAdjust": (5, 0),
        "OneHzAdjust": (1, 0),
        "ToneSignalLatch": (4, 0),
        "ToneDataLatch": (4, 0),
        "MaxLocalClock": (27, 0),
    }
    assert {name: (values[name]["Seconds"], values[name]["Subseconds"]) for name in times} == times
    states = {"ClockStateAPI": -1, "ClockSetState": 0, "ClockFlyState": 0, "ServerFlyState": 0, "Forced2Fly": 0}
    choices = {"ClockSource": 1, "ClockSignal": 1, "OneTimeDirection": 1, "OneHzDirection": 2, "DelayDirection": 1}
    limits = {"MinElapsed": 0, "MaxElapsed": 858993460, "ToneOverLimit": 85899346, "ToneUnderLimit": 4209067951}
    others = {"AtToneLeapSeconds": 37, "ClockStateFlags": 0x32E0, "VirtualMET": 1004, "DataStoreStatus": 3}
    expected = states | choices | limits | others
    assert {name: values[name] for name in expected} == expected
    counters = {name: values[name] for name in values if name.endswith("Counter")}
    del counters["VersionCounter"]
    assert counters == {name: 0 if "Error" in name else 4 for name in counters}
    assert len(times) + len(expected) + len(counters) + 1 == len(values)
    flight.send(pk.RESET_COUNTERS)
    flight.send(pk.SET_STCF, Seconds=1)
    assert diagnostic(flight)["VersionCounter"] == 1, "changes of the reference since counters were reset"


@pytest.mark.parametrize(("command", "after"), [(pk.ADD_ADJUST, (1_000_002, HALF)), (pk.SUB_ADJUST, (999_997, HALF))])
@covers("cTIME2013", "cTIME2014")
def test_cTIME2013_stcf_is_adjusted_once(flight: Flight, command: Command, after: tuple[int, int]) -> None:
    (event,) = flight.send(command, Seconds=2, MicroSeconds=500_000)
    assert event.text.startswith("STCF Adjust -- secs = 2, usecs = 500000, ssecs = 0x80000000, dir[1=Pos, 2=Neg] = ")
    flight.run_for(3)
    assert flight.cfe.time.get_stcf() == after


def test_cTIME2019_met(flight: Flight) -> None:
    to_next_second(flight)
    assert flight.send(pk.SET_MET, Seconds=7000) == told(13, "Set MET -- secs = 7000, usecs = 0, ssecs = 0x0")
    assert flight.cfe.time.get_met().seconds == 7000
    flight.run_for(3)
    assert flight.cfe.time.get_met().seconds == 7003
    assert flight.cfe.time.get_stcf() == (1_000_000, 0)
