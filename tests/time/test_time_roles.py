"""Processors other than a server with a simulated tone: clients, external sources, predicted tones, UTC."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from cfepy.config.platform import PlatformConfig
from cfepy.msg import get_msg_id
from cfepy.status import CFE_TIME_NOT_IMPLEMENTED, CfeError, UsageError
from cfepy.time import CLOCK_FLYWHEEL, CLOCK_INVALID, CLOCK_VALID, SysTime
from cfepy.time import packets as pk
from cfepy.time.settings import TimeSettings
from tests.time.conftest import World

Make = Callable[..., World]
FLY_OFF, FLY_ON = (21, "Stop FLYWHEEL"), (20, "Start FLYWHEEL")
HALF = 0x80000000


def time_of(seconds: int, subseconds: int = 0) -> dict[str, int]:
    return {"Seconds": seconds, "Subseconds": subseconds}


def tell(world: World, met: int, state: int = CLOCK_VALID, stcf: int = 100, leaps: int = 10) -> None:
    """A tone, and after 50 ms the server's message about it."""
    world.call(world.time.external_tone)
    world.run(0.05)
    world.transmit_msg(
        pk.DATA_CMD.packet(AtToneMET=time_of(met), AtToneSTCF=time_of(stcf), AtToneLeapSeconds=leaps, AtToneState=state)
    )
    world.run(0.95)


def time_command(world: World, code: int, seconds: int, micros: int = 0) -> None:
    world.command(code, pk.TIME_COMMAND.pack(Seconds=seconds, MicroSeconds=micros))


def client_of(make: Make, **config: Any) -> World:
    world = make(time_cfg_client=True, time_cfg_fake_tone=False, **config)
    world.start()
    world.run(0.5)
    world.events.clear()
    world.packets.clear()
    return world


@pytest.fixture
def client(make: Make) -> World:
    """A client half a second before its first tone."""
    return client_of(make)


# -- clients -------------------------------------------------------------------------------------------------------


def test_client_accepts_the_complete_time_of_the_server(client: World) -> None:
    assert client.time.get_clock_info() & 0x40 == 0
    tell(client, 5000)
    time = client.time
    assert client.events == [FLY_OFF]
    assert time.get_met() == (5001, 0)
    assert (time.get_stcf(), time.get_leap_seconds()) == ((100, 0), 10)
    assert (time.get_tai(), time.get_utc()) == ((5101, 0), (5091, 0))
    assert time.get_clock_state() == CLOCK_VALID
    tell(client, 5003)
    assert time.get_met() == (5004, 0)
    assert time.get_clock_info() == 0xB3A0


def test_client_reports_the_state_of_the_server(client: World) -> None:
    tell(client, 5000, CLOCK_FLYWHEEL)
    assert client.time.get_clock_state() == CLOCK_FLYWHEEL
    assert client.time.get_clock_info() & 0xC800 == 0x8800
    tell(client, 5001, CLOCK_INVALID)
    assert client.time.get_clock_state() == CLOCK_INVALID
    assert client.time.get_clock_info() & 0xC800 == 0


def test_client_does_not_send_the_time_to_others(client: World) -> None:
    tell(client, 5000)
    tell(client, 5001)
    client.transmit_msg(pk.SEND_CMD.packet())
    client.run(1)
    own = [packet for packet in client.packets if get_msg_id(packet) == pk.DATA_CMD_MID]
    assert len(own) == 2  # both are the server's, which the test delivered
    assert [get_msg_id(packet) for packet in client.packets].count(pk.TONE_CMD_MID) == 1


