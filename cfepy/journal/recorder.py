"""`JournalRecorder`: writes down a run while it goes on.

A message costs nothing: what is written are files, what comes from outside, and how far the run has come, each time
that some thousands of records were hashed anyway.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from types import TracebackType
from typing import Any

from cfepy.attachment import Attachment
from cfepy.journal.computer_facts import environ_of, host_facts, versions
from cfepy.journal.decisions import JournalPolicy, settings_of
from cfepy.journal.journal import (
    ANSWER,
    CHECK,
    END,
    FILE,
    FOLDER,
    HEADER,
    LOOK,
    PAUSE,
    FrameWriter,
    Header,
    beside_problems,
    check_paths,
    digest_of,
    is_journal,
)
from cfepy.journal.mission_files import CARRIED, MOST_FILES, Carrier, ReadFiles, files_of
from cfepy.journal.snapshots import MOST_LOOKS, look_at
from cfepy.mission import Mission, outside
from cfepy.pilot import Flown, RunPlan, fly
from cfepy.rtos import Policy
from cfepy.status import UsageError

FILE_FIELDS = ("path", "size", "sha256", "packed", "mode")
CHECK_NS = 100_000_000  # virtual time between two marks of how far a run has come, when it stops more often


class JournalRecorder(Attachment):
    """Writes a journal; use as a context manager around reading the mission, and the run.

    Args:
        path: the file.
        plan: what is run.
        carried: bytes of the mission's files that the journal carries; 0 for none.
        paced: times real time, for a run that is joined to the computer's network.
        policy: decides which task goes first, in place of the plan's schedule.

    Attributes:
        policy: for the mission: it decides as the given one does, and its decisions are written down; None for fifo.

    Raises:
        UsageError: the file cannot be written.
    """

    def __init__(
        self,
        path: str | Path,
        plan: RunPlan,
        *,
        carried: int = CARRIED,
        paced: float | None = None,
        policy: Policy | None = None,
    ) -> None:
        policy = plan.schedule.policy() if policy is None else policy
        self.policy = None if policy is None else JournalPolicy(policy)
        self._settings = None if policy is None else settings_of(policy)
        self._path = path
        self._plan = plan
        self._paced = paced
        self._carrier = Carrier(carried)
        self._reading = ReadFiles(self._file, self._folder, self._look)
        self._reading.forget(str(path))
        self._files: list[str] = []  # read before the header is written
        self._known: set[str] = set()
        self._looks: set[str] = set()
        self._error: OSError | None = None
        self._finished = self._begun = False
        self._count = 0
        self._checked_ns = 0
        self._digest = ""
        self._mission: Mission | None = None
        check_paths(path)
        try:
            self._writer = FrameWriter(path)
        except OSError as error:
            raise UsageError(f"cannot be written: {error.strerror}", file=path, field="--record") from None

    def __enter__(self) -> JournalRecorder:
        self._reading.__enter__()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        self._reading.__exit__()
        self._writer.close()
        if self._error is not None and kind is None:
            raise UsageError(f"could not be written: {self._error.strerror}", file=self._path, field="--record")

    # -- the run -----------------------------------------------------------------------------------------------------

    def begin(self, mission: Mission) -> None:
        """Write down what is known."""
        self._mission = mission
        self._write(HEADER, self._header(mission).to_dict())
        self._begun = True
        for path in dict.fromkeys((*self._files, *files_of(mission.spec))):
            self._file(path)
        mission.outside.listener = self._from_outside
        mission.trace.also(self._hashed)

    def mark(self) -> None:
        """The run stands still: write down how far it has come, unless that was done a short time ago."""
        mission = self._mission
        if mission is not None and mission.kernel.now - self._checked_ns >= CHECK_NS:
            mission.trace.flush()

    def finish(self) -> None:
        """The digest of the run was taken."""
        mission = self._mission
        assert mission is not None
        self._check(mission.kernel.now)
        mission.outside.listener = None
        self._finished = True

    def end(self, flown: Flown) -> None:
        """Write down what the run came to, after all."""
        mission = self._mission
        if mission is None or not self._finished:
            return
        body = {
            "reason": flown.reason,
            "until_ns": mission.outside.until_ns,
            "visits": mission.outside.visits,
            "now_ns": self._checked_ns,
            "records": self._count,
            "trace": flown.trace,
            "results": digest_of(flown.results),
            "outcome": {} if flown.outcome is None else flown.outcome.to_dict(),
            "beside": beside_problems(flown.results),
        }
        self._write(END, body)

    def _header(self, mission: Mission) -> Header:
        spec = mission.spec
        return Header(
            plan=self._plan,
            paced=self._paced,
            policy=self._settings,
            mission=spec.name,
            folder=str(spec.folder),
            startup=str(spec.script),
            cwd=os.getcwd(),
            environ=environ_of(spec),
            versions=versions(),
            host=host_facts(),
        )

    # -- what is written ---------------------------------------------------------------------------------------------

    def _file(self, path: str) -> None:
        """A file of the mission's."""
        if not self._begun:
            self._files.append(path)
        elif path not in self._known and not self._is_left_out(path):
            self._known.add(path)
            file = self._carrier.take(path)
            self._write(FILE, {name: getattr(file, name) for name in FILE_FIELDS})

    def _is_left_out(self, path: str) -> bool:
        """Whether a file in the folder of a mission is a journal, or what this run has written."""
        try:
            return self._reading.is_product(path) or is_journal(path)
        except OSError:
            return False

    def _folder(self, path: str, names: list[str]) -> None:
        """A node looks into a folder."""
        kinds = {name: os.path.isdir(os.path.join(path, name)) for name in names[:MOST_FILES]}
        self._write(FOLDER, {"path": path, "names": kinds})

    def _look(self, path: str) -> None:
        """A node or an application looks for something."""
        if self._begun and path not in self._looks and len(self._looks) < MOST_LOOKS:
            self._looks.add(path)
            self._write(LOOK, asdict(look_at(path)))

    def _from_outside(self, event: outside.Arrival) -> None:
        """Something comes in; it is written at once, since the run may crash of it."""
        mission = self._mission
        assert mission is not None
        if event.kind == outside.ANSWER:
            self._write(ANSWER, {"values": event.values})
        else:
            door = mission.outside
            body = {"until_ns": door.until_ns, "visits": door.visits, "events": [[event.kind, event.values]]}
            self._write(PAUSE, body)

    def _hashed(self, records: Sequence[bytes]) -> None:
        """A batch of records was hashed."""
        mission = self._mission
        assert mission is not None
        if self._finished:
            return
        self._count += len(records) - records.count(b"")  # the host's empty marks are no records
        self._digest = mission.trace.hashed
        self._check(mission.kernel.now)

    def _check(self, now_ns: int) -> None:
        policy = self.policy
        self._checked_ns = now_ns
        body = {
            "at": (now_ns, self._count, self._digest),
            "decisions": [] if policy is None else policy.taken(),
            "decided": 0 if policy is None else policy.count,
        }
        self._write(CHECK, body)

    def _write(self, kind: str, body: dict[str, Any]) -> None:
        """Write a frame; that the disk is full is told at the end, for it must not change the run."""
        if self._error is None:
            try:
                self._writer.write(kind, body)
            except OSError as error:
                self._error = error


def record(plan: RunPlan, path: str | Path, attachments: Sequence[Attachment] = (), **options: Any) -> Flown:
    """Fly a plan to its end, and write its journal.

    Args:
        plan: what to run.
        path: of the journal.
        attachments: what watches the run.
        options: of `cfepy.pilot.pilot.fly`, such as console and trace.

    Raises:
        UsageError: something in the plan is wrong, or the journal cannot be written.
        BootError: the mission cannot boot.
    """
    with JournalRecorder(path, plan) as recorder:
        flown = fly(plan, attachments=[*attachments, recorder], policy=recorder.policy, **options)
        recorder.end(flown)
    return flown
