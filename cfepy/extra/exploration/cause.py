"""The cause of a failure in one sentence, if the observations show it.

The module compares the operations (deeds) of the failing run with the operations of the run under fifo, which does not
fail. A sentence states an event that is in the failing run and not in the other. If none of the patterns below matches,
there is no sentence.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from cfepy.extra.exploration import operations as do
from cfepy.extra.exploration.made_moves import MadeMove
from cfepy.extra.exploration.operations import Deed, keys_of
from cfepy.extra.exploration.run_times import longest_more
from cfepy.extra.exploration.shared_objects import is_made_of
from cfepy.extra.exploration.task_look import AT, ORDERED, PREEMPTED, Row
from cfepy.extra.exploration.verdict import DEADLOCK, DIED, RAISED, Failure
from cfepy.rtos import HOLD
from cfepy.schedules import plain_name
from cfepy.units import time_text

_PLACE = re.compile(r"\(([\w.-]+:\d+)\)$")  # of an exception, at the end of its text
NOTHING: Counter[str] = Counter()
NOBODY = "0"  # number of tasks that were woken
_MISSING = re.compile(
    r"(?:AttributeError: '(?P<owner>\w+)' object has no attribute '(?P<attribute>\w+)'"
    r"|NameError: name '(?P<name>\w+)' is not defined).*\((?P<place>[\w.-]+:\d+)\)$"
)
_HELD = re.compile(r"(?P<task>\S+) waits for (?P<what>[^;]+), held by (?P<holder>[^;,]+)")


class Evidence:
    """The observations of a failure.

    Args:
        failure: the failure.
        moves: the deviations of the schedule.
        rows: of the failing run, up to the failure.
        deeds: of the failing run, up to the failure.
        usual: the deeds of the run under fifo.
        names: names of the locks that the failure identifies by number.
        ran: by task, the ns for which it ran in the span of a missed deadline; empty for other failures.
        usually_ran: the same under fifo.
    """

    def __init__(
        self,
        failure: Failure,
        moves: Sequence[MadeMove],
        rows: Sequence[Row],
        deeds: Sequence[Deed],
        usual: Sequence[Deed],
        names: Mapping[str, str],
        ran: Counter[str] = NOTHING,
        usually_ran: Counter[str] = NOTHING,
    ) -> None:
        self.failure = failure
        self.moves = moves
        self.rows = rows
        self.deeds = deeds
        self.usual = usual
        self.names = names
        self.ran = ran
        self.usually_ran = usually_ran
        self._keys = list(keys_of(self.deeds))
        self._usual_at = {key: at for at, key in enumerate(keys_of(self.usual))}
        self._usual_lines: dict[tuple[str, str, str], int] = {}  # the first deed of each task in each line
        for at, deed in enumerate(self.usual):
            self._usual_lines.setdefault((plain_name(deed.task), deed.verb, deed.place), at)

    def is_flipped(self, first: int, second: int) -> bool:
        """Return True if two deeds of the failing run came in the other order under fifo."""
        one, other = (self._usual_at.get(self._keys[at]) for at in (first, second))
        return one is not None and other is not None and other < one

    def are_lines_flipped(self, first: int, second: int) -> bool:
        """Return True if two tasks came to the lines of two deeds of the failing run in the other order under fifo."""
        deeds = (self.deeds[at] for at in (first, second))
        one, other = (self._usual_lines.get((plain_name(deed.task), deed.verb, deed.place)) for deed in deeds)
        return one is not None and other is not None and other < one


class Cause(NamedTuple):
    """The cause of a failure.

    Attributes:
        text: the sentence; empty if the cause is not known.
        deeds: the deeds that the sentence names.
    """

    text: str = ""
    deeds: tuple[Deed, ...] = ()


NO_CAUSE = Cause()


def cause_of(evidence: Evidence) -> Cause:
    """Return the cause; it has no text if no pattern matches."""
    sentences: tuple[Callable[[Evidence], Cause], ...] = (
        deadlock_of,
        _late,
        _lost_update,
        _lost_wake_up,
        _overflow,
        _late_subscription,
        _deleted,
        _message_order,
        _given_twice,
        _read_too_early,
        _torn,
        _raised,
        _order,
        _write_order,
        _one_switch,
    )
    return next((cause for cause in (sentence(evidence) for sentence in sentences) if cause.text), NO_CAUSE)


# -- deadlock --------------------------------------------------------------------------------------------------------


def deadlock_of(evidence: Evidence) -> Cause:
    """Return a cause if each task of a cycle holds the lock that the task before it wants."""
    if evidence.failure.kind != DEADLOCK:
        return NO_CAUSE
    waits = [(found["task"], found["what"], found["holder"]) for found in _HELD.finditer(evidence.failure.text)]
    wanted = {task: evidence.names.get(what, what) for task, what, _ in waits}
    held = {holder: evidence.names.get(what, what) for _, what, holder in waits}
    if len(waits) < 2 or wanted.keys() != held.keys():
        return NO_CAUSE
    text = "; ".join(f"{task} holds {held[task]} and waits for {wanted[task]}" for task in wanted)
    deeds = [_last_of(evidence.deeds, task, do.HAS, held[task]) for task in wanted]
    deeds += [_last_of(evidence.deeds, task, do.WANTS, wanted[task]) for task in wanted]
    return Cause(text, tuple(deed for deed in deeds if deed is not None))


def _last_of(deeds: Sequence[Deed], task: str, verb: str, thing: str) -> Deed | None:
    """Return the last deed of a task of this kind to this object."""
    return next((deed for deed in reversed(deeds) if (deed.task, deed.verb, deed.thing) == (task, verb, thing)), None)


# -- time ------------------------------------------------------------------------------------------------------------


def _late(evidence: Evidence) -> Cause:
    """Return a cause if another task ran for longer than usual in the span of a missed deadline."""
    span_ns = evidence.failure.span_ns
    task = "" if span_ns is None else longest_more(evidence.ran, evidence.usually_ran, span_ns)
    if span_ns is None or not task:
        return NO_CAUSE
    ran, usual, span = (time_text(each) for each in (evidence.ran[task], evidence.usually_ran[task], span_ns))
    return Cause(f"{task} ran for {ran} of the {span} before the missed deadline; under fifo it runs for {usual}")


# -- accesses --------------------------------------------------------------------------------------------------------


class Torn(NamedTuple):
    """Two accesses of a task, and an access of another task between them that makes them unserializable.

    No serial order of the two tasks gives such an interleaving (Lu, Tucek, Qin, Zhou: AVIO, ASPLOS 2006).

    Attributes:
        first: the first access of the task.
        other: the access of the other task after it.
        last: the next access of the first task to the same variable.
        switch: number of switches of the schedule before the other task's access; 0 if no switch let the other task in.
    """

    first: Deed
    other: Deed
    last: Deed
    switch: int

    @property
    def key(self) -> tuple[str, ...]:
        """The parts that are the same for the same interleaving in another run."""
        places = (self.first.place, self.other.place, self.last.place)
        return (plain_name(self.first.task), plain_name(self.other.task), self.other.thing, *places)


_DO_NOT_GO_TOGETHER = {
    (do.READS, do.WRITES, do.READS),
    (do.WRITES, do.WRITES, do.READS),
    (do.READS, do.WRITES, do.WRITES),
    (do.WRITES, do.READS, do.WRITES),
}


def _lost_update(evidence: Evidence) -> Cause:
    """Return a cause if a task overwrites a value that another task wrote after the first task's read."""
    return _told(evidence, _is_lost_update, _update_text)


