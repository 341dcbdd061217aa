"""Faults on applications: crash, hang, slow, compute, stop, restart.

Applications are found in Executive Services by name when the fault happens. For applications that hang, are slow or
compute longer, the calls of the kernel are wrapped, but only in runs whose plan contains such faults.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from fnmatch import fnmatchcase
from typing import Any

from cfepy.faults.fault_plan import Fault
from cfepy.faults.fault_report import FaultReport
from cfepy.faults.timing import Gate
from cfepy.mission import FailedCode, Processor
from cfepy.rtos import FOREVER, InjectedCrash, Kernel, Task, WaitList, wrapping
from cfepy.sb import Pipe
from cfepy.status import CfeError

CALLS = ("wait_on", "delay", "yield_cpu", "charge")
WAITS = ("wait_on", "delay")
COMPUTES = ("compute",)

IsCalled = Callable[[bytes | bytearray, str], bool]
"""Returns whether a packet is one of the messages named in a plan."""


class AppFault(ABC):
    """A fault on one application.

    Args:
        fault: the fault in the plan.
        app_name: the application.
        report: receives a text for each occurrence.
    """

    def __init__(self, fault: Fault, app_name: str, report: FaultReport) -> None:
        self.fault = fault
        self.app_name = app_name
        self.report = report

    def strike(self, processor: Processor) -> None:
        """Execute it now, from the task of the faults."""
        es = processor.cfe.es
        app = next((each for each in es.apps if each.name == self.app_name), None)
        if app is None:
            self.report.missed(
                self.fault, f"no application {self.app_name} runs at {processor.machine.kernel.now / 1e9:g} s"
            )
            return
        try:
            self._do(processor, app)
        except CfeError as error:
            self.report.missed(self.fault, str(error))

    @abstractmethod
    def _do(self, processor: Processor, app: Any) -> None:
        """Apply it to an application of the processor."""

    def _happened(self, text: str) -> None:
        self.report.happened(self.fault, text)


class Crash(AppFault):
    """Raises an exception in the call in which the application's main task waits, or in its next one."""

    def _do(self, processor: Processor, app: Any) -> None:
        record = app.tasks.get(app.main_task_id)
        if record is None or record.task is None or not record.task.started or record.task.done:
            self.report.missed(self.fault, f"the main task of {self.app_name} does not run")
            return
        self._happened(f"crashes {self.app_name}")
        processor.machine.record.part(FailedCode).crashed.add(self.app_name)
        processor.machine.kernel.interrupt(record.task, InjectedCrash(f"fault {self.fault.name}"))


class Hang(AppFault):
    """Stops each of its tasks in its next call.

    Args:
        fault: the fault in the plan.
        app_name: the application.
        report: receives a text for each occurrence.
        strain: holds its tasks.
    """

    def __init__(self, fault: Fault, app_name: str, report: FaultReport, strain: Strain) -> None:
        super().__init__(fault, app_name, report)
        self._strain = strain

    def _do(self, processor: Processor, app: Any) -> None:
        duration_ns = self.fault.options.get("for")
        self._happened(f"lets {self.app_name} hang" + (f" for {duration_ns / 1e9:g} s" if duration_ns else ""))
        self._strain.hang(app, None if duration_ns is None else processor.machine.kernel.now + duration_ns)


class Stop(AppFault):
    """Executive Services end the application, as with a command."""

    def _do(self, processor: Processor, app: Any) -> None:
        processor.cfe.es.delete_app(app.app_id)
        self._happened(f"stops {self.app_name}")


class Restart(AppFault):
    """Executive Services restart the application, as with a command."""

    def _do(self, processor: Processor, app: Any) -> None:
        processor.cfe.es.restart_app(app.app_id)
        self._happened(f"restarts {self.app_name}")


class Slow:
    """Its calls use more CPU time; `Strain` asks for the cost at each call.

    Args:
        fault: the fault in the plan.
        gate: its window.
        report: called once for each application, at its first call.
        kernel: for the time.
    """

    def __init__(self, fault: Fault, gate: Gate, report: FaultReport, kernel: Kernel) -> None:
        self._fault = fault
        self._gate = gate
        self._report = report
        self._kernel = kernel
        self._told: list[str] = []
        self._times = fault.options.get("times", 1.0)
        self._extra_ns = fault.options.get("extra", 0)

    def burden(self, app_name: str, charged_ns: int) -> int:
        """Return the additional CPU time in ns for a call of an application that costs `charged_ns`."""
        if app_name not in self._fault.target:
            return 0
        self._gate.seen += 1
        if not self._gate.is_open(self._kernel.now):
            return 0
        if app_name not in self._told:
            self._told.append(app_name)
            self._report.happened(self._fault, f"slows down {app_name}")
        more: int = self._extra_ns + round(charged_ns * (self._times - 1))
        return more


APP_FAULTS: dict[str, type[AppFault]] = {"crash": Crash, "stop": Stop, "restart": Restart}


