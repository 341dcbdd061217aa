"""`--check-determinism`: fly a mission several times, and print the first difference.

The runs differ in conditions that must not matter: the hash seed of the process, the addresses of its objects, the kind
of tasks.
"""

from __future__ import annotations

import argparse
import contextlib
import dataclasses
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from cfepy.cli import flight_add_ons
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.cli.run.compared_run import ComparedRun
from cfepy.cli.run.compared_runs import FirstDifference, RunInProcess, facts_of, failure, show, show_contacts, started
from cfepy.cli.user_notes import tell
from cfepy.pilot import RunPlan
from cfepy.pilot.determinism import RunEndedError, first_parting
from cfepy.pilot.determinism_look import Look
from cfepy.rtos import AUTO, GREENLET, THREAD, has_greenlets
from cfepy.status import UsageError

ATTEMPTS = 3  # runs that depend on addresses or the host do not differ first at the same record twice
_SETS = """with `ordered_sets: true` in the mission file these two agree: somewhere the order of a set decides;
sort it in the code (for name in sorted(names)), or switch ordered sets on"""
_OUTSIDE = """even two runs alike differ: something outside decides, such as the address of an object (id(), the order
of objects in a frozenset), a file that changes, a library written in C, or a compiled application that asks the
processor for the time, or the host's kernel past libc"""
_HASHES = """it hangs on PYTHONHASHSEED, but ordered sets do not cure it: hash() of a text, a frozenset, a set that a
library makes (d.keys() & e)"""
_TASKS = (
    "the difference depends on --tasks; runs on threads and greenlets must not differ, "
    "so this is an error in cfepy: please report it"
)
_NOT_TOGETHER = ("realtime", "json", "save_files", "trace", "record", "bag", "junit", "sarif")


@dataclass(frozen=True, slots=True)
class Variant:
    """The conditions of a run: PYTHONHASHSEED and `--tasks`."""

    hash_seed: int
    tasks: str

    def __str__(self) -> str:
        return f"PYTHONHASHSEED={self.hash_seed} --tasks {self.tasks}"


def check(arguments: argparse.Namespace, plan: RunPlan) -> int:
    """Run and compare.

    Args:
        arguments: the command line with the options of `add_flight`.
        plan: the run.

    Returns:
        The exit status: 0 if all runs made one trace and had no problems, 1 otherwise.

    Raises:
        UsageError: the mission cannot run, or an option conflicts with `--check-determinism`.
    """
    for name, option in flight_add_ons.options():
        if getattr(arguments, name) not in (None, []):
            raise UsageError(
                "cannot be combined with --check-determinism, which shows no run; leave one of them out", field=option
            )
    for name in _NOT_TOGETHER:
        if getattr(arguments, name) is not None:
            raise UsageError("cannot be combined with --check-determinism", field=f"--{name.replace('_', '-')}")
    problems = compare(plan, arguments.check_determinism)
    tell(problems or ())
    return ENDED_WELL if problems == [] else FOUND_PROBLEMS


def compare(plan: RunPlan, count: int) -> list[str] | None:
    """Run a plan `count` times and show the first difference.

    Returns:
        The problems of each of the runs, or None if the runs differ.

    Raises:
        UsageError: the mission cannot run.
    """
    variants = _variants(count, plan.tasks)
    print(f"{len(variants)} runs: {'; '.join(map(str, variants))}", flush=True)
    runs = Runs(plan)
    for _ in range(ATTEMPTS):
        found, facts = runs.compare(variants)
        if found is None:
            show_contacts(facts.get("contacts", []), sys.stdout)
            print(f"all made the same {facts['records']} records\ntrace: {facts['digest']}")
            return list(facts["problems"])
        one, other, index = found
        looks = (runs.look(one, index), runs.look(other, index))
        if _is_first_difference(*looks):
            show(FirstDifference((str(one), str(other)), index, looks), runs.cause(one, other), sys.stdout)
            return None
    print(f"not deterministic: record {index} differs, but never in the same way twice; something outside the runs")
    print("decides: a file that changes, an address (id()), a C library")
    return None


def _variants(count: int, tasks: str) -> list[Variant]:
    kinds = [THREAD if tasks == AUTO else tasks]
    if has_greenlets():
        kinds.append(THREAD if tasks == GREENLET else GREENLET)
    return [Variant(number, kinds[number % len(kinds)]) for number in range(count)]


def _is_first_difference(one: Look, other: Look) -> bool:
    return one.before == other.before and one.record != other.record


class Runs:
    """Makes runs of one mission.

    Args:
        plan: the run.
    """

    def __init__(self, plan: RunPlan) -> None:
        self._plan = plan

    def compare(
        self, variants: Sequence[Variant], ordered_sets: bool = False
    ) -> tuple[tuple[Variant, Variant, int] | None, dict[str, Any]]:
        """Run side by side.

        Returns:
            Two variants that differ and the number of the record, or None if all are equal; then the facts at their
            ends.
        """
        with contextlib.ExitStack() as stack:
            runs = [stack.enter_context(self._started(each, ordered_sets=ordered_sets)) for each in variants]
            try:
                parting, agreed = first_parting([run.reader for run in runs])
            except RunEndedError:
                raise failure(runs) from None
            if parting is not None:
                return (variants[0], variants[parting.run], parting.index), {}
            return None, {**(runs[0].reader.facts or {}), "records": agreed}

    def look(self, variant: Variant, index: int) -> Look:
        """Run again up to a record, and return a look at it."""
        with self._started(variant, look_at=index) as run:
            return Look.from_dict(facts_of(run))

    def cause(self, one: Variant, other: Variant) -> str:
        """Find the cause of the difference by more runs."""
        if self.compare([one, other, one, other], ordered_sets=True)[0] is None:
            return _SETS
        if self.compare([one, one])[0] is not None:
            return _OUTSIDE
        if self.compare([one, dataclasses.replace(one, hash_seed=other.hash_seed)])[0] is not None:
            return _HASHES
        return _TASKS

    def _started(
        self, variant: Variant, look_at: int | None = None, ordered_sets: bool = False
    ) -> contextlib.AbstractContextManager[RunInProcess]:
        plan = dataclasses.replace(self._plan, tasks=variant.tasks)
        return started(ComparedRun(plan, look_at=look_at, ordered_sets=ordered_sets), variant.hash_seed)
