"""The current time, and the state of the clock (time_current_test.c)."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.time import telemetry as flags

UNUSED_FLAGS = 0x000F


def test_current_time(cfe: Cfe) -> None:
    time = cfe.time
    cfe.os.task_delay(345)
    assert time.get_time() == time.get_tai(), "the default time is TAI"
    assert time.add(time.get_met(), time.get_stcf()) == time.get_tai()
    assert time.subtract(time.get_tai(), (time.get_leap_seconds(), 0)) == time.get_utc()
    assert (time.get_met_seconds(), time.get_met_subsecs()) == time.get_met()
    before = time.get_met()
    cfe.os.task_delay(1500)
    passed = time.subtract(time.get_met(), before)
    assert passed.seconds == 1
    assert abs(passed.subseconds - 0x80000000) <= 1, "subseconds are rounded up"


def test_clock(cfe: Cfe) -> None:
    """This clock was never set, as NASA's without a commanded time."""
    info = cfe.time.get_clock_info()
    assert cfe.time.get_clock_state() == -1
    assert not info & flags.FLAG_CLKSET
    assert info & flags.FLAG_SRCINT
    assert info & flags.FLAG_SIGPRI
    assert not info & (flags.FLAG_REFERR | UNUSED_FLAGS)
