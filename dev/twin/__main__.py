"""Fly random ground commands in cfepy and in NASA's cFE, and report the differences.

Usage: CFEPY_REAL_CFE=FOLDER python -m dev.twin [--seed N] [--count COMMANDS] [--flight STEPS]
"""

from __future__ import annotations

import itertools
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

from dev.twin import compare
from dev.twin.commands import Commander
from dev.twin.flight import differences, real, simulated

STEPS_OF_A_FLIGHT = 60


def fly(built: Path, seed: int, count: int, without: Iterable[str] = ()) -> Iterator[compare.Flown]:
    """Fly the steps of a seed in both."""
    with real(built) as theirs, simulated(theirs.release) as ours:
        steps = itertools.islice(Commander(seed, without).steps(), count)
        yield from compare.fly(ours, theirs, steps, differences)


def main() -> int:
    """Fly until there were so many commands."""
    parser = compare.parser_of("dev.twin", __doc__, STEPS_OF_A_FLIGHT)
    parser.add_argument("--without", nargs="*", default=(), help="names of commands to leave out")
    given = parser.parse_args()
    built = compare.real_folder()
    return compare.run(given, lambda seed: fly(built, seed, given.flight, given.without))


if __name__ == "__main__":
    sys.exit(main())
