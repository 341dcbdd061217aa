"""Shrinking: the shortest schedule that still gives the same failure, found by flying shorter ones.

First moves are left out, in halves, quarters, and one by one (Zeller's delta debugging). Then one preemption is tried
in the place of several, also one to another task, and those that are left are moved towards the failure; connections
that must be slow get the shortest delay. The result is an `at:` schedule.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import islice
from typing import Generic, Protocol, Self, TypeVar

from cfepy.exploration.moves import Choice, Move, MoveNotingPolicy, MovePolicy
from cfepy.exploration.trial import Tried
from cfepy.exploration.verdict import RESULTS, Verdict
from cfepy.rtos import Policy, Schedule
from cfepy.units import NS_PER_S

MOST_PROBES = 800
REACH = 64  # how many decisions a move is tried later
SINGLES = 200  # how many single moves are tried
AROUND = 30  # how many decisions before and after two moves one is tried in their place
TENTH_NS = NS_PER_S // 10


class Shrinkable(Protocol):
    """What is flown again and again, such as a `Trial`."""

    def fly(self, schedule: Schedule, *, policy: Policy | None = None) -> Tried:
        """Fly it.

        Args:
            schedule: who runs when.
            policy: decides in the place of the schedule's own.
        """

    def until(self, end_ns: int) -> Self | None:
        """The same in a run that ends at this virtual time; None where its length cannot be chosen."""


T = TypeVar("T", bound=Shrinkable)


@dataclass(frozen=True, slots=True)
class Shrunk(Generic[T]):
    """The end of it.

    Attributes:
        trial: with a shorter run, if that still fails.
        verdict: of the shortest schedule, an `at:`.
        moves: what that does.
        probes: how many runs it took.
    """

    trial: T
    verdict: Verdict
    moves: tuple[Move, ...]
    probes: int


@dataclass(frozen=True, slots=True)
class _Flight:
    """A run; `fails` says that it failed in the way that is looked for."""

    fails: bool
    verdict: Verdict
    moves: tuple[Move, ...]
    choices: tuple[Choice, ...]

    @property
    def cost(self) -> tuple[int, int, int]:
        """What is to become small: preemptions first, then other moves."""
        preemptions = sum(move.preempts for move in self.moves)
        return preemptions, len(self.moves), sum(choice for _, choice in self.verdict.deviations)


class Shrinker(Generic[T]):
    """Shrinks one failure.

    Args:
        trial: what is flown.
        schedule: under which it fails.
        group: of the failure.
        most_probes: how many runs it may take.
    """

    def __init__(self, trial: T, schedule: Schedule, group: str, most_probes: int = MOST_PROBES) -> None:
        self._trial = trial
        self._schedule = schedule
        self._group = group
        self._most = most_probes
        self._tried: set[tuple[Move, ...]] = set()
        self.probes = 0

    def run(self) -> Shrunk[T] | None:
        """Shrink; None when the schedule does not fail in this way."""
        best = self._fly(self._schedule.policy() or Policy())
        if not best.fails:
            return None
        best = self._without_tail(best)
        best = self._with_less(best, self._most // 2)
        best = self._with_one(best)
        best = self._sooner(self._later(self._redirected(self._merged(best))))
        return self._finish(best)

    # -- steps -------------------------------------------------------------------------------------------------------

    def _without_tail(self, best: _Flight) -> _Flight:
        """Leave out what comes after the failure: the shortest beginning that fails, by bisection."""
        least, most = 0, len(best.moves)
        while least < most:
            middle = (least + most) // 2
            found = self._try(best.moves[:middle])
            if found is not None:
                best, most = found, min(middle, len(found.moves))
            else:
                least = middle + 1
        return best

    def _with_less(self, best: _Flight, most: int | None = None) -> _Flight:
        """Leave out pieces, smaller and smaller ones, until no single move can be left out."""
        size = max(len(best.moves) // 2, 1)
        while best.moves and (most is None or self.probes < most):
            found = next(self._tries(_without_pieces(best.moves, size), best), None)
            if found is not None:
                best = found
                size = max(min(size, len(best.moves) // 2), 1)
            elif size == 1:
                break
            else:
                size //= 2
        return best

    def _with_one(self, best: _Flight) -> _Flight:
        """One move in the place of all, tried in the run of fifo, where it stands closest to the failure first."""
        if len(best.moves) < 2 or self.probes >= self._most:
            return best
        fifo = self._fly(MovePolicy((), self._schedule))
        at_ns = best.verdict.end_ns if (failure := best.verdict.failure(self._group)) is None else failure.at_ns
        ones = islice(_single_moves(fifo, at_ns, _names(best)), SINGLES)
        return next(self._tries(((move,) for move in ones), best), best)

    def _merged(self, best: _Flight) -> _Flight:
        """One move in the place of two that follow each other."""
        for at in range(len(best.moves) - 1):
            kept = (*best.moves[:at], *best.moves[at + 2 :])
            if self.probes >= self._most:
                break
            without = self._fly(MovePolicy(kept, self._schedule))
            candidates = ((*kept[:at], move, *kept[at:]) for move in _between(best, without, at))
            found = without if without.fails else next(self._tries(candidates, best), None)
            if found is not None:
                return self._merged(self._with_less(found))
        return best

    def _redirected(self, best: _Flight) -> _Flight:
        """A move to another task in the place of one and its neighbours, which got there by a detour.

        Without these the same place in the task's own work may be a decision earlier or later.
        """
        names = sorted({name for move in best.moves if not move.question for name in (move.task, move.chosen)})
        for at, move in enumerate(best.moves):
            if move.question:
                continue
            targets = [name for name in names if name not in (move.task, move.chosen)]
            candidates = (
                (*best.moves[: at - before], move._replace(chosen=name, number=number), *best.moves[at + 1 + behind :])
                for before, behind in ((1, 1), (1, 0), (0, 1))
                for name in targets
                for number in (move.number, move.number + 1, move.number - 1, move.number + 2)
                if before <= at
            )
            found = next(self._tries(candidates, best), None)
            if found is not None:
                return self._redirected(self._with_less(found))
        return best

    def _later(self, best: _Flight) -> _Flight:
        """Move each towards the failure, as far as it still fails: what is left happens close together."""
        for at in range(len(best.moves)):
            step = 1
            while step <= REACH and at < len(best.moves) and not best.moves[at].question:
                move = best.moves[at]
                moved = (*best.moves[:at], move._replace(number=move.number + step), *best.moves[at + 1 :])
                found = self._try(moved)
                if found is None or found.cost > best.cost:
                    break
                best, step = found, step * 2
        return best

    def _sooner(self, best: _Flight) -> _Flight:
        """Connections come as soon as they may, for it to fail."""
        for at, move in enumerate(best.moves):
            if not move.question:
                continue
            delays = best.choices[_place(best, move)].others
            shorter = delays[: delays.index(move.chosen)]
            candidates = ((*best.moves[:at], move._replace(chosen=each), *best.moves[at + 1 :]) for each in shorter)
            found = next(self._tries(candidates, best), None)
            if found is not None and len(found.moves) == len(best.moves):
                best = found
        return best

    def _finish(self, best: _Flight) -> Shrunk[T] | None:
        """The result as an `at:` schedule, in a run that is no longer than it need be; flown once more to be sure."""
        schedule = self._schedule.at(dict(best.verdict.deviations))
        trial, verdict = self._shorter_run(schedule)
        if verdict is None:
            return None
        return Shrunk(trial, verdict, best.moves, self.probes)

    def _shorter_run(self, schedule: Schedule) -> tuple[T, Verdict | None]:
        whole = self._trial.fly(schedule).verdict
        self.probes += 1
        failure = whole.failure(self._group)
        if failure is None:
            return self._trial, None
        end_ns = _end_of(failure.at_ns, whole.end_ns)
        trial = None if failure.kind == RESULTS or end_ns >= whole.end_ns else self._trial.until(end_ns)
        if trial is None:
            return self._trial, whole
        short = trial.fly(schedule).verdict
        self.probes += 1
        return (trial, short) if short.failure(self._group) is not None else (self._trial, whole)

    # -- probes ------------------------------------------------------------------------------------------------------

    def _tries(self, candidates: Iterable[tuple[Move, ...]], best: _Flight) -> Iterator[_Flight]:
        """Those that fail and cost less than the best so far."""
        for moves in candidates:
            found = self._try(moves)
            if found is not None and found.cost < best.cost:
                yield found

    def _try(self, moves: tuple[Move, ...]) -> _Flight | None:
        if moves in self._tried or self.probes >= self._most:
            return None
        self._tried.add(moves)
        found = self._fly(MovePolicy(moves, self._schedule))
        return found if found.fails else None

    def _fly(self, policy: Policy) -> _Flight:
        self.probes += 1
        recorder = MoveNotingPolicy(policy)
        verdict = self._trial.fly(self._schedule, policy=recorder).verdict
        fails = verdict.failure(self._group) is not None
        return _Flight(fails, verdict, tuple(recorder.moves), tuple(recorder.choices))


def _without_pieces(moves: tuple[Move, ...], size: int) -> Iterator[tuple[Move, ...]]:
    """All but so many moves in a row; the last ones are left out first."""
    for start in reversed(range(0, len(moves), size)):
        yield (*moves[:start], *moves[start + size :])


def _single_moves(fifo: _Flight, at_ns: int | None, names: set[str]) -> Iterator[Move]:
    """All that there are between the tasks that matter, before the failure, the last ones first."""
    for choice in reversed(fifo.choices):
        if choice.task in names and (at_ns is None or choice.now <= at_ns):
            others = [name for name in choice.others if name in names]
            yield from map(choice.move, others)


def _between(best: _Flight, without: _Flight, at: int) -> Iterator[Move]:
    """Moves that might do what two do, near their places, in a run without the two."""
    places = [_place(best, move) for move in best.moves[at : at + 2]]
    least = 0 if not at else _place(best, best.moves[at - 1]) + 1
    names = _names(best)
    for choice in without.choices[max(least, places[0] - AROUND) : places[1] + AROUND]:
        for other in choice.others:
            if choice.task in names and other in names:
                yield choice.move(other)


def _names(best: _Flight) -> set[str]:
    """The tasks that matter."""
    return {name for move in best.moves for name in (move.task, move.chosen)}


def _place(flight: _Flight, move: Move) -> int:
    """Which decision of a run a move is."""
    return next(
        place for place, choice in enumerate(flight.choices) if (choice.task, choice.number) == (move.task, move.number)
    )


def _end_of(at_ns: int | None, end_ns: int) -> int:
    """A round time at which a failure has happened."""
    return end_ns if at_ns is None else (at_ns // TENTH_NS + 1) * TENTH_NS
