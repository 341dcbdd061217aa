"""The things that a test can wait for: an event, a message, telemetry, a line of the console, or any condition.

A `Wanted` only checks input that is new since its last check. After a failure it describes the nearest other input.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from cfepy.flight.log import FlightLog, Here, Packet
from cfepy.ground import EVENT_TYPES, DecodedEvent
from cfepy.monitors import Heard
from cfepy.reading.suggestions import expected, like, listed
from cfepy.status import UsageError
from cfepy.units import NS_PER_S

Text = str | re.Pattern[str]
Check = Callable[[Any], Any]

NEAR = 3  # number of other items to describe
LONGEST = 200  # maximum number of characters of a message to show


@dataclass(frozen=True, slots=True)
class Wanted:
    """Something that a test waits for.

    Attributes:
        text: its description, for the failure.
        find: returns an item that matched since the last check, or None.
        instead: describes the other input.
    """

    text: str
    find: Callable[[], Any]
    instead: Callable[[], str]


def event(
    log: FlightLog, here: Here, app: str | None, event_id: int | None, text: Text | None, kind: str | None
) -> Wanted:
    """Return the expectation of an event of an application; None means any.

    Raises:
        UsageError: if there is no such type of event.
    """
    if kind is not None and kind not in EVENT_TYPES:
        raise UsageError(f"invalid event type {kind!r}; {expected(kind, EVENT_TYPES)}", field="type")

    def meets(each: DecodedEvent) -> bool:
        return (
            app in (None, each.app)
            and event_id in (None, each.event_id)
            and kind in (None, each.type_name)
            and (text is None or has_text(text, each.text))
        )

    def instead() -> str:
        events = log.events[here.events :]
        own = [each for each in events if app in (None, each.app)]
        if own:
            return "; ".join(map(str, _nearest_events(own, event_id)))
        others = ", ".join(dict.fromkeys(each.app for each in events))
        return f"no event of {app}, only of {others}" if others else "no event at all"

    parts = ["event", app or "of any app", event_id, kind, None if text is None else shown_text(text)]
    return Wanted(
        " ".join(str(part) for part in parts if part is not None), _first(log.events, here.events, meets), instead
    )


def _nearest_events(events: list[DecodedEvent], event_id: int | None) -> list[DecodedEvent]:
    """Return the last events with the wanted id, or otherwise the last of all."""
    return ([each for each in events if each.event_id == event_id] or events)[-NEAR:]


def message(log: FlightLog, here: Here, topic: str, check: Check | None, fields: Mapping[str, Any]) -> Wanted:
    """Return the expectation of a message on a topic that a function accepts, or with given field values."""
    start = here.messages.get(topic, 0)
    read: list[Heard] = []

    def news() -> list[Heard]:
        new = log.heard(topic)[start + len(read) :]
        read.extend(new)
        return new

    def find() -> Any:
        return next((each.msg for each in news() if _accepts(check, each.msg) and _has(fields, each.msg)), None)

    def instead() -> str:
        if read:
            last = "; ".join(f"{_short(each.msg)} at {each.t:.3f}" for each in read[-NEAR:])
            return f"{counted(len(read), 'message')}, the last: {last}"
        names = log.topics.names
        near = like(topic, names, NEAR) or names
        return f"no message on {topic}; there were some on {listed(near, 'and')}" if near else "no message on any topic"

    return Wanted(f"message on {topic}{_conditions(check, fields)}", find, instead)


def telemetry(
    log: FlightLog, here: Here, name: str, msg_id: int, check: Check | None, fields: Mapping[str, Any]
) -> Wanted:
    """Return the expectation of a telemetry packet that a function accepts, or with given field values."""
    start = here.packets.get(msg_id, 0)
    read: list[Packet] = []

    def find() -> Any:
        new = [log.packet(each) for each in log.packets.get(msg_id, [])[start + len(read) :]]
        read.extend(new)
        return next((each for each in new if _accepts(check, each) and _has(fields, each)), None)

    def instead() -> str:
        if not read:
            names = log.telemetry_names()
            return f"no {name}; there was {listed(names, 'and')}" if names else "no telemetry at all"
        shown = ", ".join(f"{path} was {_value(read[-1], path)!r}" for path in fields) or _short(read[-1])
        return f"{shown} in the last of {counted(len(read), 'packet')}, at {read[-1].at:.3f}"

    return Wanted(f"telemetry {name}{_conditions(check, fields)}", find, instead)


def line(lines: list[str], here: Here, text: Text) -> Wanted:
    """Return the expectation of a line of the console."""
    return Wanted(
        f"console line {shown_text(text)}",
        _first(lines, here.lines, lambda each: has_text(text, each)),
        lambda: f"{counted(len(lines) - here.lines, 'other line')}; the console's end is below",
    )


def condition(check: Callable[[], Any], what: str | None) -> Wanted:
    """Return the expectation of a condition given by a function."""
    return Wanted(what or name_of(check), lambda: check() or None, lambda: "it never held when it was looked at")


def _first(things: list[Any], start: int, meets: Callable[[Any], bool]) -> Callable[[], Any]:
    """Return a function that finds the first new item that meets a condition."""
    looked = start

    def find() -> Any:
        nonlocal looked
        new, looked = things[looked:], len(things)
        return next((each for each in new if meets(each)), None)

    return find


# -- judging and showing -----------------------------------------------------------------------------------------------


def has_text(wanted: Text, text: str) -> bool:
    """Return whether a text contains another, or matches a regular expression somewhere."""
    return wanted in text if isinstance(wanted, str) else wanted.search(text) is not None


def shown_text(text: Text) -> str:
    """Return a wanted text or regular expression for display."""
    return f'"{text}"' if isinstance(text, str) else f"/{text.pattern}/"


def name_of(check: Callable[..., Any]) -> str:
    """Return the text of a function for display: its name, or its source line for a lambda."""
    name = getattr(check, "__name__", repr(check))
    code = getattr(check, "__code__", None)
    return f"the condition in line {code.co_firstlineno}" if name == "<lambda>" and code is not None else name


def _accepts(check: Check | None, thing: Any) -> bool:
    return check is None or bool(check(thing))


def _has(fields: Mapping[str, Any], thing: Any) -> bool:
    return all(_agrees(wanted, _value(thing, path)) for path, wanted in fields.items())


def _agrees(wanted: Any, actual: Any) -> bool:
    return bool(wanted(actual)) if callable(wanted) else bool(wanted == actual)


def _value(thing: Any, path: str) -> Any:
    """Return a field of a packet or a message by its path.

    Raises:
        UsageError: if it has no such field.
    """
    try:
        if isinstance(thing, Packet):
            return thing[path]
        for name in path.split("."):
            thing = getattr(thing, name)
    except (KeyError, AttributeError):
        known = list(thing.flat) if isinstance(thing, Packet) else getattr(thing, "__slots__", [])
        hint = expected(path, known, subject="it has", last="and")
        raise UsageError(f"unknown field; {hint}", field=path) from None
    return thing


def _conditions(check: Check | None, fields: Mapping[str, Any]) -> str:
    parts = [f"{path}={name_of(wanted) if callable(wanted) else repr(wanted)}" for path, wanted in fields.items()]
    if check is not None:
        parts.append(name_of(check))
    return f" with {', '.join(parts)}" if parts else ""


def _short(thing: Any) -> str:
    text = " ".join(str(thing).split())
    return text if len(text) <= LONGEST else text[: LONGEST - 3] + "..."


def counted(number: int, what: str) -> str:
    """Return a number of items as text."""
    return f"{number} {what}{'' if number == 1 else 's'}"


def seconds(ns: int) -> str:
    """Return a virtual time in the format of failures."""
    return f"{ns / NS_PER_S:.3f}"
