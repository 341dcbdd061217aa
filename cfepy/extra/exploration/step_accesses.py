"""The accesses of a mission's steps, as far as cfepy observes them: an attachment that keeps a run's steps.

cfepy observes pipes and messages, locks, semaphores and queues, waits, tables, parameters, files and the ROS graph. In
code of the mission it also observes attributes, items of containers, and variables that functions share. If the
accesses of a call are not known, it counts as an access to all of its service. The time of day is not observed, which
differs by microseconds from one order to the next.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from typing import Any, cast

from cfepy.attachment import Attachment
from cfepy.extra.exploration.steps import GIVES, READS, TAKES, WRITES, StepLog, TaskStep, Touched, state_of
from cfepy.mission import Mission, MissionSpec, Processor, find_compiled
from cfepy.nodes import WHOLE, WRITES_FILE, FilePoints, Touch
from cfepy.ports import PEND_FOREVER
from cfepy.rtos import Kernel, Task, WaitList, wrapping
from cfepy.sb import Destination, Pipe, PutHook, SoftwareBus
from cfepy.schedules import ExploringKernel
from cfepy.status import UsageError
from cfepy.tbl import TableServices

GRAPH, PARAMETERS, PIPES, TABLES = "ROS graph", "ROS parameters", "pipes", "TableServices"
_LOOKING = ("find", "get", "has", "is_", "locked", "_is_owned", "names", "published", "search")
_OWN = frozenset(
    {
        *("__init__", "compute", "exit_app", "exit_child_task", "get_app_id", "get_task_id", "perf_log_add", "printf"),
        *("run_loop", "task_delay", "task_get_id", "wait_for_startup_sync", "write_to_sys_log"),
    }
)
"""Calls that concern the caller alone, or that are recorded where they wait or send."""
_TAKING = frozenset({"acquire", "acquire_lock", "__enter__", "_acquire_restore", "mut_sem_take"})
_GIVING = frozenset({"release", "release_lock", "__exit__", "_release_save", "mut_sem_give"})
_GRAPH_CHANGES = ("topic", "register_node", "forget_node", "register_service", "forget_service", "caller")
_TABLE_CHANGES = ("working_buffer", "exclusive_buffer", "discard_load")
_ADDRESSES = ("get_address", "get_addresses")
_TREE_CHANGES = ("give", "offer", "on_change", "set", "delete")
_TREE_LOOKS = ("find", "search", "names")


def check_visible(spec: MissionSpec) -> None:
    """Check that all accesses of a mission can be observed.

    Raises:
        UsageError: it has compiled code, whose memory accesses are not observed.
    """
    compiled = [entry.name for entry in spec.entries if find_compiled(entry.path, spec.folder) is not None]
    compiled += spec.ros.compiled
    if compiled:
        text = (
            f"the policy orders must observe all accesses, and {compiled[0]} is "
            "compiled; use another policy, such as dfs"
        )
        raise UsageError(text, field="--policy")


class Footprints(Attachment):
    """Keeps the steps of a run, and their accesses.

    Args:
        from_ns: virtual time from which steps are kept.
    """

    def __init__(self, from_ns: int = 0) -> None:
        self._log = StepLog(from_ns)
        self._services: dict[int, Any] = {}  # of the processor, by identity
        self._numbers: dict[int, tuple[int, Any]] = {}  # by identity: number of a lock, and the lock
        self._pipes = _Pipes(self)

    @property
    def steps(self) -> tuple[TaskStep, ...]:
        """The steps in the order in which they were made."""
        return self._log.steps

    def bus(self, base: type[SoftwareBus]) -> type[SoftwareBus]:
        return _touching(base, self._pipes)

    def kernel(self, base: type[Kernel]) -> type[Kernel]:
        about_waits = dict.fromkeys(("wait_on", "wake_first", "wake_all"), self._about_waits)
        return wrapping(self._log.kernel(base), {"charge": self._charging, **about_waits})

    def begin(self, mission: Mission) -> None:
        kernel = mission.kernel
        assert isinstance(kernel, ExploringKernel)
        self._log.begin_with(kernel)
        self._pipes.kernel = kernel
        mission.accesses.observers.append(self._take)
        kernel.watch(self)

    def power_up(self, processor: Processor) -> None:
        services = (getattr(processor.cfe, field.name) for field in fields(processor.cfe))
        self._services = {id(each): each for each in services}
        registry = processor.cfe.tbl.registry
        for name in _TABLE_CHANGES:
            _also(registry, name, lambda table: self._change(table))
        if processor.ros is not None:
            graph = processor.ros.graph
            for name in _GRAPH_CHANGES:
                _also(graph, name, lambda *args, **options: self.touch(GRAPH))
            for name in _TREE_CHANGES:
                _also(graph.params, name, lambda *args, **options: self.touch(PARAMETERS))
            for name in _TREE_LOOKS:
                _also(graph.params, name, lambda *args, **options: self.touch(PARAMETERS, READS))

    def conclude(self) -> None:
        """Stop recording: operations of nodes during their shutdown do not count."""
        self._log.close()

    def touch(self, thing: str, how: str = WRITES) -> None:
        """Record an access of the current task; see `StepLog.touch`."""
        self._log.touch(thing, how)

    def leave(self, task: Task) -> None:
        """Stop recording a task; see `StepLog.leave`."""
        self._log.leave(task)

    def called(self, subject: Any, call: str, args: tuple[Any, ...]) -> None:
        """Record a call of a cFE service, of a node's lock or of a file; see `CallObserver.called`."""
        if isinstance(subject, FilePoints):
            self.touch(f"file {args[0]}", WRITES if call == WRITES_FILE else READS)
        if self._is_of_calls(subject):
            wanted = self._name(subject, args) if call in _TAKING else ""
            self._log.begin(self._things(subject, call, args), wanted)

    def returned(self, subject: Any, call: str, args: tuple[Any, ...], result: Any) -> None:
        """Record the end of a call; a lock is taken when its call returns with it."""
        if call == "is_set" or not self._is_of_calls(subject):  # reported without a call
            return
        if not self._log.end():
            return
        if call in _ADDRESSES and isinstance(subject, TableServices):
            for handle in args if call == "get_address" else args[0]:
                self._log.touch_from_now_on(f"memory of {self._table(subject, handle)}")
        if call in _TAKING:
            name = self._name(subject, args)
            self.touch(state_of(name), READS)
            if result is not False:
                self.touch(name, TAKES)
        else:
            self._log.part()

    def _change(self, table: Any) -> None:
        """Record a change of a table's memory, or of the buffer for its next load."""
        self.touch(f"table {table.name}")
        self.touch(f"memory of table {table.name}")

    def _table(self, tbl: TableServices, handle: int) -> str:
        access = tbl.registry.accesses.find(handle)
        return "no table" if access is None else f"table {access.table.name}"

    def failed(self, subject: Any, call: str) -> None:
        self._log.fail()

    def _is_of_calls(self, subject: Any) -> bool:
        """Return True for a service or a Python lock: the ends of calls of its methods are reported too."""
        return id(subject) in self._services or hasattr(subject, "_at_fork_reinit")

    def _things(self, subject: Any, call: str, args: tuple[Any, ...]) -> list[Touched]:
        if isinstance(subject, SoftwareBus):
            return _things_of_bus(subject, call, args)
        if call in _OWN:
            return []
        if isinstance(subject, TableServices) and args and isinstance(args[0], int):
            how = READS if call.startswith(_LOOKING) and call not in _ADDRESSES else WRITES
            return [(self._table(subject, args[0]), how), (TABLES, READS)]
        name = self._name(subject, args)
        if call in _TAKING:  # a try without a wait reads whether another task has the lock
            may_wait = id(subject) in self._services or all(each is True or each == -1 for each in args)
            return [] if may_wait or not call.startswith("acquire") else [(state_of(name), WRITES)]
        if call in _GIVING:
            return [(name, GIVES), (state_of(name), READS)]
        return [(name, READS if call.startswith(_LOOKING) else WRITES)]

    def _name(self, subject: Any, args: tuple[Any, ...]) -> str:
        """Return a lock's name with its number, a service object's name with its id, or the name of the service."""
        kind = type(subject).__name__
        if id(subject) not in self._services:
            return f"{kind} {self._numbers.setdefault(id(subject), (len(self._numbers), subject))[0]}"
        return f"{kind} {args[0]}" if args and isinstance(args[0], int) else kind

    def _take(self, touch: Touch) -> None:
        """Record an access by code of the mission. An access to a whole container includes its items."""
        how = WRITES if touch.is_write else READS
        if touch.key == WHOLE:
            self.touch(f"all in {touch.thing}", how)
            return
        if touch.key.startswith("["):
            self.touch(f"all in {touch.thing}", READS)
        self.touch(f"{touch.key} of {touch.thing}", how)

    def _charging(self, charge: Callable[[Kernel, int], None]) -> Callable[[Kernel, int], None]:
        def pay(kernel: Kernel, duration_ns: int) -> None:
            self._calls()
            charge(kernel, duration_ns)
            self._calls()

        return pay

    def _about_waits(self, original: Callable[..., Any]) -> Callable[..., Any]:
        def call(kernel: Kernel, waits: WaitList, *args: Any, **options: Any) -> Any:
            self._waits(waits)
            return original(kernel, waits, *args, **options)

        return call

    def _calls(self) -> None:
        """Record that a node's call of ROS or Python may read the ROS graph before and after other tasks run."""
        if not self._log.is_in_a_call:
            self.touch(GRAPH, READS)

    def _waits(self, waits: WaitList) -> None:
        """Record a wait. A wait within a call belongs to the object of the call."""
        self._pipes.wakes(waits)
        if not self._pipes.waits() and not self._log.is_in_a_call:
            self.touch(f"wait for {waits.what}")


