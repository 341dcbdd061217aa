"""The values in the page: how they are thinned and encoded, and the remark about missing ones."""

from __future__ import annotations

from base64 import b64decode
from typing import Any

import numpy
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cfepy.extra.reports import page_values
from cfepy.extra.reports.page_values import MISSING, STEPS, TimeBins, encoded, value_data, values_section
from cfepy.ground.series import Series, SeriesSet
from cfepy.mission import Seen


def decoded(line: dict[str, Any], count: int) -> list[float]:
    """Return the values as the page's script decodes them."""
    if "data" not in line:
        return [line["low"]] * count
    steps = numpy.frombuffer(b64decode(line["data"]), "<u2")
    return [float("nan") if step == MISSING else line["low"] + int(step) * line["step"] for step in steps]


@given(st.lists(st.floats(-1e9, 1e9) | st.just(float("nan")), min_size=1, max_size=50))
def test_decoded_values_are_exact_to_a_step(values: list[float]) -> None:
    array = numpy.array(values)
    found = numpy.array(decoded(encoded(array), len(values)))
    there = ~numpy.isnan(array)
    assert (numpy.isnan(found) == ~there).all()
    if there.any():
        reach = array[there].max() - array[there].min()
        assert numpy.abs(found[there] - array[there]).max() <= max(reach / STEPS, 1e-6)


@given(st.lists(st.integers(-30_000, 30_000), min_size=1, max_size=50))
def test_whole_numbers_in_a_narrow_range_are_exact(values: list[int]) -> None:
    assert decoded(encoded(numpy.array(values, float)), len(values)) == values


def test_infinite_values_are_missing() -> None:
    found = decoded(encoded(numpy.array([1.0, numpy.inf, 3.0])), 3)
    assert found[0] == 1.0
    assert numpy.isnan(found[1])
    assert numpy.isnan(decoded(encoded(numpy.array([numpy.nan, numpy.nan])), 2)).all()


def test_thinned_values_keep_the_lowest_and_highest_of_each_stretch() -> None:
    times, values = numpy.arange(1_000) / 100, numpy.zeros(1_000)
    values[123], values[456] = 7.0, -7.0
    bins = TimeBins.of(times, 50)
    thinned, steps = bins.thinned(values), bins.times_us()
    assert len(thinned) == len(steps) == 100
    assert (thinned.max(), thinned.min()) == (7.0, -7.0)
    at = numpy.cumsum(steps)
    assert (numpy.diff(at) > 0).all()
    assert abs(at[thinned.argmax()] - 1_230_000) <= 200_000
    assert TimeBins.of(times[:90], 50).thinned(values[:90]).tolist() == values[:90].tolist()


def a_set(fields: int, messages: int = 300, most: int | None = None) -> SeriesSet:
    """Return a topic with a small and one with a large message."""
    found = SeriesSet()
    for name, count in (("/large", fields), ("/small", 1)):
        series = Series(name, "x/Y", lambda seen, count=count: {"v": [seen.at_ns % 7 * 1.5] * count}, lambda seen: None)
        series.most = most
        for number in range(messages):
            series.add(Seen(number * 10_000_000, b"12345678", "APP"))
        found.add(series)
    return found


def test_too_many_fields_get_fewer_points_and_large_messages_are_omitted(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(page_values, "MOST_BYTES", 20_000)
    recorded = a_set(100)
    found = value_data(recorded)
    assert found.found == 101
    assert found.shown == int(20_000 / page_values.BYTES_OF_A_PAIR / page_values.FEWEST_PAIRS) == 62
    large, small = found.plain
    assert [len(group["lines"]) for group in (*large["groups"], *small["groups"])] == [61, 1]
    assert len(small["times"]) == 2 * page_values.FEWEST_PAIRS
    assert "62 of 101 fields are included" in values_section(found, recorded)


def test_thinned_series_is_mentioned_on_the_page() -> None:
    recorded = a_set(1, 1_000, most=100)
    series = recorded.series("/small")
    assert (series.count, series.every) == (1_000, 16)
    assert len(series) == 63
    assert (numpy.diff(series.times_ns) == 160_000_000).all()
    assert "only every second, fourth" in values_section(value_data(recorded), recorded)


def test_large_messages_are_kept_in_smaller_number() -> None:
    series = Series("/image", "x/Y", lambda seen: {}, lambda seen: None)
    series.most = 100
    for number in range(100):
        series.add(Seen(number, bytes(100_000), "APP"))
    assert len(series) * 100_000 <= 100 * 8_192
    assert series.count == 100