def _torn(evidence: Evidence) -> Cause:
    """Return a cause if another task accesses a variable between two accesses of a task."""
    return _told(evidence, lambda torn: True, _torn_text)


def _told(evidence: Evidence, is_meant: Callable[[Torn], bool], text: Callable[[Torn], str]) -> Cause:
    """Return the first case after the last switch that let another task in and that fifo does not show."""
    usual = {torn.key for torn in _torn_in(evidence.usual)}
    found = [each for each in _torn_in(evidence.deeds) if each.switch and each.key not in usual and is_meant(each)]
    last = max((torn.switch for torn in found), default=0)
    chosen = next((torn for torn in found if torn.switch == last), None)
    return NO_CAUSE if chosen is None else Cause(text(chosen), (chosen.first, chosen.other, chosen.last))


@dataclass(slots=True)
class _Own:
    """The accesses of a task to an object, and the accesses of other tasks since then.

    Attributes:
        epoch: epoch of the task; a new one begins with each message that the task waits for.
        own: its accesses, each with the number of the last switch.
        others: later accesses of other tasks, each with the switch by which the task was preempted; 0 for none.
    """

    epoch: int
    own: list[tuple[Deed, int]] = field(default_factory=list)
    others: list[tuple[Deed, int]] = field(default_factory=list)


