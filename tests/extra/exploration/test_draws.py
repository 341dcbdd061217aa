"""Drawn values: they follow their distribution, from the seed and the number of the run only."""

from __future__ import annotations

from statistics import mean, stdev

import pytest

from cfepy.extra.exploration.draws import draws_of, number_text
from cfepy.mission import ParameterDistribution
from cfepy.reading.plain_yaml import plain_yaml

KINDS = {
    "/u": "uniform:1,2",
    "/n": "normal:10,0.5",
    "/l": "lognormal:0,0.25",
    "/t": "triangular:0,1,5",
    "/i": "integers:1..6",
    "/c": "choice:slow,fast,fast",
}
ALL = {name: ParameterDistribution.parse(text) for name, text in KINDS.items()}


def column(name: str, runs: int = 2000, seed: int = 0) -> list[str]:
    return [dict(drawn)[name] for drawn in draws_of({name: ALL[name]}, runs, seed)]


@pytest.mark.parametrize(
    ("name", "middle", "spread", "low", "high"),
    [
        ("/u", 1.5, 0.289, 1, 2),
        ("/n", 10, 0.5, 7, 13),
        ("/l", 1.032, 0.262, 0.3, 3),
        ("/t", 2, 1.08, 0, 5),
        ("/i", 3.5, 1.708, 1, 6),
    ],
)
def test_drawn_numbers_follow_the_distribution(
    name: str, middle: float, spread: float, low: float, high: float
) -> None:
    values = [float(text) for text in column(name)]
    assert mean(values) == pytest.approx(middle, abs=0.1)
    assert stdev(values) == pytest.approx(spread, rel=0.06)
    assert low <= min(values) < max(values) <= high


def test_choice_draws_a_repeated_value_more_often() -> None:
    values = column("/c")
    assert set(values) == {"slow", "fast"}
    assert values.count("fast") / len(values) == pytest.approx(2 / 3, abs=0.03)


def test_integers_draw_both_ends_and_whole_numbers() -> None:
    assert set(column("/i")) == set("123456")


def test_run_has_the_same_values_in_a_longer_sweep_and_with_further_parameters() -> None:
    few, many = draws_of(ALL, 5, 7), draws_of(ALL, 50, 7)
    assert many[:5] == few
    assert [dict(drawn)["/n"] for drawn in few] == column("/n", 5, 7)
    assert draws_of(ALL, 5, 8) != few


def test_first_values_equal_numpys_pcg64() -> None:
    from numpy.random import PCG64, Generator, SeedSequence

    stream = Generator(PCG64(SeedSequence(3, spawn_key=tuple(b"/n"))))
    assert column("/n", 2, 3) == [f"{each:.9g}" for each in stream.normal(10, 0.5, size=2)]


@pytest.mark.parametrize("number", [1e-05, 2.5e-7, 1e22, -3e-9, 0.1, 5.0, 1234567.89])
def test_text_of_a_number_is_a_number_in_yaml(number: float) -> None:
    assert plain_yaml(number_text(number)) == number
