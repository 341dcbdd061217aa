"""Completion of console lines: its words, commands with their fields, conditions to expect, and files."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from cfepy.cli.ground.console.pages import ALL, HK
from cfepy.cli.ground.console.session import MAXIMUM, TIMES, VERBS, ConsoleSession
from cfepy.ground import EVENT_TYPES, Dictionary
from cfepy.msg import Command, Layout, Telemetry
from cfepy.script import APP_STATES, OPERATORS, RESET_TYPES, ROS_STEPS
from cfepy.status import UsageError
from cfepy.writing.escapes import visible_line

_INDEX = re.compile(r"\[\d+\]$")
THINGS = ("event", "tlm", "topic", "response", "param", "app", "console", "file", "no")
ROS_THINGS = {"topic": "publish", "param": "set"}
TRUTH = ("true", "false")


class Candidate(NamedTuple):
    """A possible word, and a hint about it."""

    text: str
    hint: str = ""


class Completion(NamedTuple):
    """The possible replacements of the line's last word, which begins at `start`."""

    start: int
    choices: list[Candidate]

    def extended(self, line: str) -> str:
        """Extend the line as far as it is unambiguous. A whole word gets a blank, unless a value follows."""
        texts = [choice.text for choice in self.choices]
        if not texts:
            return line
        common = _in_common(texts)
        if len(texts) == 1:
            return line[: self.start] + common + ("" if common.endswith(("=", "/")) else " ")
        return line[: self.start] + common if len(common) > len(line) - self.start else line


class Completer:
    """Completes lines.

    Args:
        session: the session that will carry out the line.
    """

    def __init__(self, session: ConsoleSession) -> None:
        self._session = session

    @property
    def _dictionary(self) -> Dictionary:
        return self._session.craft.script.scene.dictionary

    def complete(self, line: str) -> Completion:
        """Return the possible replacements of a line's last word. After a blank, that word is empty."""
        words = line.split(" ")
        last = words.pop()
        before = [word for word in words if word]
        fitting = _fitting(self._choices(before, last), last)
        choices = [each for each in fitting if visible_line(each.text) == each.text]  # others cannot be typed
        return Completion(len(line) - len(last), choices)

    def _choices(self, before: list[str], last: str) -> Iterable[Candidate]:
        while before[:1] and before[0] in TIMES:
            before = before[2:]
        if not before:
            return self._first()
        verb, rest = before[0], before[1:]
        if verb in ("expect", "until"):
            return self._things(rest)
        if verb == "send":
            return self._fields(rest, last) if rest else self._commands()
        if verb in ROS_STEPS:
            return [] if rest else [Candidate(name) for name in self._ros_names(verb)]
        if verb in self._session.words or verb in VERBS:
            return self._arguments(verb, last)
        return self._fields(before, last)

    def _first(self) -> Iterator[Candidate]:
        yield from (Candidate(name, word.text) for name, word in self._session.words.items())
        yield from (Candidate(verb, "a step of a script") for verb in VERBS)
        yield from self._commands()

    def _commands(self) -> Iterator[Candidate]:
        yield from (Candidate(name, command.text) for name, command in sorted(self._dictionary.commands.items()))

    def _arguments(self, verb: str, last: str) -> Iterable[Candidate]:
        if verb == "page":
            return [Candidate(HK, "housekeeping"), Candidate(ALL, "a row for each packet"), *self._packets()]
        if verb in ("load", "save"):
            return _files(last)
        simple: dict[str, Iterable[str]] = {
            "reset": RESET_TYPES,
            "speed": (MAXIMUM, "1"),
            "events": ("all", *EVENT_TYPES, *self._apps()),
            "help": (*self._session.words, *self._dictionary.commands),
        }
        return [Candidate(text) for text in simple.get(verb, ())]

    def _packets(self) -> list[Candidate]:
        return [Candidate(name, entry.text) for name, entry in sorted(self._dictionary.telemetry.items())]

    def _apps(self) -> list[str]:
        scene = self._session.craft.script.scene
        return [app.name for app in scene.mission.cfe.es.apps] if scene.has_mission else []

    def _ros_names(self, step: str) -> list[str]:
        """Return the topics, services or parameters that a step of this kind can name now."""
        scene = self._session.craft.script.scene
        ros = scene.mission.ros if scene.has_mission else None
        if ros is None:
            return []
        if step == "set":
            return sorted(ros.graph.params.names())
        return sorted(ros.graph.topics if step == "publish" else ros.graph.services)

    def _fields(self, words: list[str], last: str) -> Iterable[Candidate]:
        try:
            command = self._dictionary.command(words[0])
        except UsageError:
            return []
        path, equals, _ = last.partition("=")
        if equals:
            return [Candidate(f"{path}={value}") for value in _values(command, path)]
        given = {word.partition("=")[0] for word in words[1:]}
        return [Candidate(f"{name}=", kind) for name, kind in fields_of(command).items() if name not in given]

    def _things(self, rest: list[str]) -> Iterable[Candidate]:
        if rest[:1] == ["no"]:
            rest = rest[1:]
        if not rest:
            return [Candidate(thing) for thing in THINGS]
        thing, words = rest[0], rest[1:]
        if thing == "tlm":
            return self._comparison(words)
        if thing in ROS_THINGS and not words:
            return [Candidate(name) for name in self._ros_names(ROS_THINGS[thing])]
        if len(words) == 0:
            return [Candidate(name) for name in ("*", *self._apps())] if thing in ("event", "app") else []
        following = {"event": EVENT_TYPES, "app": APP_STATES}.get(thing, ())
        return [Candidate(text) for text in (*following, "within")]

    def _comparison(self, words: list[str]) -> Iterable[Candidate]:
        """Complete `NAME [FIELD SIGN VALUE [and ...]]`."""
        if not words:
            return self._packets()
        place = (len(words) - 1) % 4
        entry = self._dictionary.telemetry.get(words[0])
        if place == 0:
            cells = entry.payload.cells() if isinstance(entry, Telemetry) else ()
            return [*(Candidate(cell.path, cell.type) for cell in cells), Candidate("within")]
        if place == 2 and isinstance(entry, Telemetry):
            return [Candidate(name) for name in _names(entry.payload, words[-2])]
        return {1: [Candidate(sign) for sign in OPERATORS], 3: [Candidate("and"), Candidate("within")]}.get(place, [])


