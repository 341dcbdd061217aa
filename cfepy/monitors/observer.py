"""Observation of a run from inside: which task has the processor, which packets are on the bus, and how long they wait.

An `Observer` is an attachment that is called at each of these events. It does not change the run, so the trace is the
same as without it.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Any, NamedTuple

from cfepy import trace as tr
from cfepy.attachment import Attachment
from cfepy.mission import HOST, Mission, Processor
from cfepy.msg import MAX_SEQUENCE_COUNT, PRIMARY_HEADER_SIZE
from cfepy.ports import PEND_FOREVER
from cfepy.rtos import Kernel, Task, wrapping
from cfepy.sb import Pipe, SoftwareBus
from cfepy.sb import events as ev

MESSAGE_LIMIT, PIPE_FULL, OLDEST = "message limit", "pipe full", "oldest made room"


class Sent(NamedTuple):
    """A packet that was passed to the bus.

    Attributes:
        number: number of the transmission, from 1.
        at_ns: virtual time in ns.
        msg_id: its MsgId.
        sequence: its sequence count, as subscribers see it.
        size: its length in bytes.
        task: the sender.
    """

    number: int
    at_ns: int
    msg_id: int
    sequence: int
    size: int
    task: Task


class Observer(Attachment):
    """Is called at events of a run; subclasses override the methods they need. All times are virtual, in ns."""

    def __init__(self) -> None:
        self.mission: Mission
        self._kernel: Kernel
        self._running: Task | None = None
        self._number = 0
        self._sending: dict[Task, int] = {}
        self._under_way: dict[tuple[int, int], deque[Sent]] = {}  # by pipe and MsgId, oldest first
        self._by_mark: dict[bytes, Task] = {}
        self._is_console = False

    # -- overridden by subclasses --------------------------------------------------------------------------------------

    def on_run(self, task: Task, at_ns: int) -> None:
        """A task got the processor."""

    def on_leave(self, task: Task, at_ns: int, waits: bool) -> None:
        """A task gave up the processor: it waits, or another task goes first."""

    def on_ready(self, task: Task, at_ns: int) -> None:
        """A task's wait has ended; not called if it timed out."""

    def on_send(self, sent: Sent, packet: bytes | bytearray) -> None:
        """A packet is about to be sent to its subscribers."""

    def on_receive(self, sent: Sent | None, pipe: Pipe, task: Task, at_ns: int) -> None:
        """A task has taken a packet out of a pipe; `sent` is None if it was sent before the observation."""

    def on_drop(self, msg_id: int, pipe: Pipe, why: str, at_ns: int) -> None:
        """A packet did not get into a pipe, or was removed from it for a newer one."""

    def on_depth(self, pipe: Pipe, at_ns: int) -> None:
        """Packets were put into a pipe or taken out; `len(pipe.items)` are in it now."""

    def on_console(self, line: str, at_ns: int) -> None:
        """A line was written to the console."""

    def on_note(self, text: str, at_ns: int) -> None:
        """A text was added to the trace that is not a console line: a tool's observation or action."""

    # -- the attachment ----------------------------------------------------------------------------------------------

    def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        """Return a Software Bus that reports its packets."""
        return _observed(self, base)

    def kernel(self, base: type[Kernel]) -> type[Kernel]:
        """Return a kernel that reports its waits."""
        return wrapping(base, {"block": self._blocking})

    def begin(self, mission: Mission) -> None:
        """Observe the records of the console, the trace and the kernel."""
        self.mission = mission
        self._kernel = kernel = mission.kernel
        trace, console = mission.trace, mission.console
        trace.append = self._noting(trace.append)
        console.record = self._writing(console.record or trace.note)
        if kernel.record is not None:
            kernel.record = self._recording(kernel.record)

    def power_up(self, processor: Processor) -> None:
        """After a reset, drop earlier packets, which can no longer arrive."""
        self._under_way.clear()
        self._running = None

    def _noting(self, append: Callable[[bytes], object]) -> Callable[[bytes], None]:
        """Return the trace's `append`, called for each text."""

        def note(record: bytes) -> None:
            append(record)
            if record[:1] == tr.NOTE and not self._is_console:
                self.on_note(record[1:].decode("utf-8", "replace"), self._kernel.now)

        return note

    def _writing(self, record: Callable[[str], object]) -> Callable[[str], None]:
        """Return the console's `record`, which adds its lines to the trace."""

        def write(line: str) -> None:
            self._is_console = True
            try:
                record(line)
            finally:
                self._is_console = False
            self.on_console(line, self._kernel.now)

        return write

    def _recording(self, record: Callable[[bytes], object]) -> Callable[[bytes], None]:
        """Return the kernel's `record`, called at every change of task and every end of a wait."""

        def look(mark: bytes) -> None:
            record(mark)
            kind = mark[:1]
            if kind in (tr.DISPATCH, tr.EXIT):
                self._dispatched()
            elif kind == tr.WAKE and len(mark) == 3:
                self.on_ready(self._task_of(mark), self._kernel.now)

        return look

    def _blocking(self, block: Callable[[Kernel], Any]) -> Callable[[Kernel], Any]:
        """Return the kernel's `block`, called for every wait; if a task follows itself there is no other record."""

        def wait(kernel: Kernel) -> Any:
            task: Task = kernel.current
            if self._running is task:
                self._running = None
                self.on_leave(task, kernel.now, True)
            value = block(kernel)
            if self._running is not task and kernel.current is task:
                self._dispatched()
            return value

        return wait

    def _dispatched(self) -> None:
        task, before = self._kernel.current, self._running
        if task is before:
            return
        now = self._kernel.now
        if before is not None:
            self.on_leave(before, before.since if before.done else now, False)  # the clock may have gone on since
        self._running = None if task is self._kernel.host else task
        if self._running is not None:
            self.on_run(task, now)

    def _task_of(self, mark: bytes) -> Task:
        task = self._by_mark.get(mark)
        if task is None or task.done:
            self._by_mark = {each.wake_mark: each for each in self._kernel.tasks}
            task = self._by_mark.get(mark, self._kernel.host)
        return task

    # -- the bus -----------------------------------------------------------------------------------------------------

    def _sends(self, bus: SoftwareBus, packet: bytes | bytearray, is_origination: bool) -> None:
        msg_id = packet[0] << 8 | packet[1]
        route = bus.routes.get(msg_id)
        sequence = packet[2] << 8 | packet[3]
        if is_origination and route is not None:
            sequence = route.sequence + 1
        self._number = number = self._number + 1
        task = bus.kernel.current
        sent = Sent(number, bus.kernel.now, msg_id, sequence & MAX_SEQUENCE_COUNT, len(packet), task)
        self._sending[task] = number
        for destination in () if route is None else route.active:
            pipe = destination.pipe
            under_way = self._under_way.get((pipe.pipe_id, msg_id))
            if under_way is None or under_way.maxlen != pipe.depth + 1:
                under_way = deque(under_way or (), pipe.depth + 1)
                self._under_way[pipe.pipe_id, msg_id] = under_way
            under_way.append(sent)
        self.on_send(sent, packet)

    def _has_sent(self, bus: SoftwareBus, msg_id: int) -> None:
        self._sending.pop(bus.kernel.current, None)
        route = bus.routes.get(msg_id)
        for destination in () if route is None else route.active:
            self.on_depth(destination.pipe, bus.kernel.now)

    def _receives(self, bus: SoftwareBus, pipe: Pipe, packet: bytes) -> None:
        sequence = (packet[2] << 8 | packet[3]) & MAX_SEQUENCE_COUNT
        under_way = self._under_way.get((pipe.pipe_id, packet[0] << 8 | packet[1]), ())
        found = None
        while under_way and found is None:
            oldest = under_way.popleft()
            found = oldest if oldest.sequence == sequence else None  # others were removed, or never got in
        self.on_receive(found, pipe, bus.kernel.current, bus.kernel.now)
        self.on_depth(pipe, bus.kernel.now)

    def _refused(self, bus: SoftwareBus, msg_id: int, event_id: int, pipe: Pipe) -> None:
        number = self._sending.get(bus.kernel.current)
        under_way = self._under_way.get((pipe.pipe_id, msg_id))
        for sent in [each for each in under_way or () if each.number == number]:
            assert under_way is not None
            under_way.remove(sent)
        why = MESSAGE_LIMIT if event_id == ev.MSGID_LIM_ERR_EID else PIPE_FULL
        self.on_drop(msg_id, pipe, why, bus.kernel.now)


