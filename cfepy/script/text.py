"""The text of a mission script, parsed into steps; see docs/how_to/ground_tools.md for the language.

One step per line, made of words, quoted texts and numbers of seconds. Everything that can be known before the run is
checked here: names, fields, values, times. A mistake raises UsageError with file and line.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from cfepy.ground import EVENT_TYPES, Dictionary, Topic, int_of, number_of, packet_of, topic_id, unknown_field
from cfepy.mission import CALL, PARAM, PUBLISH, MissionSpec
from cfepy.msg import Telemetry
from cfepy.reading.input_files import text_limited, unreadable
from cfepy.reading.input_limits import LINE_FILE_BYTES
from cfepy.reading.mistakes import Mistakes, collected
from cfepy.reading.plain_yaml import YamlError, plain_yaml
from cfepy.reading.suggestions import expected, listed
from cfepy.script.conditions import (
    APP_STATES,
    OPERATORS,
    AppCondition,
    Comparison,
    Condition,
    ConsoleCondition,
    EventCondition,
    FileCondition,
    ParameterCondition,
    ResponseCondition,
    RosAction,
    TelemetryCondition,
)
from cfepy.status import UsageError, placed
from cfepy.units import NS_PER_S

LONGEST_S = 1e9
LONGEST_SIGN = 2  # characters of the longest operator
_TOKEN = re.compile(r'\s*((?:[^\s"#]|"[^"]*")+)')
DEFAULT_WITHIN_NS = 5 * NS_PER_S
RESET_TYPES = {"processor": 1, "power-on": 2}
ANY = "*"


class Word(NamedTuple):
    """A word of a line; one that starts with a quote is a text."""

    text: str
    is_text: bool


class Words:
    """Words of a line that are still to be read.

    Args:
        line: a `#` outside of quotes starts a comment.

    Attributes:
        source: the line without its comment.

    Raises:
        UsageError: if a quote is not closed.
    """

    def __init__(self, line: str) -> None:
        self._words: list[Word] = []
        at = 0
        while match := _TOKEN.match(line, at):
            self._words.append(Word(match[1].replace('"', ""), match[1].startswith('"')))
            at = match.end()
        self.source = line[:at].strip()
        rest = line[at:].strip()
        if rest and not rest.startswith("#"):
            raise UsageError(f'unclosed quote: {rest}; end the text with "')

    def __bool__(self) -> bool:
        return bool(self._words)

    def take(self, what: str) -> str:
        """Return the next word.

        Args:
            what: its meaning, for the error.

        Raises:
            UsageError: if there is none.
        """
        if not self._words:
            raise UsageError(f"unexpected end of line; {what} is missing")
        return self._words.pop(0).text

    def peek(self) -> Word:
        """Return the next word without consuming it; empty at the end."""
        return self._words[0] if self._words else Word("", False)

    def take_if(self, *texts: str) -> str:
        """Return the next word if it is one of these, else ""."""
        word = self.peek()
        return self._words.pop(0).text if word.text in texts and not word.is_text else ""

    @property
    def is_at_limit(self) -> bool:
        """Whether the line ends here, or its time limit begins."""
        return self.peek().text in ("", "within", "until") and not self.peek().is_text

    def rest(self) -> list[str]:
        """Return the rest of the line."""
        words, self._words = self._words, []
        return [word.text for word in words]


def seconds_ns(text: str) -> int:
    """Return a number of seconds in ns.

    Raises:
        UsageError: if the text is not such a number.
    """
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not 0 <= number <= LONGEST_S:
        raise UsageError(f"invalid number of seconds {text!r}; expected 0 to {LONGEST_S:g}")
    return round(number * NS_PER_S)


WHEN = ("at", "after")
"""Words before a step, for its time."""
OTHER_WORDS = {
    **dict.fromkeys(("cmd", "command"), "send NAME FIELD=VALUE"),
    **dict.fromkeys(("wait", "sleep", "delay"), "after SECONDS"),
    **dict.fromkeys(("check", "assert", "verify"), "expect"),
    "pub": "publish",
    "service": "call",
    "restart": "reset",
    **dict.fromkeys(("telemetry", "packet"), "tlm"),
}
"""Words of other tools for a step or a condition, and the words here."""


def without_when(text: str) -> str:
    """Return a step's text without its leading time."""
    first, _, rest = text.partition(" ")
    return rest.strip().partition(" ")[2].strip() if first in WHEN else text


