"""All orders that differ in something, each flown once: dynamic partial-order reduction.

Two runs have the same order when each step has the same earlier steps that it depends on
(`cfepy.extra.exploration.steps`). Such runs differ only in how long tasks waited. From each flown order the search goes
on to its neighbours. A neighbour swaps two successive steps that depend on each other and that nothing else orders. The
later step goes first, and steps that depend on the earlier one are left out. Such a beginning is flown unless a known
order has it. Every order is reached in this way, and few are flown twice. The method follows Flanagan and Godefroid
(POPL 2005). The search looks for beginnings among the orders seen, and keeps no stack, so many processes can fly at
once.
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

BATCH = 8  # schedules handed out at a time; new orders count only between batches


Key = tuple[str, int, int]
"""A step of any order: its task, its place, and its number among the steps there that access something."""


@dataclass(frozen=True, slots=True)
class Beginning:
    """The beginning of a run.

    Attributes:
        runs: the tasks in their turns, each with the end of its turn, as of `cfepy.rtos.InOrder`.
        names: names of its steps except the last one.
        last: the last step (task and place), which goes earlier here than in the order that this was made from. Its
            operation, such as a wait, and so its name, is not known.
        is_pending: the last step is any step that its task makes from there on.
    """

    runs: tuple[tuple[str, int], ...]
    names: frozenset[int]
    last: Key
    is_pending: bool = False


class Order:
    """The order of a run: the dependences of its steps.

    Args:
        steps: of the run.

    Attributes:
        steps: of the run.
        names: of the steps that access something, each with all that it depends on; two runs with the same names have
            the same order.
        places: numbers of these steps.
        timed: number of pairs that are ordered only by the time that other tasks used, as far as `neighbours` has come.
        has_ends: whether a task has ended another one.
    """

    def __init__(self, steps: Sequence[TaskStep]) -> None:
        self.steps = steps
        self._direct: list[_Dependences] = []
        self._past: list[int] = []  # of each step as bits: its dependences and itself
        self._floor: list[int] = []  # earlier steps cannot come later, because virtual time advances between
        self._names: list[frozenset[int]] = []  # its own name; if it accesses nothing, the names of its dependences
        self._touches: defaultdict[str, list[tuple[int, str]]] = defaultdict(list)  # by object: step, access
        self._before: list[int | None] = []  # the step before of the same task
        self._head: list[int] = []  # the first step of each uninterruptible block
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
        """Return the steps on which a step depends directly."""
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
            elif how == ENDS and thing in self._latest:  # the task might have been ended earlier
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
        """Record that taking a lock depends on the task that took it last, and on its release."""
        for other, how in before:
            if how == TAKES:
                conflicts[other].add(thing)
                if gives.get(other) == thing:  # taken and released with no preemption point between
                    del gives[other]
                return
            if how == GIVES and thing not in gives.values():
                gives[other] = thing

    def _section(
        self, at: int, thing: str, conflicts: Mapping[int, set[str]], gives: Mapping[int, str]
    ) -> dict[int, frozenset[int]]:
        """Return, by the step that took a lock last, the steps of its task since then until it released the lock."""
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
        """Return the order of the other applications' steps: for each step, the earlier steps that it depends on."""
        others = [at for at in self.places.values() if self.steps[at].app not in apps]
        return frozenset(
            (self._keys[at], frozenset(self._keys[each] for each in others if self._past[at] >> each & 1))
            for at in others
        )

    def begins(self, beginning: Beginning) -> bool:
        """Return True if the order has all steps of a beginning, and they include all dependences of its last step."""
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
        """Return the number of the last step of a beginning."""
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
        """Yield the beginnings of runs in which two steps are swapped.

        Args:
            left: applications whose tasks keep their order among themselves.
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
        """Return True if another step follows and no task could run in between."""
        return at + 1 < len(self.steps) and self.steps[at + 1].joined

    def _block(self, head: int) -> set[int]:
        """Return a step, and the later steps of its task with no preemption point in between."""
        end = head + 1
        while end < len(self.steps) and self._head[end] == head:
            end += 1
        return set(range(head, end))

    def _is_open(self, earlier: set[int], later: int) -> bool:
        """Return True if nothing else orders steps before another step: no task, no wake-up, no time.

        Args:
            earlier: one step, or several with no preemption point between them.
            later: the other step.
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
        """Return the beginning in which the later of two steps goes first; None if no task can run there.

        The steps that depend on the earlier one are left out.
        """
        bit = 1 << earlier
        kept = [at for at in range(later) if not self._past[at] & bit]
        names = frozenset(name for at in kept if _matters(self.steps[at]) for name in self._names[at])
        turns = self._turns(kept, earlier, later)
        return (
            None if turns is None else Beginning(_runs(turns), names, self._keys[later], _is_pending(self.steps[later]))
        )

    def _turns(self, kept: list[int], earlier: int, later: int) -> list[tuple[str, int]] | None:
        """Return the turns of tasks for the steps to keep, and then for the later step.

        A kept step may be followed by a step that is not kept, with no preemption point between. Then the other tasks
        go first, including tasks that wait for a lock that is released there. This may open a preemption point.
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
            return None  # a later step of the same block depends on it
        if self._head[earlier] in cut and needed >> self._head[earlier] & 1 and not begun:
            return None
        turns = [self._turn(at) for at in kept if at not in after]
        turns += [(task, number + 1) for task, number in map(self._turn, begun)]
        return turns + [self._turn(at) for at in (*now, later, *then)]

    def _may_wait(self, at: int, cut: set[int], after: set[int]) -> bool:
        """Return True if a step may already wait for a lock that is released in the cut block."""
        direct = self._direct[at]
        is_given = any(self._head[each] in cut for each in direct.gives)
        return is_given and not after & (direct.ordered | set(direct.conflicts))

    def _turn(self, at: int) -> tuple[str, int]:
        """Return the task of a step, and the end of its turn: it is over when the task passes the next place."""
        return self.steps[at].task, self.steps[at].number + 1


@dataclass(frozen=True, slots=True)
class _Dependences:
    """The steps on which a step depends directly.

    Attributes:
        conflicts: steps that accessed the same objects, with these objects.
        gives: steps that released a lock that it takes, with the lock.
        ordered: the previous step of its task, and the step that woke it.
        sections: by the step that took one of its locks last, the steps that the other task made with the lock.
    """

    conflicts: dict[int, set[str]]
    gives: dict[int, str]
    ordered: set[int]
    sections: dict[int, frozenset[int]]

    @property
    def all(self) -> set[int]:
        """The numbers of all these steps."""
        return {*self.conflicts, *self.gives, *self.ordered}


def _is_pending(step: TaskStep) -> bool:
    """Return True if a step was not made because its task was ended before."""
    return any(how == PENDS for _, how in step.touched)


def _matters(step: TaskStep) -> bool:
    """Return True if a step accesses anything."""
    return bool(step.touched) and not _is_pending(step)


def _runs(turns: Iterable[tuple[str, int]]) -> tuple[tuple[str, int], ...]:
    """Return turns, with successive turns of one task merged."""
    found: list[tuple[str, int]] = []
    for turn in turns:
        if found and found[-1][0] == turn[0]:
            found.pop()
        found.append(turn)
    return tuple(found)


class OrdersSeen(NamedTuple):
    """The extent of a search of orders.

    Attributes:
        orders: number of different orders seen.
        is_complete: whether there are no others.
        depth: number of steps of a run that may come in another order; None for all of them.
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

    def lines(self, traces: int) -> list[str]:
        """Return a few lines of text.

        Args:
            traces: number of different traces of the runs; orders that no message or event shows have one trace.
        """
        orders = "1 order" if self.orders == 1 else f"{self.orders} different orders"
        text = f"{orders} of accesses, with {'1 trace' if traces == 1 else f'{traces} different traces'}"
        if self.is_complete:
            text += (
                "; no others were found" if self.depth is None else f"; all orders up to {self.depth} steps were seen"
            )
        found = [text]
        if self.astray:
            found.append(f"{self.astray} schedules could not be followed, because of a time or a priority")
        if self.timed:
            found.append(
                f"{self.timed} pairs of steps are ordered by the CPU time of others; the reverse order was not tried"
            )
        if self.has_ends:
            found.append("not all orders were tried in which the subscriptions of a stopped node end")
        return found


class OrderSearch:
    """Schedules of orders that differ, closest to fifo first.

    Args:
        options: a schedule with the options that all schedules have.
        left: applications whose tasks keep their order among themselves.
        depth: number of steps of a run that may come in another order, counted from the instant at which schedules
            begin to differ; None for all of them.

    Attributes:
        astray: number of schedules that did not begin as planned, because time or a priority prevented it.
        timed: number of pairs of steps that are ordered only by the time that other tasks used.
        has_ends: whether tasks were ended by other tasks.
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
        """The number of different orders seen."""
        return len(self._seen)

    @property
    def exhausted(self) -> bool:
        """Whether there are no others."""
        return not (self._ready or self._open or self._away)

    @property
    def seen(self) -> OrdersSeen:
        """The extent of the search so far."""
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
        """Take a verdict. New orders count only when all schedules that were handed out have a verdict."""
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
        """Prepare the next schedules: beginnings that no seen order has."""
        while self._open and len(self._ready) < BATCH:
            beginning = self._open.popleft()
            if not self._is_seen(beginning):
                self._ready.append(beginning)

    def _is_seen(self, beginning: Beginning) -> bool:
        return any(each.begins(beginning) for each in self._seen.values())