def _in_common(texts: list[str]) -> str:
    """Return the longest common prefix of all texts."""
    first, last = min(texts), max(texts)
    same = (number for number, (one, other) in enumerate(zip(first, last, strict=False)) if one != other)
    return first[: next(same, min(len(first), len(last)))]


def fields_of(command: Command) -> dict[str, str]:
    """Return the fields of a command that a line gives, with their types. An array is one field, such as `u32[4]`."""
    found: dict[str, str] = {}
    counts: dict[str, int] = {}
    for cell in command.payload.cells():
        name = _INDEX.sub("", cell.path)
        counts[name] = counts.get(name, 0) + 1
        found[name] = cell.type if name == cell.path else f"{cell.type}[{counts[name]}]"
    return found


def _values(command: Command, path: str) -> Iterable[str]:
    """Return the values of a field that has few."""
    return TRUTH if fields_of(command).get(path) == "bool" else _names(command.payload, path)


def _names(layout: Layout, path: str) -> Iterable[str]:
    """Return the names of a field's values, if it has names."""
    return next((cell.names.values for cell in layout.cells() if cell.path == path and cell.names is not None), ())


def _fitting(choices: Iterable[Candidate], word: str) -> Iterator[Candidate]:
    """Yield the choices that begin with the word, ignoring case. If there are none, yield those that contain it."""
    every = list(choices)
    begin = [each for each in every if each.text.lower().startswith(word.lower())]
    yield from begin or (each for each in every if word.lower() in each.text.lower())


def _files(word: str) -> Iterator[Candidate]:
    """Yield files and folders that complete a path."""
    folder, slash, _ = word.rpartition("/")
    try:
        inside = sorted(Path(f"{folder}{slash}" or ".").iterdir())
    except OSError:
        return
    for path in inside:
        yield Candidate(f"{folder}{slash}{path.name}{'/' if path.is_dir() else ''}")
