"""Faults on applications: crash, hang, slow, stop, restart.

Imports its neighbours; applications are those of Executive Services, found by name when the fault happens.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

from cfepy.faults.gate import Gate
from cfepy.faults.plan import Fault
from cfepy.faults.report import FaultReport
from cfepy.faults.strain import Strain
from cfepy.rtos.errors import InjectedCrash
from cfepy.status import CfeError


class AppFault(ABC):
    """A fault on one application.

    Args:
        fault: what the plan says.
        app_name: the application.
        report: takes what happens.
    """

    def __init__(self, fault: Fault, app_name: str, report: FaultReport) -> None:
        self.fault = fault
        self.app_name = app_name
        self.report = report

    def strike(self, processor: Any) -> None:
        """Do it now, from the task of the faults."""
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
    def _do(self, processor: Any, app: Any) -> None:
        """Do it to an application of the processor."""

    def _happened(self, text: str) -> None:
        self.report.happened(self.fault, text)


class Crash(AppFault):
    """An exception comes out of the call that its main task waits in, or out of its next one."""

    def _do(self, processor: Any, app: Any) -> None:
        record = app.tasks.get(app.main_task_id)
        if record is None or record.task is None or not record.task.started or record.task.done:
            self.report.missed(self.fault, f"the main task of {self.app_name} does not run")
            return
        self._happened(f"crashes {self.app_name}")
        processor.machine.kernel.interrupt(record.task, InjectedCrash(f"fault {self.fault.name}"))


class Hang(AppFault):
    """None of its tasks comes back from its next call.

    Args:
        fault: what the plan says.
        app_name: the application.
        report: takes what happens.
        strain: holds its tasks.
    """

    def __init__(self, fault: Fault, app_name: str, report: FaultReport, strain: Strain) -> None:
        super().__init__(fault, app_name, report)
        self._strain = strain

    def _do(self, processor: Any, app: Any) -> None:
        duration_ns = self.fault.options.get("for")
        self._happened(f"lets {self.app_name} hang" + (f" for {duration_ns / 1e9:g} s" if duration_ns else ""))
        self._strain.hang(app, None if duration_ns is None else processor.machine.kernel.now + duration_ns)


class Stop(AppFault):
    """Executive Services end it, as a command would."""

    def _do(self, processor: Any, app: Any) -> None:
        processor.cfe.es.delete_app(app.app_id)
        self._happened(f"stops {self.app_name}")


class Restart(AppFault):
    """Executive Services end it and start it anew, as a command would."""

    def _do(self, processor: Any, app: Any) -> None:
        processor.cfe.es.restart_app(app.app_id)
        self._happened(f"restarts {self.app_name}")


class Slow:
    """Its calls take more CPU time. What it costs is asked by `Strain` at each call.

    Args:
        fault: what the plan says.
        gate: its window.
        report: is told at the first call of each application, once.
        kernel: for the time.
    """

    def __init__(self, fault: Fault, gate: Gate, report: FaultReport, kernel: Any) -> None:
        self._fault = fault
        self._gate = gate
        self._report = report
        self._kernel = kernel
        self._told: list[str] = []
        self._times = fault.options.get("times", 1.0)
        self._extra_ns = fault.options.get("extra", 0)

    def burden(self, app_name: str, charged_ns: int) -> int:
        """More CPU time in ns for a call of an application that takes `charged_ns` by itself."""
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


CLASSES: dict[str, type[AppFault]] = {"crash": Crash, "stop": Stop, "restart": Restart}
