"""Time Services, requirement by requirement: the time at the tone (cTIME2012, 2015 to 2018, 2020, 2021)."""

from __future__ import annotations

import pytest

from cfepy.msg import Command, get_msg_id
from cfepy.time import CLOCK_FLYWHEEL, CLOCK_INVALID, CLOCK_VALID, SysTime, subtract
from cfepy.time import packets as pk
from tests.requirements.clock import HALF, ON_ITS_OWN, Fly, diagnostic, to_next_second, told, tone
from tests.requirements.covers import covers
from tests.requirements.flight import Flight


@pytest.fixture
def flight(fly: Fly) -> Flight:
    return fly(pk.HK_TLM_MID, pk.DIAG_TLM_MID, pk.DATA_CMD_MID)


@covers("cTIME2012", "cTIME2012.1", "cTIME2012.2")
def test_cTIME2012_tones_are_used_or_ignored(flight: Flight) -> None:
    time = flight.cfe.time
    flight.send(pk.SET_STATE, ClockState=CLOCK_VALID)
    assert time.get_clock_state() == CLOCK_VALID
    assert flight.send(pk.SET_STATE, ClockState=CLOCK_FLYWHEEL) == told(7, "Set Clock State = FLYWHEEL")
    before, matches = time.get_met(), diagnostic(flight)["ToneMatchCounter"]
    flight.run_for(20)
    values = diagnostic(flight)
    assert (time.get_clock_state(), values["Forced2Fly"]) == (CLOCK_FLYWHEEL, 1)
    assert values["ToneMatchCounter"] > matches
    assert values["AtToneLatch"] != values["ToneSignalLatch"], "the tones did not set the clock"
    assert 20 <= subtract(time.get_met(), before).seconds <= 21
    flight.send(pk.SET_STATE, ClockState=CLOCK_VALID)
    to_next_second(flight)
    assert flight.events()[-1:] == told(21, "Stop FLYWHEEL")
    assert time.get_clock_state() == CLOCK_VALID
    values = diagnostic(flight)
    assert values["AtToneLatch"] == values["ToneSignalLatch"]


def test_cTIME2012_2_a_client_follows_a_server(fly: Fly) -> None:
    """Two processors: the tone is a wire between them, the time at the tone is a message that a link brings over."""
    server = fly(pk.TONE_CMD_MID, pk.DATA_CMD_MID)
    client = fly(pk.DATA_CMD_MID, time_cfg_client=True, time_cfg_fake_tone=False)
    server.send(pk.SET_TIME, Seconds=9_000_000)
    server.send(pk.SET_STATE, ClockState=CLOCK_VALID)
    for _ in range(300):
        server.packets.clear()
        server.run_for(0.01)
        client.run_for(0.01)
        if server.all(pk.TONE_CMD):
            client.call(client.cfe.time.external_tone)
            (packet,) = (packet for packet in server.packets if get_msg_id(packet) == pk.DATA_CMD_MID)
            client.transmit(packet)
    apart = subtract(client.cfe.time.get_time(), server.cfe.time.get_time())
    assert min(apart, subtract((0, 0), apart)) < SysTime(0, 0x4000000)  # 16 ms: steps of this test are 10 ms
    assert client.cfe.time.get_leap_seconds() == 37
    assert client.cfe.time.get_clock_state() == CLOCK_VALID
    assert client.send(pk.SET_MET, Seconds=1)[0].event_id == 44


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
    values = diagnostic(flight)
    assert values["AtToneLatch"] == values["ToneSignalLatch"]
    flight.transmit(pk.SEND_CMD.packet())  # data without a new tone
    after = diagnostic(flight)
    assert (after["ToneMatchCounter"], after["ToneMatchErrorCounter"]) == (1, 1)
    assert after["AtToneLatch"] == values["AtToneLatch"]


def test_cTIME2017_a_tone_after_data_updates_the_time(fly: Fly) -> None:
    flight = fly(pk.DIAG_TLM_MID, time_at_tone_will_be=True, **ON_ITS_OWN)
    flight.call(flight.cfe.time.external_tone)
    flight.run_for(0.9)
    flight.transmit(pk.SEND_CMD.packet())
    assert diagnostic(flight)["ToneMatchCounter"] == 0
    flight.run_for(0.09)
    flight.packets.clear()
    flight.call(flight.cfe.time.external_tone)
    assert flight.events() == told(21, "Stop FLYWHEEL")
    values = diagnostic(flight)
    assert (values["ToneMatchCounter"], values["ToneMatchErrorCounter"]) == (1, 0)
    assert values["AtToneLatch"] == values["ToneSignalLatch"]
    flight.transmit(pk.TONE_CMD.packet())  # told again of the same tone
    flight.run_for(0.99)
    flight.call(flight.cfe.time.external_tone)  # a tone without data
    after = diagnostic(flight)
    assert (after["ToneMatchCounter"], after["ToneMatchErrorCounter"]) == (1, 2)
    assert after["AtToneLatch"] == values["AtToneLatch"] != after["ToneSignalLatch"]


