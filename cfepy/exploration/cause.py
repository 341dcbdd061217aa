"""The cause of a failure in one sentence, where what was observed says it.

The deeds of the failing run are held against those of the run under fifo, in which the failure is not. A sentence
states what happened in the one and not in the other; where none of the patterns below is there, nothing is said.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence

from cfepy.exploration import deeds as do
from cfepy.exploration.deeds import Deed, keys_of
from cfepy.exploration.moves import Move, plain_name
from cfepy.exploration.task_look import AT, ORDERED, PREEMPTED, Row
from cfepy.exploration.verdict import DEADLOCK, Failure
from cfepy.rtos import HOLD

NOBODY = "0"  # waits for what is notified
_HELD = re.compile(r"(?P<task>\S+) waits for (?P<what>[^;]+), held by (?P<holder>[^;,]+)")


class Evidence:
    """What is known of a failure.

    Args:
        failure: itself.
        moves: what the schedule does.
        rows: of the failing run, up to the failure.
        deeds: of the failing run, up to the failure.
        usual: those of the run under fifo.
        names: what locks are called that the failure tells by their numbers.
    """

    def __init__(
        self,
        failure: Failure,
        moves: Sequence[Move],
        rows: Sequence[Row],
        deeds: Sequence[Deed],
        usual: Sequence[Deed],
        names: Mapping[str, str],
    ) -> None:
        self.failure = failure
        self.moves = moves
        self.rows = rows
        self.deeds = deeds
        self.usual = usual
        self.names = names
        self._keys = list(keys_of(self.deeds))
        self._usual_at = {key: at for at, key in enumerate(keys_of(self.usual))}

    def is_flipped(self, first: int, second: int) -> bool:
        """Whether two deeds of the failing run came in the other order under fifo."""
        one, other = (self._usual_at.get(self._keys[at]) for at in (first, second))
        return one is not None and other is not None and other < one


def cause_of(evidence: Evidence) -> str:
    """The sentence; empty where there is none."""
    sentences: tuple[Callable[[Evidence], str], ...] = (
        _deadlock,
        _lost_update,
        _lost_wake_up,
        _overflow,
        _late_subscription,
        _deleted,
        _message_order,
        _one_switch,
    )
    return next((text for text in (sentence(evidence) for sentence in sentences) if text), "")


# -- deadlock --------------------------------------------------------------------------------------------------------


def _deadlock(evidence: Evidence) -> str:
    """Each of the tasks in a circle has what the one before it wants."""
    if evidence.failure.kind != DEADLOCK:
        return ""
    waits = [(found["task"], found["what"], found["holder"]) for found in _HELD.finditer(evidence.failure.text)]
    wanted = {task: evidence.names.get(what, what) for task, what, _ in waits}
    held = {holder: evidence.names.get(what, what) for _, what, holder in waits}
    if len(waits) < 2 or wanted.keys() != held.keys():
        return ""
    return "; ".join(f"{task} has {held[task]} and wants {wanted[task]}" for task in wanted)


# -- accesses --------------------------------------------------------------------------------------------------------


def _lost_update(evidence: Evidence) -> str:
    """One task reads, another one writes, and the first writes over that without having read it."""
    usual = {_lost_key(*each) for each in _lost(evidence.usual)}
    for read, other, write in _lost(evidence.deeds):
        if _lost_key(read, other, write) not in usual:
            return (
                f"an update of {read.thing} is lost: {other.task} wrote it at {other.place}, between {read.task}'s "
                f"read at {read.place} and {read.task}'s write at {write.place}"
            )
    return ""


def _lost_key(read: Deed, other: Deed, write: Deed) -> tuple[str, ...]:
    return plain_name(read.task), read.thing, plain_name(other.task), read.place, other.place, write.place


def _lost(deeds: Sequence[Deed]) -> Iterator[tuple[Deed, Deed, Deed]]:
    """The updates that are lost: what was read, what was written since, and what was written over that."""
    read_by: dict[tuple[str, str], Deed] = {}
    overtaken: dict[tuple[str, str], Deed] = {}
    for deed in deeds:
        key = (deed.task, deed.thing)
        if deed.verb == do.READS:
            read_by[key] = deed
            overtaken.pop(key, None)
        elif deed.verb == do.WRITES:
            if key in overtaken:
                yield read_by[key], overtaken[key], deed
            read_by.pop(key, None)
            overtaken.pop(key, None)
            for other in [each for each in read_by if each[1] == deed.thing and each[0] != deed.task]:
                overtaken[other] = deed


# -- wake-ups --------------------------------------------------------------------------------------------------------


def _lost_wake_up(evidence: Evidence) -> str:
    """A task waits in vain for what was set or notified before it waited."""
    for at in _vain_waits(evidence.deeds):
        text = _notified_early(evidence, at) or _set_and_cleared(evidence, at)
        if text:
            return text
    return ""


def _notified_early(evidence: Evidence, at: int) -> str:
    wait = evidence.deeds[at]
    last = _last(evidence.deeds[:at], wait, do.NOTIFIES)
    if last is None or evidence.deeds[last].note != NOBODY or not evidence.is_flipped(last, at):
        return ""
    deed = evidence.deeds[last]
    return f"{deed.task}'s notify at {deed.place} came before {wait.task}'s wait at {wait.place}: nobody waited then"


def _set_and_cleared(evidence: Evidence, at: int) -> str:
    """An event was set while the one that clears it was kept from doing so."""
    wait = evidence.deeds[at]
    cleared_at = _last(evidence.deeds[:at], wait, do.CLEARS)
    set_at = None if cleared_at is None else _last(evidence.deeds[:cleared_at], wait, do.SETS)
    if cleared_at is None or set_at is None:
        return ""
    cleared, was_set = evidence.deeds[cleared_at], evidence.deeds[set_at]
    own = (each for each in reversed(range(cleared_at)) if evidence.deeds[each].task == cleared.task)
    before = next(own, cleared_at)
    gave_way = evidence.deeds[before].verb == do.GIVES_WAY and before < set_at
    if was_set.task == cleared.task or not (gave_way or evidence.is_flipped(set_at, cleared_at)):
        return ""
    return (
        f"{was_set.task} set {wait.thing} at {was_set.place}, then {cleared.task} cleared it at {cleared.place}; "
        f"{wait.task} waits for it at {wait.place} in vain"
    )


def _vain_waits(deeds: Sequence[Deed]) -> list[int]:
    """The waits that no wake-up ended before the failure, the last in front."""
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
    """Where something of this kind was done last to the same thing."""
    found = (at for at in reversed(range(len(deeds))) if deeds[at].verb == verb and deeds[at].thing == like.thing)
    return next(found, None)


# -- messages --------------------------------------------------------------------------------------------------------


def _overflow(evidence: Evidence) -> str:
    """A message did not fit into a pipe, and under fifo all fit."""
    usual = {(deed.thing, deed.note) for deed in evidence.usual if deed.verb == do.LOSES}
    for deed in evidence.deeds:
        if deed.verb == do.LOSES and (deed.thing, deed.note) not in usual:
            app, _, depth = deed.note.partition(", ")
            where = f" at {deed.place}" if deed.place else ""
            full = f"full, with {depth} {'message' if depth == '1' else 'messages'}"
            return (
                f"a message {deed.thing} was lost that {deed.task} sent{where}: the pipe of {app} was {full}; "
                "under fifo none is lost there"
            )
    return ""


def _late_subscription(evidence: Evidence) -> str:
    """A message was sent before somebody subscribed to it."""
    for at, subscription in _of(evidence.deeds, do.SUBSCRIBES):
        for sent_at, sending in _of(evidence.deeds[:at], do.SENDS):
            if sending.thing == subscription.thing and evidence.is_flipped(sent_at, at):
                return (
                    f"{sending.task} sent {sending.thing} at {sending.place} before {subscription.task} subscribed to "
                    f"it at {subscription.place}; under fifo after that"
                )
    return ""


def _deleted(evidence: Evidence) -> str:
    """A task went to receive from a pipe that was deleted."""
    usual = {deed.thing for _, deed in _received_late(evidence.usual)}
    for deletion, receiving in _received_late(evidence.deeds):
        if receiving.thing not in usual:
            return (
                f"{deletion.task} deleted {deletion.thing} at {deletion.place}, and {receiving.task} went to receive "
                f"from it after that, at {receiving.place}; under fifo nobody does"
            )
    return ""


def _received_late(deeds: Sequence[Deed]) -> Iterator[tuple[Deed, Deed]]:
    """The deletion of a pipe, and who would receive from it."""
    deleted: dict[str, Deed] = {}
    for deed in deeds:
        if deed.verb == do.DELETES:
            deleted[deed.thing] = deed
        elif deed.verb == do.RECEIVES and deed.thing in deleted:
            yield deleted[deed.thing], deed
        elif deed.verb == do.SUBSCRIBES:  # one of that name was made anew
            deleted.pop(f"pipe {deed.note}", None)


def _message_order(evidence: Evidence) -> str:
    """An application that the schedule meddles with got two messages in another order."""
    apps = {deed.app for deed in evidence.deeds for move in evidence.moves if deed.task in (move.task, move.chosen)}
    got = [(at, deed) for at, deed in _of(evidence.deeds, do.GETS) if deed.app in apps]
    for number, (at, later) in enumerate(got):
        for earlier_at, earlier in reversed(got[:number]):
            if earlier.app == later.app and earlier.thing != later.thing and evidence.is_flipped(earlier_at, at):
                return f"{earlier.app} got {earlier.thing} before {later.thing}; under fifo it gets {later.thing} first"
    return ""


# -- what else there is ------------------------------------------------------------------------------------------------


def _one_switch(evidence: Evidence) -> str:
    """A single switch, without which the run is that of fifo."""
    moves = [at for at, row in enumerate(evidence.rows) if row.kind in (PREEMPTED, ORDERED)]
    if len(evidence.moves) != 1 or evidence.moves[0].question or len(moves) != 1:
        return ""
    row = evidence.rows[moves[0]]
    before = (each.text for each in reversed(evidence.rows[: moves[0]]) if each.task == row.task and each.kind == AT)
    place = ":".join(next(before, "").split(":")[:2])
    if row.kind == ORDERED:
        return f"{row.text} went on before {row.task}, which was ready first; without that one change it does not fail"
    if not place:
        return ""
    if row.text == HOLD:
        return f"{row.task} was held up at {place}; without that it does not fail"
    return f"{row.text} got in while {row.task} was at {place}; without that one switch it does not fail"


def _of(deeds: Sequence[Deed], verb: str) -> Iterator[tuple[int, Deed]]:
    return ((at, deed) for at, deed in enumerate(deeds) if deed.verb == verb)