def test_client_corrects_for_the_delay_of_the_tone(client: World) -> None:
    tell(client, 5000)
    time_command(client, pk.ADD_DELAY_CC, 1, 500_000)
    assert client.events[-1] == (11, "Set Tone Delay -- secs = 1, usecs = 500000, ssecs = 0x80000000, dir = 1")
    assert client.time.get_met() == (5002, HALF)
    assert client.housekeeping()["AdjustmentFactor"] == time_of(1, HALF)
    time_command(client, pk.SUB_DELAY_CC, 0, 500_000)
    assert client.time.get_met() == (5000, HALF)
    assert client.time.get_clock_info() & 0x80 == 0
    assert client.diagnostic()["DelayDirection"] == 2
    assert client.diagnostic()["AtToneDelay"] == time_of(0, HALF)


@pytest.mark.parametrize(("safe", "again"), [(False, 4), (True, 0)], ids=["as_nasas", "safe"])
def test_client_without_tones_enters_flywheel_and_gains_its_delay_unless_safe(
    make: Make, safe: bool, again: int
) -> None:
    client = client_of(make, safe=safe)
    tell(client, 5000)
    time_command(client, pk.ADD_DELAY_CC, 1)
    client.events.clear()
    client.run(2.6)
    assert client.events == [FLY_ON]
    assert client.time.get_clock_info() & 0x4800 == 0x4000
    client.run(29.9)
    assert client.time.get_met() == (5034 + again, HALF), "the reference moves every 8 s"
    assert client.time.clock.since_tone() >> 32 < 9
    tell(client, 5040)
    assert client.events == [FLY_ON, FLY_OFF]
    assert client.time.get_met() == (5042, 0)


@pytest.mark.parametrize(("safe", "again"), [(False, 2), (True, 0)], ids=["as_nasas", "safe"])
def test_client_gains_its_delay_at_a_reset_unless_safe(make: Make, safe: bool, again: int) -> None:
    client = client_of(make, safe=safe)
    tell(client, 5000)
    time_command(client, pk.ADD_DELAY_CC, 2)
    before = client.time.get_met()
    client.housekeeping()  # keeps the values for the next start
    after = make(time_cfg_client=True, time_cfg_fake_tone=False, safe=safe, kept=client.kept, start_ns=0)
    assert after.time.get_met()[0] == before[0] + again


@pytest.mark.parametrize(
    ("code", "payload", "event_id", "what"),
    [
        (pk.SET_TIME_CC, bytes(8), 43, "Set Time"),
        (pk.SET_MET_CC, bytes(8), 44, "Set MET"),
        (pk.SET_STCF_CC, bytes(8), 45, "Set STCF"),
        (pk.SET_LEAP_SECONDS_CC, bytes(2), 46, "Set Leaps"),
        (pk.ADD_ADJUST_CC, bytes(8), 47, "STCF Adjust"),
        (pk.SUB_ADJUST_CC, bytes(8), 47, "STCF Adjust"),
        (pk.ADD_ONE_HZ_ADJUSTMENT_CC, bytes(8), 48, "1Hz Adjust"),
        (pk.SUB_ONE_HZ_ADJUSTMENT_CC, bytes(8), 48, "1Hz Adjust"),
    ],
)
def test_time_of_a_client_cannot_be_set_by_command(
    client: World, code: int, payload: bytes, event_id: int, what: str
) -> None:
    client.command(code, payload)
    text = f"{what} commands invalid without CFE_PLATFORM_TIME_CFG_SERVER set to TRUE"
    assert client.events == [(event_id, text)]
    assert client.command_counters() == (0, 1)


def test_client_with_a_simulated_tone_keeps_its_own_seconds(make: Make) -> None:
    client = make(time_cfg_client=True)
    client.start()
    client.run(1.05)
    client.transmit_msg(pk.DATA_CMD.packet(AtToneMET=time_of(77), AtToneState=CLOCK_VALID))
    client.run(0.45)
    assert client.time.get_met() == (77, HALF)
    assert client.time.get_clock_state() == CLOCK_VALID


