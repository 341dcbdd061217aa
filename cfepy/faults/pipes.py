"""A pipe that takes no message for a while, as if it were full: its senders see an overflow.

Imports cfepy.sb and cfepy.rtos.
"""

from __future__ import annotations

from typing import Any

from cfepy.faults.agenda import Agenda
from cfepy.faults.plan import Fault
from cfepy.faults.report import FaultReport
from cfepy.rtos import WaitList
from cfepy.sb.pipe import Pipe


class ShutWaitList(WaitList):
    """Readers who wait, whom no sender sees."""

    __slots__ = ()

    def __bool__(self) -> bool:
        return False


class FullPipe(Pipe):
    """A pipe without room, which is nevertheless there."""

    __slots__ = ()

    def is_closed(self) -> bool:
        """See `Pipe.is_closed`; a depth of 0 does not mean here that the pipe was deleted."""
        return False


class Fill:
    """Fills one pipe.

    Args:
        fault: what the plan says; its target is the pipe's name.
        agenda: ends it.
        report: takes what happens.
    """

    def __init__(self, fault: Fault, agenda: Agenda, report: FaultReport) -> None:
        self._fault = fault
        self._agenda = agenda
        self._report = report

    def strike(self, processor: Any) -> None:
        """Do it now."""
        name, now = self._fault.target[0], processor.machine.kernel.now
        pipe = next((each for each in processor.cfe.sb.pipes if each.name == name), None)
        if pipe is None or type(pipe) is not Pipe:
            why = f"there is no pipe {name}" if pipe is None else f"pipe {name} is full already"
            self._report.missed(self._fault, f"{why} at {now / 1e9:g} s")
            return
        duration_ns = self._fault.options.get("for")
        self._report.happened(self._fault, f"fills pipe {name} of {pipe.app_name}")
        depth, keeps_newest = pipe.depth, pipe.keeps_newest
        # The very objects stay: those who have the pipe, and tasks that wait at it, must not notice anything.
        pipe.__class__, pipe.waits.__class__ = FullPipe, ShutWaitList
        pipe.depth, pipe.keeps_newest = 0, False
        if duration_ns is not None:
            self._agenda.add(now + duration_ns, lambda: _empty(processor, pipe, depth, keeps_newest))


def _empty(processor: Any, pipe: Pipe, depth: int, keeps_newest: bool) -> None:
    """The pipe takes messages again, unless it was deleted meanwhile."""
    pipe.__class__, pipe.waits.__class__ = Pipe, WaitList
    if processor.cfe.sb.find_pipe(pipe.pipe_id) is pipe:
        pipe.depth, pipe.keeps_newest = depth, keeps_newest