def _torn_in(deeds: Sequence[Deed]) -> Iterator[Torn]:
    """Yield all cases of a run, in the order of their ends. A task that waits for another message begins anew."""
    seen: dict[int | str, dict[str, _Own]] = {}  # by object, by task
    epochs: dict[str, int] = {}
    gave_way: dict[str, int] = {}
    switches = 0
    for deed in deeds:
        if deed.verb == do.GIVES_WAY:
            switches += 1
            gave_way[deed.task] = switches
        elif deed.verb == do.RECEIVES:
            epochs[deed.task] = epochs.get(deed.task, 0) + 1
        elif deed.verb in (do.READS, do.WRITES):
            by_task = seen.setdefault(deed.ident or deed.thing, {})
            epoch = epochs.get(deed.task, 0)
            mine = by_task.get(deed.task)
            if mine is None or mine.epoch != epoch:
                mine = by_task[deed.task] = _Own(epoch)
            yield from _ended_by(deed, mine)
            mine.own = [each for each in mine.own if not each[0].is_of_same(deed)] + [(deed, switches)]
            mine.others = [each for each in mine.others if not each[0].is_of_same(deed)]
            for task, its in by_task.items():
                if task != deed.task and not any(_is_like(each, deed) for each, _ in its.others):
                    its.others.append((deed, gave_way.get(task, 0)))


def _is_like(one: Deed, other: Deed) -> bool:
    """Return True if an access adds nothing to an earlier one."""
    return (one.task, one.verb, one.key) == (other.task, other.verb, other.key)


def _ended_by(last: Deed, mine: _Own) -> Iterator[Torn]:
    for first, since in mine.own:
        for other, switch in mine.others:
            kinds = (first.verb, other.verb, last.verb)
            if first.is_of_same(last) and other.is_of_same(last) and kinds in _DO_NOT_GO_TOGETHER:
                yield Torn(first, other, last, switch if switch > since else 0)


def _is_lost_update(torn: Torn) -> bool:
    if (torn.first.verb, torn.other.verb, torn.last.verb) != (do.READS, do.WRITES, do.WRITES):
        return False
    return not torn.first.ident or is_made_of(torn.last.note, torn.first.place, torn.last.place, torn.last.key)


def _update_text(torn: Torn) -> str:
    first, other, last, _ = torn
    return (
        f"an update of {other.thing} is lost: {other.task} wrote it at {other.place}, between {first.task}'s read at "
        f"{first.place} and {last.task}'s write at {last.place}"
    )


def _torn_text(torn: Torn) -> str:
    first, other, last, _ = torn
    words = {do.READS: "read", do.WRITES: "change" if other.key == do.ALL else "write"}
    one, two = words[first.verb], words[last.verb]
    between = f"{one}s at {first.place} and {last.place}"
    if one != two:
        between = f"{one} at {first.place} and {first.task}'s {two} at {last.place}"
    return f"{other.task} {_did(other)} {other.thing} at {other.place}, between {first.task}'s {between}"


def _raised(evidence: Evidence) -> Cause:
    """Return a cause if another task changed a value that a line had read when the line raised an exception."""
    place = _PLACE.search(evidence.failure.text)
    if evidence.failure.kind not in (RAISED, DIED) or place is None:
        return NO_CAUSE
    task = evidence.failure.task
    begun = max(
        (at for at, deed in _of(evidence.deeds, do.GIVES_WAY) if deed.task == task), default=len(evidence.deeds)
    )
    read = [deed for deed in evidence.deeds[:begun] if (deed.task, deed.place, deed.verb) == (task, place[1], do.READS)]
    for deed in evidence.deeds[begun:]:
        if deed.verb == do.WRITES and deed.task != task and any(each.is_of_same(deed) for each in read[-1:]):
            text = (
                f"{deed.task} {_did(deed)} {deed.thing} at {deed.place}, between {task}'s read at {place[1]} and the "
                "exception there"
            )
            return Cause(text, (read[-1], deed))
    return NO_CAUSE