class Strain:
    """Effects of faults on applications in the kernel's calls."""

    def __init__(self) -> None:
        self._wait_on: Callable[..., Any] = Kernel.wait_on
        self._charge: Callable[[Kernel, int], None] = Kernel.charge
        self._hanging: dict[int, tuple[Any, int | None]] = {}  # by identity: the application, and when it continues
        self.burdens: list[Callable[[str, int], int]] = []

    def kernel(self, base: type[Kernel]) -> type[Kernel]:
        self._wait_on, self._charge = base.wait_on, base.charge
        return wrapping(base, {**dict.fromkeys(CALLS, self._wrapped), "charge": self._charging})

    def hang(self, app: Any, until_ns: int | None) -> None:
        """Let no task of an application return from its next call before a time; None for never."""
        self._hanging[id(app)] = app, until_ns

    def _charging(self, original: Callable[..., Any]) -> Callable[..., Any]:
        return self._wrapped(original, is_charge=True)

    def _wrapped(self, original: Callable[..., Any], is_charge: bool = False) -> Callable[..., Any]:
        """Return one of the kernel's methods, with an additional cost before it and a check of hanging after it."""

        def call(kernel: Kernel, *args: Any) -> Any:
            task = kernel.current
            owner = task.owner
            if owner is None or task.dying:
                return original(kernel, *args)
            more_ns = sum(burden(owner.name, args[0] if is_charge else 0) for burden in self.burdens)
            if more_ns:
                self._charge(kernel, more_ns)
            result = original(kernel, *args)
            if self._hanging and not task.dying:
                self._hold(kernel, task)
            return result

        return call

    def _hold(self, kernel: Kernel, task: Any) -> None:
        """Keep the calling task as long as its application hangs."""
        held = self._hanging.get(id(task.owner))
        if held is None:
            return
        until_ns = held[1]
        if until_ns is None:
            self._wait_on(kernel, WaitList("the end of a fault: its application hangs"), FOREVER)
        elif until_ns > kernel.now:
            self._wait_on(kernel, WaitList("the end of a fault: its application hangs"), until_ns - kernel.now)


class Work:
    """Makes applications' work take longer, at its start or where its duration is given.

    A task's work begins where a wait ends, but for one for a mutex: as a `response` among the deadlines of a mission
    file does. Computing time given by a task is a call of `Kernel.compute`, which is below `cfe.psp.compute`,
    `cfepy.compute` and `compute:` of a node.

    Args:
        fault: the fault in the plan: with `for` a task computes for that additional time after it took the `message`,
            or after a wait; with `times` its computations take that many times as long.
    """

    def __init__(self, fault: Fault) -> None:
        self._fault = fault
        self._gate: Gate
        self._report: FaultReport
        self._kernel: Kernel
        self._more_ns: int = fault.options.get("for", 0)
        self._times: float = fault.options.get("times", 1.0)
        self._task: str = fault.options.get("task", "*")
        self._compute: Callable[[Kernel, int], None] = Kernel.compute

    def kernel(self, base: type[Kernel]) -> type[Kernel]:
        self._compute = base.compute
        if "message" in self._fault.options:
            return base
        names, wrapped = (COMPUTES, self._stretching) if "times" in self._fault.options else (WAITS, self._waiting)
        return wrapping(base, dict.fromkeys(names, wrapped))

    def begin(self, fault: Fault, gate: Gate, report: FaultReport, kernel: Kernel) -> None:
        """The mission was created.

        Args:
            fault: the fault in the plan, with applications by their cFE names.
            gate: at which of its occasions it happens.
            report: called each time.
            kernel: kernel of the derived class.
        """
        self._fault, self._gate, self._report, self._kernel = fault, gate, report, kernel

    def on_take(self, packet: bytes | bytearray, pipe: Pipe, is_called: IsCalled) -> None:
        """An application took a message out of its pipe: its work on it takes longer.

        Args:
            packet: the message.
            pipe: its pipe.
            is_called: returns whether it is the one named in the plan.
        """
        task = self._kernel.current
        if self._means(task) and is_called(packet, self._fault.options["message"]):
            self._works(task)

    def _means(self, task: Task) -> bool:
        owner = task.owner
        return owner is not None and owner.name in self._fault.target and fnmatchcase(task.name, self._task)

    def _works(self, task: Task) -> None:
        """Compute, if this is one of its occasions."""
        if self._gate.opens(self._kernel.now):
            self._report.happened(self._fault, f"lets {task.name} compute for {self._more_ns / 1e9:g} s")
            self._compute(self._kernel, self._more_ns)

    def _waiting(self, original: Callable[..., Any]) -> Callable[..., Any]:
        """One of the kernel's waits, after which work starts."""

        def wait(kernel: Kernel, *args: Any) -> Any:
            task = kernel.current
            is_work = task.mutex is not None  # waiting for a mutex is part of the work
            result = original(kernel, *args)
            if not is_work and not task.dying and self._means(task):
                self._works(task)
            return result

        return wait

    def _stretching(self, original: Callable[[Kernel, int], None]) -> Callable[[Kernel, int], None]:
        """Return the kernel's `compute`, in which work takes several times as long."""

        def compute(kernel: Kernel, duration_ns: int) -> None:
            if duration_ns and self._means(kernel.current) and self._gate.opens(kernel.now):
                longer_ns = round(duration_ns * self._times)
                what = (
                    f"lets {kernel.current.name} compute for {longer_ns / 1e9:g} s instead of {duration_ns / 1e9:g} s"
                )
                self._report.happened(self._fault, what)
                duration_ns = longer_ns
            original(kernel, duration_ns)

        return compute
