"""Faults on the processor: its clock, its resets, and its memory.

The spacecraft clock jumps or drifts, or the 1 Hz signal or the tone is missing. Spacecraft time is STCF and MET
(CFE_TIME); ROS nodes and OSAL's local time read the same clock in other ways. The kernel's virtual time, by which the
simulation runs, is not affected. The processor is reset, a core application dies, or the watchdog expires. Files, table
images, the CDS and other retained memory are changed.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from random import Random
from typing import Any

from cfepy.faults.fault_plan import Fault
from cfepy.faults.fault_report import FaultReport
from cfepy.faults.message_faults import damaged
from cfepy.faults.timing import Gate
from cfepy.mission import FailedCode, Processor
from cfepy.osal import OsTime
from cfepy.psp import RST_TYPE_POWERON, RST_TYPE_PROCESSOR
from cfepy.rtos import InjectedCrash, Kernel
from cfepy.status import CfeError
from cfepy.units import NS_PER_S

OSAL_TICK_NS = 100
PPM_NS = 1000  # 1 ppm of a second
VICTIM = "CFE_TBL"
"""A core application that is ended by an exception: ES cannot restart it, and thus resets the processor."""
TYPES = {"processor": RST_TYPE_PROCESSOR, "poweron": RST_TYPE_POWERON}
DEFAULT_SIGNATURE = {"bytes": {0: 0}}


def shift(processor: Processor, by_ns: int, clock: str) -> None:
    """Set the spacecraft clock of cFE, ROS nodes and OSAL, or one of the first two.

    Args:
        processor: the running processor.
        by_ns: change in ns; negative is back.
        clock: "all", "cfe" or "ros".
    """
    cfe = processor.cfe
    if clock != "ros":
        spacecraft = cfe.time.clock
        spacecraft.update(stcf=spacecraft.reference.stcf + (by_ns << 32) // NS_PER_S)
        cfe.os.set_local_time(OsTime(cfe.os.get_local_time() + by_ns // OSAL_TICK_NS))
    if clock != "cfe" and processor.ros is not None:
        processor.ros.shift_clock(by_ns)


Again = Callable[[int, Callable[[Processor], object]], object]
"""Calls a function at a virtual time, with the processor that runs then."""


class Jump:
    """The clock jumps.

    Args:
        fault: the fault in the plan; its target is the change in s.
        report: receives a text for each occurrence.
    """

    def __init__(self, fault: Fault, report: FaultReport) -> None:
        self._fault = fault
        self._report = report

    def strike(self, processor: Processor) -> None:
        """Set the clock now."""
        seconds = float(self._fault.target[0])
        clock = self._fault.options.get("clock", "all")
        self._report.happened(
            self._fault, f"sets the clock {'forward' if seconds > 0 else 'back'} by {abs(seconds):g} s"
        )
        shift(processor, round(seconds * NS_PER_S), clock)


class Drift:
    """The clock drifts: it is adjusted every second.

    Args:
        fault: the fault in the plan; its target is the drift in ppm.
        gate: its window.
        report: called once.
        again: calls `strike` at a virtual time, after a reset with the processor that runs then.
    """

    def __init__(
        self,
        fault: Fault,
        gate: Gate,
        report: FaultReport,
        again: Again,
    ) -> None:
        self._fault = fault
        self._gate = gate
        self._report = report
        self._again = again

    def strike(self, processor: Processor) -> None:
        """Adjust the clock after a second; the next call follows as long as the window is open."""
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
    """The local 1 Hz signal, or the tone, is missing.

    Args:
        fault: the fault in the plan; its target is "1hz" or "tone".
        gate: selects the signals.
        report: receives a text for each occurrence.
        kernel: for the time.
    """

    def __init__(self, fault: Fault, gate: Gate, report: FaultReport, kernel: Kernel) -> None:
        self._fault = fault
        self._gate = gate
        self._report = report
        self._kernel = kernel

    def power_up(self, processor: Processor) -> None:
        """Wrap the signal of a new processor's Time Services."""
        task = processor.cfe.time.task
        name = "interrupt" if self._fault.target[0] == "1hz" else "take_tone"
        pass_on = getattr(task, name)

        def interrupt(latch: int) -> None:
            if self._gate.opens(self._kernel.now):
                self._report.happened(self._fault, f"keeps back the {'1 Hz signal' if name == 'interrupt' else 'tone'}")
            else:
                pass_on(latch)

        setattr(task, name, interrupt)


