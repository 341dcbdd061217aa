"""`Mission`: a mission on one simulated computer, through all its resets.

It creates the parts that outlive a reset (kernel, clock, trace, console, files, network, retained memory) and boots a
`Processor` on them. No part depends on this module.
"""

from __future__ import annotations

import sys
import warnings
import weakref
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, ParamSpec, TypeVar

from cfepy.app import Cfe
from cfepy.attachment import Attachment
from cfepy.config.platform import FAIR
from cfepy.es import NODE_SYMBOL
from cfepy.interpreter.host_system import ask_for_one_blas_thread
from cfepy.interpreter.own_code import is_own_code
from cfepy.mission.failed_code import FailedCode
from cfepy.mission.host_actions import HostActs
from cfepy.mission.mission_lookup import read_mission
from cfepy.mission.outside import Outside
from cfepy.mission.processor import Machine, Processor, RunFiles
from cfepy.mission.python_code import find_code
from cfepy.mission.record import Reset, RunRecord
from cfepy.mission.run_pieces import HeldBack, PieceLength, is_to_be_held_back
from cfepy.mission.spec import MissionSpec
from cfepy.nodes import Accesses
from cfepy.osal import FileSystem, Network
from cfepy.psp import EEPROM_BYTES, RANGES, BoardProfile, MemoryBudget, PanicError, Retained, load_profile
from cfepy.rtos import AUTO, Kernel, Policy, StallWatch, Stopwatch, Task, task_kind
from cfepy.sb import SoftwareBus
from cfepy.schedules import make_kernel
from cfepy.status import StallError
from cfepy.trace import Trace
from cfepy.units import NS_PER_MS, NS_PER_S
from cfepy.writing.console import Console

if TYPE_CHECKING:
    from cfepy.nodes import Overlay
    from rospy_shim.runtime import RosRuntime

P = ParamSpec("P")
T = TypeVar("T")

SHUTDOWN_NS = 2_000_000_000  # virtual time for the shutdown hooks of nodes at the end of a run
RESTART_NS = 10 * NS_PER_MS  # from a reset until the board starts; time also passes if every boot fails


def _use_one_blas_thread() -> None:
    """Let linear algebra use one thread; only a process that has NumPy already loads the code for its libraries."""
    ask_for_one_blas_thread()
    if "numpy" in sys.modules:
        from cfepy.interpreter.blas_threads import use_one_blas_thread

        use_one_blas_thread()


def _while_there_is_one(method: Callable[P, T], otherwise: T) -> Callable[P, T]:
    """Return a method of the mission for its tasks that holds only a weak reference, so that the user can drop the
    mission.

    Args:
        method: the bound method.
        otherwise: result of a call after the mission was dropped.
    """
    reference = weakref.WeakMethod(method)

    def call(*args: P.args, **kwargs: P.kwargs) -> T:
        bound = reference()
        return otherwise if bound is None else bound(*args, **kwargs)

    return call


def _noting_lines(trace: Trace, kernel: Kernel, failed: FailedCode) -> Callable[[str], None]:
    """Return the consumer of console lines: it records them in the trace and looks for tracebacks."""

    def note(line: str) -> None:
        trace.note(line)
        failed.printed.take(line, kernel.now, kernel.current.name)

    return note


