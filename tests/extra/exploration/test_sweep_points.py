"""Meaning of a sweep's values on a command line."""

from __future__ import annotations

import pytest

from cfepy.extra.exploration.sweep_points import numbers_of, points_of, seeds_of, values_of
from cfepy.mission import read_mission
from cfepy.pilot.plan import RunPlan
from cfepy.status import UsageError


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("5", ["5"]),
        ("5,fast", ["5", "fast"]),
        ("10..50:10", ["10", "20", "30", "40", "50"]),
        ("0..0.3:0.1", ["0", "0.1", "0.2", "0.3"]),
        ("10..40", ["10", "12.5", "16", "20", "25", "31.5", "40"]),
        ("90..130", ["90", "100", "125", "130"]),
        ("7..7", ["7"]),
        ("1,1..2:1", ["1", "2"]),
    ],
)
def test_values(text: str, values: list[str]) -> None:
    assert values_of(text, "--set") == values


def test_two_decades_have_the_preferred_numbers() -> None:
    found = numbers_of("10..1000", "--rate")
    assert (len(found), found[0], found[10], found[-1]) == (21, 10.0, 100.0, 1000.0)


@pytest.mark.parametrize("text", ["", "5,", "0..10", "10..5", "1..5:0", "..5", "0..1e9:1"])
def test_invalid_values_are_refused(text: str) -> None:
    with pytest.raises(UsageError, match=r"^--set: "):
        values_of(text, "--set")


@pytest.mark.parametrize("text", ["fast", "-1", "nan", "inf"])
def test_invalid_rate_is_refused(text: str) -> None:
    with pytest.raises(UsageError, match="invalid rate"):
        numbers_of(text, "--rate")


def test_seeds() -> None:
    assert seeds_of("0..3,7", "--seed") == [0, 1, 2, 3, 7]
    for wrong in ("1.5", "a..b", "9..0"):
        with pytest.raises(UsageError, match=f"invalid seeds '{wrong}'; expected numbers, or a rising range"):
            seeds_of(wrong, "--seed")


def test_points_change_the_plan() -> None:
    spec = read_mission("rx64m_pubsub")
    points = points_of(spec, ["linux", None], [50, 100], [("/left/report_period", ["1", "2"])], [0, 1])
    assert len(points) == 16
    point, varied = points[2]
    assert (point.board, point.rate_hz, point.seed, varied) == ("linux", 100, 0, (("/left/report_period", "1"),))
    command = point.plan(RunPlan(("rx64m_pubsub",), seconds=2)).command_line()
    assert "--set /left/report_period=1 --set /left/rate=100 --set /right/rate=100" in command
    assert "--board linux" in command


def test_unknown_boards_are_reported_before_the_sweep() -> None:
    with pytest.raises(UsageError) as caught:
        points_of(read_mission("lab"), [None, "rx64n", "linux", "linxu"], [], [], [0])
    assert [error.text.partition("?")[0] for error in caught.value.each] == [
        "unknown board 'rx64n'; did you mean rx64m",
        "unknown board 'linxu'; did you mean linux",
    ]


def test_rate_without_a_target_is_refused() -> None:
    with pytest.raises(UsageError, match="missing target of --rate"):
        points_of(read_mission("lab"), [None], [50], [], [0])
