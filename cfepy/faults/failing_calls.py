"""Simulated failures: calls of cFE, OSAL or PSP, the bus's puts into pipes, and full pipes.

The method of one processor's service is wrapped, under the name that applications call it by. The Software Bus puts
messages into pipes as NASA's does by OS_QueuePut: whether such a put fails is decided exactly when the bus does it,
where it asks a destination for its message limit. So the bus does not need to know faults, and other tasks that run
while a message is delivered are not affected.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from types import MethodType
from typing import Any

from cfepy.faults.call_faults import QUEUE_GET, call_name, status_of
from cfepy.faults.fault_plan import Fault
from cfepy.faults.fault_report import FaultReport
from cfepy.faults.timing import Agenda, Gate
from cfepy.ids import OS_STREAM_BASE
from cfepy.mission import Processor
from cfepy.rtos import Kernel, Task
from cfepy.sb import NOBODY_HEARD, Destination, Pipe, PutHook, SoftwareBus
from cfepy.sb import events as ev
from cfepy.status import OS_QUEUE_FULL, CfeError, OsalError


def why_not_called(fault: Fault) -> str:
    """Return why a fault of a function that was never called did not happen."""
    call = call_name(fault.target[0])
    hint = "; pipes are read without it: use a fault of CFE_SB_ReceiveBuffer" if call == QUEUE_GET else ""
    return f"no matching task called {call}{hint}"


def caller_of(task: Task) -> str:
    """Return the description of a task's application."""
    return "the system" if task.owner is None else str(task.owner.name)


class CallFault:
    """Makes calls of one function fail.

    Args:
        fault: the fault in the plan.
        gate: selects the calls.
        report: receives a text for each occurrence.
        kernel: gives the caller and the time.
    """

    def __init__(self, fault: Fault, gate: Gate, report: FaultReport, kernel: Kernel) -> None:
        self._fault = fault
        self._gate = gate
        self._report = report
        self._kernel = kernel
        self._call = call_name(fault.target[0])
        self._status = status_of(self._call, fault.options.get("status"))
        self._app: str | None = fault.options.get("app")
        self._object: str | None = fault.options.get("object")
        self._processor: Processor | None = None

    def power_up(self, processor: Processor) -> None:
        """Wrap the function of a new processor; for one of the Software Bus its class does so (`failing`)."""
        self._processor = processor
        service_name, _, method = self._call.partition(".")
        service = getattr(processor.cfe, service_name)
        if service is not processor.cfe.sb:
            call = self._wrapped(getattr(service, method))
            setattr(service, method, MethodType(call, service))  # other attachments wrap methods too

    def _wrapped(self, original: Callable[..., Any]) -> Callable[..., Any]:
        def call(_: object, *args: Any, **named: Any) -> Any:
            self.strike(args)
            return original(*args, **named)

        return call

    def strike(self, args: tuple[Any, ...]) -> None:
        """The function is called with these arguments.

        Raises:
            CfeError: if it fails.
        """
        caller = caller_of(self._kernel.current)
        if self._is_meant(caller, args) and self._gate.opens(self._kernel.now):
            error = self._error()
            self._report.happened(self._fault, f"lets {self._call} of {caller} fail with {error.name}")
            raise error

    def put_status(self, caller: str, pipe: str) -> int | None:
        """Return the error of the Software Bus's put into a pipe, as one of these calls; None if it does not fail.

        Args:
            caller: sender of the message.
            pipe: name of the pipe.
        """
        if self._app not in (None, caller) or self._object not in (None, pipe):
            return None
        if not self._gate.opens(self._kernel.now):
            return None
        text = f"lets {self._call} of {caller} into pipe {pipe} fail with {self._error().name}"
        self._report.happened(self._fault, text)
        return self._status

    def _is_meant(self, caller: str, args: tuple[Any, ...]) -> bool:
        if self._processor is None or self._app not in (None, caller):
            return False
        return self._object is None or any(self._object == name for name in _names(args, self._processor))

    def _error(self) -> CfeError:
        kind = OsalError if self._call.startswith(("os.", "psp.")) else CfeError
        return kind(self._status, f"fault {self._fault.name}")


def _names(args: tuple[Any, ...], processor: Processor) -> list[str]:
    """Return the names in the arguments of a call: texts, and names of objects given by id."""
    found = []
    for each in args:
        if isinstance(each, str):
            found.append(each)
        elif isinstance(each, int):
            found += _name_of(each, processor)
    return found


def _name_of(number: int, processor: Processor) -> list[str]:
    """Return the names of the object with an id: a pipe, an OSAL object, or the path of an open file."""
    pipe = processor.cfe.sb.find_pipe(number)
    if pipe is not None:
        return [pipe.name]
    os = processor.cfe.os
    try:
        found = [os.get_resource_name(number)]
        return [*found, os.fd_get_info(number).path] if os.identify_object(number) == OS_STREAM_BASE else found
    except OsalError:
        return []


