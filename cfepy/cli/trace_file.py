"""`--trace FILE`: the trace of a run as text in a file. Only a trace file makes this text: the trace stays bytes."""

from __future__ import annotations

from types import TracebackType

from cfepy.attachment import Recorder
from cfepy.cli.failures import writing
from cfepy.cli.trace_text import TraceText
from cfepy.mission import Mission
from cfepy.status import UsageError
from cfepy.trace import Trace


class TraceFile(Recorder):
    """Writes trace records as text; use as a context manager around the mission.

    Args:
        path: the file.

    Attributes:
        trace: for the mission to record in.

    Raises:
        UsageError: it cannot be written.
    """

    def __init__(self, path: str) -> None:
        with writing(path, "--trace"):
            self._file = open(path, "w", encoding="utf-8")  # noqa: SIM115  # closed in __exit__
        self.trace = Trace(self.write)
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
        """The sink of a `Trace`; it is called inside the simulation, where no error of the disk may be raised."""
        if self._error is not None:
            return
        try:
            self._file.writelines(f"{line}\n" for line in self._text.lines(records))
        except OSError as error:
            self._error = error