class Mission:
    """A mission on one simulated processor.

    Args:
        mission: a startup script, a mission's folder, the name of a shipped mission, or a `MissionSpec`.
        seed: seed of everything random in the mission.
        board: name or file of a board profile; None takes the mission's own.
        tasks: "thread", "greenlet" or "auto": greenlets if they are installed (`cfepy.rtos.context_choice`).
        console: called with each line; None prints them.
        policy: decides which task runs next (`cfepy.rtos.policy`); None is first come, first served.
        trace: takes the records; None makes one that only keeps the digest.
        attachments: objects that observe or modify the mission, in the order of their calls.

    Attributes:
        spec, seed, tasks, board, config, console: as given, or as determined.
        why_tasks: why "auto" did not use installed greenlets; empty if it did.
        kernel, trace, files, network: the parts that outlive a reset.
        outside: the entry point for all external input during the run.
        record: the data of the report; `record.resets` has the resets so far.
        accesses: collects the accesses of the mission's Python code to shared data.
        stall_watch: ends the run if a task does not give up the CPU.
        processor: the processor that runs between two resets; a reset replaces it.
        booted: virtual ns at which the mission first became OPERATIONAL; None before.
        on_bad_end: called with the mission and the application of a node whose program has just ended with an error,
            before the node's threads end.
        meet: synchronizes missions that fly together, and returns the virtual ns until which this one may continue;
            None if it flies alone.
    """

    def __init__(
        self,
        mission: str | MissionSpec,
        *,
        seed: int = 0,
        board: str | BoardProfile | None = None,
        tasks: str = AUTO,
        console: Console | None = None,
        policy: Policy | None = None,
        trace: Trace | None = None,
        attachments: Sequence[Attachment] = (),
    ) -> None:
        _use_one_blas_thread()
        self.spec = mission if isinstance(mission, MissionSpec) else read_mission(mission)
        self.seed = seed
        self.tasks, self.why_tasks = kind = task_kind(tasks)
        self.board = board if isinstance(board, BoardProfile) else load_profile(board or self.spec.board)
        if self.spec.memory is not None:
            self.board = replace(self.board, memory=self.spec.memory)
        self.config = self.spec.config(self.board)
        self.console = console if console is not None else Console()
        self.trace = Trace() if trace is None else trace
        self.record = RunRecord()
        self.files = FileSystem(self.spec.folder)
        self.network = Network()
        switch_ns = self.board.cpu_costs().switch_ns
        self._attachments = tuple(attachments)
        tick_ns = self.board.tick_ns
        self.kernel = kernel = make_kernel(kind.name, self.trace, policy, tick_ns, switch_ns, seed, self._kernel_class)
        kernel.is_fair = self.config.scheduling == FAIR
        self.trace.take_times(lambda: kernel.now)
        self.console.record = _noting_lines(self.trace, kernel, self.record.part(FailedCode))
        self.outside = Outside(self.kernel, self.network, self.trace)
        self.outside.do = HostActs(self).do
        self.kernel.on_task_error = _while_there_is_one(self._task_failed, False)
        self.accesses = Accesses(kernel)
        self.on_bad_end: Callable[[Mission, str], object] = lambda mission, app: None
        self.stall_watch = StallWatch(self.kernel, is_own=is_own_code)
        self.meet: Callable[[], int] | None = None
        self._first_boot: int | None = None
        self._resetting = False
        self._provide_tables()
        self._machine = self._make_machine()
        self.processor = Processor(self._machine)
        self._is_closed = False  # before that there is nothing to close
        for each in self._attachments:
            each.begin(self)
        self._power_up()

    def _power_up(self) -> None:
        for each in self._attachments:
            each.power_up(self.processor)

    def forget_files(self) -> None:
        """Remove the files that the run wrote, for a process that leaves the run early."""
        self._machine.run_files.close()

    def _kernel_class(self, base: type[Kernel]) -> type[Kernel]:
        for each in self._attachments:
            base = each.kernel(base)
        return base

    def _make_machine(self) -> Machine:
        bus = SoftwareBus
        for each in self._attachments:
            bus = each.bus(bus)
        eeprom_bytes = self.board.data_flash or EEPROM_BYTES
        return Machine(
            spec=self.spec,
            seed=self.seed,
            board=self.board,
            config=self.config,
            kernel=self.kernel,
            console=self.console,
            files=self.files,
            network=self.network,
            retained=Retained(cds_bytes=self.config.es_cds_size, eeprom_bytes=eeprom_bytes),
            record=self.record,
            bus=bus,
            on_restart=_while_there_is_one(self._on_restart, None),
            run_files=RunFiles(),
            accesses=self.accesses,
            stall_watch=self.stall_watch,
            on_bad_end=_while_there_is_one(self._bad_end, None),
        )

    def _provide_tables(self) -> None:
        """Put the default tables of shipped apps into /cf, unless the mission has its own."""
        for package in self._packages():
            for table in sorted(package.glob("tables/*.tbl")):
                if self.files.find(f"/cf/{table.name}") is None:
                    self.files.write_file(f"/cf/{table.name}", table.read_bytes())

    def _packages(self) -> Iterator[Path]:
        """Yield the folders of apps and libraries that are packages, in the order of the startup script."""
        for entry in self.spec.entries:
            code = None if entry.symbol == NODE_SYMBOL else find_code(entry.path, self.spec.folder)
            if isinstance(code, Path) and code.name == "__init__.py":
                yield code.parent

    # -- the running parts --------------------------------------------------------------------------------------

    @property
    def cfe(self) -> Cfe:
        """The handle of the running services."""
        return self.processor.cfe

    @property
    def memory(self) -> MemoryBudget:
        """The memory accounting of the board since the last reset."""
        return self.processor.memory

    @property
    def ros(self) -> RosRuntime | None:
        """The ROS side; None before the first node has started."""
        return self.processor.ros

    def begin_ros(self) -> RosRuntime:
        """Return the ROS side, and create it if there was no node yet."""
        return self.processor.begin_ros()

    @property
    def run_files(self) -> Overlay | None:
        """The files of apps and nodes, as seen and written, until the mission is closed; None before they were
        needed.
        """
        return self._machine.run_files.made

    @property
    def booted(self) -> int | None:
        """Virtual ns at which the mission first became OPERATIONAL; None before."""
        return self._first_boot if self._first_boot is not None else self.processor.booted

    @property
    def over(self) -> bool:
        """Whether the run has ended on its own: a required node or all nodes have ended, or the flight software has
        aborted.
        """
        return self.kernel.abortion is not None or (self.ros is not None and bool(self.ros.monitor.over))

    @property
    def stall(self) -> StallError | None:
        """The error of a run that was broken off for a stall; None if every task has given up the CPU."""
        broken = self.kernel.broken
        return broken if isinstance(broken, StallError) else None

    # -- running ---------------------------------------------------------------------------------------------------

    def run_for(self, seconds: float) -> None:
        """Run for a number of virtual seconds.

        Raises:
            StallError: if a task does not give up the CPU.
            KeyboardInterrupt: for Ctrl-C; errors of tasks outside any app are also raised.
        """
        self.run_until(self.kernel.now + round(seconds * NS_PER_S))

    def run_until(self, until_ns: int) -> None:
        """Run until a virtual time in ns, through every requested reset.

        Raises:
            StallError: if a task does not give up the CPU.
            KeyboardInterrupt: for Ctrl-C; the run can continue afterwards, if each task soon gave up the CPU.
            RuntimeError: if the mission was closed.
        """
        if self._is_closed:
            raise RuntimeError("this mission is closed and cannot continue; boot another one")
        stop_ns = until_ns
        while True:
            if self.meet is not None:
                stop_ns = min(until_ns, self.meet())
            self._run_held_back(stop_ns)
            if stop_ns == until_ns or self.kernel.now < stop_ns:  # it has arrived, or was stopped on the way
                return

    def _run_held_back(self, until_ns: int) -> None:
        """Run until a virtual time in ns, while signals wait until tasks have finished their current step."""
        if not self._resetting and self.kernel.passes(until_ns):
            self.outside.begin_piece(until_ns)
            return
        if not is_to_be_held_back():
            self._run(until_ns, self.kernel.run)
            return
        with HeldBack() as signals:
            if not signals.is_first:
                self._run(until_ns, self.kernel.run)
                return
            watch = self.stall_watch
            wanted = watch.wanted
            watch.wanted = lambda: signals.asked or wanted()
            try:
                self._run(until_ns, lambda end_ns: self._run_in_pieces(end_ns, signals))
            finally:
                watch.wanted = wanted

    def _run(self, until_ns: int, run: Callable[[int], None]) -> None:
        self.stall_watch.begin()
        self.outside.begin_piece(until_ns)
        self._reset_if_asked()
        run(until_ns)
        while self._resetting:
            self._reset_if_asked()
            run(until_ns)

    def _run_in_pieces(self, until_ns: int, signals: HeldBack) -> None:
        kernel, length = self.kernel, PieceLength()
        while not signals.asked:
            watch, start_ns = Stopwatch(), kernel.now
            kernel.run(min(until_ns, start_ns + length.ns))
            if kernel.now >= until_ns or kernel.is_stopped:
                return
            length.took(kernel.now - start_ns, watch.elapsed_ns())

    def conclude(self) -> None:
        """Notify the attachments that the time of the run is over; the shutdown follows."""
        for each in self._attachments:
            each.conclude()

    def shut_down_nodes(self) -> None:
        """Ask all ROS nodes to shut down, and give them a little virtual time for their shutdown hooks."""
        ros = self.ros
        if ros is None or self._resetting or self.kernel.broken is not None:
            return
        ros.begin_shutdown("the run is over")
        end = self.kernel.now + SHUTDOWN_NS
        while not ros.all_finished() and self.kernel.now < end and not self._resetting:
            self.kernel.run(min(end, self.kernel.now + SHUTDOWN_NS // 20))

    def finish(self) -> str:
        """End the run and return its digest. Actions of tasks while they are being ended do not belong to the run."""
        digest = self.trace.digest()
        for each in self._attachments:
            each.finish()
        return digest

    def close(self) -> None:
        """End every task; the results stay readable.

        Raises:
            RuntimeError: if the caller is in another process than the tasks, or for greenlets in another thread.
        """
        self.kernel.check_caller()
        self._is_closed = True
        with HeldBack():
            self.processor.end()
            self.kernel.shutdown(tidy=True)
            self.stall_watch.end()
        for each in self._attachments:
            each.close()
        self._machine.run_files.close()

    def __enter__(self) -> Mission:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        self.close()

    def __del__(self) -> None:
        """Close a mission that was not closed and is no longer referenced, because its threads must not outlive it.

        At the exit of Python this does nothing, because its threads no longer run.
        """
        if getattr(self, "_is_closed", True) or sys.is_finalizing():
            return
        warnings.warn(f"mission {self.spec.folder.name} was not closed", ResourceWarning, source=self, stacklevel=2)
        # greenlets of another thread, or tasks of another process: these are not our threads
        with suppress(RuntimeError):
            self.close()

    # -- failures and resets ---------------------------------------------------------------------------------------

    def _bad_end(self, app: str) -> None:
        self.on_bad_end(self, app)

    def _task_failed(self, task: Task, error: BaseException) -> bool:
        """Report an exception from a task, and let ES handle it as the startup script requests."""
        self.record.part(FailedCode).take(task, error, self.kernel.now)
        if task.owner is None or isinstance(error, PanicError):
            return False
        from cfepy.mission.tracebacks import app_traceback, described, reason

        self.console.write(f"{task.owner.name}: task {task.name} died of an exception")
        self.console.write(app_traceback(error))
        is_taken = self.cfe.es.take_fault(task, error, reason(error))
        if getattr(error, "ends_process", False) and self._is_one_process(task):
            self.kernel.abort(task, described(error))
        return is_taken

    def _is_one_process(self, task: Task) -> bool:
        """Return whether a fault of a task ends all flight software, as on Linux, where it is one process.

        A ROS node is a process of its own on a robot. A run with the guard looks for more mistakes.
        """
        spec, params = self.spec, getattr(task.owner, "params", None)
        is_node = params is not None and (params.is_node or task.owner.name in spec.built)
        return self.board.memory != RANGES and not spec.safe and not spec.compiled.guard and not is_node

    def _on_restart(self, reset_type: int, why: str, fault: bool) -> None:
        """Handle a restart of the processor by the PSP: return to the host, which alone can end every task."""
        if not self._resetting:  # a `finally` block of a task that is being ended may request it again
            self._resetting = True
            self.record.resets.append(Reset(self.kernel.now, reset_type, why, fault))
        self.kernel.stop()

    def _reset_if_asked(self) -> None:
        if not self._resetting:
            return
        old = self.processor
        if self._first_boot is None:
            self._first_boot = old.booted
        old.end()
        self.record.close_books(old.cfe.sb, old.topics())
        self._resetting = False
        self.processor = Processor(self._machine, RESTART_NS)
        self._power_up()
