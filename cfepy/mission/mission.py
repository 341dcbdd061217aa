"""`Mission`: a mission on one simulated computer, through all its resets.

It makes what outlives a reset (kernel, clock, trace, console, files, network, retained memory) and lets a `Processor`
boot on it. Nothing in the parts knows of this module.
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
from cfepy.interpreter.own_code import is_own_code
from cfepy.mission.failed_code import FailedCode
from cfepy.mission.host_actions import HostActs
from cfepy.mission.loader import NODE_SYMBOL
from cfepy.mission.mission_lookup import read_mission
from cfepy.mission.outside import Outside
from cfepy.mission.processor import Machine, Processor, RunFiles
from cfepy.mission.python_code import find_code
from cfepy.mission.record import Reset, RunRecord
from cfepy.mission.run_pieces import HeldBack, PieceLength, is_to_be_held_back
from cfepy.mission.spec import MissionSpec
from cfepy.nodes import Accesses
from cfepy.osal import FileSystem, Network
from cfepy.psp import EEPROM_BYTES, BoardProfile, MemoryBudget, PanicError, Retained, load_profile
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

SHUTDOWN_NS = 2_000_000_000  # virtual time that nodes get at the end of a run for their shutdown hooks
RESTART_NS = 10 * NS_PER_MS  # from a reset until the board comes up; also keeps time going when every boot fails


def _while_there_is_one(method: Callable[P, T], otherwise: T) -> Callable[P, T]:
    """A method of the mission, for its tasks: who keeps it does not keep the mission, which its user may forget.

    Args:
        method: bound.
        otherwise: what comes of a call when there is no mission any more.
    """
    reference = weakref.WeakMethod(method)

    def call(*args: P.args, **kwargs: P.kwargs) -> T:
        bound = reference()
        return otherwise if bound is None else bound(*args, **kwargs)

    return call


def _noting_lines(trace: Trace, kernel: Kernel, failed: FailedCode) -> Callable[[str], None]:
    """What the console gives its lines to: the trace, and what reads tracebacks in them."""

    def note(line: str) -> None:
        trace.note(line)
        failed.printed.take(line, kernel.now, kernel.current.name)

    return note


class Mission:
    """One mission on one simulated processor.

    Args:
        mission: a startup script, a mission's folder, the name of a shipped mission, or a `MissionSpec`.
        seed: of everything random in the mission.
        board: name or file of a board profile; None takes the mission's own.
        tasks: "thread", "greenlet" or "auto": greenlets where they are installed (`cfepy.rtos.context_choice`).
        console: where lines go; None prints them.
        policy: decides which task runs next where there is a choice (`cfepy.rtos.policy`); None is first come, first
            served.
        trace: takes the records; None makes one that only keeps the digest.
        attachments: what watches the mission or changes it, in the order in which they are called.

    Attributes:
        spec, seed, tasks, board, config, console: as given, or as found.
        why_tasks: why "auto" left installed greenlets alone; empty when it did not.
        kernel, trace, files, network: the parts that outlive a reset.
        outside: the door through which anything comes in while it runs.
        record: what the report tells; `record.resets` are the resets so far.
        accesses: what its Python code tells of what it touches.
        stall_watch: ends the run when a task does not give up the CPU.
        processor: what runs between two resets; a reset puts another one here.
        booted: virtual ns at which the mission became OPERATIONAL for the first time, None before.
        meet: lets those that fly beside it come to where it stands, and tells the virtual ns until which it may go on
            without them; None when it flies alone.
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
        self.spec = mission if isinstance(mission, MissionSpec) else read_mission(mission)
        self.seed = seed
        self.tasks, self.why_tasks = kind = task_kind(tasks)
        self.board = board if isinstance(board, BoardProfile) else load_profile(board or self.spec.board)
        limits = self.spec.limits.config(self.board, self.spec.has_nodes)
        ids = self.spec.ids
        self.config = replace(limits, cfe_version=self.spec.cfe_version, given=tuple(ids)).with_limits(ids)
        self.console = console if console is not None else Console()
        self.trace = Trace() if trace is None else trace
        self.record = RunRecord()
        self.files = FileSystem(self.spec.folder)
        self.network = Network()
        switch_ns = self.board.cpu_costs().switch_ns
        self._attachments = tuple(attachments)
        tick_ns = self.board.tick_ns
        self.kernel = kernel = make_kernel(kind.name, self.trace, policy, tick_ns, switch_ns, seed, self._kernel_class)
        self.trace.take_times(lambda: kernel.now)
        self.console.record = _noting_lines(self.trace, kernel, self.record.part(FailedCode))
        self.outside = Outside(self.kernel, self.network, self.trace)
        self.outside.do = HostActs(self).do
        self.kernel.on_task_error = _while_there_is_one(self._task_failed, False)
        self.accesses = Accesses(kernel)
        self.stall_watch = StallWatch(self.kernel, is_own=is_own_code)
        self.meet: Callable[[], int] | None = None
        self._first_boot: int | None = None
        self._resetting = self._is_closed = False
        self._provide_tables()
        self._machine = self._make_machine()
        self.processor = Processor(self._machine)
        for each in self._attachments:
            each.begin(self)
        self._power_up()

    def _power_up(self) -> None:
        for each in self._attachments:
            each.power_up(self.processor)

    def forget_files(self) -> None:
        """What the run wrote is gone; for a process that leaves it in the middle."""
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
        )

    def _provide_tables(self) -> None:
        """Put the default tables of shipped apps into /cf, where the mission has none of its own."""
        for package in self._packages():
            for table in sorted(package.glob("tables/*.tbl")):
                if self.files.find(f"/cf/{table.name}") is None:
                    self.files.write_file(f"/cf/{table.name}", table.read_bytes())

    def _packages(self) -> Iterator[Path]:
        """The folders of apps and libraries that are packages, in the order of the startup script."""
        for entry in self.spec.entries:
            code = None if entry.symbol == NODE_SYMBOL else find_code(entry.path, self.spec.folder)
            if isinstance(code, Path) and code.name == "__init__.py":
                yield code.parent

    # -- what runs now ---------------------------------------------------------------------------------------------

    @property
    def cfe(self) -> Cfe:
        """The handle of the services that run now."""
        return self.processor.cfe

    @property
    def memory(self) -> MemoryBudget:
        """The board's memory, as booked since the last reset."""
        return self.processor.memory

    @property
    def ros(self) -> RosRuntime | None:
        """The ROS side; None before the first node started."""
        return self.processor.ros

    def begin_ros(self) -> RosRuntime:
        """The ROS side, made if there was no node yet."""
        return self.processor.begin_ros()

    @property
    def run_files(self) -> Overlay | None:
        """What apps and nodes see of files, and wrote, until the mission is closed; None before it was needed."""
        return self._machine.run_files.made

    @property
    def booted(self) -> int | None:
        """Virtual ns at which the mission became OPERATIONAL for the first time, None before."""
        return self._first_boot if self._first_boot is not None else self.processor.booted

    @property
    def over(self) -> bool:
        """Whether the run has come to its end by itself: a node ended that the others cannot do without, or all did."""
        return self.ros is not None and bool(self.ros.monitor.over)

    @property
    def stall(self) -> StallError | None:
        """What the run was broken off for; None as long as each task has given up the CPU."""
        broken = self.kernel.broken
        return broken if isinstance(broken, StallError) else None

    # -- running ---------------------------------------------------------------------------------------------------

    def run_for(self, seconds: float) -> None:
        """Run for some virtual seconds more.

        Raises:
            StallError: a task does not give up the CPU.
            KeyboardInterrupt: and what a task outside any app raised.
        """
        self.run_until(self.kernel.now + round(seconds * NS_PER_S))

    def run_until(self, until_ns: int) -> None:
        """Run until a virtual time in ns, through every reset that is asked for on the way.

        Raises:
            StallError: a task does not give up the CPU.
            KeyboardInterrupt: Ctrl-C; the run can go on after it, if each task gave up the CPU soon.
            RuntimeError: the mission was closed.
        """
        if self._is_closed:
            raise RuntimeError("this mission is closed and cannot continue; boot another one")
        stop_ns = until_ns
        while True:
            if self.meet is not None:
                stop_ns = min(until_ns, self.meet())
            self._run_held_back(stop_ns)
            if stop_ns == until_ns or self.kernel.now < stop_ns:  # it is there, or was stopped on the way
                return

    def _run_held_back(self, until_ns: int) -> None:
        """Run until a virtual time in ns; a signal does not break off what a task is about."""
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
        """Say that the time of the run is over; what comes now is the shutdown."""
        for each in self._attachments:
            each.conclude()

    def shut_down_nodes(self) -> None:
        """Ask all ROS nodes to end, and give them a little virtual time for their shutdown hooks."""
        ros = self.ros
        if ros is None or self._resetting or self.kernel.broken is not None:
            return
        ros.begin_shutdown("the run is over")
        end = self.kernel.now + SHUTDOWN_NS
        while not ros.all_finished() and self.kernel.now < end and not self._resetting:
            self.kernel.run(min(end, self.kernel.now + SHUTDOWN_NS // 20))

    def finish(self) -> str:
        """The run is over: its digest. What tasks do while they are ended is no part of it."""
        digest = self.trace.digest()
        for each in self._attachments:
            each.finish()
        return digest

    def close(self) -> None:
        """End every task; the numbers stay readable.

        Raises:
            RuntimeError: the caller is in another process than the tasks, or for greenlets in another thread.
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
        """One that nobody has closed, and that nobody can any more: its threads must not outlive it.

        At the end of Python there is nothing to do any more, and its threads do not run.
        """
        if getattr(self, "_is_closed", True) or sys.is_finalizing():
            return
        warnings.warn(f"mission {self.spec.folder.name} was not closed", ResourceWarning, source=self, stacklevel=2)
        with suppress(RuntimeError):  # greenlets of another thread, or tasks of another process: no threads of ours
            self.close()

    # -- failures and resets ---------------------------------------------------------------------------------------

    def _task_failed(self, task: Task, error: BaseException) -> bool:
        """An exception came out of a task: say so, and let ES act as the startup script asks."""
        self.record.part(FailedCode).take(task, error, self.kernel.now)
        if task.owner is None or isinstance(error, PanicError):
            return False
        from cfepy.mission.tracebacks import app_traceback, reason

        self.console.write(f"{task.owner.name}: task {task.name} died of an exception")
        self.console.write(app_traceback(error))
        return self.cfe.es.take_fault(task, error, reason(error))

    def _on_restart(self, reset_type: int, why: str, fault: bool) -> None:
        """The PSP restarts the processor: come back to the host, which alone can end every task."""
        if not self._resetting:  # a `finally` block of a task that is being ended may ask once more
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
