"""`--trace FILE`: the trace of a run as text, one record a line: virtual time, task, what happened.

The time is that of the last move of the clock; on a board where computing costs time, a task may be a little further.
Only a trace file makes this text: the trace itself stays bytes.
"""

from __future__ import annotations

import struct
from types import TracebackType

from cfepy import trace as tr
from cfepy.cli.failures import writing
from cfepy.mission import Mission
from cfepy.mission.msg_names import names_of
from cfepy.mission.watch import HOST
from cfepy.rtos.units import NS_PER_S
from cfepy.status import UsageError

_FIRST_MARK = 0x20  # smaller first bytes begin packets
_number = struct.Struct("<xH").unpack


class TraceFile:
    """Writes trace records as text; use as a context manager around the mission.

    Args:
        path: the file.

    Raises:
        UsageError: it cannot be written.
    """

    def __init__(self, path: str) -> None:
        with writing(path, "--trace"):
            self._file = open(path, "w", encoding="utf-8")  # noqa: SIM115  # closed in __exit__
        self._path = path
        self._mission: Mission | None = None
        self._names: dict[int, str] = {}
        self._tasks: dict[int, str] = {0: HOST}
        self._pipes: dict[int, str] = {}
        self._now_ns = 0
        self._task = HOST
        self._error: OSError | None = None

    def __enter__(self) -> TraceFile:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        if self._mission is not None:
            self._mission.trace.flush()
        self._close()

    def _close(self) -> None:
        try:
            self._file.close()
        except OSError as error:
            self._error = self._error or error
        if self._error is not None:
            raise UsageError(f"could not be written: {self._error.strerror}", file=self._path, field="--trace")

    def watch(self, mission: Mission) -> None:
        """Learn names of tasks, pipes and messages from this mission."""
        self._mission = mission
        self._names = names_of(mission.spec)

    def write(self, records: list[bytes]) -> None:
        """The sink of a `Trace`; it is called inside the simulation, where no error of the disk may be raised."""
        if self._error is not None:
            return
        try:
            self._write(records)
        except OSError as error:
            self._error = error

    def _write(self, records: list[bytes]) -> None:
        self._learn()
        for record in records:
            if not record:
                continue  # what the host does leaves no mark
            if record[0] < _FIRST_MARK:
                self._line(self._send(record))
            else:
                self._mark(record)

    def _learn(self) -> None:
        """Tasks and pipes have names only as long as they live; a number stands for those that came and went."""
        mission = self._mission
        if mission is None:
            return
        for task in mission.kernel.tasks:
            self._tasks.setdefault(task.ident & 0xFFFF, task.name)
        for pipe in mission.cfe.sb.pipes:
            self._pipes[pipe.pipe_id & 0xFFFF] = pipe.name
        if mission.ros is not None:
            self._names.update((row.msg_id, row.name) for row in mission.ros.topics())

    def _mark(self, record: bytes) -> None:
        kind = record[:1]
        if kind == tr.TIME:
            (self._now_ns,) = tr.unpack_time(record)
        elif kind == tr.NOTE:
            self._line(f"console {record[1:].decode('utf-8', 'replace')}")
        else:
            (number,) = _number(record)
            self._line(self._event(kind, number))

    def _event(self, kind: bytes, number: int) -> str:
        if kind in (tr.DISPATCH, tr.EXIT):
            before, self._task = self._task, self._task_name(number)
            return "dispatch" if kind == tr.DISPATCH else f"dispatch, {before} ended"
        if kind == tr.WAKE:
            return f"wake {self._task_name(number)}"
        if kind == tr.RECEIVE:
            return f"receive from {self._pipe_name(number)}"
        if kind == tr.DROP:
            return f"drop at {self._pipe_name(number)}"
        verb = {tr.PUT: "put into queue", tr.GET: "get from queue"}.get(kind, f"record {kind!r}")
        return f"{verb} {number}"

    def _send(self, packet: bytes) -> str:
        msg_id = packet[0] << 8 | packet[1]
        sequence = (packet[2] << 8 | packet[3]) & 0x3FFF
        name = self._names.get(msg_id, "")
        return f"send 0x{msg_id:04X} {name + ' ' if name else ''}sequence {sequence} length {len(packet)}"

    def _line(self, what: str) -> None:
        self._file.write(f"{self._now_ns // NS_PER_S}.{self._now_ns % NS_PER_S:09d} {self._task} {what}\n")

    def _task_name(self, ident: int) -> str:
        return self._tasks.get(ident, f"task-{ident}")

    def _pipe_name(self, number: int) -> str:
        return self._pipes.get(number, f"pipe-{number}")