class _Pipes:
    """Model of the pipes. While a pipe is neither empty nor full, writers and readers do not conflict."""

    kernel: Kernel
    bus: SoftwareBus

    def __init__(self, footprints: Footprints) -> None:
        self.touch = footprints.touch
        self._leave = footprints.leave
        self._getting: dict[Task, tuple[Pipe, bool]] = {}  # the pipe of each receiving task, and whether it waited

    def puts(self, destination: Destination, limit: int) -> None:
        """Record that the current task puts a message into a pipe now."""
        pipe, waiting = destination.pipe, len(destination.pipe.items)
        self.touch(f"pipe {pipe.pipe_id}", READS)
        self.touch(f"tail of {pipe.name}")
        if not waiting:
            self.touch(f"emptiness of {pipe.name}")
        if min(pipe.depth - waiting, limit - (destination.puts - destination.gets)) <= 1:
            self.touch(f"room of {pipe.name}")

    def gets(self, pipe: Pipe) -> None:
        """Record that the current task is about to get a message; its subscription may already be about to end."""
        self.touch(f"wait for {pipe.waits.what}", READS)
        self._getting[self.kernel.current] = pipe, False

    def wakes(self, waits: WaitList) -> None:
        """Record wake-ups. Tasks of subscriptions that no longer exist only clean up, so they are left out."""
        for task in waits:
            pipe = self._getting.get(task, (None, False))[0]
            if pipe is not None and pipe.waits is waits and not self.routes_to(pipe):
                self._leave(task)

    def routes_to(self, pipe: Pipe) -> list[int]:
        """Return the MsgIds that are routed to a pipe."""
        return [msg_id for msg_id, route in self.bus.routes.items() if route.find(pipe) is not None]

    def waits(self) -> bool:
        """Record that the current task waits for a message. Returns False if it does not wait for a pipe."""
        task = self.kernel.current
        if task not in self._getting:
            return False
        pipe = self._getting[task][0]
        self._getting[task] = pipe, True
        self.touch(f"emptiness of {pipe.name}")
        return True

    def got(self, packet: bytes | None) -> None:
        """Record that the current task received a message; None if there was none."""
        pipe, has_waited = self._getting.pop(self.kernel.current)
        if packet is None:
            self.touch(f"emptiness of {pipe.name}", READS)
        elif not has_waited:
            waited = len(pipe.items) + 1
            self.touch(f"head of {pipe.name}")
            if waited == 1:
                self.touch(f"emptiness of {pipe.name}")
            if waited >= min(pipe.depth, _SMALL_LIMIT) - 1:
                self.touch(f"room of {pipe.name}")


