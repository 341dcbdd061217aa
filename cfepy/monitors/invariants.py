"""Invariants of the messages of a mission: the section `invariants` of a mission file.

An invariant is an expression over a message, a function in the mission's own Python file, or an answer that must come
in time. They are read here and checked by `cfepy.monitors.invariant_watch`. See docs/reference/mission_file.md.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from cfepy.interpreter.syntax_trees import compiled
from cfepy.mission import app_sources as sources
from cfepy.monitors.predicate import LATEST, Predicate
from cfepy.msg import HIGHEST_VALID_MSG_ID, RED, YELLOW
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import PYTHON_BYTES
from cfepy.reading.marked_yaml import Marked
from cfepy.reading.mistakes import Mistakes, each_of
from cfepy.reading.suggestions import expected
from cfepy.status import UsageError

NAMES = ("msg", "last", LATEST, "topic", "sender", "t", "count")
CAUSE = "cause"
SOURCE_FIELDS = ("topic", "packet")
ANSWER_FIELDS = (*SOURCE_FIELDS, "holds")
KINDS = ("holds", "function", "within", "again", "eventually", "limits")
FIELDS = (
    *SOURCE_FIELDS,
    "holds",
    "when",
    "within",
    "then",
    "again",
    "eventually",
    "limits",
    "file",
    "function",
    "after",
)


@dataclass(frozen=True, slots=True)
class Selection:
    """Selected messages: topics by name or pattern, packets by the dictionary's names or MsgIds. All topics if
    empty.
    """

    topics: tuple[str, ...] = ()
    packets: tuple[str, ...] = ()

    def __str__(self) -> str:
        return ", ".join((*self.topics, *self.packets)) or "any topic"


@dataclass(frozen=True, slots=True)
class Answer:
    """The answer that must follow a message within a time limit."""

    selection: Selection
    holds: Predicate | None
    within_ns: int


@dataclass(frozen=True, slots=True)
class Invariant:
    """A rule for messages.

    Attributes:
        name: its key in the mission file.
        place: its place there, `file:line`.
        selection: messages to which it applies.
        when: condition; it applies only to messages for which this holds.
        holds: condition that must hold for each of them.
        answer: answer that must follow each of them.
        again_ns: longest virtual time between such messages, and before the first one, in ns; None for no limit.
        eventually: condition that must hold for at least one message by the end of the run.
        file: Python file of the mission with `function`; None without it.
        function: function of the mission that judges the messages; empty for none.
        after_ns: virtual time in ns from which on it applies.
        limits: limits that the measurements of the packets must keep, `RED`, or `YELLOW` for both; empty for none.
    """

    name: str
    place: str
    selection: Selection
    when: Predicate | None = None
    holds: Predicate | None = None
    answer: Answer | None = None
    again_ns: int | None = None
    eventually: Predicate | None = None
    file: Path | None = None
    function: str = ""
    after_ns: int = 0
    limits: str = ""

    @property
    def predicates(self) -> tuple[Predicate, ...]:
        """All its expressions."""
        of_answer = None if self.answer is None else self.answer.holds
        return tuple(each for each in (self.when, self.holds, self.eventually, of_answer) if each is not None)

    @property
    def names(self) -> tuple[str, ...]:
        """The topics, patterns and packets to which it applies, without answers."""
        return (*self.selection.topics, *self.selection.packets)

    @property
    def packets(self) -> tuple[str, ...]:
        """The names of all packets to which it applies."""
        return self.selection.packets + (() if self.answer is None else self.answer.selection.packets)


def read_invariants(section: Marked, mistakes: Mistakes) -> tuple[Invariant, ...]:
    """Return the section `invariants:`, without invalid entries.

    Args:
        section: its value; files of functions are searched in the folder of its file.
        mistakes: collects unknown keys, missing keys and invalid values.
    """
    entries = mistakes.mapping(section).items()
    found = (mistakes.whole(partial(_invariant, name, entry)) for name, entry in entries)
    return tuple(each for each in found if each is not None)


def _invariant(name: str, entry: Marked, mistakes: Mistakes) -> Invariant:
    fields = dict(mistakes.fields(entry, FIELDS))
    kinds = [each for each in KINDS if each in fields]
    is_known = not mistakes.errors  # otherwise a field is missing because its name is wrong
    if len(kinds) > 1 or (not kinds and is_known):
        said = f"has {' and '.join(kinds)}; write one of them" if kinds else "missing condition"
        text = 'give `holds: "msg.data < 3"`, `file` and `function`, `within` and `then`, `again`, `eventually`'
        text += ", or `limits: red`"
        mistakes.add(entry.fail(f"{said}; {text}"))
    selection = mistakes.attempt(partial(read_selection, fields))
    if selection == Selection() and "function" not in fields and is_known:
        mistakes.add(entry.fail("missing message; add `topic: /name` or `packet: NAME`"))
    code = mistakes.attempt(partial(_function, entry, fields)) if is_known else None
    file, function = code or (None, "")

    def predicate(field: str) -> Predicate | None:
        return mistakes.attempt(partial(Predicate.read, fields[field], NAMES)) if field in fields else None

    return Invariant(
        name,
        f"{entry.file.name}:{entry.line}",
        selection or Selection(),
        when=predicate("when"),
        holds=predicate("holds"),
        answer=mistakes.whole(partial(_answer, entry, fields)) if is_known else None,
        again_ns=mistakes.attempt(partial(_again, fields["again"])) if "again" in fields else None,
        eventually=predicate("eventually"),
        file=file,
        function=function,
        after_ns=(mistakes.attempt(fields["after"].time) or 0) if "after" in fields else 0,
        limits=mistakes.attempt(partial(_limits, fields)) or "" if "limits" in fields else "",
    )


def read_selection(fields: Mapping[str, Marked]) -> Selection:
    """Return the messages given by `topic` and `packet`.

    Raises:
        UsageError: if a topic does not start with "/", or a MsgId is invalid.
    """
    topics = [partial(_topic, each) for each in _list(fields.get("topic"))]
    packets = [partial(_packet, each) for each in _list(fields.get("packet"))]
    found = each_of([*topics, *packets])
    return Selection(tuple(found[: len(topics)]), tuple(found[len(topics) :]))


def _list(entry: Marked | None) -> list[Marked]:
    if entry is None:
        return []
    return entry.items() if isinstance(entry.value, list) else [entry]


def _topic(entry: Marked) -> str:
    name = entry.text()
    if not name.startswith(("/", "*")):
        raise entry.fail(f'invalid topic name {name!r}; expected a full name, which begins with "/", or a pattern')
    return name


def _packet(entry: Marked) -> str:
    if isinstance(entry.value, int) and not isinstance(entry.value, bool):
        return f"0x{entry.integer(1, HIGHEST_VALID_MSG_ID):04X}"
    return entry.text()


def _answer(entry: Marked, fields: Mapping[str, Marked], mistakes: Mistakes) -> Answer | None:
    if "within" not in fields:
        if "then" in fields:
            raise fields["then"].fail("requires `within`; add it, such as `within: 0.5 s`")
        return None
    if "then" not in fields:
        raise entry.fail("`within` requires `then`; add it, such as `then: {topic: /name}`")
    within_ns = mistakes.attempt(fields["within"].time)
    then = dict(mistakes.fields(fields["then"], ANSWER_FIELDS))
    holds = mistakes.attempt(partial(Predicate.read, then["holds"], (*NAMES, CAUSE))) if "holds" in then else None
    selection = mistakes.attempt(partial(read_selection, then))
    if selection == Selection() and not mistakes.errors:  # otherwise its key may be misspelt
        mistakes.add(fields["then"].fail("missing message; add `topic: /name` or `packet: NAME`"))
    return Answer(selection or Selection(), holds, within_ns or 0)


def _again(entry: Marked) -> int:
    time_ns = entry.time()
    if not time_ns:
        raise entry.fail("must be the longest time between two such messages, such as 0.5 s, not 0")
    return time_ns


def _limits(fields: Mapping[str, Marked]) -> str:
    """Return the limits that measurements must keep."""
    entry = fields["limits"]
    if entry.value not in (RED, YELLOW):
        raise entry.fail(f"must be {RED} or {YELLOW}, not {entry.shown()}")
    if "topic" in fields:
        raise fields["topic"].fail("cannot be combined with `limits`; only packets have them: `packet: NAME`")
    return str(entry.value)


def _function(entry: Marked, fields: Mapping[str, Marked]) -> tuple[Path | None, str]:
    """Return the file and the name of a function or class."""
    if "function" not in fields:
        if "file" in fields:
            raise entry.fail("`file` requires `function`; add `function: NAME`")
        return None, ""
    if "file" not in fields:
        raise entry.fail("`function` requires `file`; add `file: checks.py`")
    file, name = entry.file.parent / fields["file"].text(), fields["function"].text()
    if not os.path.isfile(file):
        raise fields["file"].fail(f"file not found: {file}; give a path relative to the mission's folder")
    broken = sources.syntax_error(file)
    if broken is not None:
        raise UsageError(f"is not Python: {broken[1]}", file=file, line=broken[0])
    if not sources.defines(file, name):
        hint = expected(name, sources.functions_and_classes_of(file), subject=f"{file.name} has")
        raise fields["function"].fail(f"unknown function or class {name!r}; {hint}")
    return file, name


def code_of(invariant: Invariant) -> Any:
    """Return the function of an invariant, from a new execution of its file; a class is instantiated.

    Raises:
        UsageError: if executing its file failed.
    """
    assert invariant.file is not None
    space: dict[str, Any] = {"__name__": invariant.file.stem, "__file__": str(invariant.file)}
    try:
        exec(compiled(read_limited(invariant.file, PYTHON_BYTES), str(invariant.file)), space)
        found = space[invariant.function]
        return found() if isinstance(found, type) else found
    except Exception as error:
        text = f"{invariant.function} cannot be loaded: {type(error).__name__}: {error}"
        raise UsageError(text, file=invariant.file) from error
