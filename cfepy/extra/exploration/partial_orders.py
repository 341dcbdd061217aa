"""All orders that differ in something, each flown once: dynamic partial-order reduction.

Two runs are of one order when each step has the same steps before it that it depends on
(`cfepy.extra.exploration.steps`): then they differ in nothing but who waited a little longer. From each order that was
flown the search goes on to its
neighbours: where two steps follow each other that depend on each other, and nothing else orders them, the later one
goes first, and what depends on the other is left out. Such a beginning is flown unless an order is known that has it.
Every order is reached like that, and hardly one is flown twice (the idea is that of Flanagan and Godefroid, POPL 2005;
that of looking for beginnings among the orders seen, instead of keeping a stack, lets many processes fly at once).
"""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from hashlib import blake2b
from typing import NamedTuple

from cfepy.extra.exploration.steps import (
    ENDS,
    GIVES,
    HANDED,
    OVERTAKING,
    PENDS,
    READS,
    TAKES,
    TRIES,
    WRITES,
    TaskStep,
    state_of,
)
from cfepy.extra.exploration.verdict import Verdict
from cfepy.rtos import PLACE
from cfepy.schedules import Schedule

BATCH = 8  # schedules that are handed out at a time; what is known of orders changes only between


Key = tuple[str, int, int]
"""A step of any order: its task, which place of it, and which of the steps there that touch something."""


@dataclass(frozen=True, slots=True)
class Beginning:
    """How runs may begin.

    Attributes:
        runs: who runs until when, as of `cfepy.rtos.InOrder`.
        names: of its steps but the last one.
        last: the last step, which goes earlier here than in the order that this was made from: its task and place. What
            it does there, such as to wait, and so its name, is not known.
        is_pending: the last step is any that its task makes from there on.
    """

    runs: tuple[tuple[str, int], ...]
    names: frozenset[int]
    last: Key
    is_pending: bool = False


