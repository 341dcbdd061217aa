"""Compare a node on cfepy with the same node on roscpp. Differences between two runs of roscpp count as chance."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from enum import StrEnum
from typing import Any, NamedTuple

from dev.convert.stimulus.outcome import Outcome

NEAR = 1e-5
"""Numbers that differ by less than this share are alike: those that were computed of times of now are no nearer."""
TINY = 1e-9
OVERLAP = 0.6
"""The share of what was seen that two runs must have in common, where a node goes on by itself."""
MOST_LONGER = 1.5
SEQ = ".header.seq"
_NUMBER = re.compile(r"\b[0-9a-f]{5,}\b|-?\d+(\.\d+)?(e[+-]?\d+)?|nan|inf")


class Likeness(StrEnum):
    """How alike a part of two runs is."""

    EQUAL = "equal"
    SHIFTED = "equal where both were there"
    VARIES = "differs where two runs of roscpp differ"
    DIFFERENT = "different"


class Part(NamedTuple):
    """A part of the runs of a node.

    Attributes:
        name: such as "topic /chatter".
        likeness: of both sides.
        seen: how many things were seen with roscpp.
        example: the first that differs, with roscpp and on cfepy.
    """

    name: str
    likeness: Likeness
    seen: int
    example: str = ""


def compared(first: Outcome, second: Outcome, ours: Outcome) -> list[Part]:
    """Return the parts of three runs.

    Args:
        first, second: with roscpp.
        ours: on cfepy.
    """
    ends = [str(each.failed) for each in (first, second, ours)]
    found = [_part("end", [[each] for each in ends])]
    for name in sorted({*first.parts, *second.parts, *ours.parts}):
        runs = [each.parts.get(name, []) for each in (first, second, ours)]
        found.append(_part(name, runs))
    return found


def _part(name: str, runs: list[list[Any]]) -> Part:
    one, other, ours = runs
    if same(one, ours):
        return Part(name, Likeness.EQUAL, len(one))
    if common(one, ours) is not None:
        return Part(name, Likeness.SHIFTED, len(one))
    pairs = list(zip(one, other, strict=False))
    chance = frozenset(place for pair in pairs for place in different_places(*pair))
    if not pairs and one:
        chance = frozenset({""})
    if name == "log":
        chance = frozenset()
        if not same(one, other):
            numbers = [[_NUMBER.sub("#", line) for line in run] for run in runs]
            if common(numbers[0], numbers[2]) is not None:
                return Part(name, Likeness.VARIES, len(one), "numbers in the text")
    elif chance:
        masked = [[without(each, chance) for each in run] for run in runs]
        if same(masked[0], masked[2]) or common(masked[0], masked[2]) is not None:
            return Part(name, Likeness.VARIES, len(one), " ".join(sorted(chance)))
    if common(one, other) is None and not same(one, other):
        return Part(name, Likeness.DIFFERENT, len(one), "two runs of roscpp differ, too; " + example(one, ours))
    return Part(name, Likeness.DIFFERENT, len(one), example(one, ours))


def example(one: list[Any], other: list[Any]) -> str:
    """Return the first difference."""
    for number, (first, second) in enumerate(zip(one, other, strict=False)):
        places = list(different_places(first, second))
        if places and places != [SEQ]:
            place = next(each for each in places if each != SEQ)
            return (
                f"number {number} of {len(one)} and {len(other)}{place}: {shown(first, place)} {shown(second, place)}"
            )
    return f"{len(one)} and {len(other)} were seen: {str((one or other)[-1:])[:200]}"


def shown(value: Any, place: str) -> str:
    """Return the part of a value at a place with no list on the way."""
    for name in place.split(".")[1:]:
        if not isinstance(value, dict) or (name.endswith("[]") and name.removesuffix("[]") not in value):
            break
        value = value[name.removesuffix("[]")]
    return str(value)[:200]


# -- sequences ---------------------------------------------------------------------------------------------------------


def same(one: Sequence[Any], other: Sequence[Any]) -> bool:
    """Return whether both sequences are equal. Repeated items count once if they came about equally often."""
    if len(one) == len(other) and all(map(alike, one, other)):
        return True
    first, second = short(one), short(other)
    return as_often(one, other) and len(first) == len(second) and all(map(alike, first, second))


def common(one: Sequence[Any], other: Sequence[Any]) -> list[tuple[Any, Any]] | None:
    """Return the common part if one run began earlier or lasted longer: pairs of equal items, or None."""
    if not one or not other or not as_often(one, other):
        return None
    first, second = short(one), short(other)
    least = max(1, math.ceil(OVERLAP * min(len(first), len(second))))
    for offset in sorted(range(-len(second) + least, len(first) - least + 1), key=abs):
        pairs = list(zip(first[max(0, offset) :], second[max(0, -offset) :], strict=False))
        if len(pairs) >= least and all(alike(*pair) for pair in pairs):
            return pairs
    return None


def short(run: Sequence[Any]) -> list[Any]:
    """Return the items without repetitions of their predecessor. Sequence numbers of headers do not count."""
    found: list[Any] = []
    for each in run:
        item = without(each, frozenset({SEQ}))
        if not found or not alike(found[-1], item):
            found.append(item)
    return found


def as_often(one: Sequence[Any], other: Sequence[Any]) -> bool:
    """Return whether both came at about the same rate: a node may have been seen for a second longer."""
    fewer, more = sorted((len(one), len(other)))
    return more <= MOST_LONGER * fewer + 2


# -- values ------------------------------------------------------------------------------------------------------------


def alike(one: Any, other: Any) -> bool:
    """Return whether two plain values are the same, numbers nearly."""
    return next(different_places(one, other), None) is None


def different_places(one: Any, other: Any, at: str = "") -> Iterator[str]:
    """Yield the places where two plain values differ. Items of lists have no place of their own."""
    if isinstance(one, dict) and isinstance(other, dict) and one.keys() == other.keys():
        for name in one:
            yield from different_places(one[name], other[name], f"{at}.{name}")
    elif isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        for first, second in zip(one, other, strict=True):
            yield from different_places(first, second, f"{at}[]")
    elif isinstance(one, float) and isinstance(other, float):
        if not math.isclose(one, other, rel_tol=NEAR, abs_tol=TINY):
            yield at
    elif one != other:
        yield at


def without(value: Any, places: frozenset[str], at: str = "") -> Any:
    """Return a plain value without the parts at some places."""
    if at in places:
        return "..."
    if isinstance(value, dict):
        return {name: without(each, places, f"{at}.{name}") for name, each in value.items()}
    if isinstance(value, list):
        return [without(each, places, f"{at}[]") for each in value]
    return value