def _read_too_early(evidence: Evidence) -> Cause:
    """Return a cause if a line read an attribute or a variable that a task writes later, and earlier under fifo."""
    found = _MISSING.match(evidence.failure.text)
    if evidence.failure.kind not in (RAISED, DIED) or found is None:
        return NO_CAUSE
    thing = found["name"] or f"{found['owner']}.{found['attribute']}"
    written = [deed for _, deed in _of(evidence.usual, do.WRITES) if deed.thing.rpartition(" ")[2] == thing]
    if not written:
        return NO_CAUSE
    first = written[0]
    task = evidence.failure.task
    writes = f"it was written at {first.place}" if first.task == task else f"{first.task} wrote it at {first.place}"
    text = f"{task} read {thing} at {found['place']} before {writes}; under fifo it is written first"
    return Cause(text, tuple(deed for deed in evidence.deeds if deed.place == first.place and deed.thing == thing))


def _write_order(evidence: Evidence) -> Cause:
    """Return a cause if two writes have another order than under fifo, for one variable only.

    The first write to a new item of a dictionary is a change of all of it, so lines are compared, not objects.
    """
    found = list(_flipped_accesses(evidence, _are_writes, evidence.are_lines_flipped))
    if not found or len({(later.ident, later.key) for _, later in found}) != 1:
        return NO_CAUSE
    earlier, later = found[0]
    thing = earlier.thing if later.key == do.ALL else later.thing
    text = (
        f"{later.task} wrote {thing} at {later.place} after {earlier.task} wrote it at {earlier.place}; under fifo the "
        "order is reversed"
    )
    return Cause(text, (earlier, later))


def _order(evidence: Evidence) -> Cause:
    """Return a cause if a read and a write have another order than under fifo, for one variable only."""
    found = list(_flipped_accesses(evidence, _is_order_seen, evidence.is_flipped))
    if len({later.thing for _, later in found}) != 1:
        return NO_CAUSE
    earlier, later = found[0]
    text = (
        f"{earlier.task} {_did(earlier)} {later.thing} at {earlier.place} before {later.task} {_did(later)} it at "
        f"{later.place}; under fifo the order is reversed"
    )
    return Cause(text, (earlier, later))


def _flipped_accesses(
    evidence: Evidence, is_meant: Callable[[Deed, Deed], bool], is_flipped: Callable[[int, int], bool]
) -> Iterator[tuple[Deed, Deed]]:
    """Yield accesses of two tasks in another order than under fifo, if a switch delayed the second task."""
    gave_way: dict[str, int] = {}
    seen: dict[int, list[int]] = {}
    for at, deed in enumerate(evidence.deeds):
        if deed.verb == do.GIVES_WAY:
            gave_way[deed.task] = at
        elif deed.verb in (do.READS, do.WRITES) and deed.ident:
            for earlier_at in seen.setdefault(deed.ident, []):
                earlier = evidence.deeds[earlier_at]
                is_kept_back = earlier_at > gave_way.get(deed.task, at) and earlier.task != deed.task
                if is_kept_back and is_meant(earlier, deed) and is_flipped(earlier_at, at):
                    yield earlier, deed
            seen[deed.ident].append(at)


def _is_order_seen(one: Deed, other: Deed) -> bool:
    """Return True if the order of two accesses matters. A change of a whole container also counts as a read of it."""
    both = (one, other)
    reads = any(each.verb == do.READS or each.key == do.ALL for each in both)
    return one.is_of_same(other) and reads and any(each.verb == do.WRITES for each in both)


def _are_writes(one: Deed, other: Deed) -> bool:
    return one.is_of_same(other) and (one.verb, other.verb) == (do.WRITES, do.WRITES)


def _did(deed: Deed) -> str:
    return "read" if deed.verb == do.READS else "changed" if deed.key == do.ALL else "wrote"


# -- wake-ups --------------------------------------------------------------------------------------------------------


def _lost_wake_up(evidence: Evidence) -> Cause:
    """Return a cause if a task waits in vain because the object was set or notified before the wait."""
    for at in _vain_waits(evidence.deeds):
        for cause in (_notified_early(evidence, at), _set_and_cleared(evidence, at)):
            if cause.text:
                return cause
    return NO_CAUSE


