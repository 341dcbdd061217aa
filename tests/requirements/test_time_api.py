"""Time Services, requirement by requirement: requests of applications (cTIME2300 to 2323)."""

from __future__ import annotations

import pytest

from cfepy.status import CFE_TIME_CALLBACK_NOT_REGISTERED, CFE_TIME_TOO_MANY_SYNCH_CALLBACKS, CfeError
from cfepy.time import A_GT_B, A_LT_B, CLOCK_FLYWHEEL, CLOCK_INVALID, CLOCK_VALID, EQUAL
from cfepy.time import packets as pk
from tests.requirements.clock import HALF, Fly, to_next_second
from tests.requirements.covers import covers
from tests.requirements.flight import Flight

EXTERNAL = {"time_cfg_fake_tone": False, "time_cfg_source": True}


@pytest.fixture
def flight(fly: Fly) -> Flight:
    return fly()


@covers("cTIME2300", "cTIME2301", "cTIME2302", "cTIME2303", "cTIME2304", "cTIME2305", "cTIME2306", "cTIME2307")
def test_cTIME2300_the_times_of_an_instant(flight: Flight) -> None:
    flight.run_for(0.25 - flight.mission.kernel.now % 10**9 / 1e9 + 1)
    time = flight.cfe.time

    def ask() -> tuple[object, ...]:
        met = time.get_met()
        assert (time.get_met_seconds(), time.get_met_subsecs()) == met
        assert time.add(met, time.get_stcf()) == time.get_tai() == time.get_time()
        assert time.subtract(time.get_tai(), (time.get_leap_seconds(), 0)) == time.get_utc()
        return met, time.get_stcf(), time.get_leap_seconds()

    assert flight.call(ask) == ((1004, 0x40000000), (1_000_000, 0), 37)


def test_cTIME2302_the_default_may_be_utc(fly: Fly) -> None:
    time = fly(time_cfg_default_utc=True).cfe.time
    assert time.get_time() == time.get_utc()
    assert time.subtract(time.get_tai(), time.get_time()) == (37, 0)


@covers("cTIME2308", "cTIME2320")
def test_cTIME2308_clock_state_and_flags(flight: Flight) -> None:
    time = flight.cfe.time
    assert (time.get_clock_state(), time.get_clock_info()) == (CLOCK_INVALID, 0x33E0)
    flight.send(pk.SET_STATE, ClockState=CLOCK_VALID)
    assert (time.get_clock_state(), time.get_clock_info()) == (CLOCK_VALID, 0xB3E0)
    flight.send(pk.SET_STATE, ClockState=CLOCK_FLYWHEEL)
    flight.send(pk.SUB_ADJUST, Seconds=1)
    flight.send(pk.SUB_ONE_HZ_ADJUSTMENT, Seconds=0)
    assert (time.get_clock_state(), time.get_clock_info()) == (CLOCK_FLYWHEEL, 0xFCE0)


def test_cTIME2320_flags_of_other_boards(fly: Fly) -> None:
    """An external source, the redundant signal and no tone yet; and a client with a tone that arrives too early."""
    external = fly(**EXTERNAL, time_cfg_src_met=True, time_cfg_signal=True)
    external.send(pk.SET_SIGNAL, ToneSource=2)
    assert external.cfe.time.get_clock_info() == 0x4BC0
    client = fly(time_cfg_client=True, time_cfg_fake_tone=False)
    client.send(pk.SUB_DELAY, MicroSeconds=1000)
    assert client.cfe.time.get_clock_info() == 0x7B00


@covers("cTIME2309", "cTIME2310", "cTIME2311")
def test_cTIME2309_arithmetic(flight: Flight) -> None:
    time = flight.cfe.time
    assert time.add((1000, HALF), (1, HALF)) == (1002, 0)
    assert time.subtract((1000, 0), (1, HALF)) == (998, HALF)
    assert [time.compare(first, (5, 5)) for first in ((5, 4), (5, 5), (5, 6))] == [A_LT_B, EQUAL, A_GT_B]
    assert time.compare((1, 1), (0xFFFFFFFF, 0xFFFFFFFF)) == A_GT_B


@covers("cTIME2312", "cTIME2313")
def test_cTIME2312_conversions(flight: Flight) -> None:
    assert flight.cfe.time.sub2micro_secs(31000) == 7
    assert flight.cfe.time.micro2sub_secs(64512) == 277076931
    assert flight.cfe.time.micro2sub_secs(1_000_000) == 0xFFFFFFFF


@pytest.mark.parametrize(
    ("time", "text"),
    [
        ((0, 0), "1980-001-00:00:00.00000"),
        ((31_622_400, HALF), "1981-001-00:00:00.50000"),
        ((31_622_399 - 8 * 3600 - 7 * 60 - 6, 0x00100000), "1980-366-15:52:53.00024"),
    ],
)
def test_cTIME2314_readable_format(flight: Flight, time: tuple[int, int], text: str) -> None:
    assert flight.cfe.time.print_(time) == text


