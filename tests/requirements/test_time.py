"""Time Services, requirement by requirement: commands, telemetry, tones, resets (cTIME2000 to 2021, 2500 to 2700)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from cfepy.evs import DEBUG, ERROR, INFORMATION
from cfepy.evs import packets as evs_packets
from cfepy.msg import Command, get_msg_id
from cfepy.time import CLOCK_FLYWHEEL, CLOCK_INVALID, CLOCK_VALID, SysTime, add, subtract
from cfepy.time import packets as pk
from tests.requirements.covers import covers
from tests.requirements.flight import POWERON_RESET, PROCESSOR_RESET, Event, Flight

Fly = Callable[..., Flight]
HALF = 0x80000000
ON_ITS_OWN = {"time_cfg_fake_tone": False}
"""A server whose tones come from outside: from the test."""


@pytest.fixture
def flight(fly: Fly) -> Flight:
    return fly(pk.HK_TLM_MID, pk.DIAG_TLM_MID, pk.DATA_CMD_MID)


def housekeeping(flight: Flight) -> dict[str, Any]:
    return flight.ask(pk.SEND_HK, pk.HK_TLM)


def diagnostic(flight: Flight) -> dict[str, Any]:
    return flight.ask(pk.SEND_DIAGNOSTIC, pk.DIAG_TLM)


def told(event_id: int, text: str, event_type: int = INFORMATION) -> list[Event]:
    return [Event("CFE_TIME", event_id, event_type, text)]


def tone(flight: Flight) -> None:
    """A tone from outside, and the request for the time at it, as a scheduler sends it."""
    flight.call(flight.cfe.time.external_tone)
    flight.transmit(pk.SEND_CMD.packet())


def to_next_second(flight: Flight) -> None:
    """Go on to the tenth of a second after the next tone."""
    subseconds = flight.cfe.time.get_met_subsecs()
    flight.run(1.1 - subseconds / 2**32)


def test_cTIME2000_housekeeping(flight: Flight) -> None:
    flight.send(pk.ADD_ONE_HZ_ADJUSTMENT, Seconds=0, Subseconds=0x100)
    flight.send(pk.SET_STATE, ClockState=CLOCK_VALID)
    values = housekeeping(flight)
    time = flight.cfe.time
    assert values["ClockStateFlags"] == time.get_clock_info() == 0xB3E0
    assert values["ClockStateAPI"] == CLOCK_VALID
    assert values["LeapSeconds"] == 37
    assert values["MET"]["Seconds"] == time.get_met().seconds == 1003
    assert values["STCF"] == {"Seconds": 1_000_000, "Subseconds": 0}
    assert values["AdjustmentFactor"] == {"Seconds": 0, "Subseconds": 0x100}


def test_cTIME2001_noop(flight: Flight) -> None:
    version = "CFE_TIME v7.0.0+dev0 (Draco) v7.0.0 Official Release, EDS disabled"
    assert flight.send(pk.NOOP) == told(4, f"No-op Cmd Rcvd: {version}")


def test_cTIME2002_counters_are_set_to_zero(flight: Flight) -> None:
    flight.send(evs_packets.ENABLE_APP_EVENT_TYPE, AppName="CFE_TIME", BitMask=1)
    flight.send(Command("unknown", pk.CMD_MID, 99))
    assert flight.send(pk.RESET_COUNTERS) == told(5, "Reset Counters command", DEBUG)
    values = housekeeping(flight)
    assert (values["CommandCounter"], values["CommandErrorCounter"]) == (0, 0)
    counters = {name: value for name, value in diagnostic(flight).items() if name.endswith("Counter")}
    assert set(counters.values()) == {0}
    assert len(counters) == 10


@covers("cTIME2003", "cTIME2004")
def test_cTIME2003_command_counters(flight: Flight) -> None:
    flight.send(pk.NOOP)
    flight.send(pk.SET_LEAP_SECONDS, LeapSeconds=1)
    invalid = "Invalid command code -- ID = 0x1805, CC = 99"
    assert flight.send(Command("unknown", pk.CMD_MID, 99)) == told(27, invalid, ERROR)
    length = "Invalid msg length: ID = 0x1805,  CC = 0, Len = 10, Expected = 8"
    assert flight.send(Command("too long", pk.CMD_MID, 0, pk.STATE_COMMAND)) == told(49, length, ERROR)
    assert flight.send(pk.SET_STATE, ClockState=2) == told(30, "Invalid Clock State = 0x2", ERROR)
    values = housekeeping(flight)
    assert (values["CommandCounter"], values["CommandErrorCounter"]) == (2, 3)


def test_cTIME2005_leap_seconds(flight: Flight) -> None:
    assert flight.send(pk.SET_LEAP_SECONDS, LeapSeconds=-5) == told(17, "Set Leap Seconds = -5")
    assert flight.cfe.time.get_leap_seconds() == -5


def test_cTIME2006_stcf(flight: Flight) -> None:
    text = "Set STCF -- secs = 2000000, usecs = 500000, ssecs = 0x80000000"
    assert flight.send(pk.SET_STCF, Seconds=2_000_000, MicroSeconds=500_000) == told(14, text)
    assert flight.cfe.time.get_stcf() == (2_000_000, HALF)


def test_cTIME2007_current_time(flight: Flight) -> None:
    met = flight.cfe.time.get_met()
    text = "Set Time -- secs = 3000000, usecs = 0, ssecs = 0x0"
    assert flight.send(pk.SET_TIME, Seconds=3_000_000) == told(12, text)
    assert flight.cfe.time.get_time().seconds == 3_000_000
    assert subtract(flight.cfe.time.get_met(), met) < SysTime(0, HALF)
    assert add(flight.cfe.time.get_stcf(), met) == (3_000_000, 0)


@pytest.mark.parametrize(("command", "after"), [("ADD", (1_000_001, 0)), ("SUB", (999_999, 0))])
@covers("cTIME2009", "cTIME2020", "cTIME2021")
def test_cTIME2009_stcf_is_adjusted_every_second(flight: Flight, command: str, after: tuple[int, int]) -> None:
    """What each second adds stays until another command takes it away, and no tone undoes it."""
    adjust: Command = getattr(pk, f"{command}_ONE_HZ_ADJUSTMENT")
    direction = 1 if command == "ADD" else 2
    text = f"STCF 1Hz Adjust -- secs = 0, ssecs = 0x40000000, dir[1=Pos, 2=Neg] = {direction}"
    assert flight.send(adjust, Seconds=0, Subseconds=0x40000000) == told(16, text)
    flight.run(4)
    assert flight.cfe.time.get_stcf() == after
    flight.send(adjust, Seconds=0, Subseconds=0)
    flight.run(4)
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
    to_next_second(flight)
    values = diagnostic(flight)
    assert len(flight.packets[0]) == 216
    assert values["TimeSinceTone"]["Seconds"] == 0
    assert values["CurrentMET"]["Seconds"] == values["VirtualMET"] == values["AtToneMET"]["Seconds"]
    assert values["AtToneSTCF"] == {"Seconds": 1_000_005, "Subseconds": 0}
    assert values["OneTimeAdjust"] == {"Seconds": 5, "Subseconds": 0}
    assert values["AtToneLatch"] == values["ToneSignalLatch"] == values["ToneDataLatch"]
    assert values["ToneMatchCounter"] == values["ToneIntCounter"] == values["LocalIntCounter"] == 4
    assert (values["ClockSource"], values["ClockSignal"], values["DataStoreStatus"]) == (1, 1, 3)


@covers("cTIME2012", "cTIME2012.1", "cTIME2012.2")
def test_cTIME2012_tones_are_used_or_ignored(flight: Flight) -> None:
    time = flight.cfe.time
    flight.send(pk.SET_STATE, ClockState=CLOCK_VALID)
    assert time.get_clock_state() == CLOCK_VALID
    assert flight.send(pk.SET_STATE, ClockState=CLOCK_FLYWHEEL) == told(7, "Set Clock State = FLYWHEEL")
    before, matches = time.get_met(), diagnostic(flight)["ToneMatchCounter"]
    flight.run(5)
    values = diagnostic(flight)
    assert (time.get_clock_state(), values["Forced2Fly"]) == (CLOCK_FLYWHEEL, 1)
    assert values["ToneMatchCounter"] > matches
    assert values["TimeSinceTone"]["Seconds"] >= 4
    assert 5 <= subtract(time.get_met(), before).seconds <= 6
    flight.send(pk.SET_STATE, ClockState=CLOCK_VALID)
    to_next_second(flight)
    assert flight.events()[-1:] == told(21, "Stop FLYWHEEL")
    assert time.get_clock_state() == CLOCK_VALID
    assert diagnostic(flight)["TimeSinceTone"]["Seconds"] == 0


def test_cTIME2012_2_a_client_follows_a_server(fly: Fly) -> None:
    """Two processors: the tone is a wire between them, the time at the tone is a message that a link brings over."""
    server = fly(pk.TONE_CMD_MID, pk.DATA_CMD_MID)
    client = fly(pk.DATA_CMD_MID, time_cfg_client=True, time_cfg_fake_tone=False)
    server.send(pk.SET_TIME, Seconds=9_000_000)
    server.send(pk.SET_STATE, ClockState=CLOCK_VALID)
    for _ in range(300):
        server.packets.clear()
        server.run(0.01)
        client.run(0.01)
        if server.all(pk.TONE_CMD):
            client.call(client.cfe.time.external_tone)
            (packet,) = (packet for packet in server.packets if get_msg_id(packet) == pk.DATA_CMD_MID)
            client.transmit(packet)
    apart = subtract(client.cfe.time.get_time(), server.cfe.time.get_time())
    assert min(apart, subtract((0, 0), apart)) < SysTime(0, 0x4000000)  # 16 ms: steps of this test are 10 ms
    assert client.cfe.time.get_leap_seconds() == 37
    assert client.cfe.time.get_clock_state() == CLOCK_VALID
    assert client.send(pk.SET_MET, Seconds=1)[0].event_id == 44


@pytest.mark.parametrize(("command", "after"), [(pk.ADD_ADJUST, (1_000_002, HALF)), (pk.SUB_ADJUST, (999_997, HALF))])
@covers("cTIME2013", "cTIME2014")
def test_cTIME2013_stcf_is_adjusted_once(flight: Flight, command: Command, after: tuple[int, int]) -> None:
    (event,) = flight.send(command, Seconds=2, MicroSeconds=500_000)
    assert event.text.startswith("STCF Adjust -- secs = 2, usecs = 500000, ssecs = 0x80000000, dir[1=Pos, 2=Neg] = ")
    flight.run(3)
    assert flight.cfe.time.get_stcf() == after


def test_cTIME2015_tone_data_is_sent_on_request(fly: Fly) -> None:
    flight = fly(pk.DATA_CMD_MID, **ON_ITS_OWN)
    flight.packets.clear()
    flight.transmit(pk.SEND_CMD.packet())
    (data,) = flight.all(pk.DATA_CMD)
    assert data == {
        "AtToneMET": {"Seconds": 1003, "Subseconds": 0},
        "AtToneSTCF": {"Seconds": 1_000_000, "Subseconds": 0},
        "AtToneLeapSeconds": 37,
        "AtToneState": CLOCK_INVALID,
    }


def test_cTIME2016_data_after_a_tone_updates_the_time(fly: Fly) -> None:
    flight = fly(pk.DIAG_TLM_MID, **ON_ITS_OWN)
    assert diagnostic(flight)["ToneMatchCounter"] == 0
    flight.call(flight.cfe.time.external_tone)
    assert flight.cfe.time.get_clock_info() & 0x4000
    flight.packets.clear()
    flight.transmit(pk.SEND_CMD.packet())
    assert flight.events() == told(21, "Stop FLYWHEEL")
    assert flight.cfe.time.get_clock_info() & 0x4000 == 0
    flight.transmit(pk.SEND_CMD.packet())  # data without a new tone
    values = diagnostic(flight)
    assert (values["ToneMatchCounter"], values["ToneMatchErrorCounter"]) == (1, 1)


def test_cTIME2017_a_tone_after_data_updates_the_time(fly: Fly) -> None:
    flight = fly(pk.DIAG_TLM_MID, time_at_tone_will_be=True, **ON_ITS_OWN)
    flight.call(flight.cfe.time.external_tone)
    flight.run(0.9)
    flight.transmit(pk.SEND_CMD.packet())
    assert diagnostic(flight)["ToneMatchCounter"] == 0
    flight.run(0.09)
    flight.packets.clear()
    flight.call(flight.cfe.time.external_tone)
    assert flight.events() == told(21, "Stop FLYWHEEL")
    assert diagnostic(flight)["ToneMatchCounter"] == 1


def test_cTIME2018_a_message_triggers_the_one_hz_cycle(fly: Fly) -> None:
    flight = fly(**ON_ITS_OWN)
    flight.send(pk.ADD_ONE_HZ_ADJUSTMENT, Seconds=1)
    before = flight.cfe.time.get_stcf().seconds
    flight.transmit(pk.ONEHZ_CMD.packet())
    flight.transmit(pk.ONEHZ_CMD.packet())
    assert flight.cfe.time.get_stcf().seconds == before + 2


def test_cTIME2019_met(flight: Flight) -> None:
    to_next_second(flight)
    assert flight.send(pk.SET_MET, Seconds=7000) == told(13, "Set MET -- secs = 7000, usecs = 0, ssecs = 0x0")
    assert flight.cfe.time.get_met().seconds == 7000
    flight.run(3)
    assert flight.cfe.time.get_met().seconds == 7003
    assert flight.cfe.time.get_stcf() == (1_000_000, 0)


def test_cTIME2012_a_lost_tone_starts_flywheel_mode_once(fly: Fly) -> None:
    """Tones stop: after two seconds the clock says so and goes on; a tone that comes back ends it."""
    flight = fly(pk.DIAG_TLM_MID, **ON_ITS_OWN)
    flight.send(pk.SET_STATE, ClockState=CLOCK_VALID)
    for _ in range(3):
        tone(flight)
        flight.run(1 - 0.002)
    assert flight.cfe.time.get_clock_state() == CLOCK_VALID
    assert flight.cfe.time.get_clock_info() & 0x20
    flight.packets.clear()
    met = flight.cfe.time.get_met()
    flight.run(20)
    assert flight.events() == told(20, "Start FLYWHEEL")
    assert flight.cfe.time.get_clock_state() == CLOCK_FLYWHEEL
    assert flight.cfe.time.get_clock_info() & 0x4C00 == 0x4800
    assert diagnostic(flight)["ServerFlyState"] == 1
    assert subtract(flight.cfe.time.get_met(), met).seconds == 20
    flight.packets.clear()
    tone(flight)
    assert flight.events() == told(21, "Stop FLYWHEEL")
    assert flight.cfe.time.get_clock_state() == CLOCK_VALID


# -- resets --------------------------------------------------------------------------------------------------------


def change_everything(flight: Flight) -> None:
    """Set what a reset may keep, and let housekeeping save it."""
    flight.send(pk.SET_STATE, ClockState=CLOCK_VALID)
    flight.send(pk.SET_MET, Seconds=50_000)
    flight.send(pk.SET_STCF, Seconds=5)
    flight.send(pk.SET_LEAP_SECONDS, LeapSeconds=3)
    housekeeping(flight)


def test_cTIME2500_power_on_reset(flight: Flight) -> None:
    change_everything(flight)
    flight.reset(POWERON_RESET)
    time = flight.cfe.time
    assert (time.get_met().seconds, time.get_stcf(), time.get_leap_seconds()) == (1003, (1_000_000, 0), 37)
    assert time.get_clock_state() == CLOCK_INVALID
    assert diagnostic(flight)["DataStoreStatus"] == 3


@covers("cTIME2501", "cTIME2502", "cTIME2700")
def test_cTIME2501_processor_reset(flight: Flight) -> None:
    change_everything(flight)
    flight.run(10)  # nobody saves the time of these
    flight.reset(PROCESSOR_RESET)
    time = flight.cfe.time
    assert (time.get_met().seconds, time.get_stcf(), time.get_leap_seconds()) == (50_003, (5, 0), 3)
    assert diagnostic(flight)["DataStoreStatus"] == 4


@covers("cTIME2502", "cTIME2502.1")
def test_cTIME2502_1_a_damaged_data_store_is_not_used(flight: Flight) -> None:
    change_everything(flight)
    kept = flight.cfe.psp.retained.kept
    kept["TIME"] = b"\xff" + kept["TIME"][1:]
    flight.reset(PROCESSOR_RESET)
    time = flight.cfe.time
    assert (time.get_met().seconds, time.get_stcf(), time.get_leap_seconds()) == (1003, (1_000_000, 0), 37)
    assert diagnostic(flight)["DataStoreStatus"] == 3