def choice(text: str, choices: Iterable[str], what: str) -> str:
    """Return the word itself, if it is one of the choices.

    Args:
        text: the word.
        choices: allowed words.
        what: meaning of the choices, for the error.

    Raises:
        UsageError: if it is not one of them.
    """
    known = list(choices)
    if text in known:
        return text
    meant = OTHER_WORDS.get(text, "")
    if meant.split(" ")[0] in (*known, *(WHEN if "send" in known else ())):
        raise UsageError(f"invalid {what} {text!r}; write `{meant}`")
    hint = expected(text, known, likeness=0.5) if len(text) > LONGEST_SIGN else f"expected {listed(known)}"
    raise UsageError(f"invalid {what} {text!r}; {hint}")


@dataclass(frozen=True, slots=True)
class Step:
    """One line of a script. Times in ns.

    `at_ns` is when it is to happen, `after_ns` how long after the step before; without both it happens at once. A step
    sends a packet, or acts on the ROS side (`action`), or expects something (`condition`), or none of these: "end". A
    packet with `must_arrive` fails when no pipe subscribes to it; after one with `is_reset` the script waits for the
    reset, and after a service call for the response. `within_ns` counts from the last packet sent or time waited for,
    `until_ns` from the start of the run; without both, an expectation of a state is checked at once, and an unwanted
    condition must not be met until the script ends.
    """

    line: int
    text: str
    at_ns: int | None = None
    after_ns: int | None = None
    packet: bytes | None = None
    must_arrive: bool = False
    is_reset: bool = False
    action: RosAction | None = None
    condition: Condition | None = None
    must_not: bool = False
    within_ns: int | None = None
    until_ns: int | None = None

    @property
    def is_call(self) -> bool:
        """Whether it calls a service, and waits for the response."""
        return self.action is not None and self.action.kind == CALL

    def deadline_ns(self, mark_ns: int, now_ns: int) -> int | None:
        """Return the latest time at which an expectation is decided, in virtual ns; None for the end of the script.

        Args:
            mark_ns: when the script last acted.
            now_ns: when the expectation starts.
        """
        if self.is_reset:
            return now_ns + DEFAULT_WITHIN_NS
        if self.is_call and self.within_ns is self.until_ns is None:
            return now_ns + DEFAULT_WITHIN_NS
        if self.until_ns is not None:
            return self.until_ns
        if self.within_ns is not None:
            return mark_ns + self.within_ns
        if self.condition is None or self.condition.lasts:
            return now_ns
        return None if self.must_not else mark_ns + DEFAULT_WITHIN_NS


@dataclass(frozen=True, slots=True)
class Script:
    """A script without mistakes, for one mission. `longest_ns` is the maximum virtual time that it takes."""

    file: str
    steps: tuple[Step, ...]
    dictionary: Dictionary
    longest_ns: int


def read_script(path: str | Path, spec: MissionSpec, dictionary: Dictionary) -> Script:
    """Read a script.

    Args:
        path: the file, UTF-8.
        spec: its mission.
        dictionary: dictionary of that mission.

    Raises:
        UsageError: if it cannot be read, or has a mistake.
    """
    try:
        text = text_limited(path, LINE_FILE_BYTES, handed=True)
    except OSError as error:
        raise unreadable(path, error) from None
    except UnicodeError:
        raise UsageError("is not UTF-8 text", file=path) from None
    return parse_script(text, path, spec, dictionary)


def parse_script(text: str, path: str | Path, spec: MissionSpec | None, dictionary: Dictionary) -> Script:
    """`read_script` for a text; `path` is for messages. Without a mission, it cannot name new topics."""
    reader = _Reader(spec, dictionary)
    steps = collected(partial(_steps, reader, text, path))
    if not steps:
        raise UsageError("has no steps; add at least one, such as `at 5 send CFE_ES_NOOP`", file=path)
    return Script(str(path), tuple(steps), dictionary, reader.longest_ns)


def _steps(reader: _Reader, text: str, path: str | Path, mistakes: Mistakes) -> list[Step]:
    steps: list[Step] = []
    for number, line in enumerate(text.split("\n"), 1):
        try:
            words = Words(line)
            if words:
                steps.append(reader.step(number, words))
        except UsageError as error:
            mistakes.add(placed(error, file=path, line=number))
    return steps


