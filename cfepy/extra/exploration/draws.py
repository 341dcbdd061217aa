"""The values that a sweep draws from distributions: a set of values for each run.

A run depends on the seed and on its number. It does not depend on the number of runs, so a longer sweep begins with the
runs of a shorter one. Each parameter has its own stream of random numbers, so a further parameter changes no values of
the others. The streams are numpy's PCG64; another version of numpy may draw other values of a distribution.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from cfepy.mission import CHOICE, INTEGERS, ParameterDistribution

if TYPE_CHECKING:
    from numpy.random import Generator

DIGITS = 9  # of a drawn number; the run, the tables and the command to repeat it have the same digits

Drawn = tuple[tuple[str, str], ...]
"""The drawn values of a run, as text, by the name of the parameter."""


def draws_of(distributions: Mapping[str, ParameterDistribution], runs: int, seed: int) -> list[Drawn]:
    """Draw the values of all runs.

    Args:
        distributions: by the name of the parameter or launch argument.
        runs: number of runs.
        seed: seed of the draws, at least 0.
    """
    columns = [[(name, text) for text in _column(name, each, runs, seed)] for name, each in distributions.items()]
    return list(zip(*columns, strict=True)) if columns else [()] * runs


def _column(name: str, distribution: ParameterDistribution, runs: int, seed: int) -> list[str]:
    from numpy.random import PCG64, Generator, SeedSequence

    stream = Generator(PCG64(SeedSequence(seed, spawn_key=tuple(name.encode()))))
    if distribution.kind == CHOICE:
        return [distribution.values[int(each)] for each in stream.integers(len(distribution.values), size=runs)]
    return [number_text(each) for each in _numbers(stream, distribution, runs)]


def _numbers(stream: Generator, distribution: ParameterDistribution, runs: int) -> list[int] | list[float]:
    """Return the drawn numbers as Python's own."""
    if distribution.kind == INTEGERS:
        first, last = map(int, distribution.numbers)
        return [int(each) for each in stream.integers(first, last, size=runs, endpoint=True)]
    draw = getattr(stream, distribution.kind)  # numpy has the same names
    return [float(each) for each in draw(*distribution.numbers, size=runs)]


def number_text(number: float) -> str:
    """Return a number as text that YAML reads as a number: YAML 1.1 takes 1e-05 for a text, but not 1.0e-05."""
    if isinstance(number, int):
        return str(number)
    text = f"{number:.{DIGITS}g}"
    digits, mark, exponent = text.partition("e")
    return text if not mark or "." in digits else f"{digits}.0e{exponent}"