def _observed(observer: Observer, base: type[SoftwareBus]) -> type[SoftwareBus]:
    class ObservedBus(base):  # type: ignore[misc, valid-type]  # mypy does not follow a class that is an argument
        """A Software Bus that reports its packets to an observer."""

        def transmit_msg(self, packet: bytes | bytearray, is_origination: bool = True) -> None:
            if not PRIMARY_HEADER_SIZE < len(packet) <= self.config.sb_max_msg_size:
                super().transmit_msg(packet, is_origination)
                return
            observer._sends(self, packet, is_origination)
            super().transmit_msg(packet, is_origination)
            observer._has_sent(self, packet[0] << 8 | packet[1])

        def receive_buffer(self, pipe_id: int, timeout_ms: int = PEND_FOREVER) -> bytes | None:
            packet: bytes | None = super().receive_buffer(pipe_id, timeout_ms)
            pipe = None if packet is None else self.find_pipe(pipe_id)
            if packet is not None and pipe is not None:
                observer._receives(self, pipe, packet)
            return packet

        def hand_on(self, packet: bytes, destination: Any) -> None:
            super().hand_on(packet, destination)
            observer._receives(self, destination.pipe, packet)

        def _report_failures(self, msg_id: int, failures: list[tuple[int, Any]]) -> None:
            for event_id, destination in failures:
                observer._refused(self, msg_id, event_id, destination.pipe)
            super()._report_failures(msg_id, failures)

        def _drop_oldest(self, pipe: Pipe) -> int:
            oldest = pipe.items[0][0]
            left: int = super()._drop_oldest(pipe)
            observer.on_drop(oldest[0] << 8 | oldest[1], pipe, OLDEST, self.kernel.now)
            return left

    return ObservedBus


def app_of(task: Task) -> str:
    """Return the name of the application of a task; "host" if it has none."""
    return HOST if task.owner is None else str(task.owner.name)