def _notified_early(evidence: Evidence, at: int) -> Cause:
    wait = evidence.deeds[at]
    last = _last(evidence.deeds[:at], wait, do.NOTIFIES)
    if last is None or evidence.deeds[last].note != NOBODY or not evidence.is_flipped(last, at):
        return NO_CAUSE
    deed = evidence.deeds[last]
    text = f"{deed.task}'s notify at {deed.place} came before {wait.task}'s wait at {wait.place}: no task was waiting"
    return Cause(text, (deed, wait))


def _set_and_cleared(evidence: Evidence, at: int) -> Cause:
    """Return a cause if an event was set while the task that clears it was delayed."""
    wait = evidence.deeds[at]
    cleared_at = _last(evidence.deeds[:at], wait, do.CLEARS)
    set_at = None if cleared_at is None else _last(evidence.deeds[:cleared_at], wait, do.SETS)
    if cleared_at is None or set_at is None:
        return NO_CAUSE
    cleared, was_set = evidence.deeds[cleared_at], evidence.deeds[set_at]
    own = (each for each in reversed(range(cleared_at)) if evidence.deeds[each].task == cleared.task)
    before = next(own, cleared_at)
    gave_way = evidence.deeds[before].verb == do.GIVES_WAY and before < set_at
    if was_set.task == cleared.task or not (gave_way or evidence.is_flipped(set_at, cleared_at)):
        return NO_CAUSE
    text = (
        f"{was_set.task} set {wait.thing} at {was_set.place}, then {cleared.task} cleared it at {cleared.place}; "
        f"{wait.task} waits for it at {wait.place} in vain"
    )
    return Cause(text, (was_set, cleared, wait))


def _given_twice(evidence: Evidence) -> Cause:
    """Return a cause if a binary semaphore was given while it was given already, which does not happen under fifo."""
    end_ns = evidence.deeds[-1].at_ns if evidence.deeds else 0
    as_far = [deed for deed in evidence.usual if deed.at_ns <= end_ns]
    usual = {(plain_name(second.task), second.thing) for _, second in _second_gives(as_far)}
    for first, second in _second_gives(evidence.deeds):
        if (plain_name(second.task), second.thing) not in usual:
            giver = "its own give" if first.task == second.task else f"{first.task}'s give"
            text = (
                f"{second.task} gave {second.thing} at {second.place} while it was given already, by {giver} at "
                f"{first.place}, so one give is lost; under fifo a task takes it in between"
            )
            return Cause(text, (first, second))
    return NO_CAUSE


def _second_gives(deeds: Sequence[Deed]) -> Iterator[tuple[Deed, Deed]]:
    """Yield a give of a binary semaphore, and the next one while no task had taken the first."""
    given: dict[str, Deed] = {}
    waiting: dict[str, list[str]] = {}
    for deed in deeds:
        if deed.note != do.BINARY:
            continue
        waiters = waiting.setdefault(deed.thing, [])
        if deed.verb == do.WANTS and given.pop(deed.thing, None) is None:
            waiters.append(deed.task)
        elif deed.verb == do.GIVES and waiters:
            waiters.pop(0)
        elif deed.verb == do.GIVES:
            if deed.thing in given:
                yield given[deed.thing], deed
            given[deed.thing] = deed
        elif deed.verb == do.GIVES_UP and deed.task in waiters:
            waiters.remove(deed.task)


def _vain_waits(deeds: Sequence[Deed]) -> list[int]:
    """Return the positions of the waits that no wake-up ended before the failure, the last one first."""
    begun: dict[tuple[str, str], int] = {}
    vain: list[int] = []
    for at, deed in enumerate(deeds):
        key = (deed.task, deed.thing)
        if deed.verb == do.AWAITS:
            begun[key] = at
        elif deed.verb == do.WAKES:
            begun.pop(key, None)
        elif deed.verb == do.GIVES_UP and key in begun:
            vain.append(begun.pop(key))
    return sorted([*vain, *begun.values()], reverse=True)


def _last(deeds: Sequence[Deed], like: Deed, verb: str) -> int | None:
    """Return the position of the last deed of this kind to the same object."""
    found = (at for at in reversed(range(len(deeds))) if deeds[at].verb == verb and deeds[at].thing == like.thing)
    return next(found, None)


# -- messages --------------------------------------------------------------------------------------------------------