class Order:
    """The order of a run: what each step depends on.

    Args:
        steps: of the run.

    Attributes:
        steps: of the run.
        names: of the steps that touch something, each with all that it depends on; two runs with the same names are
            of one order.
        places: numbers of these steps.
        timed: how many pairs have their order by the time alone that others used, as far as `neighbours` has come.
        has_ends: whether a task has ended another one.
    """

    def __init__(self, steps: Sequence[TaskStep]) -> None:
        self.steps = steps
        self._direct: list[_Dependences] = []
        self._past: list[int] = []  # of each step as bits: all on which it depends, and itself
        self._floor: list[int] = []  # none of those before can come later, since time goes on between
        self._names: list[frozenset[int]] = []  # its own; of one that touches nothing, those of the ones before it
        self._touches: defaultdict[str, list[tuple[int, str]]] = defaultdict(list)  # by thing: who, and how
        self._before: list[int | None] = []  # the step before of the same task
        self._head: list[int] = []  # the first of those between which nobody could get in
        self._keys: list[Key] = []
        self._hasty = {step.ready for step in steps if step.waker == OVERTAKING}
        self.timed = 0
        self._latest: dict[str, int] = {}  # step of each task
        for at, step in enumerate(steps):
            before = self._latest.get(step.task)
            self._before.append(before)
            self._head.append(at if before is None or not step.joined else self._head[before])
            self._keys.append(self._key(step, before))
            direct = self._dependences(at)
            self._latest[step.task] = at
            self._direct.append(direct)
            self._past.append(1 << at)
            for each in direct.all:
                self._past[at] |= self._past[each]
            own = step.ready if step.waker < 0 else 0
            self._floor.append(max([own, *(self._floor[each] for each in direct.all)]))
            self._names.append(self._named(at, direct))
            for thing, how in step.touched:
                self._touches[thing].append((at, how))
        touching = [at for at, step in enumerate(steps) if _matters(step)]
        self.has_ends = any(how == ENDS for step in steps for _, how in step.touched)
        self.names = frozenset(name for at in touching for name in self._names[at])
        self.places = {self._keys[at]: at for at in touching}

    def _dependences(self, at: int) -> _Dependences:
        """On which steps one depends directly."""
        step, before = self.steps[at], self._before[at]
        conflicts: defaultdict[int, set[str]] = defaultdict(set)
        gives: dict[int, str] = {}
        sections: dict[int, frozenset[int]] = {}
        for thing, how in step.touched:
            earlier = reversed(self._touches[thing])
            if how in (TAKES, TRIES):
                self._after_lock(thing, earlier, conflicts, gives)
                sections |= self._section(at, thing, conflicts, gives)
            elif how in (READS, WRITES):
                for other, other_how in earlier:
                    if WRITES in (how, other_how):
                        conflicts[other].add(thing)
                    if other_how == WRITES:
                        break
            elif how == PENDS:
                conflicts[self._touches[thing][-1][0]].add(thing)
            elif how == ENDS and thing in self._latest:  # it might have been ended earlier
                conflicts[self._latest[thing]].add(thing)
        gives = {each: lock for each, lock in gives.items() if (state_of(lock), WRITES) not in step.touched}
        ordered = set() if before is None else {before}
        if step.waker >= 0:
            handed = [thing for thing, how in step.touched if how == HANDED]
            if handed:  # it might have been taken before, without a wait
                gives[step.waker] = handed[0]
            else:
                ordered.add(step.waker)
        return _Dependences(dict(conflicts), gives, ordered, sections)

    @staticmethod
    def _after_lock(
        thing: str, before: Iterable[tuple[int, str]], conflicts: defaultdict[int, set[str]], gives: dict[int, str]
    ) -> None:
        """A lock is taken after whoever took it last, and gave it back."""
        for other, how in before:
            if how == TAKES:
                conflicts[other].add(thing)
                if gives.get(other) == thing:  # taken and given back with nobody in between
                    del gives[other]
                return
            if how == GIVES and thing not in gives.values():
                gives[other] = thing

    def _section(
        self, at: int, thing: str, conflicts: Mapping[int, set[str]], gives: Mapping[int, str]
    ) -> dict[int, frozenset[int]]:
        """By the step that took a lock last: those that its task made since, until it gave it back."""
        taken = next((each for each, things in conflicts.items() if thing in things), None)
        if taken is None:
            return {}
        is_over = (thing, GIVES) in self.steps[taken].touched[self.steps[taken].touched.index((thing, TAKES)) :]
        given = max((each for each, given in gives.items() if given == thing), default=taken if is_over else at)
        while given + 1 < at and self.steps[given + 1].joined:
            given += 1
        task = self.steps[taken].task
        return {taken: frozenset(at for at in range(taken + 1, given + 1) if self.steps[at].task == task)}

    def _named(self, at: int, direct: _Dependences) -> frozenset[int]:
        step = self.steps[at]
        before = frozenset(name for each in direct.all for name in self._names[each])
        if not _matters(step):
            return before
        told = repr((*self._keys[at], sorted(before)))
        return frozenset([int.from_bytes(blake2b(told.encode(), digest_size=8).digest())])

    def _key(self, step: TaskStep, before: int | None) -> Key:
        place = step.number // PLACE
        if before is None or self._keys[before][1] != place:
            return step.task, place, 0
        return step.task, place, self._keys[before][2] + _matters(self.steps[before])

    def without(self, apps: Collection[str]) -> frozenset[tuple[Key, frozenset[Key]]]:
        """The order of the other applications: which of their steps come before which."""
        others = [at for at in self.places.values() if self.steps[at].app not in apps]
        return frozenset(
            (self._keys[at], frozenset(self._keys[each] for each in others if self._past[at] >> each & 1))
            for at in others
        )

    def begins(self, beginning: Beginning) -> bool:
        """Whether it has all steps of a beginning, and all that comes before the last one there is among them."""
        at = self._place_of(beginning)
        if at is None or not beginning.names <= self.names:
            return False
        past = self._past[at] & ~(1 << at)
        return all(
            self._names[each] <= beginning.names
            for each in range(at)
            if past >> each & 1 and _matters(self.steps[each])
        )

    def _place_of(self, beginning: Beginning) -> int | None:
        """The number of the last step of a beginning."""
        if not beginning.is_pending:
            return self.places.get(beginning.last)
        task, place, number = beginning.last
        return next(
            (
                at
                for at, step in enumerate(self.steps)
                if step.task == task and self._keys[at][1:] >= (place, number) and not _is_pending(step)
            ),
            None,
        )

    def neighbours(self, left: Collection[str] = ()) -> Iterator[Beginning]:
        """How runs begin in which two steps go the other way round.

        Args:
            left: applications whose tasks keep the order among themselves that they have.
        """
        for later, direct in enumerate(self._direct):
            whole: set[int] = set()
            for earlier in sorted(direct.conflicts):
                if self.steps[earlier].app in left and self.steps[later].app in left:
                    continue
                found = self._reversed(earlier, later) if self._is_open({earlier}, later) else None
                if found is not None:
                    yield found
                elif self._head[earlier] != earlier or self._is_head(earlier):
                    whole.add(self._head[earlier])
            for head in sorted(whole):
                if self._is_open(self._block(head), later):
                    found = self._reversed(head, later)
                    if found is not None:
                        yield found

    def _is_head(self, at: int) -> bool:
        """Whether another step follows with nobody in between."""
        return at + 1 < len(self.steps) and self.steps[at + 1].joined

    def _block(self, head: int) -> set[int]:
        """A step, and those of its task that follow it with nobody in between."""
        end = head + 1
        while end < len(self.steps) and self._head[end] == head:
            end += 1
        return set(range(head, end))

    def _is_open(self, earlier: set[int], later: int) -> bool:
        """Whether nothing else has steps come before another: no task, no wake-up, no time.

        Args:
            earlier: one step, or several between which nobody can get in.
            later: the other one.
        """
        step, direct, first = self.steps[later], self._direct[later], min(earlier)
        if self.steps[first].task == step.task or earlier & direct.ordered:
            return False
        if len(earlier) == 1 and first in direct.gives:
            return False
        if any(first in section for section in direct.sections.values()):
            return False  # its task had the lock then
        locks = {lock for each in earlier for lock in direct.conflicts.get(each, ())}
        sections = {at for each in earlier for at in direct.sections.get(each, ())}
        others = {*direct.conflicts, *direct.ordered} - earlier - sections
        others |= {each for each, thing in direct.gives.items() if thing not in locks}
        if any(self._past[each] >> first & 1 for each in others):
            return False
        times = [self._floor[each] for each in others] + [step.ready if step.waker < 0 else 0]
        hard = [each for each in times if each > first]
        self.timed += bool(hard) and self._hasty.issuperset(hard)
        return not hard

    def _reversed(self, earlier: int, later: int) -> Beginning | None:
        """The beginning in which the later of two steps goes first; what depends on the earlier one is left out.

        None when nobody can get in there.
        """
        bit = 1 << earlier
        kept = [at for at in range(later) if not self._past[at] & bit]
        names = frozenset(name for at in kept if _matters(self.steps[at]) for name in self._names[at])
        turns = self._turns(kept, earlier, later)
        return (
            None if turns is None else Beginning(_runs(turns), names, self._keys[later], _is_pending(self.steps[later]))
        )

    def _turns(self, kept: list[int], earlier: int, later: int) -> list[tuple[str, int]] | None:
        """Who runs until when, for the steps to be kept, and then the later one.

        Where a step is kept and the one after it is not, with nobody in between, the other tasks go first, those that
        wait for a lock that is given back there, too: then somebody may get in after all.
        """
        stays = set(kept)
        cut = {
            self._head[at - 1]
            for at in range(1, later)
            if self.steps[at].joined and at - 1 in stays and at not in stays
        }
        mask = sum(1 << head for head in cut)
        after = {at for at in kept if self._past[at] & mask}
        needed = 0
        for each in self._direct[later].all:
            needed |= self._past[each] if each in stays else 0
        now = [at for at in kept if at in after and needed >> at & 1]
        then = [at for at in kept if at in after and not needed >> at & 1]
        begun = [at for at in (*now, later) if self._may_wait(at, cut, after)]
        rest = {each for at in self._block(self._head[later]) if at > later for each in self._direct[at].all}
        if any(self._head[each] == self._head[earlier] and each < earlier for each in rest):
            return None  # what follows the later one with nobody in between
        if self._head[earlier] in cut and needed >> self._head[earlier] & 1 and not begun:
            return None
        turns = [self._turn(at) for at in kept if at not in after]
        turns += [(task, number + 1) for task, number in map(self._turn, begun)]
        return turns + [self._turn(at) for at in (*now, later, *then)]

    def _may_wait(self, at: int, cut: set[int], after: set[int]) -> bool:
        """Whether a step may wait already for a lock that is given back in what is cut."""
        direct = self._direct[at]
        is_given = any(self._head[each] in cut for each in direct.gives)
        return is_given and not after & (direct.ordered | set(direct.conflicts))

    def _turn(self, at: int) -> tuple[str, int]:
        """Whose turn a step is, and until when: it is over when the next place is passed."""
        return self.steps[at].task, self.steps[at].number + 1