# -- windows -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("pause", "matches"), [(0, 1), (0.2, 1), (0.200001, 0), (1.1, 0)])
def test_message_must_follow_its_tone_within_the_window(client: World, pause: float, matches: int) -> None:
    client.call(client.time.external_tone)
    client.run(pause)
    client.transmit_msg(pk.DATA_CMD.packet(AtToneMET=time_of(5000)))
    client.run(0.01)
    counters = client.time.tone.counters
    assert (counters.tone_match, counters.tone_match_error) == (matches, 1 - matches)


def test_message_counts_once(client: World) -> None:
    tell(client, 5000)
    client.transmit_msg(pk.DATA_CMD.packet(AtToneMET=time_of(7000)))
    client.run(0.01)
    assert client.time.tone.counters.tone_match_error == 1
    assert client.time.get_met_seconds() == 5001


@pytest.mark.parametrize(("micros", "good"), [(980_001, True), (980_000, False), (1_019_999, True), (1_020_000, False)])
def test_tone_is_accepted_a_second_after_the_last(client: World, micros: int, good: bool) -> None:
    client.call(client.time.external_tone)
    client.run(micros / 1e6)
    client.call(client.time.external_tone)
    assert bool(client.time.get_clock_info() & 0x20) == good


# -- external sources ----------------------------------------------------------------------------------------------


def source(make: Make, kind: str, **config: bool) -> World:
    """Return a server with an external source, at its first tone."""
    world = make(time_cfg_source=True, time_cfg_fake_tone=False, **{f"time_cfg_src_{kind}": True}, **config)
    world.start()
    world.run(0.5)
    world.call(world.time.external_tone)
    world.events.clear()
    return world


def test_an_external_met(make: Make) -> None:
    world = source(make, "met")
    assert world.time.get_clock_info() & 0x2000 == 0
    world.call(lambda: world.time.external_met((2000, 0)))
    world.run(0.25)
    assert world.events == [FLY_OFF]
    assert world.time.get_met() == (2000, 0x40000000)
    assert world.time.get_stcf() == (1_000_000, 0)
    assert world.diagnostic()["VirtualMET"] == 2000


@pytest.mark.parametrize(("new_met", "sent"), [(2001, 2001), (2002, 2000), (1999, 2000)])
def test_set_clock_refuses_a_time_beyond_its_limit(make: Make, new_met: int, sent: int) -> None:
    """The limit is half a second. Beyond it, the server sends its own time."""
    world = source(make, "met")
    world.call(lambda: world.time.external_met((2000, 0)))
    world.run(0.01)
    world.command(pk.SET_STATE_CC, b"\0\0")
    world.run(0.99)
    world.call(world.time.external_tone)
    world.call(lambda: world.time.external_met((new_met, 0)))
    world.run(0.01)
    assert world.tone_data()["AtToneMET"] == time_of(2001 if sent == 2000 else sent)
    assert world.time.get_met_seconds() == 2001


def test_external_source_can_be_disabled(make: Make) -> None:
    world = source(make, "met")
    world.command(pk.SET_SOURCE_CC, b"\1\0")
    assert world.events == [(8, "Set Time Source = INTERNAL")]
    world.call(lambda: world.time.external_met((2000, 0)))
    world.run(0.01)
    assert world.tone_data()["AtToneMET"] == time_of(1000)
    world.command(pk.SET_SOURCE_CC, b"\2\0")
    assert world.events[-1] == (8, "Set Time Source = EXTERNAL")
    assert world.housekeeping()["ClockStateFlags"] & 0x2000 == 0


def test_gps_time_sets_stcf_and_leap_seconds(make: Make) -> None:
    world = source(make, "gps")
    world.call(lambda: world.time.external_gps((3_001_000, HALF), 20))
    world.run(0.01)
    assert world.time.get_stcf() == (3_000_000, HALF)
    assert world.time.get_leap_seconds() == 20
    assert world.time.get_met_seconds() == 1000


def test_external_time_sets_only_the_stcf(make: Make) -> None:
    world = source(make, "time")
    world.call(lambda: world.time.external_time((3_001_000, 0)))
    world.run(0.01)
    assert world.time.get_stcf() == (3_000_000, 0)
    assert world.time.get_leap_seconds() == 37


