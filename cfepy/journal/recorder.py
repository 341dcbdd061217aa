"""`JournalRecorder`: writes the journal during a run.

Messages are not written, so they have no cost. Written are files, input from outside, and the progress, whenever some
thousands of records have been hashed.
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
from cfepy.reading.input_files import unwritable
from cfepy.rtos import Policy
from cfepy.status import UsageError

FILE_FIELDS = ("path", "size", "sha256", "packed", "mode")
CHECK_NS = 100_000_000  # virtual time between two progress marks, if a run stops more often


class JournalRecorder(Attachment):
    """Writes a journal; use as a context manager around reading the mission and the run.

    Args:
        path: the file.
        plan: plan of the run.
        carried: maximum number of bytes of the mission's files in the journal; 0 for none.
        paced: factor of real time, for a run that is connected to the computer's network.
        policy: decides which task goes first, instead of the plan's schedule.

    Attributes:
        policy: policy for the mission, which records the decisions of the given one; None for fifo.

    Raises:
        UsageError: if the file cannot be written.
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
            raise unwritable(path, error, "--record") from None

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
        """Write the header."""
        self._mission = mission
        self._write(HEADER, self._header(mission).to_dict())
        self._begun = True
        for path in dict.fromkeys((*self._files, *files_of(mission.spec))):
            self._file(path)
        mission.outside.listener = self._from_outside
        mission.trace.also(self._hashed)

    def mark(self) -> None:
        """Write the progress when the run stops, unless that was done a short time ago."""
        mission = self._mission
        if mission is not None and mission.kernel.now - self._checked_ns >= CHECK_NS:
            mission.trace.flush()

    def finish(self) -> None:
        """The digest of the run was computed."""
        mission = self._mission
        assert mission is not None
        self._check(mission.kernel.now)
        mission.outside.listener = None
        self._finished = True

    def end(self, flown: Flown) -> None:
        """Write the end of the run."""
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

    # -- writing -------------------------------------------------------------------------------------------------------

    def _file(self, path: str) -> None:
        """A file of the mission was read."""
        if not self._begun:
            self._files.append(path)
        elif path not in self._known and not self._is_left_out(path):
            self._known.add(path)
            file = self._carrier.take(path)
            self._write(FILE, {name: getattr(file, name) for name in FILE_FIELDS})

    def _is_left_out(self, path: str) -> bool:
        """Return whether a file in the folder of a mission is a journal, or written by this run."""
        try:
            return self._reading.is_product(path) or is_journal(path)
        except OSError:
            return False

    def _folder(self, path: str, names: list[str]) -> None:
        """A node lists a folder."""
        kinds = {name: os.path.isdir(os.path.join(path, name)) for name in names[:MOST_FILES]}
        self._write(FOLDER, {"path": path, "names": kinds})

    def _look(self, path: str) -> None:
        """A node or an application checks a path."""
        if self._begun and path not in self._looks and len(self._looks) < MOST_LOOKS:
            self._looks.add(path)
            self._write(LOOK, asdict(look_at(path)))

    def _from_outside(self, event: outside.Arrival) -> None:
        """Record input; it is written at once, because the run may crash because of it."""
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
        self._count += len(records) - records.count(b"")  # the host's empty marks are not records
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
        """Write a frame; a full disk is reported at the end, because it must not change the run."""
        if self._error is None:
            try:
                self._writer.write(kind, body)
            except OSError as error:
                self._error = error


def record(plan: RunPlan, path: str | Path, attachments: Sequence[Attachment] = (), **options: Any) -> Flown:
    """Fly a plan to its end, and write its journal.

    Args:
        plan: plan of the run.
        path: path of the journal.
        attachments: observe the run.
        options: as for `cfepy.pilot.pilot.fly`, such as console and trace.

    Raises:
        UsageError: if there is a mistake in the plan, or the journal cannot be written.
        BootError: if the mission cannot boot.
    """
    with JournalRecorder(path, plan) as recorder:
        flown = fly(plan, attachments=[*attachments, recorder], policy=recorder.policy, **options)
        recorder.end(flown)
    return flown
