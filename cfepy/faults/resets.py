"""Faults on the processor: it is reset, a core application dies, the watchdog bites.

Imports cfepy.psp and its neighbours.
"""

from __future__ import annotations

from typing import Any

from cfepy.faults.plan import Fault
from cfepy.faults.report import FaultReport
from cfepy.psp.psp import RST_TYPE_POWERON, RST_TYPE_PROCESSOR
from cfepy.rtos.errors import InjectedCrash

VICTIM = "CFE_TBL"
"""A core application, out of which an exception comes: ES cannot restart it, and so reset the processor."""

TYPES = {"processor": RST_TYPE_PROCESSOR, "poweron": RST_TYPE_POWERON}


class ProcessorFault:
    """A reset.

    Args:
        fault: what the plan says; its target is the kind of reset.
        report: takes what happens.
    """

    def __init__(self, fault: Fault, report: FaultReport) -> None:
        self._fault = fault
        self._report = report

    def strike(self, processor: Any) -> None:
        """Do it now; the calling task does not come back from a reset."""
        how = self._fault.target[0]
        if how == "exception":
            self._raise(processor)
        elif how == "watchdog":
            self._report.happened(self._fault, "lets the watchdog bite")
            processor.psp.bite(f"the watchdog bites (fault {self._fault.name})")
        else:
            self._report.happened(self._fault, f"asks for a {how} reset")
            processor.cfe.es.reset_cfe(TYPES[how])

    def _raise(self, processor: Any) -> None:
        es = processor.cfe.es
        app = next((each for each in es.apps if each.name == VICTIM), None)
        record = None if app is None else app.tasks.get(app.main_task_id)
        if record is None or record.task is None or not record.task.started:
            self._report.missed(self._fault, f"{VICTIM} does not run yet")
            return
        self._report.happened(self._fault, f"lets an exception come out of {VICTIM}")
        processor.machine.kernel.interrupt(record.task, InjectedCrash(f"fault {self._fault.name}"))
