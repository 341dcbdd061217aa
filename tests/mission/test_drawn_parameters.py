"""Distributions as text: their numbers, and errors in them."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.mission import ParameterDistribution, read_mission_file
from cfepy.reading.mistakes import Mistakes
from cfepy.status import UsageError


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("uniform:1,2", ParameterDistribution("uniform", (1.0, 2.0))),
        ("normal:-10, 0.5", ParameterDistribution("normal", (-10.0, 0.5))),
        ("lognormal:0,1e-3", ParameterDistribution("lognormal", (0.0, 0.001))),
        ("triangular:1,1,5", ParameterDistribution("triangular", (1.0, 1.0, 5.0))),
        ("integers:-3..3", ParameterDistribution("integers", (-3, 3))),
        ("choice:slow,fast,5", ParameterDistribution("choice", values=("slow", "fast", "5"))),
    ],
)
def test_distribution_has_the_numbers_of_its_text(text: str, found: ParameterDistribution) -> None:
    assert ParameterDistribution.parse(text) == found


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("gauss:1,2", "unknown distribution 'gauss'; expected uniform, normal, lognormal"),
        ("norml:1,2", "unknown distribution 'norml'; did you mean normal?"),
        ("normal", "missing numbers of normal; write normal:MEAN,DEVIATION"),
        ("integers", "missing numbers of integers; write integers:1..6"),
        ("normal:1", "expected 2 numbers, as in normal:MEAN,DEVIATION"),
        ("normal:1,-2", "invalid distribution 'normal:1,-2'; DEVIATION must be greater than 0"),
        ("normal:1,inf", "invalid DEVIATION 'inf' of normal; expected a finite number"),
        ("uniform:a,2", "invalid LOWEST 'a' of uniform; expected a finite number"),
        ("uniform:2,2", "LOWEST must be less than HIGHEST"),
        ("lognormal:600,30", "MEAN + 40 DEVIATION must be less than 700"),
        ("triangular:1,6,5", "the numbers must rise: LOWEST, MODE, HIGHEST"),
        ("integers:1.5..3", "expected a range of whole numbers, such as integers:1..6"),
        ("integers:6..1", "the first number must not be greater than the last one"),
        ("integers:0..9999999999999999999", "the numbers must be from -2^62 to 2^62"),
        ("choice:a,,b", "expected a value between two commas"),
    ],
)
def test_invalid_distribution_is_refused_with_the_remedy(text: str, error: str) -> None:
    with pytest.raises(UsageError) as caught:
        ParameterDistribution.parse(text)
    assert error in caught.value.text


def test_mission_file_names_the_line_of_an_invalid_distribution(tmp_path: Path) -> None:
    file = tmp_path / "mission.yaml"
    file.write_text("sweep:\n  draw:\n    /a/b: uniform:1,2\n    /a/c: uniform:2,1\n    d: 5\n", encoding="utf-8")
    mistakes = Mistakes()
    assert read_mission_file(file, mistakes).sweep.draw == {"/a/b": ParameterDistribution("uniform", (1.0, 2.0))}
    assert [(each.line, each.field) for each in mistakes.errors] == [(4, "sweep.draw./a/c"), (5, "sweep.draw.d")]