_SMALL_LIMIT = 4  # messages of one kind that a pipe takes by default


def _things_of_bus(bus: SoftwareBus, call: str, args: tuple[Any, ...]) -> list[Touched]:
    """Return the accesses of a Software Bus call, except those that are recorded as they happen.

    A subscription's task looks up its pipe if it is about to end and did not wait.
    """
    if call == "set_pipe_opts":
        return [(f"pipe {args[0]}", WRITES)]
    if call == "find_pipe":
        pipe = bus.find_pipe(*args)
        return [] if pipe is None else [(f"wait for {pipe.waits.what}", READS)]
    return [(PIPES, READS)] if call == "get_pipe_id_by_name" else []


def _also(subject: Any, name: str, before: Callable[..., object]) -> None:
    """Wrap a method of an object, so that a function is called before it."""
    original = getattr(subject, name)

    def both(*args: Any, **options: Any) -> Any:
        before(*args, **options)
        return original(*args, **options)

    setattr(subject, name, both)


class _Touching(PutHook):
    """Reports the pipes that messages are put into."""

    def __init__(self, pipes: _Pipes, inner: PutHook | None) -> None:
        super().__init__(inner)
        self._pipes = pipes

    def limit(self, destination: Destination) -> int:
        """Report the pipe. The limit does not change."""
        limit = super().limit(destination)
        self._pipes.puts(destination, limit)
        return limit