def _overflow(evidence: Evidence) -> Cause:
    """Return a cause if a message did not fit into a pipe, although all messages fit under fifo."""
    usual = {(deed.thing, deed.note) for deed in evidence.usual if deed.verb == do.LOSES}
    for deed in evidence.deeds:
        if deed.verb == do.LOSES and (deed.thing, deed.note) not in usual:
            app, _, depth = deed.note.partition(", ")
            where = f" at {deed.place}" if deed.place else ""
            full = f"full, with {depth} {'message' if depth == '1' else 'messages'}"
            text = (
                f"a message {deed.thing} that {deed.task} sent{where} was lost: the pipe of {app} was {full}; "
                "under fifo no message is lost there"
            )
            return Cause(text, (deed,))
    return NO_CAUSE


def _late_subscription(evidence: Evidence) -> Cause:
    """Return a cause if a message was sent before a task subscribed to it."""
    for at, subscription in _of(evidence.deeds, do.SUBSCRIBES):
        for sent_at, sending in _of(evidence.deeds[:at], do.SENDS):
            if sending.thing == subscription.thing and evidence.is_flipped(sent_at, at):
                text = (
                    f"{sending.task} sent {sending.thing} at {sending.place} before {subscription.task} subscribed to "
                    f"it at {subscription.place}; under fifo the order is reversed"
                )
                return Cause(text, (sending, subscription))
    return NO_CAUSE


def _deleted(evidence: Evidence) -> Cause:
    """Return a cause if a task tried to receive from a deleted pipe."""
    usual = {deed.thing for _, deed in _received_late(evidence.usual)}
    for deletion, receiving in _received_late(evidence.deeds):
        if receiving.thing not in usual:
            text = (
                f"{deletion.task} deleted {deletion.thing} at {deletion.place} before {receiving.task} tried to "
                f"receive from it at {receiving.place}; under fifo no task does so after the deletion"
            )
            return Cause(text, (deletion, receiving))
    return NO_CAUSE


def _received_late(deeds: Sequence[Deed]) -> Iterator[tuple[Deed, Deed]]:
    """Yield the deletion of a pipe, and a later attempt to receive from it."""
    deleted: dict[str, Deed] = {}
    for deed in deeds:
        if deed.verb == do.DELETES:
            deleted[deed.thing] = deed
        elif deed.verb == do.RECEIVES and deed.thing in deleted:
            yield deleted[deed.thing], deed
        elif deed.verb == do.SUBSCRIBES:  # a new pipe of that name
            deleted.pop(f"pipe {deed.note}", None)


def _message_order(evidence: Evidence) -> Cause:
    """Return a cause if an application that the schedule affects received two messages in another order."""
    apps = {deed.app for deed in evidence.deeds for move in evidence.moves if deed.task in (move.task, move.chosen)}
    got = [(at, deed) for at, deed in _of(evidence.deeds, do.GETS) if deed.app in apps]
    for number, (at, later) in enumerate(got):
        for earlier_at, earlier in reversed(got[:number]):
            if earlier.app == later.app and earlier.thing != later.thing and evidence.is_flipped(earlier_at, at):
                text = f"{earlier.app} got {earlier.thing} before {later.thing}; under fifo it gets {later.thing} first"
                return Cause(text, (earlier, later))
    return NO_CAUSE


# -- other causes ------------------------------------------------------------------------------------------------------


def _one_switch(evidence: Evidence) -> Cause:
    """Return a cause if the schedule differs from fifo by a single switch."""
    moves = [at for at, row in enumerate(evidence.rows) if row.kind in (PREEMPTED, ORDERED)]
    if len(evidence.moves) != 1 or evidence.moves[0].question or len(moves) != 1:
        return NO_CAUSE
    row = evidence.rows[moves[0]]
    before = (each.text for each in reversed(evidence.rows[: moves[0]]) if each.task == row.task and each.kind == AT)
    place = ":".join(next(before, "").split(":")[:2])
    if row.kind == ORDERED:
        return Cause(
            f"{row.text} continued before {row.task}, which was ready first; without this change the run does not fail"
        )
    if not place:
        return NO_CAUSE
    if row.text == HOLD:
        return Cause(f"{row.task} was delayed at {place}; without this delay the run does not fail")
    return Cause(f"{row.text} preempted {row.task} at {place}; without this preemption the run does not fail")


def _of(deeds: Sequence[Deed], verb: str) -> Iterator[tuple[int, Deed]]:
    return ((at, deed) for at, deed in enumerate(deeds) if deed.verb == verb)
