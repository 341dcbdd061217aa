"""Fly the steps of a seed on two computers and report the differences: the common part of the comparing programs."""

from __future__ import annotations

import argparse
import itertools
import sys
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from dev.twin.commands import Step
from dev.twin.flight import Observed, Real, Simulated
from dev.twin.real import VARIABLE, installed


class Flown(NamedTuple):
    """A step that was flown on both.

    Attributes:
        observed: its results on NASA's cFE.
        lines: the differences.
    """

    step: Step
    observed: Observed
    lines: list[str]


def fly(
    ours: Simulated, theirs: Real, steps: Iterable[Step], differences: Callable[[Observed, Observed], list[str]]
) -> Iterator[Flown]:
    """Fly steps on both."""
    for step in steps:
        expected = ours.fly(step)
        observed = theirs.fly(step, expected)
        yield Flown(step, observed, differences(expected, observed))


def parser_of(name: str, usage: str | None, steps: int) -> argparse.ArgumentParser:
    """Return the command line parser of a program that flies seeds. `steps` is the default length of a flight."""
    parser = argparse.ArgumentParser(prog=f"python -m {name}", description=usage)
    parser.add_argument("--seed", type=int, default=0, help="of the first flight; the next ones count up")
    parser.add_argument("--count", type=int, default=100, help="commands in all")
    parser.add_argument("--flight", type=int, default=steps, help="steps of a flight")
    return parser


def real_folder(variable: str = VARIABLE) -> Path:
    """Return the folder of NASA's executable from an environment variable. Ends the program if it is not set."""
    built = installed(variable)
    if built is None:
        sys.exit(f"{variable} does not say where the folder of NASA's core-cpu1 is")
    return built


def run(given: argparse.Namespace, flight: Callable[[int], Iterable[Flown]]) -> int:
    """Fly seeds one by one up to the number of commands, and print the differences. Returns the exit status."""
    steps = commands = unlike = 0
    for seed in itertools.count(given.seed):
        for number, (step, _, lines) in enumerate(flight(seed)):
            steps, commands, unlike = steps + 1, commands + len(step.packets), unlike + bool(lines)
            if lines:
                sent = " ".join(packet.hex() for packet in step.packets)
                print(f"seed {seed}, step {number}, {step.service} {step.pace}: {sent}", *lines, sep="\n  ", flush=True)
        print(f"seed {seed}: {commands} commands in {steps} steps so far, {unlike} steps differ", flush=True)
        if commands >= given.count:
            break
    return 1 if unlike else 0
