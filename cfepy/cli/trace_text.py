"""Records of a trace as text, a line each: virtual time, task, event.

The time is the record's own if the trace notes it (`TimedRecords`). Otherwise it is the last move of the clock, and a
task that uses the CPU may be further.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from itertools import repeat
from pathlib import PurePath

from cfepy import trace as tr
from cfepy.ground import names_of
from cfepy.mission import HOST, Mission
from cfepy.units import NS_PER_S

_FIRST_MARK = 0x20  # smaller first bytes begin packets
_number = struct.Struct("<xH").unpack


class TraceText:
    """Turns the records of one run, given in order, into lines.

    Attributes:
        now_ns: virtual time of the last record, or of the last move of the clock.
        task: name of the task that runs.
    """

    def __init__(self) -> None:
        self.now_ns = 0
        self.task = HOST
        self._mission: Mission | None = None
        self._names: dict[int, str] = {}
        self._tasks: dict[int, str] = {0: HOST}
        self._pipes: dict[int, str] = {}

    def watch(self, mission: Mission) -> None:
        """Learn names of tasks, pipes and messages from this mission, before any part of it has run."""
        self._mission = mission
        self._names = names_of(mission.spec)
        kernel = mission.kernel
        if kernel.record is not None:
            kernel.record = self._naming(mission, kernel.record)
            mission.cfe.sb.listen(partial(self._heard, mission))  # the buses after a reset use the kernel's `record`

    def _naming(self, mission: Mission, record: Callable[[bytes], None]) -> Callable[[bytes], None]:
        """Return the kernel's `record`, which also learns the names of tasks and pipes that are gone when records
        become text.
        """
        kernel, tasks = mission.kernel, self._tasks

        def note(mark: bytes) -> None:
            record(mark)
            if mark[:1] in (tr.DISPATCH, tr.EXIT):
                (number,) = _number(mark)
                if number not in tasks:
                    tasks[number] = kernel.current.name
            else:
                self._heard(mission, mark)

        return note

    def _heard(self, mission: Mission, record: bytes) -> None:
        """Learn the names of pipes when a record is about an unknown one."""
        if record[:1] in (tr.RECEIVE, tr.DROP) and _number(record)[0] not in self._pipes:
            self._learn_pipes(mission)

    def lines(self, records: Sequence[bytes]) -> Iterator[str]:
        """Yield a line without its line end for each record, except those that move the clock."""
        self._learn()
        times: Iterable[int | None] = records.times if isinstance(records, tr.TimedRecords) else repeat(None)
        for record, time_ns in zip(records, times, strict=False):
            if not record:
                continue  # host actions leave no mark
            if time_ns is not None:
                self.now_ns = time_ns
            what = self._packet(record) if record[0] < _FIRST_MARK else self._mark(record)
            if what is not None:
                yield f"{self.now_ns // NS_PER_S}.{self.now_ns % NS_PER_S:09d} {self.task} {what}"

    def _learn(self) -> None:
        """Learn the names of tasks and pipes, which last only while they live; deleted ones show as numbers."""
        mission = self._mission
        if mission is None:
            return
        for task in mission.kernel.tasks:
            self._tasks.setdefault(task.ident & 0xFFFF, task.name)
        self._learn_pipes(mission)
        if mission.ros is not None:
            self._names.update((row.msg_id, row.name) for row in mission.ros.topics())

    def _learn_pipes(self, mission: Mission) -> None:
        for pipe in mission.cfe.sb.pipes:
            self._pipes[pipe.pipe_id & 0xFFFF] = pipe.name

    def _mark(self, record: bytes) -> str | None:
        kind = record[:1]
        if kind == tr.TIME:
            (self.now_ns,) = tr.unpack_time(record)
            return None
        if kind == tr.NOTE:
            return f"console {record[1:].decode('utf-8', 'replace')}"
        if kind == tr.UNSENT:
            topic, _, message = record[1:].partition(b"\0")
            what = f"publish {topic.decode()} length {len(message)}" if topic else self._packet(message)
            return f"{what}, not over the bus"
        if kind == tr.CALLED:
            place, _, numbers = record[1:].decode("utf-8", "replace").partition("\0")
            return f"calls from {PurePath(place).name}" + (f" with {numbers}" if numbers else "")
        (number,) = _number(record)
        return self._event(kind, number)

    def _event(self, kind: bytes, number: int) -> str:
        if kind in (tr.DISPATCH, tr.EXIT):
            before, self.task = self.task, self._task_name(number)
            return "dispatch" if kind == tr.DISPATCH else f"dispatch, {before} ended"
        if kind == tr.WAKE:
            return f"wake {self._task_name(number)}"
        if kind == tr.RECEIVE:
            return f"receive from {self._pipe_name(number)}"
        if kind == tr.DROP:
            return f"drop at {self._pipe_name(number)}"
        verb = {tr.PUT: "put into queue", tr.GET: "get from queue"}.get(kind, f"record {kind!r}")
        return f"{verb} {number}"

    def subject(self, record: bytes) -> str:
        """Return the topic or packet of a message, also of one that the bus does not carry; its MsgId if it has no
        name.
        """
        if record[:1] == tr.UNSENT:
            topic, _, record = record[1:].partition(b"\0")
            if topic:
                return topic.decode()
        msg_id = record[0] << 8 | record[1]
        return self._names.get(msg_id) or f"0x{msg_id:04X}"

    def _packet(self, packet: bytes) -> str:
        msg_id = packet[0] << 8 | packet[1]
        sequence = (packet[2] << 8 | packet[3]) & 0x3FFF
        name = self._names.get(msg_id, "")
        return f"send 0x{msg_id:04X} {name + ' ' if name else ''}sequence {sequence} length {len(packet)}"

    def _task_name(self, ident: int) -> str:
        return self._tasks.get(ident, f"task-{ident}")

    def _pipe_name(self, number: int) -> str:
        return self._pipes.get(number, f"pipe-{number}")
