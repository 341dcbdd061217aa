"""Observes the tasks of a mission: their places at preemption points, and their operations on shared objects.

It changes nothing, so the run is the one of its schedule. Rows are for a timeline (`cfepy.extra.exploration.timeline`),
deeds are for a comparison with another run (`cfepy.extra.exploration.cause`).
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import PurePath
from types import FrameType
from typing import Any

from cfepy.attachment import Attachment
from cfepy.extra.exploration import operations as do
from cfepy.extra.exploration.operations import Deed
from cfepy.extra.exploration.shared_objects import Things, Use, use_of
from cfepy.ground import dictionary_of, line_of, plain
from cfepy.interpreter.own_code import is_shown
from cfepy.mission import CORE_APPS, Mission, MissionSpec
from cfepy.monitors import Heard, MessageWatch
from cfepy.nodes import WHOLE, WRITES_FILE, FilePoints, Touch
from cfepy.pilot.determinism_look import place_text
from cfepy.rtos import TIMEOUT, AskingPolicy, Decision, Kernel, Policy, Task, wrapping
from cfepy.sb import PEND_FOREVER, Pipe, Route, SoftwareBus
from cfepy.schedules import ExploringKernel
from cfepy.status import CfeError
from cfepy.writing.escapes import visible_line

AT, WAITS, SENDS, DOES, PREEMPTED, ORDERED, ANSWERS = "at", "waits", "sends", "does", "preempted", "ordered", "answers"
TOUCHES = "touches"
_TAKING = ("acquire", "acquire_lock", "__enter__")
_GIVING = ("release", "release_lock", "__exit__")
_OF_CONDITIONS = {"set": do.SETS, "clear": do.CLEARS, "notify": do.NOTIFIES, "notify_all": do.NOTIFIES}
START, JOIN = "start", "join"  # of a thread
_OF_OSAL = {
    "mut_sem_take": (do.HAS, "mutex"),
    "mut_sem_give": (do.RELEASES, "mutex"),
    "bin_sem_take": (do.TAKES, "semaphore"),
    "bin_sem_timed_wait": (do.TAKES, "semaphore"),
    "bin_sem_give": (do.GIVES, "semaphore"),
    "count_sem_take": (do.TAKES, "semaphore"),
    "count_sem_timed_wait": (do.TAKES, "semaphore"),
    "count_sem_give": (do.GIVES, "semaphore"),
}
EVENT = "CFE_EVS_LONG_EVENT_MSG"
_OF_COUNTERS = {"get_gen_count": do.READS, "set_gen_count": do.WRITES}

Tell = Callable[[str, int | None, Pipe | None], object]
"""Gets the operation (a verb of `operations`), and its MsgId and pipe, if any."""


@dataclass(frozen=True, slots=True)
class Row:
    """An event of a task.

    Attributes:
        at_ns: virtual time.
        task: its name.
        kind: AT a line of source, WAITS for an object, SENDS a message, DOES an operation on a lock or similar, TOUCHES
            a variable, is PREEMPTED by `text`, or `text` is ORDERED before it, or it ANSWERS a question as the schedule
            decides.
        text: the line, object, message or operation; for TOUCHES first the line of source, then the operation in a
            second line.
        is_of_cause: whether the cause of the failure names this operation, so the row is always shown.
    """

    at_ns: int
    task: str
    kind: str
    text: str
    is_of_cause: bool = False


class TaskLook(Attachment):
    """Records the operations of the tasks of a mission's applications, up to a failure.

    Args:
        spec: the mission.
        first: rows are kept from this decision on.
        is_over: returns True once the failure has been seen; then recording stops.

    Attributes:
        rows: in the order in which they happened.
        deeds: from the beginning of the run on.
        wanting: by task, the deed that requests a lock that it has not got yet.
        names: names of the locks that reports identify by numbers, by that text: "lock 6 of MAPPER".
    """

    def __init__(self, spec: MissionSpec, first: int = 0, is_over: Callable[[], bool] = lambda: False) -> None:
        self.rows: list[Row] = []
        self.deeds: list[Deed] = []
        self._rows_before: list[int] = []  # number of rows before each deed
        self._row_of: dict[int, int] = {}  # by the identity of a deed: the row that shows it
        self._sources: dict[str, str] = {}  # by place: the place with its line of source
        self.wanting: dict[str, Deed] = {}
        self.names: dict[str, str] = {}
        self.is_on = first <= 0
        self._first = first
        self._is_over = is_over
        self._closed = False
        self._things = Things()
        self._calls: dict[Task, FrameType] = {}  # the call of the standard library that each task is in
        packets = dictionary_of(spec)
        names = (*packets.commands, *(name for name in packets.telemetry if not name.startswith("/")))
        self._packets = {
            packet.msg_id: name for name, packet in (*packets.telemetry.items(), *packets.commands.items())
        }
        self._messages = MessageWatch(spec, self._take_message, ("*",), names)
        self._mission: Mission | None = None
        self._ros: Any = None  # of the processor whose parameters are observed

    def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        return _told(self._messages.bus(base), self._take_bus)

    def kernel(self, base: type[Kernel]) -> type[Kernel]:
        """Wrap `block`, which every wait uses."""
        return wrapping(base, {"block": self._blocking})

    def begin(self, mission: Mission) -> None:
        self._mission = mission
        self._messages.begin(mission)
        if isinstance(mission.kernel, ExploringKernel):
            mission.kernel.watch(self)
            mission.accesses.observers.append(self._take_touch)

    def conclude(self) -> None:
        """Stop recording: the end of tasks does not count."""
        self._closed = True

    def policy(self, inner: Policy) -> Policy:
        """Return a policy that decides as another does, and records the place of each task at its decisions."""
        return _LookingPolicy(inner, self)

    def reached(self, decision: int) -> None:
        """Record the number of decisions so far."""
        self.is_on = self.is_on or decision >= self._first

    def add(self, task: str, kind: str, text: str) -> None:
        """Keep a row, until the failure has been seen."""
        if self._goes_on():
            self._keep(task, kind, text)

    def gives_way(self, task: Task, kind: str, chosen: str) -> None:
        """Record that a task does not continue although fifo would let it."""
        self.add(task.name, kind, chosen)
        if not self._closed and task.owner is not None:
            self._done(task, do.GIVES_WAY, chosen, None)

    def answers(self, text: str) -> None:
        """Record the answer to a question. The running task may belong to a node that is just starting."""
        if self._mission is not None:
            self.add(self._mission.kernel.current.name, ANSWERS, text)

    def look(self, frame: FrameType | None) -> None:
        """Record the place of the running task."""
        task = self._watched()
        if task is not None and self.is_on and self._goes_on():
            self._keep_place(task, frame)

    # -- keeping ------------------------------------------------------------------------------------------------------

    def _goes_on(self) -> bool:
        self._closed = self._closed or self._is_over()
        return not self._closed

    def _watched(self) -> Task | None:
        """Return the running task, if it belongs to one of the mission's applications."""
        if self._mission is None:
            return None
        if self._mission.ros is not self._ros:
            self._look_at_parameters(self._mission.ros)
        task = self._mission.kernel.current
        return None if task.owner is None or task.owner.name in CORE_APPS else task

    def _keep_place(self, task: Task, frame: FrameType | None) -> None:
        text = place_text(frame)
        if text:
            self._keep(task.name, AT, text)

    def _keep(self, task: str, kind: str, text: str, deed: Deed | None = None) -> None:
        """Keep a row, which shows a deed if one is given."""
        assert self._mission is not None
        row = Row(self._mission.kernel.now, task, kind, text if kind == TOUCHES else visible_line(text))
        if not self.rows or (self.rows[-1].task, self.rows[-1].kind, self.rows[-1].text) != (task, kind, row.text):
            self.rows.append(row)
        if deed is not None:
            self._row_of[id(deed)] = len(self.rows) - 1

    def rows_with(self, deeds: Sequence[Deed]) -> list[Row]:
        """Return the rows, with the rows of some deeds marked: the cause of the failure names them.

        A deed without a row gets one here, with the line of source before it.
        """
        wanted = {id(deed) for deed in deeds}
        rows: list[Row] = []
        shown = {at for ident, at in self._row_of.items() if ident in wanted}
        marked = [replace(row, is_of_cause=True) if at in shown else row for at, row in enumerate(self.rows)]
        begun = 0
        for deed, before in zip(self.deeds, self._rows_before, strict=True):
            if id(deed) in wanted and id(deed) not in self._row_of:
                rows += marked[begun:before]
                begun = before
                if deed.place:
                    rows.append(Row(deed.at_ns, deed.task, AT, self._sources.get(deed.place, deed.place)))
                rows.append(Row(deed.at_ns, deed.task, DOES, f"{deed.verb} {deed.thing}", is_of_cause=True))
        return rows + marked[begun:]

    def _done(self, task: Task, verb: str, thing: str, frame: FrameType | None, note: str = "") -> Deed:
        """Record a deed."""
        assert self._mission is not None
        source = place_text(frame)
        place = ":".join(source.split(":")[:2])
        self._sources[place] = source
        return self._noted(Deed(self._mission.kernel.now, task.name, task.owner.name, verb, thing, place, note))

    def _noted(self, deed: Deed) -> Deed:
        self._rows_before.append(len(self.rows))
        self.deeds.append(deed)
        return deed

    def _shown(self, task: Task, deed: Deed, frame: FrameType | None, more: str = "") -> None:
        """Record a row for a deed."""
        if self.is_on:
            self._keep_place(task, frame)
            self._keep(task.name, DOES, f"{deed.verb} {deed.thing}{more}", deed)

    # -- calls, which are scheduling points ---------------------------------------------------------------------------

    def called(self, subject: Any, call: str, args: tuple[Any, ...]) -> None:
        task, frame = self._watched(), _outside(sys._getframe(1))
        if task is None or not self._goes_on() or _is_nested(subject, sys._getframe(2)):
            return
        if call in _OF_OSAL or call in _OF_COUNTERS:
            self._call_of_app(task, subject, call, args, frame)
        elif call == "__init__":
            self._things.made(subject, frame)
        elif isinstance(subject, FilePoints):
            verb = do.WRITES if call == WRITES_FILE else do.READS
            self._shown(task, self._done(task, verb, f"file {args[0]}", frame), frame)
        elif hasattr(subject, "_at_fork_reinit"):
            self._call_of_node(task, subject, call, frame)

    def returned(self, subject: Any, call: str, args: tuple[Any, ...], result: Any) -> None:
        task, frame = self._watched(), _outside(sys._getframe(1))
        if task is None or not self._goes_on() or _is_nested(subject, sys._getframe(2)):
            return
        if call in _OF_OSAL or call in _OF_COUNTERS:
            self._call_of_app(task, subject, call, args, frame, ended=True, is_done=result is not False)
        elif call in _TAKING and hasattr(subject, "_at_fork_reinit"):
            self._lock_taken(task, use_of(subject, call, frame), result)

    def failed(self, subject: Any, call: str) -> None:
        """Do nothing: a failed call has no effect."""

    def _call_of_app(
        self,
        task: Task,
        service: Any,
        call: str,
        args: tuple[Any, ...],
        frame: FrameType | None,
        ended: bool = False,
        is_done: bool = True,
    ) -> None:
        if call in _OF_COUNTERS:
            counter = service.counters.find(args[0]) if args else None
            if ended and counter is not None:
                self._done(task, _OF_COUNTERS[call], f"counter {counter.name}", frame)
            return
        verb, kind = _OF_OSAL[call]
        try:
            thing = f"{kind} {service.get_resource_name(args[0])}"
        except (CfeError, IndexError):  # an invalid id: the call has failed, or is about to
            return
        takes = verb in (do.HAS, do.TAKES)
        note = do.BINARY if call.startswith("bin_") else ""
        if takes and not ended:
            self._wants(task, thing, frame, note)
        elif takes == ended:
            self.wanting.pop(task.name, None)
            self._shown(task, self._done(task, verb if is_done else do.GIVES_UP, thing, frame, note), frame)

    def _wants(self, task: Task, thing: str, frame: FrameType | None, note: str = "") -> None:
        self.wanting[task.name] = self._done(task, do.WANTS, thing, frame, note)

    def _call_of_node(self, task: Task, lock: Any, call: str, frame: FrameType | None) -> None:
        use = use_of(lock, call, frame)
        if use is None:
            return
        if use.inner is not None and use.call not in (*_TAKING, *_GIVING):
            self._call_of_library(task, use)
            return
        name = self._named(lock, use)
        if name and use.call in _TAKING and not _owns(lock, task):
            self._wants(task, name, use.frame)
        elif name and use.call in _GIVING and not _keeps(lock):
            self._shown(task, self._done(task, do.RELEASES, name, use.frame), use.frame)

    def _lock_taken(self, task: Task, use: Use | None, is_taken: bool) -> None:
        if use is None or (use.inner is not None and use.call not in _TAKING) or task.name not in self.wanting:
            return
        deed = self.wanting.pop(task.name)
        if is_taken:
            self._shown(task, self._done(task, do.HAS, deed.thing, use.frame), use.frame)

    def _call_of_library(self, task: Task, use: Use) -> None:
        """Record a method call of an Event, Condition or Queue once, at its first use of a lock."""
        assert use.inner is not None
        if self._calls.get(task) is use.inner:
            return
        self._calls[task] = use.inner
        verb = _OF_CONDITIONS.get(use.call)
        name = "" if verb is None else self._things.name(use.subject, use.frame)
        if verb is None or not name:
            return
        waiters = getattr(use.subject, "_waiters", None)
        note = f"{len(waiters)}" if verb == do.NOTIFIES and waiters is not None else ""
        more = {"": "", "0": ": no task waits"}.get(note, f": {note} wait")
        self._shown(task, self._done(task, verb, name, use.frame, note), use.frame, more)

    def _named(self, lock: Any, use: Use) -> str:
        name = self._things.name(lock if use.inner is None else use.subject, use.frame)
        if name and hasattr(lock, "_serial"):
            app = "" if self._mission is None else self._mission.kernel.current.owner.name
            self.names[f"lock {lock._serial} of {app}"] = name
        return name

    # -- waits --------------------------------------------------------------------------------------------------------

    def _blocking(self, block: Callable[[Kernel], Any]) -> Callable[[Kernel], Any]:
        def wait(kernel: Kernel) -> Any:
            task = self._watched()
            if task is None or not self._goes_on():
                return block(kernel)
            frame = _outside(sys._getframe(1))
            deed = self._begins_to_wait(task, frame)
            value = block(kernel)
            if deed is not None and self._goes_on():
                is_over = value is TIMEOUT
                ended = self._done(task, do.GIVES_UP if is_over else do.WAKES, deed.thing, frame)
                if is_over:
                    self._shown(task, ended, frame)
            return value

        return wait

    def _begins_to_wait(self, task: Task, frame: FrameType | None) -> Deed | None:
        """Record the awaited object. Returns the deed of a wait for an event or similar; None for a lock."""
        if self.is_on:
            self._keep_place(task, frame)
        waits = task.waits
        deed: Deed | None = None
        shown: Deed | None = None
        if waits is None:
            text = "sleeps"
        elif task.name in self.wanting:
            holders = " and ".join(holder.name for holder in waits.holders())
            thing = self.wanting[task.name].thing
            text = f"wants {thing}, which {holders} has" if holders else f"waits for {thing}"
            shown = self.wanting[task.name]
        else:
            use = use_of(None, "", frame) if "lock " in waits.what else None
            name = "" if use is None else self._awaited(use)
            text = f"waits for {name or self._of_pipe(waits.what)}"
            if name and use is not None and use.call not in (START, JOIN):
                shown = deed = self._done(task, do.AWAITS, name, frame)
        if self.is_on:
            self._keep(task.name, WAITS, text, shown)
        return deed

    def _awaited(self, use: Use) -> str:
        """Return the object that a call of the standard library waits for; empty if it has no name."""
        assert self._mission is not None
        if use.inner is None or use.subject is None:
            return ""
        if use.call == START:
            return "a thread to start"
        if use.call == JOIN:
            ident = getattr(use.subject, "ident", None)
            tasks = (task.name for task in self._mission.kernel.tasks if task.ident == ident)
            return f"the end of {next(tasks, getattr(use.subject, 'name', 'a thread'))}"
        return self._things.name(use.subject, use.frame)

    def _of_pipe(self, what: str) -> str:
        """Return a short name of a pipe. For a node's pipe it is the topic of its messages."""
        name = what.removeprefix("a message on pipe ")
        if self._mission is None or name == what:
            return what
        topics = {deed.thing for deed in self.deeds if deed.verb == do.SUBSCRIBES and deed.note == name}
        (topic,) = topics if len(topics) == 1 else (name,)
        return topic if topic.startswith("/") else f"pipe {name}"

    # -- messages and parameters --------------------------------------------------------------------------------------

    def _take_bus(self, verb: str, msg_id: int | None, pipe: Pipe | None) -> None:
        task = self._watched()
        if task is None or not self._goes_on():
            return
        frame = _outside(sys._getframe(1))
        if pipe is None:
            assert msg_id is not None
            name = self._message_name(msg_id)
            if name == _number(msg_id):  # `_take_message` records messages with a name
                self._shown(task, self._done(task, verb, name, frame), frame)
            return
        if msg_id is None:
            self._done(task, verb, f"pipe {pipe.name}", frame)
            return
        note = f"{pipe.app_name}, {pipe.depth}" if verb == do.LOSES else pipe.name
        deed = self._done(task, verb, self._message_name(msg_id), frame, note)
        if verb == do.LOSES and self.is_on:
            self._keep(task.name, DOES, f"{deed.thing} is lost: the pipe of {pipe.app_name} is full", deed)

    def _message_name(self, msg_id: int) -> str:
        ros = None if self._mission is None else self._mission.ros
        topics = {} if ros is None else ros.graph.topics
        found = (topic.name for topic in topics.values() if topic.msg_id == msg_id)
        return next(found, self._packets.get(msg_id, _number(msg_id)))

    def _take_message(self, heard: Heard) -> None:
        """Record a message. It may be the failure itself, so it is also kept if the failure has just been seen."""
        task = self._watched()
        if task is None or self._closed:
            return
        frame = _outside(sys._getframe(1))
        deed = self._done(task, do.SENDS, heard.topic, frame)
        if not self.is_on:
            return
        try:
            values = plain(heard.msg)
        except Exception as error:  # the type of its messages is not known
            values = {"?": str(error)}
        self._keep_place(task, frame)
        self._keep(task.name, SENDS, _sending(heard.topic, values), deed)

    def _take_touch(self, touch: Touch) -> None:
        """Record an access to a variable. Accesses long before the first move are not kept, because they are many."""
        task = self._watched()
        if task is None or not self.is_on or not self._goes_on():
            return
        assert self._mission is not None
        verb = do.WRITES if touch.is_write else do.READS
        place, key = f"{PurePath(touch.file).name}:{touch.line}", do.ALL if touch.key == WHOLE else touch.key
        deed = Deed(
            self._mission.kernel.now, task.name, task.owner.name, verb, touch.name, place, touch.file, touch.thing, key
        )
        source = place_text(_outside(sys._getframe(1)))
        self._keep(task.name, TOUCHES, f"{source}\n{verb} {touch.name}", self._noted(deed))

    def _look_at_parameters(self, ros: Any) -> None:
        """Watch the parameters of ROS, which has just started on a processor that may not be the first."""
        self._ros = ros
        if ros is not None:
            tree = ros.graph.params
            tree.find = self._of_parameter(tree.find, do.READS)
            tree.set = self._of_parameter(tree.set, do.WRITES)

    def _of_parameter(self, method: Callable[..., Any], verb: str) -> Callable[..., Any]:
        """Return the method of a parameter tree, wrapped to record the parameter that a node accesses."""

        def call(name: str, *args: Any) -> Any:
            task = self._watched()
            if task is not None and self._goes_on():
                frame = _outside(sys._getframe(1))
                if place_text(frame):
                    self._done(task, verb, f"parameter {name}", frame)
            return method(name, *args)

        return call