class _Reader:
    """Reads steps one after the other; keeps track of the maximum time they take."""

    def __init__(self, spec: MissionSpec | None, dictionary: Dictionary) -> None:
        self._spec = spec
        self._dictionary = dictionary
        self._now_ns = self._mark_ns = self._latest_at_ns = 0
        self.longest_ns = 0
        self._conditions: dict[str, Callable[[Words], Condition]] = {
            "event": _event,
            "tlm": self._telemetry,
            "topic": self._topic,
            "response": lambda words: ResponseCondition(_comparisons(words)),
            "param": _parameter,
            "app": _app,
            "file": _file,
            "console": lambda words: ConsoleCondition(words.take("the text")),
        }

    def step(self, line: int, words: Words) -> Step:
        """Return the step of one line."""
        at_ns, after_ns = self._when(words)
        packet: bytes | None = None
        condition: Condition | None = None
        action: RosAction | None = None
        must_arrive = is_reset = must_not = False
        verb = choice(words.take("a step such as send or expect"), STEPS, "step")
        if verb == "send":
            must_arrive = words.peek().text != "raw"
            packet = self._packet(words)
        elif verb == "reset":
            must_arrive = is_reset = True
            kind = choice(words.take("the kind of reset"), RESET_TYPES, "kind of reset")
            packet = self._command("CFE_ES_RESTART", [f"RestartType={RESET_TYPES[kind]}"])
        elif verb in ROS_STEPS:
            action = RosAction(*ROS_STEPS[verb](words), without_when(words.source))
        elif verb == "expect":
            must_not = bool(words.take_if("no"))
            what = choice(words.take("a condition such as event or tlm"), self._conditions, "condition")
            condition = self._conditions[what](words)
        within_ns = until_ns = None
        if condition is not None or verb == "call":
            within_ns, until_ns = _limits(words)
        if words:
            raise UsageError(f"unexpected {words.peek().text!r} after the end of the step")
        doing = (packet, must_arrive, is_reset, action)
        step = Step(line, words.source, at_ns, after_ns, *doing, condition, must_not, within_ns, until_ns)
        self._pass_time(step)
        return step

    def _when(self, words: Words) -> tuple[int | None, int | None]:
        if words.take_if("at"):
            at_ns = seconds_ns(words.take("the time"))
            if at_ns < self._latest_at_ns:
                text = f"at {at_ns / NS_PER_S:g} is earlier than a step before, at {self._latest_at_ns / NS_PER_S:g}"
                raise UsageError(f"{text}; sort the steps by time")
            self._latest_at_ns = at_ns
            return at_ns, None
        if words.take_if("after"):
            return None, seconds_ns(words.take("the time"))
        return None, None

    def _pass_time(self, step: Step) -> None:
        """Add the step's maximum time to that of the script."""
        if step.at_ns is not None:
            self._now_ns = max(self._now_ns, step.at_ns)
        self._now_ns += step.after_ns or 0
        if step.condition is None or step.at_ns is not None or step.after_ns is not None:
            self._mark_ns = self._now_ns
        deadline = step.deadline_ns(self._mark_ns, self._now_ns)
        if deadline is not None:
            self.longest_ns = max(self.longest_ns, deadline, self._now_ns)
            if not step.must_not:
                self._now_ns = max(self._now_ns, deadline)

    def _packet(self, words: Words) -> bytes:
        name = words.take("the command's name")
        if name != "raw":
            return self._command(name, words.rest())
        digits = "".join(words.rest())
        try:
            return bytes.fromhex(digits)
        except ValueError:
            raise UsageError(f"invalid bytes {digits!r}; write two hexadecimal digits for each byte") from None

    def _command(self, name: str, assignments: list[str]) -> bytes:
        return packet_of(self._dictionary.command(name), assignments)

    def _telemetry(self, words: Words) -> Condition:
        name = words.take("the packet's name")
        if name.startswith("/") and self._spec is not None:
            declared: Telemetry | Topic = Topic(name, topic_id(self._spec, name))
            self._dictionary.add([declared])
        else:
            declared = self._dictionary.telemetry_of(name)
        return TelemetryCondition(declared.name, declared.msg_id, _comparisons(words, declared))

    def _topic(self, words: Words) -> Condition:
        _check_ros_name(words.peek().text, "topic")
        return self._telemetry(words)


def _limits(words: Words) -> tuple[int | None, int | None]:
    if words.take_if("within"):
        return seconds_ns(words.take("the time")), None
    if words.take_if("until"):
        return None, seconds_ns(words.take("the time"))
    return None, None


def _event(words: Words) -> Condition:
    app = words.take("the application's name")
    event_id = event_type = text = None
    if words.peek().text.isdigit() and not words.peek().is_text:
        event_id = int_of(words.take("the event's number"))
    else:
        words.take_if(ANY)
    kind = words.take_if(*EVENT_TYPES)
    if kind:
        event_type = EVENT_TYPES[kind]
    if words.peek().is_text:
        text = words.take("the text")
    elif not words.is_at_limit:
        choice(words.peek().text, EVENT_TYPES, "type of event")
    return EventCondition(None if app == ANY else app, event_id, event_type, text)


