"""Requirements of a campaign: which test shows which requirement, and with which result.

The states are the states of RequirementTracker in NASA's COSMOS plugin: U untested, P passed, F failed, I needs
inspection, A needs analysis, IA needs both.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import LINE_FILE_BYTES
from cfepy.reading.plain_yaml import plain_yaml
from cfepy.status import UsageError

T = TypeVar("T", bound=Callable[..., Any])
STATES = {
    "U": "not run",
    "P": "passed",
    "F": "failed",
    "I": "needs inspection",
    "A": "needs analysis",
    "IA": "needs inspection and analysis",
}
MARK = "cfepy_requirements"
_IDS = re.compile(r"[,\s]+")


def requirement(*ids: str) -> Callable[[T], T]:
    """Mark a test, or all tests of a group: `@requirement("cES1004")`.

    Args:
        ids: ids of the requirements that it shows.
    """

    def mark(test: T) -> T:
        setattr(test, MARK, (*ids, *getattr(test, MARK, ())))
        return test

    return mark


def marked(*objects: Any) -> tuple[str, ...]:
    """Return the ids of the marks of functions and classes, each once."""
    return tuple(dict.fromkeys(each for thing in objects for each in getattr(thing, MARK, ())))


def next_state(before: str, wanted: str) -> str:
    """Return the state of a requirement after a new one is set, by the rules of RequirementTracker.

    F stays, a need for inspection or analysis is not lost by P, I and A become IA, and nothing becomes U again.
    """
    if before == "F" or wanted == "U":
        return before
    if {before, wanted} == {"I", "A"} or (before == "IA" and wanted != "F"):
        return "IA"
    if before in ("I", "A") and wanted == "P":
        return before
    return wanted


@dataclass(slots=True)
class Requirement:
    """A requirement.

    Attributes:
        name: its id.
        text: its text.
        state: a key of `STATES`.
        tests: state by the name of each test that shows it, and a message.
    """

    name: str
    text: str = ""
    state: str = "U"
    tests: dict[str, tuple[str, str]] = field(default_factory=dict)


class Requirements:
    """The requirements of a campaign.

    Args:
        file: a YAML file with texts by id; None for none.

    Attributes:
        current: name of the running test.

    Raises:
        UsageError: if the file is not a mapping from ids to texts.
    """

    def __init__(self, file: Path | None = None) -> None:
        self.known: dict[str, Requirement] = {}
        self.current = ""
        if file is not None:
            for name, text in read_texts(file).items():
                self.known[name] = Requirement(name, text)

    def set_status(self, ids: str | Iterable[str], state: str, message: str = "", *rest: Any) -> None:
        """Set the state of requirements, as a procedure does.

        Args:
            ids: one id, ids with commas between them, or a list.
            state: a key of `STATES`.
            message: why.

        Raises:
            UsageError: if there is no such state.
        """
        if state not in STATES:
            raise UsageError(f"unknown state {state!r} of a requirement; expected {', '.join(STATES)}")
        for name in _IDS.split(ids.strip()) if isinstance(ids, str) else ids:
            found = self.known.setdefault(name, Requirement(name))
            found.state = next_state(found.state, state)
            before = found.tests.get(self.current, ("U", ""))[0]
            found.tests[self.current] = (next_state(before, state), message)

    def note_test(self, test: str, ids: Iterable[str], verdict: str, message: str = "") -> None:
        """Set the state of the requirements that a finished test shows."""
        self.current = test
        state = {"PASS": "P", "FAIL": "F"}.get(verdict, "U")
        if state == "U":
            for name in ids:
                self.known.setdefault(name, Requirement(name)).tests.setdefault(test, ("U", message))
            return
        self.set_status(list(ids), state, message)

    def read_tracker(self, tracker: Any) -> None:
        """Take the states from an object with `requirements`, as NASA's RequirementTracker has."""
        for name, entry in dict(getattr(tracker, "requirements", {})).items():
            state = entry.get("state") if isinstance(entry, Mapping) else None
            if state in STATES and state != "U":
                events = entry.get("events") or [{}]
                self.set_status([name], state, str(events[-1].get("message", "")))

    def rows(self) -> list[Requirement]:
        """Return all requirements, by id."""
        return sorted(self.known.values(), key=lambda each: each.name)


def read_texts(file: Path) -> dict[str, str]:
    """Return the texts of requirements by id, from a YAML file.

    Raises:
        UsageError: if the file is not a mapping from ids to texts.
    """
    found = plain_yaml(read_limited(file, LINE_FILE_BYTES).decode("utf-8", "replace"))
    if not isinstance(found, dict) or not all(isinstance(each, str | int) for each in found.values()):
        raise UsageError("requirements must be a mapping from ids to texts", file=file)
    return {str(name): str(text) for name, text in found.items()}
