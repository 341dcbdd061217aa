"""A record of a trace as an event: the actor, the action and its place in the source; and the difference of two events
in words.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from itertools import zip_longest
from typing import Any

from cfepy import trace as tr
from cfepy.mission import Mission
from cfepy.pilot import place_text
from cfepy.rtos import Task
from cfepy.units import NS_PER_S, time_text

TIMER, MESSAGE, OTHER, OVER = "timer", "message", "other", "over"
_FIRST_MARK = 0x20  # smaller first bytes begin packets
MOST_FIELDS = 4
MOST_BYTES = 8
_WORDS = (
    (r"send (\S+) (\S+) sequence (\d+) .*", r"{task} sends message \3 of \2"),
    (r"publish (\S+) .*", r"{task} publishes on \1"),
    (r"dispatch, (\S+) ended", r"{task} runs, because \1 has ended"),
    (r"dispatch", r"{task} runs"),
    (r"wake (\S+)", r"{task} wakes \1"),
    (r"receive from (\S+)", r"{task} takes a message from pipe \1"),
    (r"drop at (\S+)", r"a message of {task} finds no room in pipe \1"),
    (r"put into queue (\S+)", r"{task} puts into queue \1"),
    (r"get from queue (\S+)", r"{task} takes from queue \1"),
    (r"console (.*)", r"{task} prints: \1"),
    (r"calls from (.*)", r"{task} calls from \1"),
)
"""Texts of a trace, with sentences for them."""
_LINE = re.compile(r"(\d+)\.(\d{9}) (\S+) (.*)", re.DOTALL)


@dataclass(frozen=True, slots=True)
class RecordEvent:
    """An event.

    Attributes:
        kind: TIMER, MESSAGE, OTHER, or OVER for the end of the run.
        at_ns: its virtual time in ns; for a timer, the time at which it is due.
        task: the task that acts; for a timer, the waiting task.
        action: as in the text of the trace; for a message its topic or packet.
        place: the line of source, such as `talker.py:9: pub.publish(n)`; empty if it is not known.
        fields: for a message, its fields as text.
        data: for a message, its bytes in hexadecimal digits.
    """

    kind: str
    at_ns: int = 0
    task: str = ""
    action: str = ""
    place: str = ""
    fields: dict[str, str] = field(default_factory=dict)
    data: str = ""

    def to_dict(self) -> dict[str, Any]:
        """Return it as plain data."""
        return asdict(self)


def due_timer(record: bytes, mission: Mission) -> RecordEvent:
    """Return the event of a record that moves the clock: the timer that is due then, and its task.

    Args:
        record: the record that is being made.
        mission: the mission, inside of which this is called.
    """
    task = _task_due(mission)
    (at_ns,) = tr.unpack_time(record)
    if task is None:
        return RecordEvent(TIMER, at_ns)
    return RecordEvent(TIMER, at_ns, task.name, place=place_text(mission.kernel.context.frame_of(task)))


def timer_line(event: RecordEvent) -> str:
    """Return a line about a timer, as in the text of a trace."""
    when = f"{event.at_ns // NS_PER_S}.{event.at_ns % NS_PER_S:09d}"
    return f"{when} the next timer is due" + (f": {event.task}, {event.place}" if event.task else "")


def _task_due(mission: Mission) -> Task | None:
    """Return the task whose timer has just been taken out of the list of timers."""
    waiting = {number for _, number, _ in mission.kernel.timers}
    return next((task for task in mission.kernel.tasks if task.timer and task.timer not in waiting), None)


def is_message(record: bytes) -> bool:
    """Return True if a record is a packet, or a message that the bus does not carry."""
    return bool(record) and (record[0] < _FIRST_MARK or record[:1] == tr.UNSENT)


# -- in words ----------------------------------------------------------------------------------------------------------


def difference_lines(one: RecordEvent, other: RecordEvent, runs: tuple[str, str]) -> Iterator[str]:
    """Yield the sentences about the first difference.

    Args:
        one: the event of the first run.
        other: the event of the second run in its place.
        runs: the names of the runs.
    """
    if one.kind == other.kind == TIMER and one.at_ns != other.at_ns:
        yield from _timers(one, other, runs)
    elif one.kind == other.kind == MESSAGE and (one.task, one.action) == (other.task, other.action):
        yield from _messages(one, other, runs)
    elif (one.kind, one.task, one.action) == (other.kind, other.task, other.action) and one.at_ns != other.at_ns:
        yield f"{sentence(one)} at another time: {_times(one.at_ns, other.at_ns, runs)}"
        yield from _places(one, other, runs)
    else:
        yield "the runs go on with different steps:"
        for event, run in zip((one, other), runs, strict=True):
            yield f"in {run}: {sentence(event)}{_at(event)}{_place(event)}"


def line_difference(sides: Sequence[tuple[str, str]]) -> Iterator[str]:
    """Yield the sentences about two lines of text traces that differ; none if one is not a line of a trace.

    Args:
        sides: file and line of each of the two runs.
    """
    found = [_LINE.fullmatch(line.rstrip("\n")) for _, line in sides]
    events = [RecordEvent(OTHER, int(each[1]) * NS_PER_S + int(each[2]), each[3], each[4]) for each in found if each]
    if len(events) == len(sides):
        yield from difference_lines(events[0], events[1], (sides[0][0], sides[1][0]))


def sentence(event: RecordEvent) -> str:
    """Return an event as a sentence without its time."""
    if event.kind == OVER:
        return "the run is over"
    if event.kind == TIMER:
        return f"all tasks wait; the next timer is due, and {event.task or 'a task'} goes on"
    if event.kind == MESSAGE:
        return f"{event.task} sends {event.action}"
    for pattern, words in _WORDS:
        found = re.fullmatch(pattern, event.action, re.DOTALL)
        if found is not None:
            return found.expand(words.replace("{task}", event.task.replace("\\", r"\\")))
    return f"{event.task}: {event.action}"


def _timers(one: RecordEvent, other: RecordEvent, runs: tuple[str, str]) -> Iterator[str]:
    times = _times(one.at_ns, other.at_ns, runs)
    if one.task == other.task:
        yield f"the next timer, which {one.task or 'a task'} waits for, is due at another time: {times}"
        yield from _places(one, other, runs)
        return
    yield f"another timer is due next: {times}"
    for event, run in zip((one, other), runs, strict=True):
        yield f"in {run}, {event.task or 'a task'} waits for it{_place(event)}"


def _messages(one: RecordEvent, other: RecordEvent, runs: tuple[str, str]) -> Iterator[str]:
    values = value_texts(one.fields, other.fields)
    number = one.fields.get("sequence")
    which = f"message {number} of {one.action}" if number is not None else f"a message of {one.action}"
    if not values:
        header = [name for name in one.fields if name in other.fields and one.fields[name] != other.fields[name]]
        values = [f"{name} {one.fields[name]} and {other.fields[name]}" for name in header] or [_bytes(one, other)]
    yield f"{which} from {one.task} has other values in {runs[0]} and {runs[1]}: {'; '.join(values)}"
    yield from _places(one, other, runs)


def _bytes(one: RecordEvent, other: RecordEvent) -> str:
    """Return the first bytes in which two messages without known fields differ."""
    mine, theirs = bytes.fromhex(one.data), bytes.fromhex(other.data)
    at = next((place for place, (a, b) in enumerate(zip_longest(mine, theirs)) if a != b), 0)
    parts = " and ".join(data[at : at + MOST_BYTES].hex(" ") or "nothing" for data in (mine, theirs))
    return f"from byte {at} on {parts}"


def _places(one: RecordEvent, other: RecordEvent, runs: tuple[str, str]) -> Iterator[str]:
    if one.place == other.place:
        yield from [one.place] if one.place else []
        return
    for event, run in zip((one, other), runs, strict=True):
        if event.place:
            yield f"in {run}: {event.place}"


def _times(one_ns: int, other_ns: int, runs: tuple[str, str]) -> str:
    change = other_ns - one_ns
    late = "later" if change > 0 else "earlier"
    return f"{_s(one_ns)} in {runs[0]}, {_s(other_ns)} in {runs[1]}, {time_text(abs(change))} {late}"


def _s(at_ns: int) -> str:
    return f"{at_ns / NS_PER_S:.6f} s" if at_ns % 1000 == 0 else f"{at_ns / NS_PER_S:.9f} s"


def _at(event: RecordEvent) -> str:
    return f" at {_s(event.at_ns)}"


def _place(event: RecordEvent) -> str:
    return f", {event.place}" if event.place else ""


def value_texts(one: Mapping[str, str], other: Mapping[str, str]) -> list[str]:
    """Return a text for each field in which two messages differ: `data 1 and 1.5 (+0.5)`."""
    names = [name for name in one if name in other and one[name] != other[name] and name not in _OF_HEADER]
    texts = [f"{name} {one[name]} and {other[name]}{_by(one[name], other[name])}" for name in names]
    more = len(texts) - MOST_FIELDS
    return [*texts[:MOST_FIELDS], *([f"and {more} more"] if more > 0 else [])]


_OF_HEADER = ("sequence", "time of the header")


def _by(one: str, other: str) -> str:
    """Return the difference of two numbers in brackets; empty for other values."""
    try:
        change = float(other) - float(one)
    except ValueError:
        return ""
    return f" ({change:+.6g})"
