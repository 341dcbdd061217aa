"""The distribution of a drawn parameter, as text on a command line or in the section `sweep:` of a mission file.

uniform:1,2            any number from 1 to 2, all equally likely
normal:10,0.5          the normal distribution with mean 10 and standard deviation 0.5
lognormal:0,0.25       e to the power of a value of normal:0,0.25
triangular:1,2,5       from 1 to 5, with the mode 2
integers:1..6          a whole number from 1 to 6, all equally likely
choice:slow,fast,fast  one of these values; a repeated value is more likely

Nothing is drawn here: `cfepy sweep` draws. So `cfepy check` needs no numpy to find a mistake.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass

from cfepy.reading.suggestions import expected
from cfepy.status import UsageError

INTEGERS, CHOICE = "integers", "choice"
_NUMBERS = {
    "uniform": ("LOWEST", "HIGHEST"),
    "normal": ("MEAN", "DEVIATION"),
    "lognormal": ("MEAN", "DEVIATION"),
    "triangular": ("LOWEST", "MODE", "HIGHEST"),
}
"""The numbers of each distribution of real numbers, in their order."""
KINDS = (*_NUMBERS, INTEGERS, CHOICE)
MOST_INTEGER = 1 << 62
_WHOLE_RANGE = re.compile(r"(-?\d{1,19})\.\.(-?\d{1,19})", re.ASCII)


@dataclass(frozen=True, slots=True)
class ParameterDistribution:
    """A distribution.

    Attributes:
        kind: one of `KINDS`.
        numbers: its numbers, in their order; the two ends of integers, both included.
        values: the values of a choice.
    """

    kind: str
    numbers: tuple[float, ...] = ()
    values: tuple[str, ...] = ()

    @classmethod
    def parse(cls, text: str) -> ParameterDistribution:
        """Return the distribution of a text; see the module.

        Raises:
            UsageError: the text is not a distribution.
        """
        kind, mark, rest = text.strip().partition(":")
        if kind not in KINDS:
            raise UsageError(f"unknown distribution {kind!r}; {expected(kind, KINDS)}")
        if not mark:
            raise UsageError(f"missing numbers of {kind}; write {_form(kind)}")
        if kind == CHOICE:
            return cls(kind, values=_choices(text, rest))
        return cls(kind, _ends(text, rest) if kind == INTEGERS else _numbers(kind, text, rest))


def _form(kind: str) -> str:
    return {CHOICE: "choice:VALUE,VALUE", INTEGERS: "integers:1..6"}.get(kind) or f"{kind}:{','.join(_NUMBERS[kind])}"


def _choices(text: str, rest: str) -> tuple[str, ...]:
    values = tuple(each.strip() for each in rest.split(","))
    if not all(values):
        raise UsageError(f"invalid distribution {text!r}; expected a value between two commas")
    return values


def _ends(text: str, rest: str) -> tuple[float, ...]:
    match = _WHOLE_RANGE.fullmatch(rest.strip())
    if match is None:
        raise UsageError(f"invalid distribution {text!r}; expected a range of whole numbers, such as integers:1..6")
    first, last = int(match[1]), int(match[2])
    if first > last:
        raise UsageError(f"invalid distribution {text!r}; the first number must not be greater than the last one")
    if max(abs(first), abs(last)) > MOST_INTEGER:
        raise UsageError(f"invalid distribution {text!r}; the numbers must be from -2^62 to 2^62")
    return first, last


def _numbers(kind: str, text: str, rest: str) -> tuple[float, ...]:
    names = _NUMBERS[kind]
    parts = rest.split(",")
    if len(parts) != len(names):
        raise UsageError(f"invalid distribution {text!r}; expected {len(names)} numbers, as in {_form(kind)}")
    numbers = []
    for name, part in zip(names, parts, strict=True):
        try:
            number = float(part)
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            raise UsageError(f"invalid {name} {part.strip()!r} of {kind}; expected a finite number")
        numbers.append(number)
    is_valid, rule = _RULES[kind]
    if not is_valid(*numbers):
        raise UsageError(f"invalid distribution {text!r}; {rule}")
    return tuple(numbers)


_RULES: dict[str, tuple[Callable[..., bool], str]] = {
    "uniform": (lambda low, high: low < high, "LOWEST must be less than HIGHEST"),
    "normal": (lambda mean, deviation: deviation > 0, "DEVIATION must be greater than 0"),
    "lognormal": (
        lambda mean, deviation: deviation > 0 and mean + 40 * deviation < 700,
        "DEVIATION must be greater "
        "than 0, and both numbers are of the logarithm, so that MEAN + 40 DEVIATION must be less than 700",
    ),
    "triangular": (
        lambda low, mode, high: low <= mode <= high and low < high,
        "the numbers must rise: LOWEST, MODE, HIGHEST",
    ),
}