def failing(base: type[SoftwareBus], method: str, strike: Callable[[tuple[Any, ...]], None]) -> type[SoftwareBus]:
    """Return a class of Software Bus with a function that fails.

    Args:
        base: the class to start from.
        method: the function.
        strike: receives the arguments before each call, and may raise the error.
    """
    original: Callable[..., Any] = getattr(base, method)

    def call(bus: SoftwareBus, *args: Any, **named: Any) -> Any:
        strike(args)
        return original(bus, *args, **named)

    return type("FailingBus", (base,), {method: call})


class Puts:
    """Puts into pipes of a run, and which of them fail; none before `begin`."""

    def __init__(self) -> None:
        self._faults: Sequence[CallFault] = ()
        self._refused: dict[Task, dict[Pipe, int]] = {}  # for the transmission of a task, with the status

    def begin(self, faults: Sequence[CallFault]) -> None:
        """Take the faults of a run."""
        self._faults = faults
        self._refused.clear()

    @contextmanager
    def transmitting(self, task: Task) -> Iterator[None]:
        """Context of a transmission; a task may start another inside it, for an event about it."""
        before = self._refused.get(task)
        self._refused[task] = {}
        try:
            yield
        finally:
            del self._refused[task]
            if before is not None:
                self._refused[task] = before

    def refuses(self, task: Task, pipe: Pipe) -> bool:
        """Return whether a task is putting a message into a pipe and the put fails."""
        refused = self._refused.get(task)
        if refused is None:
            return False
        statuses = [fault.put_status(caller_of(task), pipe.name) for fault in self._faults]  # each counts each put
        failed = [status for status in statuses if status is not None]
        if failed:
            refused[pipe] = failed[0]
        return bool(failed)

    def status(self, task: Task, pipe: Pipe) -> int | None:
        """Return the error of the put into a pipe; None if no fault made it fail."""
        return self._refused.get(task, {}).get(pipe)


class _Refusing(PutHook):
    """Acts as if the message limit were reached where a put fails."""

    def __init__(self, kernel: Kernel, puts: Puts, inner: PutHook | None) -> None:
        super().__init__(inner)
        self._kernel = kernel
        self._puts = puts

    def limit(self, destination: Destination) -> int:
        limit = super().limit(destination)
        waiting = destination.puts - destination.gets
        fails = waiting < limit and self._puts.refuses(self._kernel.current, destination.pipe)
        return waiting if fails else limit


def refusing(base: type[SoftwareBus], puts: Puts) -> type[SoftwareBus]:
    """Return a class of Software Bus with puts that fail.

    Args:
        base: the class to start from.
        puts: which puts fail.
    """

    class RefusingBus(base):  # type: ignore[misc, valid-type]  # mypy does not follow a class that is an argument
        """A Software Bus that cannot put some messages into some pipes."""

        put_hook: PutHook | None

        def __init__(self, kernel: Kernel, *args: Any) -> None:
            super().__init__(kernel, *args)
            self.put_hook = _Refusing(kernel, puts, self.put_hook)

        def transmit_msg(self, packet: bytes | bytearray, is_origination: bool = True) -> None:
            with puts.transmitting(self.kernel.current):
                super().transmit_msg(packet, is_origination)

        def _report_failures(self, msg_id: int, failures: list[tuple[int, Destination]]) -> None:
            super()._report_failures(msg_id, [self._as_it_is(*failure) for failure in failures])

        def _as_it_is(self, event_id: int, destination: Destination) -> tuple[int, Destination]:
            """Return a failure as reported: a failed put is not a message limit."""
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


class Fill:
    """Fills one pipe.

    Args:
        fault: the fault in the plan; its target is the pipe's name.
        agenda: ends it.
        report: receives a text for each occurrence.
    """

    def __init__(self, fault: Fault, agenda: Agenda, report: FaultReport) -> None:
        self._fault = fault
        self._agenda = agenda
        self._report = report

    def strike(self, processor: Processor) -> None:
        """Fill the pipe now."""
        name, now = self._fault.target[0], processor.machine.kernel.now
        pipe = next((each for each in processor.cfe.sb.pipes if each.name == name), None)
        if pipe is None or pipe.is_filled:
            why = f"the pipe {name} does not exist" if pipe is None else f"pipe {name} is full already"
            self._report.missed(self._fault, f"{why} at {now / 1e9:g} s")
            return
        duration_ns = self._fault.options.get("for")
        self._report.happened(self._fault, f"fills pipe {name} of {pipe.app_name}")
        depth, keeps_newest = pipe.depth, pipe.keeps_newest
        pipe.ignore(NOBODY_HEARD)
        pipe.depth, pipe.keeps_newest = 0, False
        if duration_ns is not None:
            self._agenda.add(now + duration_ns, lambda: _empty(processor, pipe, depth, keeps_newest))


def _empty(processor: Processor, pipe: Pipe, depth: int, keeps_newest: bool) -> None:
    """Make the pipe take messages again, unless it was deleted meanwhile."""
    pipe.heed(NOBODY_HEARD)
    if processor.cfe.sb.find_pipe(pipe.pipe_id) is pipe:
        pipe.depth, pipe.keeps_newest = depth, keeps_newest