def test_cTIME2018_a_message_triggers_the_one_hz_cycle(fly: Fly) -> None:
    flight = fly(**ON_ITS_OWN)
    flight.send(pk.ADD_ONE_HZ_ADJUSTMENT, Seconds=1)
    before = flight.cfe.time.get_stcf().seconds
    flight.transmit(pk.ONEHZ_CMD.packet())
    flight.transmit(pk.ONEHZ_CMD.packet())
    assert flight.cfe.time.get_stcf().seconds == before + 2


def test_a_lost_tone_starts_flywheel_mode_once(fly: Fly) -> None:
    """Without tones, the clock enters flywheel mode after two seconds and continues. A new tone ends it."""
    flight = fly(pk.DIAG_TLM_MID, **ON_ITS_OWN)
    flight.send(pk.SET_STATE, ClockState=CLOCK_VALID)
    for _ in range(3):
        tone(flight)
        flight.run_for(1 - 0.002)
    assert flight.cfe.time.get_clock_state() == CLOCK_VALID
    assert flight.cfe.time.get_clock_info() & 0x20
    flight.packets.clear()
    met = flight.cfe.time.get_met()
    flight.run_for(20)
    assert flight.events() == told(20, "Start FLYWHEEL")
    assert flight.cfe.time.get_clock_state() == CLOCK_FLYWHEEL
    assert flight.cfe.time.get_clock_info() & 0x4C00 == 0x4800
    assert diagnostic(flight)["ServerFlyState"] == 1
    assert subtract(flight.cfe.time.get_met(), met).seconds == 20
    flight.packets.clear()
    tone(flight)
    assert flight.events() == told(21, "Stop FLYWHEEL")
    assert flight.cfe.time.get_clock_state() == CLOCK_VALID


def follow(client: Flight, second: int) -> None:
    """A tone, and a server's message that it was at this second of MET."""
    client.run_for(0.998)
    client.call(client.cfe.time.external_tone)
    times = {"AtToneMET": time_of(second), "AtToneSTCF": time_of(1_000_000)}
    client.transmit(pk.DATA_CMD.packet(**times, AtToneLeapSeconds=37, AtToneState=CLOCK_VALID))


def time_of(seconds: int, subseconds: int = 0) -> dict[str, int]:
    return {"Seconds": seconds, "Subseconds": subseconds}


def is_about(time: SysTime, seconds: float) -> bool:
    """Return whether a time is this one, or up to 10 ms later, the duration of a test's steps."""
    return 0 <= time.seconds + time.subseconds / 2**32 - seconds < 0.01


@pytest.mark.parametrize(("command", "sign"), [(pk.ADD_DELAY, 1), (pk.SUB_DELAY, -1)], ids=["add", "subtract"])
@covers("cTIME2020", "cTIME2021")
def test_cTIME2020_time_is_adjusted_beside_tone_and_stcf(fly: Fly, command: Command, sign: int) -> None:
    """A client's adjustment stays, with any tones and tone messages, until a command removes it."""
    client = fly(pk.DIAG_TLM_MID, time_cfg_client=True, time_cfg_fake_tone=False)
    follow(client, 5000)
    assert is_about(client.cfe.time.get_met(), 5000)
    amount = "secs = 2, usecs = 500000, ssecs = 0x80000000"
    direction = 1 if sign > 0 else 2
    expected = told(11, f"Set Tone Delay -- {amount}, dir = {direction}")
    assert client.send(command, Seconds=2, MicroSeconds=500_000) == expected
    assert is_about(client.cfe.time.get_met(), 5000 + 2.5 * sign)
    for second in (5001, 5002):
        follow(client, second)
        assert is_about(client.cfe.time.get_met(), second + 2.5 * sign)
        assert is_about(client.cfe.time.get_time(), 1_000_000 + second + 2.5 * sign)
        values = diagnostic(client)
        assert values["AtToneMET"] == time_of(second)
        assert values["AtToneSTCF"] == time_of(1_000_000)
        assert (values["AtToneDelay"], values["DelayDirection"]) == (time_of(2, HALF), direction)
    client.send(command)
    assert is_about(client.cfe.time.get_met(), 5002)
