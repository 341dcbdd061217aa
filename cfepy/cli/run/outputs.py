"""Output of a run on this computer: its numbers, files, trace, bag and journal, as the command line asks.

cfepy checks before the run that each file can be written. A run itself never writes to the host, so that it cannot
change the next. Files on its virtual disks are saved after it.
"""

from __future__ import annotations

import argparse
import contextlib
import os
from collections.abc import Iterator
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

from cfepy.attachment import Attachment, Recorder
from cfepy.cli.json_output import check_ci_outputs, check_json, wants_ci_outputs, write_json
from cfepy.cli.run.report import verdict_of
from cfepy.cli.user_notes import writing
from cfepy.mission import Mission
from cfepy.pilot import Flown, RunPlan
from cfepy.status import UsageError
from cfepy.trace import TimedRecords, Trace

if TYPE_CHECKING:
    from cfepy.journal import JournalRecorder

SAVE_FILES = "--save-files"


class TraceFile(Recorder):
    """`--trace FILE`: writes the records of the trace as text. This text is made for a trace file only.

    Args:
        path: the file.

    Attributes:
        trace: the trace for the mission.

    Raises:
        UsageError: it cannot be written.
    """

    def __init__(self, path: str) -> None:
        from cfepy.cli.trace_text import TraceText

        with writing(path, "--trace"):
            self._file = open(path, "w", encoding="utf-8")  # noqa: SIM115  # closed in __exit__
        self.trace = Trace(self.write, TimedRecords())
        self._path = path
        self._text = TraceText()
        self._error: OSError | None = None

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        self.trace.flush()
        self._close()

    def _close(self) -> None:
        try:
            self._file.close()
        except OSError as error:
            self._error = self._error or error
        if self._error is not None:
            raise UsageError(f"could not be written: {self._error.strerror}", file=self._path, field="--trace")

    def begin(self, mission: Mission) -> None:
        """Learn names of tasks, pipes and messages from this mission."""
        self._text.watch(mission)

    def write(self, records: list[bytes]) -> None:
        """Write records as the sink of a `Trace`. It runs inside the simulation, so it keeps errors of the disk."""
        if self._error is not None:
            return
        try:
            self._file.writelines(f"{line}\n" for line in self._text.lines(records))
        except OSError as error:
            self._error = error


class SavedRunFiles(Attachment):
    """Copies the files that apps and nodes wrote on the host, at the end of the mission.

    Args:
        folder: the target folder.
        below: copy only files in this folder.

    Attributes:
        count: number of copied files.
        error: the first error, or None.
    """

    def __init__(self, folder: Path, below: str = "/") -> None:
        self._below = os.path.join(below, "")
        self.count = 0
        self.error: UsageError | None = None
        self._folder = folder
        self._mission: Mission | None = None

    def begin(self, mission: Mission) -> None:
        self._mission = mission

    def close(self) -> None:
        """Copy the run's own files before they are removed."""
        files = None if self._mission is None else self._mission.run_files
        for name, place in files.written() if files is not None else ():
            if not name.startswith(self._below):
                continue
            try:
                _write(self._folder, name, Path(place).read_bytes())
            except UsageError as error:
                self.error = self.error or error
            else:
                self.count += 1


class Outputs:
    """The output of one run; use as a context manager around the run.

    Args:
        arguments: a command line with `add_outputs`.
        plan: the run.

    Attributes:
        attachments: attachments that record the run.
        trace: the trace for the records; None if only their digest is wanted.

    Raises:
        UsageError: a file cannot be written, or options conflict.
    """

    def __init__(self, arguments: argparse.Namespace, plan: RunPlan) -> None:
        self.attachments: list[Attachment] = []
        self.trace: Trace | None = None
        self._open = contextlib.ExitStack()
        self._arguments = arguments
        self._plan = plan
        check_json(arguments)
        check_ci_outputs(arguments)
        self._folder = None if arguments.save_files is None else _saving_to(arguments.save_files)
        self._run_files = None if self._folder is None else SavedRunFiles(self._folder)
        self._trace_file = TraceFile(arguments.trace) if arguments.trace else None
        self._bag = arguments.bag
        self._bag_topics = arguments.bag_topics
        usual = RunPlan(plan.words)  # the kind of tasks and the stall limit do not affect the run
        self._command = plan.command_line(tasks=usual.tasks, stall=usual.stall)
        if self._bag is None and self._bag_topics:
            raise UsageError("requires --bag FILE", field="--bag-topics")

    def __enter__(self) -> Outputs:
        recorder = self._trace_file
        if recorder is not None:
            self.trace = recorder.trace
            self._open.enter_context(recorder)
        if self._bag is not None:
            from cfepy.ground import recorder_of

            recorder_of_bag = recorder_of(self._bag, self._bag_topics, self._command)
            self.attachments.append(self._open.enter_context(recorder_of_bag))
        self.attachments += [each for each in (recorder, self._run_files) if each is not None]
        return self

    def __exit__(self, *error: Any) -> None:
        self._open.__exit__(*error)

    def write_findings(self, flown: Flown) -> UsageError | None:
        """Write the numbers, and the outputs for continuous integration.

        Returns:
            The error instead of raising it, so that the report of a long run is not lost.
        """
        numbers = flown.results.to_dict()
        numbers["verdict"] = verdict_of(flown)
        if flown.outcome is not None:
            numbers["script"] = flown.outcome.to_dict()
        try:
            write_json(self._arguments, numbers)
            if wants_ci_outputs(self._arguments):
                from cfepy.cli.run.run_cases import write_run

                write_run(self._arguments, self._plan, flown)
        except UsageError as error:
            return error
        return None

    def save_files(self, flown: Flown, quiet: bool = False) -> None:
        """Write the files that the mission wrote, and print their place.

        Args:
            flown: the run.
            quiet: do not print it.

        Raises:
            UsageError: one cannot be written.
        """
        saved = self._run_files
        if self._folder is None or saved is None:
            return
        if saved.error is not None:
            raise saved.error
        written = flown.mission.files.written()
        for name, data in written.items():
            _write(self._folder, name, data)
        count = len(written) + saved.count
        if not quiet:
            print(f"saved to {self._folder}: {count} {'file' if count == 1 else 'files'}")


def _saving_to(folder: str) -> Path:
    """Return the folder to save to; make it if it does not exist."""
    path = Path(folder)
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UsageError(f"cannot be made: {error.strerror}", file=path, field=SAVE_FILES) from None
    return path


def _write(folder: Path, name: str, data: bytes) -> None:
    """Write /ram/cfe_evs.log to DIR/ram/cfe_evs.log; overwrite a file of the same name."""
    from cfepy.reading.contained_files import write_contained

    inside = f"/{name.lstrip('/')}"
    with writing(f"{folder}{inside}", SAVE_FILES):
        write_contained(folder, inside, data)


@contextlib.contextmanager
def recording(arguments: argparse.Namespace, plan: RunPlan) -> Iterator[JournalRecorder | None]:
    """Yield the recorder for `--record FILE`, or None without it, around reading a mission and running it.

    Args:
        arguments: a command line with `add_recording`.
        plan: the run.

    Raises:
        UsageError: the journal cannot be written.
    """
    if arguments.record is None:
        yield None
        return
    from cfepy.journal import CARRIED, JournalRecorder

    carried = 0 if arguments.record_no_files else CARRIED
    with JournalRecorder(arguments.record, plan, carried=carried, paced=arguments.realtime) as recorder:
        yield recorder
