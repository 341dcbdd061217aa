"""Shrinking: find the shortest schedule that still gives the same failure, by flying shorter ones.

First, moves are left out, in halves, quarters, and one by one (Zeller's delta debugging), from each of the shortest
known failing schedules. In the best of them, one move is tried in place of all and of several, also a move to another
task. The remaining moves are shifted towards the failure. Connections that must be slow get the shortest delay. In the
end each subset of the moves is flown, if they are few. The result is a schedule of moves.

A run is flown only if known runs do not predict its end (`KnownRuns`), and it goes no further than the failure.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, islice
from typing import Any, Generic, NamedTuple, Protocol, Self, TypeVar

from cfepy.extra.exploration.made_moves import Choice, KnownRuns, MadeMove, MoveNotingPolicy
from cfepy.extra.exploration.trial import Tried
from cfepy.extra.exploration.verdict import RESULTS, Verdict
from cfepy.rtos import Policy, Stopwatch
from cfepy.schedules import Move, Schedule
from cfepy.units import NS_PER_MS, NS_PER_S

LEAST_PROBES, MOST_PROBES = 300, 800
SHRINK_S = 60.0  # wall time for one failure
STARTS = 3  # failing schedules that are shrunk, the shortest ones
SUBSETS_OF = 6  # moves of which all subsets are flown
REACH = 64  # the most decisions by which a move is shifted
FEW, SINGLES = 10, 200  # single moves that are tried, at first and in the end
MERGED = (3, 2)  # numbers of moves that are replaced by one
AROUND = 30  # decisions before and after them that are searched
CANDIDATES = 15  # such moves that are tried
PLAINER: tuple[dict[str, Any], ...] = ({"points": ""}, {"any_priority": False}, {"late_ns": 0}, {"hold_ns": 0})
TENTH_NS = NS_PER_S // 10

Moves = tuple[Move, ...]


def budget_of(schedules: int) -> int:
    """Return the default number of runs for shrinking a failure: the number that the search took, within limits.

    Args:
        schedules: schedules that were flown in search of failures.
    """
    return min(max(schedules, LEAST_PROBES), MOST_PROBES)


class Shrinkable(Protocol):
    """An experiment that is flown repeatedly, such as a `Trial`."""

    def fly(self, schedule: Schedule, *, policy: Policy | None = None) -> Tried:
        """Fly it.

        Args:
            schedule: decides which task runs when.
            policy: decides in place of the schedule's own.
        """

    def until(self, end_ns: int) -> Self | None:
        """Return the same in a run that ends at this virtual time; None if its length cannot be chosen."""


T = TypeVar("T", bound=Shrinkable)


class NotedFlight(NamedTuple):
    """A flight with its moves.

    Attributes:
        verdict: the verdict on it.
        made: the moves that it made.
        choices: all its decisions.
    """

    verdict: Verdict
    made: tuple[MadeMove, ...]
    choices: tuple[Choice, ...]

    @classmethod
    def of(cls, verdict: Verdict, recorder: MoveNotingPolicy) -> Self:
        """Return the flight that a policy has recorded."""
        return cls(verdict, recorder.made, tuple(recorder.choices))


def fly_noting(trial: Shrinkable, schedule: Schedule) -> NotedFlight:
    """Fly a trial in this process, and record its moves."""
    recorder = MoveNotingPolicy(schedule.policy() or Policy())
    return NotedFlight.of(trial.fly(schedule, policy=recorder).verdict, recorder)


@dataclass(frozen=True, slots=True)
class Shrunk(Generic[T]):
    """The result of shrinking.

    Attributes:
        trial: with a shorter run, if that still fails.
        verdict: of the shortest schedule, which consists of moves.
        moves: its moves.
        probes: number of runs that it took.
        is_cut_short: whether the time ended before all shorter schedules were tried.
    """

    trial: T
    verdict: Verdict
    moves: tuple[MadeMove, ...]
    probes: int
    is_cut_short: bool = False

    def text(self, option: str) -> str:
        """Return how long the schedule is and how it was found: `1 preemption, found in 13 runs`.

        Args:
            option: the name of the time limit, for a search that was cut short.
        """
        over = f", until its time was over ({option} gives more)" if self.is_cut_short else ""
        return f"{self._length()}, found in {self.probes} runs{over}"

    def _length(self) -> str:
        preemptions = self.verdict.preemptions
        answers = Counter(move.question for move in self.moves if move.question)
        others = len(self.verdict.deviations) - preemptions - answers.total()
        parts = [f"{preemptions} {'preemption' if preemptions == 1 else 'preemptions'}"]
        if others:
            parts.append(f"{others} {'change' if others == 1 else 'changes'} of order")
        parts += [f"{count} {kind if count == 1 else f'{kind}s'}" for kind, count in answers.items()]
        return " and ".join(parts)


@dataclass(frozen=True, slots=True)
class _Flight:
    """A run. `fails` is True if it shows the failure; `options` is a schedule with its options."""

    options: Schedule
    fails: bool
    verdict: Verdict
    made: tuple[MadeMove, ...]
    choices: tuple[Choice, ...]

    @property
    def moves(self) -> Moves:
        """The moves that it made, which reproduce it."""
        return tuple(each.move for each in self.made)

    @property
    def cost(self) -> tuple[int, int, int]:
        """The cost to minimize: preemptions first, then other moves."""
        preemptions = sum(each.preempts for each in self.made)
        return preemptions, len(self.made), sum(each.choice for each in self.made)


class Shrinker(Generic[T]):
    """Shrinks one failure.

    Args:
        trial: the trial.
        schedules: schedules under which it fails, the shortest first.
        group: of the failure.
        most_probes: the most runs; the final check that no move can be left out is made in any case.
        most_s: the most wall time, after which only the final run is made; None for any.
        fly: flies a trial under a schedule and records its moves, as `fly_noting` does.
    """

    def __init__(
        self,
        trial: T,
        schedules: Sequence[Schedule],
        group: str,
        most_probes: int = MOST_PROBES,
        most_s: float | None = None,
        fly: Callable[[T, Schedule], NotedFlight] = fly_noting,
    ) -> None:
        self._trial = trial
        self._fly_noting = fly
        self._schedules = schedules
        self._group = group
        self._most = most_probes
        self._known: dict[Schedule, KnownRuns[_Flight]] = {}
        self._limit = most_probes
        self._most_s = most_s
        self._watch = Stopwatch()
        self._is_cut_short = False
        self.probes = 0

    @property
    def _is_spent(self) -> bool:
        """Whether no further run may be made at present."""
        if self._most_s is not None and self._watch.elapsed_ns() > self._most_s * NS_PER_S:
            self._is_cut_short = True
        return self._is_cut_short or self.probes >= self._limit

    def run(self) -> Shrunk[T] | None:
        """Shrink; None if the first schedule does not show the failure."""
        first = self._fly(self._schedules[0])
        if not first.fails:
            return None
        first = self._cut(first)
        self._limit = self._most // 2
        best = self._with_one(self._with_less(self._without_tail(first)), FEW)
        for schedule in self._schedules[1:STARTS]:
            if len(best.made) > 1 and not self._is_spent:
                other = self._fly(schedule)
                if other.fails:
                    best = min(best, self._with_less(self._without_tail(other)), key=lambda flight: flight.cost)
        self._limit = self._most
        best = self._with_one(self._merged(self._redirected(best)), SINGLES)
        best = self._fewest(self._sooner(self._later(best)))
        plain = self._plainer(best)
        return self._finish(best if plain is best else self._fewest(plain))

    # -- steps -------------------------------------------------------------------------------------------------------

    def _cut(self, first: _Flight) -> _Flight:
        """Shorten all runs to the failure if a shorter run shows it too, and forget the longer known runs."""
        failure = first.verdict.failure(self._group)
        assert failure is not None
        if failure.at_ns is None or failure.kind == RESULTS:
            return first
        whole, end_ns = self._trial, _end_of(failure.at_ns)
        short = whole.until(end_ns) if end_ns < first.verdict.end_ns else None
        if short is None:
            return first
        known, self._known, self._trial = self._known, {}, short
        again = self._fly(first.options.by_moves(first.moves))
        if again.fails:
            return again
        self._known, self._trial = known, whole
        return first

    def _without_tail(self, best: _Flight) -> _Flight:
        """Leave out the moves after the failure: find the shortest beginning that fails, by bisection."""
        least, most = 0, len(best.moves)
        while least < most:
            middle = (least + most) // 2
            found = self._try(best.moves[:middle], best)
            if found is not None:
                best, most = found, min(middle, len(found.moves))
            else:
                least = middle + 1
        return best

    def _with_less(self, best: _Flight) -> _Flight:
        """Leave out ever smaller groups of moves, until no single move can be left out."""
        size = max(len(best.moves) // 2, 1)
        while best.moves:
            found = next(self._tries(_without_pieces(best.moves, size), best), None)
            if found is not None:
                best = found
                size = max(min(size, len(best.moves) // 2), 1)
            elif size == 1:
                break
            else:
                size //= 2
        return best

    def _with_one(self, best: _Flight, count: int) -> _Flight:
        """Try one move in place of all, in the run of fifo: similar places and moves closest to the failure first."""
        if len(best.made) < 2 or self._is_spent:
            return best
        fifo = self._flight((), best.options)
        at_ns = best.verdict.end_ns if (failure := best.verdict.failure(self._group)) is None else failure.at_ns
        ones = islice(_single_moves(best, fifo, at_ns), count)
        return next(self._tries(((move,) for move in ones), best), best)

    def _merged(self, best: _Flight) -> _Flight:
        """Try one move in place of three or two successive moves."""
        pieces = [(at, size) for size in MERGED for at in range(len(best.made) - size + 1)]
        for at, size in pieces:
            kept = (*best.moves[:at], *best.moves[at + size :])
            if self._is_spent:
                break
            without = self._flight(kept, best.options)
            near = islice(_between(best, without, at, size), CANDIDATES)
            candidates = ((*kept[:at], move, *kept[at:]) for move in near)
            found = without if without.fails else next(self._tries(candidates, best), None)
            if found is not None:
                return self._merged(self._with_less(found))
        return best

    def _redirected(self, best: _Flight) -> _Flight:
        """Try a move to another task in place of a move and its neighbours, which reached that task indirectly.

        Without these neighbours, the same place in the task's own work may be a decision earlier or later.
        """
        if len(best.made) < 2:
            return best
        moves, names = best.moves, sorted(_names(best))
        for at, made in enumerate(best.made):
            if made.question:
                continue
            near = [move for choice in _near(best, made) for move in choice.moves if move.chosen in names]
            candidates = (
                (*moves[: at - before], move, *moves[at + 1 + behind :])
                for before, behind in ((1, 1), (1, 0), (0, 1))
                if before <= at
                for move in near
                if move.chosen != made.move.chosen
            )
            found = next(self._tries(candidates, best), None)
            if found is not None:
                return self._redirected(self._with_less(found))
        return best

    def _later(self, best: _Flight) -> _Flight:
        """Shift each move towards the failure as far as it still fails, so that the moves are close together."""
        for at in range(len(best.made)):
            step = 1
            while step <= REACH and at < len(best.made) and not best.made[at].question:
                move = next(islice(_same_later(best, best.made[at]), step - 1, None), None)
                if move is None:
                    break
                found = self._try((*best.moves[:at], move, *best.moves[at + 1 :]), best)
                if found is None or found.cost > best.cost:
                    break
                best, step = found, step * 2
        return best

    def _sooner(self, best: _Flight) -> _Flight:
        """Use the first answer that fails for questions with ordered answers, such as the time of a connection."""
        for at, made in enumerate(best.made):
            if not made.question:
                continue
            sooner = best.choices[made.decision].moves[: made.choice - 1]
            candidates = ((*best.moves[:at], move, *best.moves[at + 1 :]) for move in sooner)
            found = next(self._tries(candidates, best), None)
            if found is not None and len(found.made) == len(best.made):
                best = found
        return best

    def _fewest(self, best: _Flight) -> _Flight:
        """Return the smallest subset of the moves that fails; with many moves, one without a removable move."""
        self._limit = self.probes + 2**SUBSETS_OF
        count = len(best.made)
        if count > SUBSETS_OF:
            return self._with_less(best)
        subsets = (subset for size in range(count) for subset in combinations(best.moves, size))
        return next(self._tries(subsets, best), best)

    def _plainer(self, best: _Flight) -> _Flight:
        """Leave out the options that the failure does not need, such as points between calls."""
        for change in PLAINER:
            options = replace(best.options, **change)
            if options == best.options:
                continue
            found = self._flight(best.moves, options)
            if found.fails and found.cost <= best.cost:
                best = found
        return best

    def _finish(self, best: _Flight) -> Shrunk[T] | None:
        """Return the result as a schedule of moves, flown once more to be sure."""
        self.probes += 1
        verdict = self._trial.fly(best.options.by_moves(best.moves)).verdict
        if verdict.failure(self._group) is None:
            return None
        return Shrunk(self._trial, verdict, best.made, self.probes, self._is_cut_short)

    # -- probes ------------------------------------------------------------------------------------------------------

    def _tries(self, candidates: Iterable[Moves], best: _Flight) -> Iterator[_Flight]:
        """Yield the flights that fail and cost less than the best so far."""
        for moves in candidates:
            found = self._try(moves, best)
            if found is not None and found.cost < best.cost:
                yield found

    def _try(self, moves: Moves, like: _Flight) -> _Flight | None:
        """Return a flight with the options of another, if it fails and the budget allows it."""
        found = self._runs(like.options).find(moves)
        if found is None:
            if self._is_spent:
                return None
            found = self._fly(like.options.by_moves(moves))
        return found if found.fails else None

    def _flight(self, moves: Moves, options: Schedule) -> _Flight:
        """Return a flight, failing or not."""
        return self._runs(options).find(moves) or self._fly(options.by_moves(moves))

    def _runs(self, options: Schedule) -> KnownRuns[_Flight]:
        return self._known.setdefault(options, KnownRuns())

    def _fly(self, schedule: Schedule) -> _Flight:
        self.probes += 1
        noted = self._fly_noting(self._trial, schedule)
        fails = noted.verdict.failure(self._group) is not None
        flight = _Flight(schedule.by_moves(()), fails, *noted)
        self._runs(flight.options).add(flight)
        return flight


def _without_pieces(moves: Moves, size: int) -> Iterator[Moves]:
    """Yield the moves without one group of `size` successive moves; the last groups are left out first."""
    for start in reversed(range(0, len(moves), size)):
        yield (*moves[:start], *moves[start + size :])


def _single_moves(best: _Flight, fifo: _Flight, at_ns: int | None) -> list[Move]:
    """Return all moves between the tasks that matter, before the failure: similar places first, then the last ones."""
    like = _places(best)
    choices = [choice for choice in reversed(fifo.choices) if at_ns is None or choice.now <= at_ns]
    moves = [move for choice in choices for move in _among(choice, _names(best))]
    return sorted(moves, key=lambda move: (move.subject, move.place) not in like)


def _between(best: _Flight, without: _Flight, at: int, size: int) -> list[Move]:
    """Return candidates to replace some moves, near their places in a run without them, similar places first."""
    least = 0 if not at else best.made[at - 1].decision + 1
    replaced = [made.decision for made in best.made[at : at + size]]
    places = range(max(least, replaced[0] - AROUND), min(replaced[-1] + AROUND, len(without.choices)))
    moves = [(move, place) for place in places for move in _among(without.choices[place], _names(best))]
    like = _places(best)

    def rank(found: tuple[Move, int]) -> tuple[bool, int]:
        move, place = found
        return (move.subject, move.place) not in like, min(abs(place - each) for each in replaced)

    return [move for move, _ in sorted(moves, key=rank)]


def _among(choice: Choice, names: set[str]) -> Iterator[Move]:
    """Yield the moves that a decision offers between the given tasks."""
    return (move for move in choice.moves if move.subject in names and move.chosen in names)


def _near(best: _Flight, made: MadeMove) -> Iterator[Choice]:
    """Yield the decision of a move, and the decisions before and after it about the same task."""
    same = [choice for choice in best.choices if choice.moves and choice.moves[0].subject == made.move.subject]
    at = same.index(best.choices[made.decision])
    for each in (at, at + 1, at - 1, at + 2):
        if 0 <= each < len(same):
            yield same[each]


def _same_later(best: _Flight, made: MadeMove) -> Iterator[Move]:
    """Yield the moves between the same tasks, later in the same millisecond."""
    for choice in best.choices[made.decision + 1 :]:
        if choice.now // NS_PER_MS > made.move.from_ms:
            return
        for move in choice.moves:
            if (move.subject, move.chosen) == (
                made.move.subject,
                made.move.chosen,
            ) and choice.preempts == made.preempts:
                yield move


def _places(best: _Flight) -> set[tuple[str, str]]:
    """Return the places of the moves."""
    return {(move.subject, move.place) for move in best.moves}


def _names(best: _Flight) -> set[str]:
    """Return the tasks that matter."""
    return {name for made in best.made for name in (made.move.subject, made.move.chosen)}


def _end_of(at_ns: int) -> int:
    """Return a round time by which a failure has happened."""
    return (at_ns // TENTH_NS + 1) * TENTH_NS
