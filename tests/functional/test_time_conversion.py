"""Times in other units (time_conversion_test.c)."""

from __future__ import annotations

from cfepy.app import Cfe


def test_convert_met_into_spacecraft_time(cfe: Cfe) -> None:
    cfe.os.task_delay(345)
    met = cfe.time.get_met()
    assert cfe.time.met2sc_time(met) == cfe.time.get_time()
    assert met.subseconds > 0, "not a moment at which nothing could be wrong"


def test_convert_sub_seconds_into_micro_seconds(cfe: Cfe) -> None:
    assert cfe.time.sub2micro_secs(31000) == 7


def test_convert_micro_seconds_into_sub_seconds(cfe: Cfe) -> None:
    assert cfe.time.micro2sub_secs(64512) == 277076931
    assert cfe.time.micro2sub_secs(999999 + 1) == 0xFFFFFFFF
