"""`Journal`: everything that determined a run, and its results, as plain values; and the file format.

The file is a mark and frames, each with length and checksum, so that a damaged file is detected. A frame is written and
passed to the operating system at once: if the process is killed, at most the last frame is lost. A frame is `<II`
(number of bytes that follow, their CRC-32) and a msgpack array of its kind and a mapping.
"""

from __future__ import annotations

import json
import os
import struct
import zlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields
from hashlib import blake2b
from pathlib import Path
from typing import Any, NamedTuple

from cfepy.journal.frame_check import FORMAT, check_values, problem_of
from cfepy.journal.mission_files import MissionFile, hash_of
from cfepy.journal.snapshots import PathLook
from cfepy.mission import Arrival
from cfepy.pilot import STALLED, SUDDEN, Results, RunPlan
from cfepy.reading.input_files import open_input
from cfepy.reading.input_limits import JOURNAL_FRAME_BYTES
from cfepy.status import UsageError

HEADER, FILE, FOLDER, LOOK, PAUSE = "header", "file", "folder", "look", "pause"
ANSWER, CHECK, END = "answer", "check", "end"
MARK = b"cfepy journal\r\n\x1a"
_head = struct.Struct("<II")
_NOT_OF_THE_RUN = (
    "wall_s",
    "speed",
    "tasks",
    "why_tasks",
    "trace",
    "ros_peers",
    "viewer_peers",
    "beside",
    "missed_steps",
)


