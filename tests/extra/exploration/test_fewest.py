"""Shrinking leaves nothing that could be removed, and some runs are known without flying them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from itertools import combinations
from random import Random

import pytest

from cfepy.extra.exploration.made_moves import KnownRuns, MoveNotingPolicy
from cfepy.extra.exploration.shrink import Shrinker, Shrunk
from cfepy.extra.exploration.trial import Tried
from cfepy.extra.exploration.verdict import Failure, Verdict
from cfepy.rtos import Kernel, NotingPolicy, Policy
from cfepy.schedules import Move, Schedule, make_kernel
from cfepy.trace import Trace

SEEDS = range(60)


class RandomProgram:
    """A few tasks that read and write a few numbers. It fails when the numbers reach rare values.

    Args:
        seed: seed of the program.
    """

    def __init__(self, seed: int) -> None:
        random = Random(seed)
        self._tasks = [
            [(random.choice("rwc"), random.randrange(2), random.randrange(9)) for _ in range(random.randrange(3, 8))]
            for _ in range(random.randrange(2, 5))
        ]
        usual = self._outcome(Policy())
        seen = Counter(self._outcome(Schedule("random", number).policy() or Policy()) for number in range(30))
        self._wrong = min((each for each in seen if each != usual), key=lambda each: (seen[each], each), default=None)
        self.flights = 0

    def _outcome(self, policy: Policy) -> tuple[int, ...]:
        numbers = [0, 0]

        def body(kernel: Kernel, steps: list[tuple[str, int, int]]) -> Callable[[], None]:
            def run() -> None:
                own = 0
                for what, where, value in steps:
                    kernel.charge(1)
                    if what == "r":
                        own = numbers[where]
                    elif what == "w":
                        numbers[where] = own + value
                    else:
                        own += value

            return run

        with make_kernel("greenlet", trace=Trace(), policy=policy) as kernel:
            for number, steps in enumerate(self._tasks):
                kernel.spawn(f"T.{number}", body(kernel, steps))
            kernel.run()
        return tuple(numbers)

    def fly(self, schedule: Schedule, policy: Policy | None = None) -> Tried:
        self.flights += 1
        noting = NotingPolicy(policy or schedule.policy())
        outcome = self._outcome(noting)
        failures = (Failure("wrong", "numbers", "are wrong"),) if outcome == self._wrong else ()
        deviations = tuple(noting.deviations.items())
        return Tried(Verdict(schedule, failures, deviations=deviations, preemptions=noting.preemptions))

    def until(self, end_ns: int) -> None:
        pass


def shrunk(program: RandomProgram) -> Shrunk[RandomProgram] | None:
    """Return the shrunk form of the first three failing schedules of a program, or None if there is none."""
    schedules = [Schedule("random", seed) for seed in range(30)]
    failing = [each for each in schedules if program.fly(each).verdict.failures]
    if not failing:
        return None
    found = Shrinker(program, failing[:3], program.fly(failing[0]).verdict.groups[0]).run()
    assert found is not None
    return found


@pytest.mark.slow
def test_shrunk_schedule_has_no_removable_move() -> None:
    counts: list[int] = []
    for seed in SEEDS:
        program = RandomProgram(seed)
        found = shrunk(program)
        if found is None:
            continue
        moves = [each.move for each in found.moves]
        assert program.fly(Schedule().by_moves(moves)).verdict.failures
        assert len(moves) <= 6
        for size in range(len(moves)):
            for subset in combinations(moves, size):
                assert not program.fly(Schedule().by_moves(subset)).verdict.failures
        counts.append(len(moves))
    assert len(counts) > len(SEEDS) / 2
    assert max(counts) > 1


@pytest.mark.parametrize("seed", range(8))
def test_known_run_has_the_choices_of_its_flight(seed: int) -> None:
    program, known, random = RandomProgram(seed), KnownRuns["Noted"](), Random(seed)
    all_moves: set[Move] = set()
    found = 0
    for number in range(60):
        moves = random.sample(sorted(all_moves), min(len(all_moves), random.randrange(4)))
        told = known.find(moves)
        inner = Schedule().by_moves(moves).policy() if number % 3 else Schedule("random", number).policy()
        noted = Noted(inner or Policy())
        program.fly(Schedule(), noted)
        if told is not None and number % 3:
            assert told.choices == noted.choices
            found += 1
        known.add(noted)
        all_moves |= {move for choice in noted.choices for move in choice.moves}
    assert found > 3


class Noted(MoveNotingPolicy):
    """A run, as its policy noted it."""


@pytest.mark.slow
def test_known_runs_are_not_flown(monkeypatch: pytest.MonkeyPatch) -> None:
    programs = [RandomProgram(seed) for seed in SEEDS]
    with_knowledge = [shrunk(program) for program in programs]
    flights = sum(program.flights for program in programs)
    monkeypatch.setattr(KnownRuns, "find", lambda self, moves: None)
    programs = [RandomProgram(seed) for seed in SEEDS]
    without = [shrunk(program) for program in programs]
    assert [each and each.moves for each in with_knowledge] == [each and each.moves for each in without]
    assert flights < sum(program.flights for program in programs)