def external(fly: Fly, kind: str) -> Flight:
    flight = fly(pk.DATA_CMD_MID, **EXTERNAL, **{f"time_cfg_src_{kind}": True})
    flight.call(flight.cfe.time.external_tone)
    flight.packets.clear()
    return flight


def test_cTIME2315_tone_data_for_an_external_met(fly: Fly) -> None:
    flight = external(fly, "met")
    flight.call(lambda: flight.cfe.time.external_met((9000, 0)))
    (data,) = flight.all(pk.DATA_CMD)
    assert data["AtToneMET"] == {"Seconds": 9000, "Subseconds": 0}
    assert (data["AtToneSTCF"]["Seconds"], data["AtToneLeapSeconds"], data["AtToneState"]) == (1_000_000, 37, -1)
    assert flight.cfe.time.get_met_seconds() == 9000


def test_cTIME2316_tone_data_for_an_external_time_and_leap_seconds(fly: Fly) -> None:
    flight = external(fly, "gps")
    flight.call(lambda: flight.cfe.time.external_gps((3_001_003, 0), 20))
    (data,) = flight.all(pk.DATA_CMD)
    assert data["AtToneMET"] == {"Seconds": 1003, "Subseconds": 0}
    assert (data["AtToneSTCF"]["Seconds"], data["AtToneLeapSeconds"]) == (3_000_000, 20)
    assert (flight.cfe.time.get_stcf(), flight.cfe.time.get_leap_seconds()) == ((3_000_000, 0), 20)


def test_cTIME2317_tone_data_for_an_external_time(fly: Fly) -> None:
    flight = external(fly, "time")
    flight.call(lambda: flight.cfe.time.external_time((3_001_003, 0)))
    (data,) = flight.all(pk.DATA_CMD)
    assert data["AtToneMET"] == {"Seconds": 1003, "Subseconds": 0}
    assert (data["AtToneSTCF"]["Seconds"], data["AtToneLeapSeconds"]) == (3_000_000, 37)
    assert flight.cfe.time.get_stcf() == (3_000_000, 0)


@covers("cTIME2318", "cTIME2319")
def test_cTIME2318_synchronization_callbacks(flight: Flight) -> None:
    time, calls = flight.cfe.time, list[int]()

    def callback() -> None:
        calls.append(time.get_met_seconds())

    to_next_second(flight)
    flight.call(lambda: time.register_synch_callback(callback))
    with pytest.raises(CfeError) as caught:
        flight.call(lambda: time.register_synch_callback(print))
    assert caught.value.status == CFE_TIME_TOO_MANY_SYNCH_CALLBACKS
    flight.run_for(2.5)
    assert calls == [1005, 1006]
    flight.call(lambda: time.unregister_synch_callback(callback))
    with pytest.raises(CfeError) as caught:
        flight.call(lambda: time.unregister_synch_callback(callback))
    assert caught.value.status == CFE_TIME_CALLBACK_NOT_REGISTERED
    flight.run_for(2.5)
    assert calls == [1005, 1006]


@pytest.mark.parametrize(("utc", "seconds"), [(False, 1_001_000), (True, 1_000_963)])
def test_cTIME2321_spacecraft_time_of_a_met(fly: Fly, utc: bool, seconds: int) -> None:
    assert fly(time_cfg_default_utc=utc).cfe.time.met2sc_time((1000, 7)) == (seconds, 7)


def test_cTIME2322_the_api_triggers_the_one_hz_cycle(fly: Fly) -> None:
    flight = fly(pk.DIAG_TLM_MID, time_cfg_fake_tone=False)
    flight.send(pk.ADD_ONE_HZ_ADJUSTMENT, Seconds=1)
    before = flight.ask(pk.SEND_DIAGNOSTIC, pk.DIAG_TLM)
    flight.call(flight.cfe.time.local1hz_isr)
    after = flight.ask(pk.SEND_DIAGNOSTIC, pk.DIAG_TLM)
    for counter in ("LocalIntCounter", "LocalTaskCounter"):
        assert after[counter] == before[counter] + 1
    assert after["AtToneSTCF"]["Seconds"] == before["AtToneSTCF"]["Seconds"] + 1


def test_cTIME2323_the_api_triggers_tone_processing(fly: Fly) -> None:
    flight = fly(pk.DIAG_TLM_MID, time_cfg_fake_tone=False)
    calls: list[str] = []
    flight.call(lambda: flight.cfe.time.register_synch_callback(lambda: calls.append("tone")))
    for _ in range(3):
        flight.call(flight.cfe.time.external_tone)
        flight.run_for(1 - 0.001)
    values = flight.ask(pk.SEND_DIAGNOSTIC, pk.DIAG_TLM)
    assert (values["ToneIntCounter"], values["ToneIntErrorCounter"]) == (2, 1)
    assert (values["ToneSignalCounter"], values["ToneTaskCounter"]) == (2, 2)
    assert calls == ["tone", "tone"]