@dataclass(frozen=True, slots=True)
class Header:
    """Facts known at the start of the run.

    Attributes:
        plan: plan of the run.
        paced: factor of real time, if it was connected to the network of its computer; None otherwise.
        policy: settings of the policy, apart from its answers (`cfepy.rtos.policy`); None for plain fifo.
        mission: its name; `folder` is shown as /cf, `startup` is the file it was read from, as paths of the computer.
        cwd: working directory.
        environ: environment variables that the mission could see.
        versions: versions of cfepy, cFE and Python.
        host: facts about the computer that a node can see.
        format: format of the journal.
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
        """Return it as plain values."""
        return {each.name: getattr(self, each.name) for each in fields(self)} | {"plan": self.plan.to_dict()}

    @classmethod
    def from_dict(cls, plain: Mapping[str, Any]) -> Header:
        """Return a header from plain values; values added by later versions are ignored."""
        known = {each.name: plain[each.name] for each in fields(cls) if each.name in plain}
        plan = {each.name: plain["plan"][each.name] for each in fields(RunPlan) if each.name in plain["plan"]}
        return cls(**{**known, "plan": RunPlan.from_dict(plan)})


@dataclass(frozen=True, slots=True)
class Pause:
    """Where the run stopped and input came from outside.

    Attributes:
        until_ns: virtual time to which the run had advanced.
        visits: number of consecutive stops at this time, from 1.
        events: the input, in order.
    """

    until_ns: int
    visits: int
    events: list[Arrival] = field(default_factory=list)


class Checkpoint(NamedTuple):
    """Progress of a run: virtual ns, number of records, and their digest."""

    now_ns: int
    records: int
    digest: str


@dataclass(frozen=True, slots=True)
class End:
    """End of a run.

    Attributes:
        reason: OVER, INTERRUPTED, BROKEN_OFF or STALLED (`cfepy.pilot.run_loop`).
        until_ns: virtual time to which it last advanced.
        visits: number of consecutive stops at this time, from 1.
        now_ns: virtual time at the end, after the nodes have shut down.
        records: number of records of the trace.
        trace: digest of the trace.
        results: digest of the numbers of its report.
        outcome: how many steps of its script passed and failed; empty without a script.
        beside: problems of the missions that flew together with it, which are not replayed.
    """

    reason: str
    until_ns: int
    visits: int
    now_ns: int
    records: int
    trace: str
    results: str
    outcome: dict[str, Any] = field(default_factory=dict)
    beside: list[str] = field(default_factory=list)


@dataclass(slots=True)
class Journal:
    """A recorded run.

    Attributes:
        path: its file.
        header: facts known at the start.
        files: files of the mission, by path on the computer of the run.
        folders: contents of listed folders: by path, names and whether they are folders.
        looks: facts about paths that nodes and applications checked, by path.
        pauses: input from outside.
        answers: which calls of the mission to the outside were answered, in order.
        decisions: answers of the policy that differ from fifo's, by number of the decision.
        decided: number of decisions that these cover.
        checkpoints: progress, in order.
        end: None if the process of the run ended suddenly.
    """

    path: str
    header: Header
    files: dict[str, MissionFile] = field(default_factory=dict)
    folders: dict[str, dict[str, bool]] = field(default_factory=dict)
    looks: dict[str, PathLook] = field(default_factory=dict)
    pauses: list[Pause] = field(default_factory=list)
    answers: list[Arrival] = field(default_factory=list)
    decisions: dict[int, int] = field(default_factory=dict)
    decided: int = 0
    checkpoints: list[Checkpoint] = field(default_factory=list)
    end: End | None = None

    @property
    def plan(self) -> RunPlan:
        """The plan of the run."""
        return self.header.plan

    @property
    def mission_hash(self) -> str:
        """SHA-256 over names and contents of all files of the mission, 64 hexadecimal digits."""
        return hash_of(self.files.values())

    @property
    def known_until_ns(self) -> int:
        """The virtual time until which the journal covers the run."""
        if self.end is not None:
            if self.end.reason == STALLED:
                return self.end.now_ns  # the task would be stuck there again
            is_broken = self.end.reason in SUDDEN  # in the middle of its last instant
            return self.end.now_ns - 1 if is_broken else self.end.until_ns
        return max((0, *(each.until_ns for each in self.pauses[-1:]), *(each.now_ns for each in self.checkpoints[-1:])))

    def _take(self, kind: str, body: dict[str, Any]) -> None:
        """Add the contents of a frame; frames of an unknown kind are from a later version."""
        if kind == FILE:
            self.files[body["path"]] = MissionFile(**body)
        elif kind == FOLDER:
            self.folders[body["path"]] = body["names"]
        elif kind == LOOK:
            self.looks[body["path"]] = PathLook(**body)
        elif kind == PAUSE:
            self._take_pause(Pause(body["until_ns"], body["visits"]), body["events"])
        elif kind == ANSWER:
            self.answers.append(Arrival(kind, tuple(body["values"])))
        elif kind == CHECK:
            self.checkpoints.append(Checkpoint(*body["at"]))
            self._take_decisions(body["decisions"], body["decided"])
        elif kind == END:
            self.end = End(**body)

    def _take_pause(self, pause: Pause, events: list[list[Any]]) -> None:
        last = self.pauses[-1] if self.pauses else None
        if last is None or (last.until_ns, last.visits) != (pause.until_ns, pause.visits):
            self.pauses.append(last := pause)
        last.events.extend(Arrival(name, tuple(values)) for name, values in events)

    def _take_decisions(self, gaps_and_choices: list[int], decided: int) -> None:
        number = self.decided - 1
        for gap, choice in zip(gaps_and_choices[::2], gaps_and_choices[1::2], strict=True):
            number += gap
            self.decisions[number] = choice
        self.decided = decided


def read_journal(path: str | Path) -> Journal:
    """Read a journal.

    Raises:
        JournalError: if it is not a journal, is damaged, or has another format.
        UsageError: if there is no such file.
    """
    try:
        return _read(str(path))
    except OSError as error:
        raise JournalError(f"cannot be read: {error.strerror}", file=path) from None
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        if isinstance(error, JournalError):
            raise
        raise JournalError(f"is damaged: {type(error).__name__}: {error}", file=path) from error


def check_paths(path: str | Path) -> None:
    """Refuse journals on a computer whose paths have drives, since journals contain POSIX paths.

    Raises:
        UsageError: if this is such a computer.
    """
    if os.name == "nt":
        text = "journals require the file names of Linux or macOS; record and replay there, or in WSL"
        raise UsageError(text, file=path)


def _read(path: str) -> Journal:
    check_paths(path)
    frames = read_frames(path)
    kind, body = next(frames, ("", {}))
    if kind != HEADER:
        raise JournalError("is truncated before the end of its first frame and cannot be replayed", file=path)
    if body["format"] != FORMAT:
        who = body.get("versions", {}).get("cfepy", "?")
        text = (
            f"has format {body['format']}, written by cfepy {who}; this cfepy reads only "
            f"format {FORMAT}. Replay it with that version"
        )
        raise JournalError(text, file=path)
    journal = Journal(path, Header.from_dict(body))
    for kind, body in frames:
        journal._take(kind, body)
    return journal


def is_journal(path: str | Path) -> bool:
    """Return whether a file begins as a journal does.

    Raises:
        OSError: if it cannot be read.
    """
    with open_input(path, handed=True) as file:
        return file.read(len(MARK)) == MARK


class JournalError(UsageError):
    """Error for a file that is not a journal, is damaged, or cannot be read here."""


class FrameWriter:
    """Writes the frames of a journal.

    Args:
        path: the file; it is overwritten.

    Raises:
        OSError: if it cannot be written.
    """

    def __init__(self, path: str | Path) -> None:
        import msgpack

        self._pack = msgpack.Packer().pack
        self._file = open(path, "wb", buffering=0)  # noqa: SIM115  # closed in `close`
        self._file.write(MARK)

    def write(self, kind: str, body: Mapping[str, Any]) -> None:
        """Write a frame.

        Raises:
            OSError: if the disk is full.
        """
        data = self._pack([kind, body])
        frame = memoryview(_head.pack(len(data), zlib.crc32(data)) + data)
        while frame:
            frame = frame[self._file.write(frame) :]

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def read_frames(path: str | Path) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the frames of a journal, kind and body; an incomplete last one is left out.

    Raises:
        JournalError: if it is not a journal, or is damaged.
        OSError: if it cannot be read.
    """
    import msgpack

    with open_input(path, handed=True) as file:
        if file.read(len(MARK)) != MARK:
            raise JournalError("is not a journal; give a file that `cfepy run --record FILE` wrote", file=path)
        while len(head := file.read(_head.size)) == _head.size:
            size, checksum = _head.unpack(head)
            at = file.tell()
            data = file.read(min(size, JOURNAL_FRAME_BYTES))
            if len(data) < size <= JOURNAL_FRAME_BYTES:
                return
            if size > JOURNAL_FRAME_BYTES or zlib.crc32(data) != checksum:
                raise JournalError(f"is damaged at byte {at}: the checksum is wrong; copy it again", file=path)
            try:
                check_values(data)
                kind, body = msgpack.unpackb(data, strict_map_key=False)
            except (ValueError, TypeError, RecursionError, msgpack.UnpackException) as error:
                raise JournalError(f"is damaged at byte {at}: {error or type(error).__name__}", file=path) from None
            problem = problem_of(kind, body) if isinstance(kind, str) else f"a frame has the kind {kind!r}"
            if problem is not None:
                raise JournalError(f"was not written by cfepy: at byte {at}, {problem}", file=path)
            yield kind, body


def beside_problems(results: Results) -> list[str]:
    """Return the problems of the missions that flew together with it, as in its report."""
    return [f"{row['mission']}: {line}" for row in results.beside for line in row["problems"]]


def digest_of(results: Results, root: str = "") -> str:
    """Return 32 hexadecimal digits, a digest of the numbers of a report without wall-clock time.

    Args:
        results: the numbers.
        root: folder at the start of paths, which is ignored.
    """
    plain = results.to_dict()
    elsewhere = (*beside_problems(results), *results.missed_steps)  # steps are reported with the path of their script
    plain["problems"] = [line for line in results.problems if line not in elsewhere]
    for name in _NOT_OF_THE_RUN:
        del plain[name]
    text = json.dumps(plain, sort_keys=True)
    return blake2b((text.replace(root, "") if root else text).encode(), digest_size=16).hexdigest()
