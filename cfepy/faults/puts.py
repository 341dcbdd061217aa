"""A Software Bus whose puts into pipes can fail, as NASA's bus puts them by OS_QueuePut.

Whether a put fails is decided in the very instant in which the bus makes it, where it asks a destination for its
message limit. So the bus itself need not know of faults, and other tasks, which may run while a message goes to its
receivers, are not concerned. Imports cfepy.sb and its neighbours.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from cfepy.faults.calls import CallFault, caller_of
from cfepy.rtos import Kernel, Task
from cfepy.sb import SoftwareBus
from cfepy.sb import events as ev
from cfepy.sb.pipe import Pipe
from cfepy.sb.routing import Destination, Route
from cfepy.status import OS_QUEUE_FULL

_limit = Destination.__dict__["limit"].__get__


class Puts:
    """The puts into pipes of a run, and which of them fail; none before `begin`."""

    def __init__(self) -> None:
        self._faults: Sequence[CallFault] = ()
        self._refused: dict[Task, dict[Pipe, int]] = {}  # of the transmission that a task is in, with the status

    def begin(self, faults: Sequence[CallFault]) -> None:
        """Take the faults of a run."""
        self._faults = faults
        self._refused.clear()

    @contextmanager
    def transmitting(self, task: Task) -> Iterator[None]:
        """Around a transmission; within one of them a task may begin another, of an event about it."""
        before = self._refused.get(task)
        self._refused[task] = {}
        try:
            yield
        finally:
            del self._refused[task]
            if before is not None:
                self._refused[task] = before

    def refuses(self, task: Task, pipe: Pipe) -> bool:
        """Whether a task puts a message into a pipe now, and that fails."""
        refused = self._refused.get(task)
        if refused is None:
            return False
        statuses = [fault.put_status(caller_of(task), pipe.name) for fault in self._faults]  # each counts each put
        failed = [status for status in statuses if status is not None]
        if failed:
            refused[pipe] = failed[0]
        return bool(failed)

    def status(self, task: Task, pipe: Pipe) -> int | None:
        """What the put into a pipe failed with; None when no fault let it fail."""
        return self._refused.get(task, {}).get(pipe)


def refusing(base: type[SoftwareBus], puts: Puts) -> type[SoftwareBus]:
    """A class of Software Bus with puts that fail.

    Args:
        base: the class to start from.
        puts: says which.
    """

    class RefusingBus(base):  # type: ignore[misc, valid-type]  # mypy does not follow a class that is an argument
        """A Software Bus that cannot put some messages into some pipes."""

        def __init__(self, kernel: Kernel, *args: Any) -> None:
            super().__init__(kernel, *args)
            self._refusable = _refusable(kernel, puts)

        def _add(self, route: Route, pipe: Pipe, limit: int, scope: int) -> None:
            super()._add(route, pipe, limit, scope)
            route.destinations[0].__class__ = self._refusable

        def transmit_msg(self, packet: bytes | bytearray, is_origination: bool = True) -> None:
            """See `SoftwareBus.transmit_msg`."""
            with puts.transmitting(self.kernel.current):
                super().transmit_msg(packet, is_origination)

        def _report_failures(self, msg_id: int, failures: list[tuple[int, Destination]]) -> None:
            super()._report_failures(msg_id, [self._as_it_is(*failure) for failure in failures])

        def _as_it_is(self, event_id: int, destination: Destination) -> tuple[int, Destination]:
            """A failure as it is to be told: a put that failed is no message limit."""
            status = puts.status(self.kernel.current, destination.pipe)
            if status is None:
                return event_id, destination
            destination.limit_drops -= 1
            destination.overflow_drops += 1
            return ev.Q_FULL_ERR_EID if status == OS_QUEUE_FULL else ev.Q_WR_ERR_EID, destination

        def _report_failure(self, event_id: int, msg_id: int, pipe: Pipe) -> None:
            if event_id != ev.Q_WR_ERR_EID:
                super()._report_failure(event_id, msg_id, pipe)
                return
            pipe.overflows += 1
            self._report_write_error(msg_id, pipe, puts.status(self.kernel.current, pipe))

    return RefusingBus


def _refusable(kernel: Kernel, puts: Puts) -> type[Destination]:
    """A kind of destination that takes no message while a put into its pipe fails."""

    class RefusableDestination(Destination):
        """One whose message limit is asked for right before each put."""

        __slots__ = ()

        @property
        def limit(self) -> int:  # type: ignore[override]  # nobody changes it
            """The message limit; as if it were reached when the put fails."""
            limit: int = _limit(self)
            waiting = self.puts - self.gets
            return waiting if waiting < limit and puts.refuses(kernel.current, self.pipe) else limit

    return RefusableDestination