class _LookingPolicy(AskingPolicy):
    def __init__(self, inner: Policy, look: TaskLook) -> None:
        super().__init__(inner)
        self._look = look

    def choose(self, decision: Decision) -> int:
        """Decide, and record. It is called in the task that gives up the processor."""
        choice = self._inner.choose(decision)
        self._look.reached(decision.number)
        self._look.look(sys._getframe(1))
        if choice and decision.question is not None:
            self._look.answers(decision.question.told.format(decision.answers[choice]))
        elif choice:
            kind = PREEMPTED if decision.running else ORDERED
            self._look.gives_way(decision.tasks[0], kind, decision.answers[choice])
        return choice


def _told(base: type[SoftwareBus], tell: Tell) -> type[SoftwareBus]:
    """Return a Software Bus class that reports operations on its pipes.

    Args:
        base: the class to start from.
        tell: called inside the simulation, in the task of the operation; it must not wait.
    """

    class ToldBus(base):  # type: ignore[misc, valid-type]  # mypy does not follow a class that is an argument
        """A Software Bus that reports operations on its pipes."""

        def __init__(self, *args: object) -> None:
            super().__init__(*args)
            self._gone: dict[int, Pipe] = {}

        def _add(self, route: Route, pipe: Pipe, limit: int, scope: int) -> None:
            super()._add(route, pipe, limit, scope)
            tell(do.SUBSCRIBES, route.msg_id, pipe)

        def transmit_msg(self, packet: bytes | bytearray, is_origination: bool = True) -> None:
            if len(packet) > 1:
                tell(do.SENDS, packet[0] << 8 | packet[1], None)
            super().transmit_msg(packet, is_origination)

        def receive_buffer(self, pipe_id: int, timeout_ms: int = PEND_FOREVER) -> bytes | None:
            pipe = self.find_pipe(pipe_id) or self._gone.get(pipe_id)
            if pipe is not None:
                tell(do.RECEIVES, None, pipe)
            packet: bytes | None = super().receive_buffer(pipe_id, timeout_ms)
            if packet is not None and pipe is not None:
                tell(do.GETS, packet[0] << 8 | packet[1], pipe)
            return packet

        def remove_pipe(self, pipe: Pipe) -> None:
            tell(do.DELETES, None, pipe)
            self._gone[pipe.pipe_id] = pipe
            super().remove_pipe(pipe)

        def _report_failure(self, event_id: int, msg_id: int, pipe: Pipe) -> None:
            tell(do.LOSES, msg_id, pipe)
            super()._report_failure(event_id, msg_id, pipe)

        def _drop_oldest(self, pipe: Pipe) -> int:
            packet = pipe.items[0][0]
            tell(do.LOSES, packet[0] << 8 | packet[1], pipe)
            left: int = super()._drop_oldest(pipe)
            return left

    return ToldBus


def _number(msg_id: int) -> str:
    return f"0x{msg_id:04X}"


def _sending(topic: str, values: Any) -> str:
    """Return a sent message in a line; the text of an event."""
    if topic == EVENT and isinstance(values.get("PacketID"), dict):
        about = values["PacketID"]
        return f"event {about.get('AppName')} {about.get('EventID')}: {values.get('Message')}"
    return f"sends {topic}: {line_of(values) if isinstance(values, dict) else values}"


def _outside(frame: FrameType | None) -> FrameType | None:
    """Return the innermost frame that is not the simulator's."""
    while frame is not None and not is_shown(frame.f_code.co_filename):
        frame = frame.f_back
    return frame


def _is_nested(lock: Any, frame: FrameType) -> bool:
    """Return True if a method of a lock calls another one, as `__exit__` calls `release`."""
    return frame.f_code.co_name in (*_TAKING, *_GIVING) and frame.f_locals.get("self") is lock


def _owns(lock: Any, task: Task) -> bool:
    """Return True if the task already owns a recursive lock."""
    return getattr(lock, "_owner", None) is task


def _keeps(lock: Any) -> bool:
    """Return True if a recursive lock stays with its owner after one release."""
    return getattr(lock, "_count", 1) > 1