class ProcessorFault:
    """A reset.

    Args:
        fault: the fault in the plan; its target is the kind of reset.
        report: receives a text for each occurrence.
    """

    def __init__(self, fault: Fault, report: FaultReport) -> None:
        self._fault = fault
        self._report = report

    def strike(self, processor: Processor) -> None:
        """Reset the processor now; the calling task does not return."""
        how = self._fault.target[0]
        if how == "exception":
            self._raise(processor)
        elif how == "watchdog":
            self._report.happened(self._fault, "lets the watchdog bite")
            processor.psp.bite(f"the watchdog bites (fault {self._fault.name})")
        else:
            self._report.happened(self._fault, f"asks for a {how} reset")
            processor.cfe.es.reset_cfe(TYPES[how])

    def _raise(self, processor: Processor) -> None:
        es = processor.cfe.es
        app = next((each for each in es.apps if each.name == VICTIM), None)
        record = None if app is None else app.tasks.get(app.main_task_id)
        if record is None or record.task is None or not record.task.started:
            self._report.missed(self._fault, f"{VICTIM} does not run yet")
            return
        self._report.happened(self._fault, f"lets an exception come out of {VICTIM}")
        processor.machine.record.part(FailedCode).crashed.add(VICTIM)
        processor.machine.kernel.interrupt(record.task, InjectedCrash(f"fault {self._fault.name}"))


class MemoryFault(ABC):
    """A fault on some bytes.

    Args:
        fault: the fault in the plan.
        random: chooses random bits.
        report: receives a text for each occurrence.
    """

    def __init__(self, fault: Fault, random: Random, report: FaultReport) -> None:
        self._fault = fault
        self._random = random
        self._report = report

    def strike(self, processor: Processor) -> None:
        """Change the bytes now."""
        try:
            memory, what = self._find(processor)
        except (CfeError, LookupError) as error:
            self._report.missed(self._fault, error.args[0] if isinstance(error, LookupError) else str(error))
            return
        if not len(memory):
            self._report.missed(self._fault, f"{what} is empty")
            return
        memory[:] = damaged(bytes(memory), 0, self._options(), self._random)
        self._report.happened(self._fault, f"changes {what}")

    def _options(self) -> Any:
        return self._fault.options

    @abstractmethod
    def _find(self, processor: Processor) -> tuple[Any, str]:
        """Return the bytes, which can be written in place, and their description.

        Raises:
            CfeError, LookupError: there are none; the latter with a text.
        """


class FileFault(MemoryFault):
    """A file of the virtual file system."""

    def _find(self, processor: Processor) -> tuple[Any, str]:
        path = self._fault.target[0]
        node = processor.machine.files.find(path)
        if node is None:
            raise LookupError(f"the file {path} does not exist at {processor.machine.kernel.now / 1e9:g} s")
        return node.data, f"file {path}"


class TableFault(MemoryFault):
    """The active image of a table."""

    def _find(self, processor: Processor) -> tuple[Any, str]:
        name = self._fault.target[0]
        registry = processor.cfe.tbl.registry
        table = registry.find(name)
        active = None if table is None else registry.active(table)
        if table is None or active is None:
            raise LookupError(f"the table {name} does not exist at {processor.machine.kernel.now / 1e9:g} s")
        return table.image(active), f"table {name}"


class RetainedFault(MemoryFault):
    """Memory that survives a reset: the CDS or a block of it, the EEPROM, the reset and the user reserved area."""

    def _options(self) -> Any:
        """By default the CDS as a whole loses its signature, so the next boot does not find it."""
        options = self._fault.options
        whole_cds = self._fault.target[0] == "cds" and "block" not in options
        return DEFAULT_SIGNATURE if whole_cds and not {"bits", "bytes"} & set(options) else options

    def _find(self, processor: Processor) -> tuple[Any, str]:
        area, block_name = self._fault.target[0], self._fault.options.get("block")
        memory = memoryview(getattr(processor.machine.retained, area))
        if block_name is None:
            return memory, f"the {area.upper()}" if area != "user_reserved" else "the user reserved area"
        store = processor.cfe.es.cds
        if store is None:
            raise LookupError("the CDS does not exist yet")
        block = store.named(block_name)
        start = block.offset + block.size - block.user_size
        return memory[start : start + block.user_size], f"CDS block {block_name}"


MEMORY_FAULTS: dict[str, type[MemoryFault]] = {
    "corrupt_file": FileFault,
    "corrupt_table": TableFault,
    "corrupt_memory": RetainedFault,
}