def _app(words: Words) -> Condition:
    name = words.take("the application's name")
    if words.is_at_limit:
        return AppCondition(name)
    return AppCondition(name, choice(words.take("the state"), APP_STATES, "application state"))


def _file(words: Words) -> Condition:
    path = words.take("the file's path")
    if not path.startswith("/"):
        raise UsageError(
            f"invalid path {path!r}; a path in the mission's file system begins with /cf, /ram or the like"
        )
    if not words.take_if("size"):
        return FileCondition(path)
    sign = words.take_if(*OPERATORS) or "=="
    size = words.take("the size")
    if not size.isdigit():
        raise UsageError(f"invalid size {size!r}; expected a number of bytes")
    return FileCondition(path, sign, int(size))


def _parameter(words: Words) -> Condition:
    name = words.take("the parameter's name")
    _check_ros_name(name, "parameter")
    sign = words.take_if(*OPERATORS)
    return ParameterCondition(name, Comparison(name, sign, words.take("the value")) if sign else None)


def _check_ros_name(name: str, kind: str) -> None:
    if not name.startswith("/"):
        raise UsageError(f'invalid {kind} name {name!r}; it must begin with "/"')


def _publish(words: Words) -> tuple[str, str, Any]:
    name = words.take("the topic's name")
    _check_ros_name(name, "topic")
    return PUBLISH, name, _ros_fields(words.rest())


def _call(words: Words) -> tuple[str, str, Any]:
    name = words.take("the service's name")
    _check_ros_name(name, "service")
    given = []
    while not words.is_at_limit:
        given.append(words.take("a field"))
    return CALL, name, _ros_fields(given)


def _set(words: Words) -> tuple[str, str, Any]:
    name = words.take("the parameter's name")
    _check_ros_name(name, "parameter")
    return PARAM, name, _yaml(words.take("the value"), name)


ROS_STEPS: dict[str, Callable[[Words], tuple[str, str, Any]]] = {"publish": _publish, "call": _call, "set": _set}
STEPS = ("send", "expect", "reset", *ROS_STEPS, "end")


def _ros_fields(given: list[str]) -> dict[str, Any]:
    """Return the fields of a message by name.

    Args:
        given: assignments such as `linear.x=0.5`, whose values are YAML, or one YAML mapping.
    """
    if len(given) == 1 and given[0].lstrip().startswith("{"):
        found = _yaml(given[0], None)
        assert isinstance(found, dict)  # YAML that begins with a brace is a mapping
        return {str(name): value for name, value in found.items()}
    fields: dict[str, Any] = {}
    for each in given:
        path, equals, value = each.partition("=")
        if not equals or not path:
            raise UsageError(f'invalid field {each!r}; write FIELD=VALUE, or one YAML mapping such as "{{x: 1}}"')
        *outer, last = path.split(".")
        inner = fields
        for name in outer:
            inner = inner.setdefault(name, {})
            if not isinstance(inner, dict):
                raise UsageError(f"{name} has a value already; give its fields or its value", field=path)
        if last in inner:
            raise UsageError("given twice", field=path)
        inner[last] = _yaml(value, path)
    return fields


def _yaml(text: str, field: str | None) -> Any:
    try:
        return plain_yaml(text)
    except YamlError as error:
        raise UsageError(f"invalid value {text!r}: {error.text}", field=field) from None


def _comparisons(words: Words, declared: Telemetry | Topic | None = None) -> tuple[Comparison, ...]:
    """Return comparisons up to the end of the line or its time limit; without a declaration, any field is allowed."""
    found = []
    while not words.is_at_limit:
        found.append(_comparison(words, declared))
        words.take_if("and")
    return tuple(found)


def _comparison(words: Words, declared: Telemetry | Topic | None) -> Comparison:
    path = words.take("the field")
    cells = {cell.path: cell for cell in declared.payload.cells()} if isinstance(declared, Telemetry) else {}
    if isinstance(declared, Telemetry) and path not in cells:
        raise unknown_field(declared.name, cells, path)
    sign = choice(words.take("a sign such as =="), OPERATORS, "sign")
    value = words.take("the value")
    names = cells[path].names if path in cells else None
    if names is not None and value.upper() in names.values:
        value = str(names.number(value))
    if path in cells and not cells[path].type.startswith("char"):
        try:
            number_of(value)
        except ValueError:
            hint = "" if names is None else f"; {expected(value, names.values)}"
            raise UsageError(f"invalid number {value!r}{hint}", field=path) from None
    return Comparison(path, sign, value)
