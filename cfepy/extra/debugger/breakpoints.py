"""Breakpoints of a run: an event, messages of one MsgId, or messages for which a predicate holds."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Sequence
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

from cfepy.attachment import Attachment
from cfepy.ground import EVENT_IDS, EVENT_TYPES, DecodedEvent, Dictionary, dictionary_of
from cfepy.mission import Mission, MissionSpec, PacketWatch, Seen
from cfepy.monitors import Heard, MessageWatch, Predicate, short, shortened
from cfepy.reading.marked_yaml import Marked
from cfepy.reading.suggestions import did_you_mean, expected
from cfepy.sb import SoftwareBus
from cfepy.status import UsageError

NAMES = ("msg", "topic", "sender", "t")
"""Names in a predicate: the message, its topic or packet name, its sender, the virtual time in s."""
FORMS = "APP:ID or APP:ERROR for an event, a MsgId or the name of a packet or topic, or a Python expression about msg"
MOST_REASONS = 3
_EVENT = re.compile(r"([A-Za-z_]\w*|\*):(\d+|\*|[A-Z]+)")
_NAME = re.compile(r"(0[xX])?\w+", re.ASCII)
_TOPIC = re.compile(r"/[\w/*?\[\]~-]*")

_HARMLESS = frozenset(
    {"abs", "all", "any", "bool", "float", "int", "isinstance", "len", "max", "min", "round", "str", "sum"}
)
"""Functions that an expression about variables may call."""

Hit = Callable[[str], object]
"""Called with each event or message, in the task that sends it and before any receiver gets it."""


class Breakpoint(Attachment):
    """A breakpoint, from the text of a user.

    Args:
        text: see `FORMS`.
        spec: the mission.
        hit: is called at each match.

    Raises:
        UsageError: the text is not a valid breakpoint.
    """

    def __init__(self, text: str, spec: MissionSpec, hit: Hit) -> None:
        self._text = text
        self._hit = hit
        self._has_hit = False
        self._watch = _meant(text, spec, self._stop)

    def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        return self._watch.bus(base)

    def begin(self, mission: Mission) -> None:
        self._watch.begin(mission)

    @property
    def missed(self) -> str | None:
        """A message if the breakpoint never matched, with the reason if it is known; None if it matched."""
        if self._has_hit:
            return None
        why = self._watch.why_not() if isinstance(self._watch, _AtPredicate) else ""
        return f"--break {self._text!r} never matched{why}"

    def _stop(self, what: str) -> None:
        self._has_hit = True
        self._hit(what)


def _meant(text: str, spec: MissionSpec, hit: Hit) -> Attachment:
    event = _EVENT.fullmatch(text)
    if event is not None:
        return _at_event(text, event[1], event[2], hit)
    if _TOPIC.fullmatch(text):
        return MessageWatch(spec, lambda heard: hit(_told(heard)), topics=(text,))
    if _NAME.fullmatch(text):
        return _at_packet(text, dictionary_of(spec), hit)
    return _AtPredicate(text, spec, hit)


def _at_event(text: str, app: str, which: str, hit: Hit) -> Attachment:
    if which.isalpha() and which not in EVENT_TYPES:
        raise UsageError(f"{text!r}: invalid event type {which}; {expected(which, EVENT_TYPES)}", field="--break")

    def take(seen: Seen) -> None:
        event = DecodedEvent.of(seen)
        wanted = which in ("*", str(event.event_id)) or EVENT_TYPES.get(which) == event.event_type
        if wanted and app in ("*", event.app):
            hit(f"event {event}")

    return PacketWatch(take, EVENT_IDS.__contains__)


def _at_packet(name: str, dictionary: Dictionary, hit: Hit) -> Attachment:
    command = dictionary.commands.get(name)
    try:
        msg_id = dictionary.telemetry_of(name).msg_id if command is None else command.msg_id
    except UsageError:
        hint = did_you_mean(name, [*dictionary.commands, *dictionary.telemetry], f"expected {FORMS}")
        raise UsageError(f"unknown packet {name!r}; {hint}", field="--break") from None

    def take(seen: Seen) -> None:
        decoded = dictionary.decode(seen.packet)
        if command is None or decoded.name == name:
            values = f": {short(decoded.values)}" if decoded.values else ""
            hit(f"{decoded.name} (0x{msg_id:04X}) of {seen.sender}, {len(seen.packet)} bytes{values}")

    return PacketWatch(take, msg_id.__eq__)


class _AtPredicate(Attachment):
    """Stops where a predicate holds for a message. It does not hold if it does not apply, as with a missing field."""

    def __init__(self, text: str, spec: MissionSpec, hit: Hit) -> None:
        try:
            self._predicate = Predicate.read(Marked(text, Path("--break"), 1, ""), NAMES)
        except UsageError as error:
            raise UsageError(f"{error.text}; expected {FORMS}", field="--break") from None
        dictionary = dictionary_of(spec)
        packets = tuple(dict.fromkeys([*dictionary.telemetry, *dictionary.commands]))
        self._watch = MessageWatch(spec, self._take, topics=("*",), packets=packets)
        self._hit = hit
        self._errors: dict[str, str] = {}  # why it did not apply, by topic or packet
        self._applies = False

    def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        return self._watch.bus(base)

    def begin(self, mission: Mission) -> None:
        self._watch.begin(mission)

    def _take(self, heard: Heard) -> None:
        try:
            names = {"msg": heard.msg, "topic": heard.topic, "sender": heard.sender, "t": heard.t}
            holds = self._predicate.holds(names)
        except Exception as error:
            self._errors[heard.topic] = f"{type(error).__name__}: {error}"
            return
        self._applies = True
        if holds:
            self._hit(f"{self._predicate.source}: {_told(heard)}")

    def why_not(self) -> str:
        """Return why it never applied, such as a misspelt field; empty if it applied and was only false."""
        if self._applies or not self._errors:
            return ""
        topics = sorted(self._errors, key=lambda topic: not topic.startswith("/"))[:MOST_REASONS]
        return "; it does not apply to any message: " + "; ".join(f"{topic}: {self._errors[topic]}" for topic in topics)


def _told(heard: Heard) -> str:
    return f"{heard.topic} of {heard.sender}: {_shown(heard)}"


def _shown(heard: Heard) -> str:
    """Return a message on one line."""
    try:
        message: Any = heard.msg
    except UsageError as error:
        return f"({error.text})"
    return short(message) if isinstance(message, dict) else shortened(" ".join(str(message).split()))


def breakpoints(texts: Sequence[str], spec: MissionSpec, hit: Hit) -> list[Breakpoint]:
    """Return the breakpoints for several texts; see `Breakpoint`."""
    return [Breakpoint(text, spec, hit) for text in texts]


class VariableCondition:
    """An expression about variables in the code of a mission.

    Args:
        text: a Python expression; it may call only a few built-in functions that change nothing.

    Raises:
        UsageError: it is not such an expression.
    """

    def __init__(self, text: str) -> None:
        try:
            tree = ast.parse(text, mode="eval")
        except (SyntaxError, ValueError):
            raise UsageError(f"invalid Python expression {text!r}", field="--back-to") from None
        calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
        harmful = [each for each in calls if not (isinstance(each.func, ast.Name) and each.func.id in _HARMLESS)]
        if harmful or any(isinstance(node, ast.NamedExpr | ast.Await | ast.Yield) for node in ast.walk(tree)):
            raise UsageError(f"calls are not allowed in {text!r}, because they could change the run", field="--back-to")
        self._code: CodeType = compile(tree, "--back-to", "eval")

    def holds(self, frame: FrameType | None) -> bool:
        """Return True if it holds in a frame; False if its names are not known there."""
        if frame is None:
            return False
        try:
            return bool(eval(self._code, frame.f_globals, frame.f_locals))
        except Exception:  # any error of the mission's objects
            return False


def finders(text: str, spec: MissionSpec, hit: Callable[[str], object]) -> list[Breakpoint] | VariableCondition:
    """Return the breakpoints for a text, or a condition on variables if it is not a breakpoint.

    Raises:
        UsageError: it is neither.
    """
    try:
        return breakpoints([text], spec, hit)
    except UsageError:
        if text.replace("_", "").isalnum():
            raise
        return VariableCondition(text)