@dataclass(frozen=True, slots=True)
class _Dependences:
    """The steps on which one depends directly.

    Attributes:
        conflicts: those that touched what it touches, with these things.
        gives: those that gave back a lock that it takes, with the lock.
        ordered: the one before of its task, and the one that woke it.
        sections: by the step that took a lock last which it takes, those that the other task made with it.
    """

    conflicts: dict[int, set[str]]
    gives: dict[int, str]
    ordered: set[int]
    sections: dict[int, frozenset[int]]

    @property
    def all(self) -> set[int]:
        """All of them."""
        return {*self.conflicts, *self.gives, *self.ordered}


def _is_pending(step: TaskStep) -> bool:
    """Whether a step was not made, since its task was ended before."""
    return any(how == PENDS for _, how in step.touched)


def _matters(step: TaskStep) -> bool:
    """Whether a step touches anything."""
    return bool(step.touched) and not _is_pending(step)


def _runs(turns: Iterable[tuple[str, int]]) -> tuple[tuple[str, int], ...]:
    """Turns, with those of one task in a row as one."""
    found: list[tuple[str, int]] = []
    for turn in turns:
        if found and found[-1][0] == turn[0]:
            found.pop()
        found.append(turn)
    return tuple(found)


class OrdersSeen(NamedTuple):
    """How far a search of orders came.

    Attributes:
        orders: how many different ones were seen.
        is_complete: whether it found no others.
        depth: how many steps of a run might come in another order; None for all of them.
        astray: see `OrderSearch`.
        timed: see `OrderSearch`.
        has_ends: see `OrderSearch`.
    """

    orders: int
    is_complete: bool
    depth: int | None = None
    astray: int = 0
    timed: int = 0
    has_ends: bool = False

    def lines(self) -> list[str]:
        """A few lines for a person, the first one as a part of a sentence."""
        told = f"{self.orders} of them in what tasks touch"
        if self.is_complete:
            told += (
                "; no others were found" if self.depth is None else f"; all orders up to {self.depth} steps were seen"
            )
        found = [told]
        if self.astray:
            found.append(f"{self.astray} schedules could not go as they were to: time or a priority is against it")
        if self.timed:
            found.append(f"{self.timed} pairs of steps came in the order of the time that others used; it was left so")
        if self.has_ends:
            found.append("how the subscriptions of a node end that is ended was not tried in all orders")
        return found


