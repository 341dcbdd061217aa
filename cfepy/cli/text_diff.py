"""Comparing two files of `--trace`, which are text: the first line that differs, and what is before it."""

from __future__ import annotations

from collections import deque
from itertools import zip_longest
from typing import TextIO

from cfepy.status import UsageError


def compare_texts(one: str, other: str, before: int, stream: TextIO) -> bool:
    """Compare two traces.

    Args:
        one: path of the first.
        other: path of the second.
        before: lines that are shown before the first that differs.
        stream: where what was found is written.

    Returns:
        Whether they are alike.

    Raises:
        UsageError: one is no text.
    """
    latest: deque[str] = deque(maxlen=before)
    count = 0
    try:
        with open(one, encoding="utf-8") as first, open(other, encoding="utf-8") as second:
            for mine, theirs in zip_longest(first, second, fillvalue=""):
                count += 1
                if mine != theirs:
                    _show(count, latest, {one: mine, other: theirs}, stream)
                    return False
                latest.append(mine)
    except UnicodeDecodeError:
        raise UsageError("one of the two is neither a journal nor a trace", file=f"{one}, {other}") from None
    print(f"the same run: all {count:,} lines are alike", file=stream)
    return True


def _show(number: int, before: deque[str], sides: dict[str, str], stream: TextIO) -> None:
    print(f"the first {number - 1:,} lines are alike; line {number:,} differs", file=stream)
    if before:
        print("\nbefore it, in both:", file=stream)
        stream.writelines(f"  {line}" for line in before)
    for path, line in sides.items():
        print(f"\n{path}\n  {line.rstrip() or 'the run is over'}", file=stream)
