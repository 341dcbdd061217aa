"""Time Services, requirement by requirement: the time data that a reset keeps (cTIME2500 to 2700)."""

from __future__ import annotations

import pytest

from cfepy.time import CLOCK_INVALID, CLOCK_VALID
from cfepy.time import packets as pk
from tests.requirements.clock import Fly, diagnostic, housekeeping
from tests.requirements.covers import covers
from tests.requirements.flight import POWERON_RESET, PROCESSOR_RESET, Flight


def change_everything(flight: Flight) -> None:
    """Change everything that a reset may keep, and let housekeeping save it."""
    flight.send(pk.SET_STATE, ClockState=CLOCK_VALID)
    flight.send(pk.SET_MET, Seconds=50_000)
    flight.send(pk.SET_STCF, Seconds=5)
    flight.send(pk.SET_LEAP_SECONDS, LeapSeconds=3)
    flight.send(pk.SET_SIGNAL, ToneSource=2)
    housekeeping(flight)


@pytest.fixture
def switchable(fly: Fly) -> Flight:
    """Return a board whose tone signal can be switched."""
    return fly(pk.HK_TLM_MID, pk.DIAG_TLM_MID, time_cfg_signal=True)


def check_defaults(flight: Flight) -> None:
    """All is as the configuration has it."""
    time = flight.cfe.time
    assert (time.get_met().seconds, time.get_stcf(), time.get_leap_seconds()) == (1003, (1_000_000, 0), 37)
    assert time.get_clock_state() == CLOCK_INVALID
    values = diagnostic(flight)
    assert (values["ClockSignal"], values["DataStoreStatus"]) == (1, 3)


def test_cTIME2500_power_on_reset(switchable: Flight) -> None:
    flight = switchable
    change_everything(flight)
    flight.reset(POWERON_RESET)
    check_defaults(flight)


@covers("cTIME2501", "cTIME2502", "cTIME2700")
def test_cTIME2501_processor_reset(switchable: Flight) -> None:
    flight = switchable
    change_everything(flight)
    flight.run_for(10)  # the time of these is not saved
    flight.reset(PROCESSOR_RESET)
    time = flight.cfe.time
    assert (time.get_met().seconds, time.get_stcf(), time.get_leap_seconds()) == (50_003, (5, 0), 3)
    values = diagnostic(flight)
    assert (values["ClockSignal"], values["DataStoreStatus"]) == (2, 4)


@pytest.mark.parametrize("at", [0, 6], ids=["signature", "signal"])
@covers("cTIME2502", "cTIME2502.1")
def test_cTIME2502_1_a_damaged_data_store_is_not_used(switchable: Flight, at: int) -> None:
    flight = switchable
    change_everything(flight)
    kept = flight.cfe.psp.retained.kept
    damaged = bytearray(kept["TIME"])
    damaged[at] ^= 0xFF
    kept["TIME"] = bytes(damaged)
    flight.reset(PROCESSOR_RESET)
    check_defaults(flight)