def test_leap_seconds_are_added_to_external_utc(make: Make) -> None:
    world = source(make, "time", time_cfg_default_utc=True)
    world.call(lambda: world.time.external_time((3_001_000, 0)))
    world.run(0.5)
    assert world.time.get_time() == (3_001_000, HALF)
    assert world.time.get_tai() == (3_001_037, HALF)


@pytest.mark.parametrize("call", ["external_met", "external_gps", "external_time"])
def test_external_time_without_a_source_is_not_implemented(world: World, call: str) -> None:
    more = (5,) if call == "external_gps" else ()
    with pytest.raises(CfeError) as caught:
        getattr(world.time, call)((1000, 0), *more)
    assert caught.value.status == CFE_TIME_NOT_IMPLEMENTED


def test_tone_signal_can_be_switched_and_keeps_its_setting_over_a_reset(make: Make) -> None:
    world = make(time_cfg_signal=True)
    world.command(pk.SET_SIGNAL_CC, b"\2\0")
    assert world.events == [(9, "Set Tone Source = REDUNDANT")]
    assert world.housekeeping()["ClockStateFlags"] & 0x1000 == 0
    after = make(time_cfg_signal=True, kept=world.kept)
    assert after.diagnostic()["ClockSignal"] == 2
    after.command(pk.SET_SIGNAL_CC, b"\1\0")
    assert after.events[-1] == (9, "Set Tone Source = PRIMARY")


# -- foretold tones, UTC, contradictions ---------------------------------------------------------------------------


def test_message_may_announce_the_tone(make: Make) -> None:
    world = make(time_at_tone_will_be=True, time_cfg_fake_tone=False)
    world.start()
    world.run(0.9)
    world.call(world.time.external_tone)
    world.run(0.9)
    world.transmit_msg(pk.SEND_CMD.packet())
    world.run(0.1)
    assert world.tone_data()["AtToneMET"] == time_of(1002)
    assert world.events[1:] == []
    world.call(world.time.external_tone)
    world.run(0.01)
    assert world.events[1:] == [FLY_OFF]
    assert world.time.tone.counters.tone_match == 1


def test_spacecraft_time_can_be_utc(make: Make) -> None:
    world = make(time_cfg_default_utc=True)
    time = world.time
    assert time.get_time() == time.get_utc() == time.now() == (1_001_000 - 37, 0)
    assert time.stamp() == 1_000_963 << 16
    assert time.met2sc_time((1000, 0)) == SysTime(1_000_963, 0)
    jumps = world.jumps
    world.command(pk.SET_LEAP_SECONDS_CC, b"\x26\0")
    assert time.get_time() == (1_001_000 - 38, 0)
    assert world.jumps == jumps + 1
    time_command(world, pk.SET_TIME_CC, 5_000_000)
    assert time.get_time() == (5_000_000, 0)


@pytest.mark.parametrize(
    ("config", "field"),
    [
        ({"time_cfg_client": True, "time_cfg_source": True}, "client"),
        ({"time_cfg_src_gps": True}, "src_gps"),
        ({"time_cfg_source": True, "time_cfg_fake_tone": False}, "source"),
        ({"time_cfg_source": True, "time_cfg_src_met": True}, "source"),
        (
            {"time_cfg_source": True, "time_cfg_fake_tone": False, "time_cfg_src_met": True, "time_cfg_src_gps": True},
            "source",
        ),
        ({"time_at_tone_will_be": True}, "fake_tone"),
    ],
)
def test_contradictory_configuration_is_refused(config: dict[str, bool], field: str) -> None:
    with pytest.raises(UsageError) as caught:
        TimeSettings.of(PlatformConfig(**config))  # type: ignore[arg-type]
    assert caught.value.field == f"limits.time_cfg_{field}"