def _touching(base: type[SoftwareBus], pipes: _Pipes) -> type[SoftwareBus]:
    """Return a Software Bus class that reports accesses to pipes.

    Args:
        base: the class to start from.
        pipes: receives the accesses.
    """

    class TouchingBus(base):  # type: ignore[misc, valid-type]  # mypy does not follow a class that is an argument
        """A Software Bus that reports accesses to its pipes."""

        put_hook: PutHook | None

        def __init__(self, kernel: Kernel, *args: Any) -> None:
            super().__init__(kernel, *args)
            pipes.bus = self
            self.put_hook = _Touching(pipes, self.put_hook)

        def transmit_msg(self, packet: bytes | bytearray, is_origination: bool = True) -> None:
            pipes.touch(f"route {packet[0] << 8 | packet[1]}", READS)
            pipes.touch(f"message {packet[0] << 8 | packet[1]}")
            super().transmit_msg(packet, is_origination)

        def receive_buffer(self, pipe_id: int, timeout_ms: int = PEND_FOREVER) -> bytes | None:
            pipes.touch(f"pipe {pipe_id}", READS)
            pipe = self.find_pipe(pipe_id)
            if pipe is None:
                return cast("bytes | None", super().receive_buffer(pipe_id, timeout_ms))
            pipes.gets(pipe)
            packet: bytes | None = None
            try:
                packet = super().receive_buffer(pipe_id, timeout_ms)
            finally:
                pipes.got(packet)
            return packet

        def _subscribe(self, msg_id: int, pipe_id: int, *args: Any) -> None:
            self._touch_route(msg_id, pipe_id)
            super()._subscribe(msg_id, pipe_id, *args)

        def _unsubscribe(self, msg_id: int, pipe_id: int, *args: Any) -> None:
            self._touch_route(msg_id, pipe_id)
            super()._unsubscribe(msg_id, pipe_id, *args)

        def _touch_route(self, msg_id: int, pipe_id: int) -> None:
            pipes.touch(f"route {msg_id}")
            pipes.touch(f"pipe {pipe_id}", READS)
            pipes.touch(GRAPH)  # a node does not publish without subscribers

        def create_pipe(self, *args: Any) -> int:
            pipes.touch(PIPES)
            pipe_id = cast(int, super().create_pipe(*args))
            pipes.touch(f"pipe {pipe_id}")
            return pipe_id

        def delete_pipe(self, pipe_id: int) -> None:
            pipes.touch(PIPES, READS)
            pipes.touch(f"pipe {pipe_id}")
            pipe = self.find_pipe(pipe_id)
            for msg_id in [] if pipe is None else pipes.routes_to(pipe):
                pipes.touch(f"route {msg_id}")
            super().delete_pipe(pipe_id)

    return TouchingBus
