"""Faults on time: the spacecraft clock jumps or drifts, the 1 Hz signal or the tone does not come.

Spacecraft time is STCF and MET (CFE_TIME); ROS nodes read the same clock by another way, and so does OSAL's local time.
The kernel's virtual time always goes on: it is what the simulation runs by. Imports its neighbours.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cfepy.faults.gate import Gate
from cfepy.faults.plan import Fault
from cfepy.faults.report import FaultReport
from cfepy.rtos.units import NS_PER_S

OSAL_TICK_NS = 100
PPM_NS = 1000  # in a second


def shift(processor: Any, by_ns: int, clock: str) -> None:
    """Set the spacecraft clock of cFE, of ROS nodes and of OSAL, or one of the first two.

    Args:
        processor: the one that runs.
        by_ns: how far, in ns; negative is back.
        clock: "all", "cfe" or "ros".
    """
    cfe = processor.cfe
    if clock != "ros":
        spacecraft = cfe.time.clock
        spacecraft.update(stcf=spacecraft.reference.stcf + (by_ns << 32) // NS_PER_S)
        cfe.os.set_local_time(cfe.os.get_local_time() + by_ns // OSAL_TICK_NS)
    if clock != "cfe" and processor.ros is not None:
        processor.ros.shift_clock(by_ns)


class Jump:
    """The clock jumps.

    Args:
        fault: what the plan says; its target is how far, in s.
        report: takes what happens.
    """

    def __init__(self, fault: Fault, report: FaultReport) -> None:
        self._fault = fault
        self._report = report

    def strike(self, processor: Any) -> None:
        """Do it now."""
        seconds = float(self._fault.target[0])
        clock = self._fault.options.get("clock", "all")
        self._report.happened(
            self._fault, f"sets the clock {'forward' if seconds > 0 else 'back'} by {abs(seconds):g} s"
        )
        shift(processor, round(seconds * NS_PER_S), clock)


class Drift:
    """The clock is set a little every second.

    Args:
        fault: what the plan says; its target is how fast, in ppm.
        gate: its window.
        report: is told once.
        again: has `strike` called at a virtual time, after a reset of the processor with the one that runs then.
    """

    def __init__(
        self, fault: Fault, gate: Gate, report: FaultReport, again: Callable[[int, Callable[[Any], object]], object]
    ) -> None:
        self._fault = fault
        self._gate = gate
        self._report = report
        self._again = again

    def strike(self, processor: Any) -> None:
        """A second is over; the next one follows as long as the window is open."""
        now = processor.machine.kernel.now
        if not self._gate.is_open(now):
            return
        ppm = float(self._fault.target[0])
        if not self._gate.seen:
            self._report.happened(self._fault, f"lets the clock drift by {ppm:g} ppm")
        self._gate.seen += 1
        shift(processor, round(ppm * PPM_NS), self._fault.options.get("clock", "all"))
        self._again(now + NS_PER_S, self.strike)


class LostSignal:
    """The local 1 Hz signal, or the tone, does not come.

    Args:
        fault: what the plan says; its target is "1hz" or "tone".
        gate: which ones.
        report: takes what happens.
        kernel: for the time.
    """

    def __init__(self, fault: Fault, gate: Gate, report: FaultReport, kernel: Any) -> None:
        self._fault = fault
        self._gate = gate
        self._report = report
        self._kernel = kernel

    def power_up(self, processor: Any) -> None:
        """Stand between a new processor's Time Services and their signal."""
        task = processor.cfe.time.task
        name = "interrupt" if self._fault.target[0] == "1hz" else "take_tone"
        pass_on = getattr(task, name)

        def interrupt(latch: int) -> None:
            if self._gate.opens(self._kernel.now):
                self._report.happened(self._fault, f"keeps back the {'1 Hz signal' if name == 'interrupt' else 'tone'}")
            else:
                pass_on(latch)

        setattr(task, name, interrupt)
