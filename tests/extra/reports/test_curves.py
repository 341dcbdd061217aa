"""Curves of values over time, and their picture."""

from __future__ import annotations

from pathlib import Path

import numpy
import pytest

from cfepy.extra.reports.curves import Change, Curve, Curves, curves_of, picture_of, save, thinned
from cfepy.extra.reports.page_values import limits_section, value_data
from cfepy.ground.series import SeriesRecorder
from cfepy.pilot import RunPlan, fly
from cfepy.status import UsageError
from tests.ground.measured import write_thermal


@pytest.fixture(scope="module")
def recorded() -> SeriesRecorder:
    recorder = SeriesRecorder()
    fly(RunPlan(("capture",), seconds=1.6), attachments=[recorder])
    return recorder


def test_array_has_a_line_for_each_item(recorded: SeriesRecorder) -> None:
    (curves,) = curves_of(recorded, "/joint_states.position")
    assert [line.label for line in curves.lines][:2] == ["position[0] shoulder_roll", "position[1] shoulder_pitch"]
    assert len(curves.lines) == 7
    assert curves.title == "/joint_states.position, rad or m"


def test_units_come_from_the_innermost_type_with_units(recorded: SeriesRecorder) -> None:
    titles = {
        word: curves_of(recorded, word)[0].title
        for word in ("/hand_pose.pose.position", "/hand_pose.pose.position.x", "/hand_pose.header.stamp")
    }
    assert titles == {
        "/hand_pose.pose.position": "/hand_pose.pose.position",
        "/hand_pose.pose.position.x": "/hand_pose.pose.position.x, m",
        "/hand_pose.header.stamp": "/hand_pose.header.stamp, s",
    }


def test_text_field_has_its_changes(recorded: SeriesRecorder) -> None:
    (curves,) = curves_of(recorded, "/phase.data")
    assert curves.lines == ()
    assert curves.changes == (Change(0.60102, "approach"),)


def test_a_pattern_has_curves_of_each_topic(recorded: SeriesRecorder) -> None:
    assert len(curves_of(recorded, "/arm_health/*")) == 4


def test_field_that_cannot_be_drawn_is_refused(recorded: SeriesRecorder) -> None:
    with pytest.raises(UsageError, match="name: cannot be drawn"):
        curves_of(recorded, "/joint_states.name")


def test_a_later_beginning(recorded: SeriesRecorder) -> None:
    (curves,) = curves_of(recorded, "/joint_states.position")
    later = curves.since(1.0)
    assert later.lines[0].times[0] >= 1.0
    assert len(later.lines[0].times) == len(later.lines[0].values) < len(curves.lines[0].times)


def test_thinning_keeps_ends_and_peaks() -> None:
    values = numpy.zeros(10_000)
    values[4_321], values[7_654], values[100:200] = 9.0, -9.0, numpy.nan
    few = thinned(Curve("x", numpy.arange(10_000) * 0.1, values), 100)
    assert len(few.times) == len(few.values) <= 102
    assert few.times[0] == 0.0
    assert few.times[-1] == pytest.approx(999.9)
    assert (numpy.diff(few.times) > 0).all()
    assert numpy.nanmax(few.values) == 9.0
    assert numpy.nanmin(few.values) == -9.0
    assert thinned(few, 1_000) is few


def test_picture_has_axes_for_each_group_with_lines() -> None:
    pytest.importorskip("matplotlib")
    times = numpy.array([0.0, 1.0])
    curves = Curves("/a", "x", "m", (Curve("x", times, times),))
    text = Curves("/phase", "data", "", (), (Change(0.5, "go"),))
    picture = picture_of([[curves], [text], [curves, curves]], title="run")
    assert [axes.get_ylabel() for axes in picture.axes] == ["/a.x, m", "m"]
    assert picture.axes[-1].get_xlabel() == "virtual time, s"
    assert [each.get_text() for each in picture.axes[0].texts] == ["go"]


@pytest.mark.parametrize("kind", ["svg", pytest.param("pdf", marks=pytest.mark.slow)])
def test_equal_pictures_have_equal_bytes(kind: str, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    line = Curve("x", numpy.array([0.0, 1.0]), numpy.array([2.0, 3.0]))
    files = [tmp_path / f"{name}.{kind}" for name in ("one", "other")]
    for file in files:
        save(picture_of([[Curves("/a", "x", "m", (line,))]]), file)
    assert files[0].read_bytes() == files[1].read_bytes()


@pytest.fixture(scope="module")
def thermal(tmp_path_factory: pytest.TempPathFactory) -> SeriesRecorder:
    recorder = SeriesRecorder()
    fly(RunPlan((write_thermal(tmp_path_factory.mktemp("thermal")),), seconds=2.4), attachments=[recorder])
    return recorder


def test_measurement_is_drawn_with_unit_and_limits(thermal: SeriesRecorder) -> None:
    (curves,) = curves_of(thermal, "THERMAL_HK_TLM.Temp")
    assert curves.title == "THERMAL_HK_TLM.Temp, degC"
    assert curves.lines[0].values.tolist() == pytest.approx([32, 44, 56, 68])
    assert curves.limits == (("yellow", 0), ("yellow", 50), ("red", -20), ("red", 60))
    (place,) = picture_of([[curves]]).axes
    assert sorted(text.get_text() for text in place.texts) == ["red", "yellow", "yellow"], "needs no colour"
    low, high = place.get_ylim()
    assert -20 < low < 0 < 68 < high, "a distant limit is left out"


def test_measurement_is_drawn_as_raw_number_on_demand(thermal: SeriesRecorder) -> None:
    (curves,) = curves_of(thermal, "THERMAL_HK_TLM.Temp", raw=True)
    assert (curves.title, curves.limits) == ("THERMAL_HK_TLM.Temp", ())
    assert curves.lines[0].values.tolist() == [720, 840, 960, 1080]
    assert thermal.series("THERMAL_HK_TLM").to_numpy("Temp").values.tolist() == [720, 840, 960, 1080]


def test_distant_limit_does_not_flatten_the_curve() -> None:
    times = numpy.array([0.0, 1.0])
    curves = Curves("T", "x", "", (Curve("x", times, times),), (), (("red", 1e6), ("yellow", 1.5)))
    (place,) = picture_of([[curves]]).axes
    assert place.get_ylim()[1] == pytest.approx(1.5, abs=0.1)


def test_page_lists_measurements_with_limits(thermal: SeriesRecorder) -> None:
    section = limits_section(thermal)
    assert '<span class="verdict missed">red</span>' in section
    assert "68 degC, above the red limit of 60 degC" in section
    assert "THERMAL_HK_TLM.Volts" not in section, "it has no limits"
    assert limits_section(SeriesRecorder()) == ""
    (temperature,) = [
        group
        for series in value_data(thermal).plain
        if series["name"] == "THERMAL_HK_TLM"
        for group in series["groups"]
        if group["name"] == "Temp"
    ]
    assert temperature["unit"] == "degC"
    assert temperature["limits"] == [["yellow", 0], ["yellow", 50], ["red", -20], ["red", 60]]
    assert temperature["lines"][0]["low"] == pytest.approx(32)
