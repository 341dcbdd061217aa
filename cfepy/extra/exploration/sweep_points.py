"""The points of a sweep, from the command line: ranges of rates, boards, seeds, values of parameters.

10..1000        the preferred numbers of ISO 3, ten to the decade: 10 12.5 16 20 25 31.5 40 50 63 80 100 ...
10..50:10       10 20 30 40 50
5,10,fast       these values
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import partial
from itertools import product

from cfepy.extra.exploration.draws import Drawn
from cfepy.extra.exploration.sweep import Point
from cfepy.mission import MissionSpec
from cfepy.psp import load_profile
from cfepy.reading.mistakes import each_of
from cfepy.status import UsageError

MOST_POINTS = 100_000
_PREFERRED = (1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0)
_NUMBER = r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?"
_RANGE = re.compile(rf"({_NUMBER})\.\.({_NUMBER})(?::({_NUMBER}))?", re.ASCII | re.IGNORECASE)


def values_of(text: str, option: str) -> list[str]:
    """Return the values of a text, in its order, each once.

    Args:
        text: values and ranges, with commas between.
        option: the option with the text, for errors.

    Raises:
        UsageError: a range is endless or falls, or a value is empty.
    """
    found: list[str] = []
    for part in text.split(","):
        match = _RANGE.fullmatch(part.strip())
        if match is None:
            if not part.strip() or ".." in part:
                raise UsageError(
                    f"invalid value {part!r}; expected a value, or a range such as 10..1000 or 10..50:10", field=option
                )
            found.append(part.strip())
        else:
            found += _range(part, match, option)
    return list(dict.fromkeys(found))


def _range(part: str, match: re.Match[str], option: str) -> list[str]:
    first, last = float(match[1]), float(match[2])
    if match[3] is None:
        if not 0 < first <= last:
            raise UsageError(
                f"invalid range {part!r}; it must rise from a number greater than 0, or have a step as in 0..50:10",
                field=option,
            )
        return [f"{each:.12g}" for each in _preferred(first, last)]
    step = float(match[3])
    if step <= 0 or first > last or (last - first) / step > MOST_POINTS:
        raise UsageError(f"invalid range {part!r}; it must rise in steps to an end, as in 10..50:10", field=option)
    count = int((last - first) / step + 1e-9) + 1
    return [f"{first + number * step:.12g}" for number in range(count)]


def _preferred(first: float, last: float) -> list[float]:
    """Return the ends, and the preferred numbers between them."""
    found = [first]
    decade = 10.0**-12
    while decade <= last:
        found += [each * decade for each in _PREFERRED if first < float(f"{each * decade:.12g}") < last]
        decade = float(f"{decade * 10:.12g}")
    return [*found, last] if last > first else found


def numbers_of(text: str, option: str) -> list[float]:
    """Return rates in Hz, as `values_of` does.

    Raises:
        UsageError: a value is not a number above 0.
    """
    found = []
    for value in values_of(text, option):
        try:
            number = float(value)
        except ValueError:
            number = 0.0
        if not 0 < number < float("inf"):
            raise UsageError(f"invalid rate {value!r}; expected a number of Hz greater than 0", field=option)
        found.append(number)
    return found


def seeds_of(text: str, option: str) -> list[int]:
    """Return seeds: whole numbers, and all whole numbers of a range.

    Raises:
        UsageError: a value is not a whole number.
    """
    steps = ",".join(f"{part}:1" if ".." in part and ":" not in part else part for part in text.split(","))
    try:
        return [int(value) for value in values_of(steps, option)]
    except ValueError:  # a UsageError is one; it would name a range with a step, which the user did not write
        raise UsageError(
            f"invalid seeds {text!r}; expected numbers, or a rising range such as 0..9", field=option
        ) from None


def points_of(
    spec: MissionSpec,
    boards: Sequence[str | None],
    rates: Sequence[float],
    varied: Sequence[tuple[str, Sequence[str]]],
    seeds: Sequence[int] | None,
    draws: Sequence[Drawn] = (),
) -> list[tuple[Point, tuple[tuple[str, str], ...]]]:
    """Return all points, boards outermost, then drawn runs and seeds innermost, each with its varied values.

    Args:
        spec: the mission.
        boards: names or files; None is the mission's own.
        rates: in Hz; an empty list flies the mission at its own rate.
        varied: names of parameters (with a slash) and arguments of the launch file, each with its values.
        seeds: seeds of all random values; None for 0, or for the number of the run if values are drawn.
        draws: drawn values of each run; an empty list draws nothing.

    Raises:
        UsageError: a board does not exist, the mission does not define the target of a rate, two options set the same
            parameter, or there are too many points.
    """
    each_of(partial(load_profile, board) for board in boards if board is not None)
    sets = spec.sweep.rate
    if rates and not sets:
        text = "missing target of --rate; add `sweep: {rate: [/node/rate]}` to the mission file, or use --set"
        raise UsageError(text, file=spec.mission_file or spec.script, field="--rate")
    drawn = [name for name, _ in draws[0]] if draws else []
    _check_targets([name for name, _ in varied], drawn, sets if rates else ())
    axes = [[(name, value) for value in values] for name, values in varied]
    count = len(boards) * max(1, len(rates)) * max(1, len(draws)) * len(seeds or (0,))
    for axis in axes:
        count *= len(axis)
    if count > MOST_POINTS:
        raise UsageError(f"more than {MOST_POINTS:,} points ({count:,}); give fewer values", field="--set")
    found = []
    asked: Sequence[float | None] = rates or [None]
    runs: Sequence[tuple[int | None, Drawn]] = list(enumerate(draws)) or [(None, ())]
    for board, chosen, rate, (run, values) in product(boards, product(*axes), asked, runs):
        said = [*chosen, *values, *((name, f"{rate:g}") for name in sets if rate is not None)]
        settings = tuple((name, value) for name, value in said if name.startswith("/"))
        args = tuple((name, value) for name, value in said if not name.startswith("/"))
        for seed in [run or 0] if seeds is None else seeds:
            found.append((Point(board, rate, settings, args, seed, run, values), chosen))
    return found


def _check_targets(varied: Sequence[str], drawn: Sequence[str], by_rate: Sequence[str]) -> None:
    """Check that each parameter is set once.

    Raises:
        UsageError: two options set one.
    """
    for names, option, others, other in (
        (varied, "--set", by_rate, "--rate"),
        (drawn, "--draw", by_rate, "--rate"),
        (drawn, "--draw", varied, "--set"),
    ):
        both = next((name for name in names if name in others), None)
        if both is not None:
            raise UsageError(f"{both} is already set by {other}; leave one of them out", field=option)
