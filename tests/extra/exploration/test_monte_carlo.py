"""The summary of drawn runs: success rate, quantiles, and the worst run."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.exploration.field_measures import FieldMeasure, FieldValue, recorder_of
from cfepy.extra.exploration.monte_carlo import Group, groups_of, wilson
from cfepy.extra.exploration.monte_carlo_picture import picture_of_draws
from cfepy.extra.exploration.sweep import Point, PointNumbers, SweepRow, TopicNumbers, sweep_table
from cfepy.extra.reports import save
from cfepy.ground import SeriesSet
from cfepy.pilot import RunPlan, fly
from cfepy.status import UsageError
from tests.ground.measured import write_thermal


def row(run: int, latency_us: float = 1.0, lost: int = 0, problem: str = "", value: float | None = None) -> SweepRow:
    topic = TopicNumbers("/a", 10, 10 - lost, lost, 0, 50.0, 1.0, latency_us)
    values = () if value is None else (FieldValue("min:/a.x", value, "m"),)
    numbers = PointNumbers("small", 0.01, topics=(topic,), problem=problem, trace="0", values=values)
    return SweepRow(Point(seed=run, run=run, drawn=(("/p", str(run)),)), numbers, ())


@pytest.mark.parametrize(
    ("successes", "runs", "low", "high"),
    [(8, 10, 0.4902, 0.9433), (0, 10, 0.0, 0.2775), (10, 10, 0.7225, 1.0), (500, 1000, 0.4691, 0.5309)],
)
def test_interval_has_the_values_of_published_tables(successes: int, runs: int, low: float, high: float) -> None:
    assert wilson(successes, runs) == pytest.approx((low, high), abs=5e-5)


def test_quantities_have_quantiles_and_the_runs_of_the_extremes() -> None:
    (group,) = groups_of([row(run, latency_us=float(run % 20)) for run in range(40)])
    found = {each.measure: each for each in group.quantities()}
    latency = found["/a longest latency"]
    assert (latency.runs, latency.least, latency.least_run, latency.most, latency.most_run) == (40, 0, 0, 19, 19)
    assert (latency.low, latency.median, latency.high) == pytest.approx((0.95, 9.5, 18.05))
    assert list(found) == ["/a rate", "/a lost", "/a longest latency", "CPU"]


def test_success_rate_counts_clean_runs() -> None:
    (group,) = groups_of([row(0), row(1, lost=1), row(2, problem="ARM died"), row(3)])
    assert group.text == "small: 2 of 4 runs clean, 50.0% (95% confidence: 15.0% to 85.0%)"


@pytest.mark.parametrize(
    ("rows", "run", "why"),
    [
        ([row(0, 9.0), row(1, lost=1), row(2, problem="ARM died")], 2, "ARM died"),
        ([row(0), row(1, lost=1), row(2, lost=4)], 2, "/a lost 4 of 10"),
        ([row(0), row(1, 14.0), row(2, 14.0)], 1, "clean, with a latency of 14 us"),
        ([row(0, 9.0, value=2.0), row(1, value=0.5), row(2, value=0.5)], 1, "clean, with min:/a.x = 0.5 m"),
    ],
)
def test_worst_run_is_the_first_of_the_worst(rows: list[SweepRow], run: int, why: str) -> None:
    (group,) = groups_of(rows)
    found, reason = group.worst()
    assert (found.point.run, reason) == (run, why)


def test_table_of_drawn_runs_has_run_values_and_fields() -> None:
    heads, cells = sweep_table([row(3, value=0.5)])
    found = dict(zip(heads, cells[0], strict=True))
    assert (found["run"], found["/p"], found["min:/a.x"]) == (3, "3", 0.5)


def test_drawn_run_without_topics_is_clean() -> None:
    assert SweepRow(Point(run=0), PointNumbers("small"), ()).why_not_clean == ""
    assert SweepRow(Point(), PointNumbers("small"), ()).why_not_clean == "no message came"


def test_drawn_run_without_a_value_of_a_measured_field_is_not_clean() -> None:
    numbers = PointNumbers("small", values=(FieldMeasure("max", "/a.x").value_in(SeriesSet()),))
    text = "no value of max:/a.x: no message was sent there or on any other topic"
    assert SweepRow(Point(run=0), numbers, ()).why_not_clean == text


def test_measured_field_has_the_engineering_value_and_its_unit(tmp_path: Path) -> None:
    measure = FieldMeasure.parse("max:THERMAL_HK_TLM.Temp", "--measure")
    (recorder,) = recorder_of([measure])
    fly(RunPlan((write_thermal(tmp_path),), seconds=1.2), attachments=[recorder])
    assert measure.value_in(recorder) == FieldValue("max:THERMAL_HK_TLM.Temp", 44.0, "degC")
    page = recorder.series("THERMAL_HK_TLM")._repr_html_()
    assert "44.0" in page
    assert "840" not in page, "it has the unit of the engineering value"


@pytest.mark.parametrize(
    ("text", "error"),
    [("largest:/a.x", "unknown measure 'largest'; did you mean last"), ("max:", "missing field of max")],
)
def test_invalid_measure_is_refused(text: str, error: str) -> None:
    with pytest.raises(UsageError, match=error):
        FieldMeasure.parse(text, "--measure")


def test_picture_has_axes_for_varying_measures_and_drawn_values(tmp_path: Path) -> None:
    group = Group("small", tuple(row(run, float(run), lost=int(run == 3)) for run in range(6)))
    picture = picture_of_draws([group], "m")
    names = [place.get_xlabel() for place in picture.axes if place.get_visible()]
    assert names == ["/a lost", "/a longest latency, us", "/p, drawn"]
    save(picture, tmp_path / "a.svg")
    assert (tmp_path / "a.svg").read_bytes().startswith(b"<?xml")
