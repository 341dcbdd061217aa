"""`Journal`: everything that decided a run, and what it came to, as plain values; and how to read one from its file.

May import cfepy.mission and its neighbours in cfepy.journal.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any, NamedTuple

from cfepy.journal.frames import JournalError, read_frames
from cfepy.journal.mission_files import FileRecord, hash_of
from cfepy.mission.course import BROKEN_OFF
from cfepy.mission.outside import Event
from cfepy.mission.run_plan import RunPlan

FORMAT = 1
HEADER, FILE, FOLDER, PAUSE, ANSWER, CHECK, END = "header", "file", "folder", "pause", "answer", "check", "end"


@dataclass(frozen=True, slots=True)
class Header:
    """What was known when the run began.

    Attributes:
        plan: what was run, and on what.
        paced: times real time, when it was joined to the network of its computer; None for one that was not.
        policy: what the policy told the kernel beside its answers (`cfepy.rtos.policy`); None for plain fifo.
        mission: its name; `folder` is what shows as /cf, `startup` what it was read from, as paths of the computer.
        cwd: the working directory.
        environ: environment variables that the mission could see.
        versions: of cfepy, cFE and Python.
        host: of the computer: what a node can find out about it.
        format: of the journal.
    """

    plan: RunPlan
    paced: float | None
    policy: dict[str, Any] | None
    mission: str
    folder: str
    startup: str
    cwd: str
    environ: dict[str, str]
    versions: dict[str, str]
    host: dict[str, str]
    format: int = FORMAT

    def to_dict(self) -> dict[str, Any]:
        """Itself as plain values."""
        return {each.name: getattr(self, each.name) for each in fields(self)} | {"plan": self.plan.to_dict()}

    @classmethod
    def from_dict(cls, plain: Mapping[str, Any]) -> Header:
        """The other way round; values that a later version may have added are left out."""
        known = {each.name: plain[each.name] for each in fields(cls) if each.name in plain}
        plan = {each.name: plain["plan"][each.name] for each in fields(RunPlan) if each.name in plain["plan"]}
        return cls(**{**known, "plan": RunPlan.from_dict(plan)})


@dataclass(frozen=True, slots=True)
class Pause:
    """Where the run stood still and something came from outside.

    Attributes:
        until_ns: the virtual time until which the run had been let go on.
        visits: the how manyeth time in a row that was until this very time, from 1.
        events: what came, in order.
    """

    until_ns: int
    visits: int
    events: list[Event] = field(default_factory=list)


class Checkpoint(NamedTuple):
    """How far the run had come: virtual ns, number of records, the digest of them."""

    now_ns: int
    records: int
    digest: str


@dataclass(frozen=True, slots=True)
class End:
    """The end of a run.

    Attributes:
        reason: OVER, INTERRUPTED or BROKEN_OFF (`cfepy.mission.course`).
        until_ns: the virtual time until which it was let go on at last.
        visits: the how manyeth time in a row that was until this very time, from 1.
        now_ns: virtual time at the end, after the nodes have shut down.
        records: of the trace.
        trace: the digest of the trace.
        results: the digest of the numbers of its report.
        outcome: how many steps of its script have passed and failed; empty without one.
    """

    reason: str
    until_ns: int
    visits: int
    now_ns: int
    records: int
    trace: str
    results: str
    outcome: dict[str, Any] = field(default_factory=dict)


@dataclass(slots=True)
class Journal:
    """A run that was written down.

    Attributes:
        path: its file.
        header: what was known when it began.
        files: the files that make the mission, by path on the computer of the run.
        folders: what nodes saw in folders that they looked into: by path, names and whether they are folders.
        pauses: what came from outside.
        answers: which calls of the mission's to the outside were answered, in order.
        decisions: the answers of the policy that were not fifo's, by number of the decision.
        decided: how many decisions that covers.
        checkpoints: how far it had come, in order.
        end: None when the process of the run came to a sudden end.
    """

    path: str
    header: Header
    files: dict[str, FileRecord] = field(default_factory=dict)
    folders: dict[str, dict[str, bool]] = field(default_factory=dict)
    pauses: list[Pause] = field(default_factory=list)
    answers: list[Event] = field(default_factory=list)
    decisions: dict[int, int] = field(default_factory=dict)
    decided: int = 0
    checkpoints: list[Checkpoint] = field(default_factory=list)
    end: End | None = None

    @property
    def plan(self) -> RunPlan:
        """What was run, and on what."""
        return self.header.plan

    @property
    def mission_hash(self) -> str:
        """SHA-256 over names and contents of all files that make the mission, 64 hexadecimal digits."""
        return hash_of(self.files.values())

    @property
    def known_until_ns(self) -> int:
        """The virtual time until which the journal knows the run."""
        if self.end is not None:
            is_broken = self.end.reason == BROKEN_OFF  # in the middle of what happened at its last instant
            return self.end.now_ns - 1 if is_broken else self.end.until_ns
        return max((0, *(each.until_ns for each in self.pauses[-1:]), *(each.now_ns for each in self.checkpoints[-1:])))

    def _take(self, kind: str, body: dict[str, Any]) -> None:
        """What a frame says; frames of an unknown kind are a later version's."""
        if kind == FILE:
            self.files[body["path"]] = FileRecord(**body)
        elif kind == FOLDER:
            self.folders[body["path"]] = body["names"]
        elif kind == PAUSE:
            self._take_pause(Pause(body["until_ns"], body["visits"]), body["events"])
        elif kind == ANSWER:
            self.answers.append(Event(kind, tuple(body["values"])))
        elif kind == CHECK:
            self.checkpoints.append(Checkpoint(*body["at"]))
            self._take_decisions(body["decisions"], body["decided"])
        elif kind == END:
            self.end = End(**body)

    def _take_pause(self, pause: Pause, events: list[list[Any]]) -> None:
        last = self.pauses[-1] if self.pauses else None
        if last is None or (last.until_ns, last.visits) != (pause.until_ns, pause.visits):
            self.pauses.append(last := pause)
        last.events.extend(Event(name, tuple(values)) for name, values in events)

    def _take_decisions(self, gaps_and_choices: list[int], decided: int) -> None:
        number = self.decided - 1
        for gap, choice in zip(gaps_and_choices[::2], gaps_and_choices[1::2], strict=True):
            number += gap
            self.decisions[number] = choice
        self.decided = decided


def read_journal(path: str | Path) -> Journal:
    """Read a journal.

    Raises:
        JournalError: it is none, it is damaged, or its format is another one.
        UsageError: there is no such file.
    """
    try:
        return _read(str(path))
    except OSError as error:
        raise JournalError(f"cannot be read: {error.strerror}", file=path) from None
    except (KeyError, TypeError, ValueError) as error:
        if isinstance(error, JournalError):
            raise
        raise JournalError(f"is damaged: {type(error).__name__}: {error}", file=path) from error


def _read(path: str) -> Journal:
    frames = read_frames(path)
    kind, body = next(frames, ("", {}))
    if kind != HEADER:
        raise JournalError("is cut off before its first frame is complete: there is nothing to replay", file=path)
    if body["format"] != FORMAT:
        who = body.get("versions", {}).get("cfepy", "?")
        text = f"has format {body['format']} (cfepy {who}); this cfepy reads format {FORMAT}: use the other one"
        raise JournalError(text, file=path)
    journal = Journal(path, Header.from_dict(body))
    for kind, body in frames:
        journal._take(kind, body)
    return journal
