"""Fly random ground commands in cfepy and in NASA's cFE, and tell what differs.

Usage: CFEPY_REAL_CFE=FOLDER python -m tests.twin [--seed N] [--count COMMANDS] [--flight STEPS]
"""

from __future__ import annotations

import argparse
import itertools
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from tests.twin.commands import Commander, Step
from tests.twin.flight import differences, real, simulated
from tests.twin.real import VARIABLE, installed

STEPS_OF_A_FLIGHT = 60


class Difference(NamedTuple):
    """What a step did otherwise."""

    seed: int
    number: int
    step: Step
    lines: list[str]

    def __str__(self) -> str:
        sent = " ".join(packet.hex() for packet in self.step.packets)
        return "\n  ".join(
            [f"seed {self.seed}, step {self.number}, {self.step.service} {self.step.pace}: {sent}", *self.lines]
        )


def compare_flight(
    built: Path, seed: int, count: int, without: Iterable[str] = ()
) -> Iterator[tuple[Step, Difference | None]]:
    """Fly the steps of a seed in both; each with its difference, or None."""
    with real(built) as theirs, simulated(theirs.release) as ours:
        for number, step in enumerate(itertools.islice(Commander(seed, without).steps(), count)):
            expected = ours.fly(step)
            lines = differences(expected, theirs.fly(step, expected))
            yield step, Difference(seed, number, step, lines) if lines else None


def main() -> int:
    """Fly until there were so many commands."""
    parser = argparse.ArgumentParser(prog="python -m tests.twin", description=__doc__)
    parser.add_argument("--seed", type=int, default=0, help="of the first flight; the next ones count up")
    parser.add_argument("--count", type=int, default=100, help="commands in all")
    parser.add_argument("--flight", type=int, default=STEPS_OF_A_FLIGHT, help="steps of a flight")
    parser.add_argument("--without", nargs="*", default=(), help="names of commands to leave out")
    given = parser.parse_args()
    built = installed()
    if built is None:
        sys.exit(f"{VARIABLE} does not say where the folder of NASA's core-cpu1 is")
    steps = commands = unlike = 0
    for seed in itertools.count(given.seed):
        for step, difference in compare_flight(built, seed, given.flight, given.without):
            steps, commands = steps + 1, commands + len(step.packets) + 1
            unlike += difference is not None
            if difference is not None:
                print(difference, flush=True)
        print(f"seed {seed}: {commands} commands in {steps} steps so far, {unlike} steps differ", flush=True)
        if commands >= given.count:
            return 1 if unlike else 0
    return 0


if __name__ == "__main__":
    sys.exit(main())