class OrderSearch:
    """Schedules of orders that differ, those that are closer to fifo first.

    Args:
        options: a schedule whose options all have.
        left: applications whose tasks keep the order among themselves that they have.
        depth: how many steps of a run may come in another order, from the instant on at which schedules part; None for
            all of them.

    Attributes:
        astray: how many schedules did not go as they were to begin, since time or a priority was against it.
        timed: how many pairs of steps have their order by the time alone that others used.
        has_ends: whether tasks were ended by others.
    """

    def __init__(self, options: Schedule, left: Collection[str] = (), depth: int | None = None) -> None:
        self._left = left
        self._depth = depth
        self._options = options
        self._open: deque[Beginning] = deque()
        self._ready: deque[Beginning | None] = deque([None])  # the first run is fifo's
        self._away: list[Beginning | None] = []
        self._told: list[Order] = []
        self._known: set[tuple[Key, int]] = set()
        self._seen: dict[frozenset[int], Order] = {}
        self.astray = 0
        self.timed = 0
        self.has_ends = False

    @property
    def orders(self) -> int:
        """How many different ones were seen."""
        return len(self._seen)

    @property
    def exhausted(self) -> bool:
        """Whether there are no others."""
        return not (self._ready or self._open or self._away)

    @property
    def seen(self) -> OrdersSeen:
        """How far it came."""
        is_complete = self.exhausted and not self.astray
        return OrdersSeen(self.orders, is_complete, self._depth, self.astray, self.timed, self.has_ends)

    def next(self) -> Schedule | None:
        if not self._ready and not self._away:
            self._fill()
        if not self._ready:
            return None
        beginning = self._ready.popleft()
        self._away.append(beginning)
        return self._options.in_order(() if beginning is None else beginning.runs)

    def tell(self, number: int, verdict: Verdict) -> None:
        """What is new counts when all that were handed out are back."""
        order = Order(verdict.steps[: self._depth])
        self._told.append(order)
        if len(self._told) < len(self._away) or self._ready:
            return
        for beginning, each in zip(self._away, self._told, strict=True):
            self.astray += beginning is not None and not each.begins(beginning)
            self._learn(each)
        self._away, self._told = [], []

    def _learn(self, order: Order) -> None:
        if order.names in self._seen:
            return
        self._seen[order.names] = order
        for beginning in order.neighbours(self._left):
            key = beginning.last, hash(beginning.names)
            if key not in self._known:
                self._known.add(key)
                self._open.append(beginning)
        self.timed += order.timed
        self.has_ends |= order.has_ends

    def _fill(self) -> None:
        """The next ones to fly: beginnings that no order seen has."""
        while self._open and len(self._ready) < BATCH:
            beginning = self._open.popleft()
            if not self._is_seen(beginning):
                self._ready.append(beginning)

    def _is_seen(self, beginning: Beginning) -> bool:
        return any(each.begins(beginning) for each in self._seen.values())
