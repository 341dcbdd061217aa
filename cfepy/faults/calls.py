"""Calls of cFE, OSAL or PSP that fail though nothing is wrong: the N-th allocation, queue put, file write, ...

The method of one processor's service is wrapped, under the name that applications call it by. Imports the services,
for the names of their functions, and its neighbours.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from difflib import get_close_matches
from typing import Any

from cfepy import status as codes
from cfepy.es import ExecutiveServices
from cfepy.evs import EventServices
from cfepy.faults.gate import Gate
from cfepy.faults.plan import Fault
from cfepy.faults.report import FaultReport
from cfepy.fs.services import FileServices
from cfepy.ids import OS_STREAM_BASE
from cfepy.osal import Osal
from cfepy.psp import Psp
from cfepy.rtos import Task
from cfepy.sb import SoftwareBus
from cfepy.status import CfeError, OsalError, UsageError
from cfepy.tbl import TableServices
from cfepy.time import TimeServices

AREAS = {"CFE_ES_": "es", "CFE_EVS_": "evs", "CFE_SB_": "sb", "CFE_TBL_": "tbl", "CFE_TIME_": "time", "CFE_FS_": "fs"}
PSP_PREFIX, OS_PREFIX = "CFE_PSP_", "OS_"
_WORD = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")

USUAL = {
    "es.get_pool_buf": codes.CFE_ES_ERR_MEM_BLOCK_SIZE,
    "es.register_cds": codes.CFE_ES_ERR_MEM_BLOCK_SIZE,
    "sb.allocate_message_buffer": codes.CFE_SB_BUF_ALOC_ERR,
    "sb.transmit_msg": codes.CFE_SB_BUF_ALOC_ERR,
    "sb.transmit_buffer": codes.CFE_SB_BUF_ALOC_ERR,
    "sb.create_pipe": codes.CFE_SB_PIPE_CR_ERR,
    "sb.receive_buffer": codes.CFE_SB_PIPE_RD_ERR,
    "sb.subscribe": codes.CFE_SB_MAX_MSGS_MET,
    "tbl.register": codes.CFE_TBL_ERR_REGISTRY_FULL,
    "os.queue_put": codes.OS_QUEUE_FULL,
}
"""What a call fails with when the plan does not say."""
QUEUE_PUT, QUEUE_GET = "os.queue_put", "os.queue_get"


def call_name(target: str) -> str:
    """A call as applications write it, "os.queue_put", from that or from NASA's name, OS_QueuePut.

    Raises:
        UsageError: no service has such a name.
    """
    found = _call_name(target)
    service, _, method = found.partition(".")
    functions = [name for name in dir(_classes()[service]) if not name.startswith("_")]
    if method not in functions:
        near = get_close_matches(method, functions, 1)
        hint = f"; is {service}.{near[0]} meant?" if near else ""
        raise UsageError(f"{target!r} is no function of {service}{hint}")
    return found


def _classes() -> dict[str, type]:
    return {
        "es": ExecutiveServices,
        "evs": EventServices,
        "sb": SoftwareBus,
        "tbl": TableServices,
        "time": TimeServices,
        "fs": FileServices,
        "os": Osal,
        "psp": Psp,
    }


def _call_name(target: str) -> str:
    prefixes = {**AREAS, PSP_PREFIX: "psp", OS_PREFIX: "os"}
    for prefix, service in prefixes.items():
        if target.startswith(prefix):
            return f"{service}.{_WORD.sub('_', target.removeprefix(prefix)).lower()}"
    service, dot, method = target.removeprefix("cfe.").partition(".")
    if not dot or service not in _classes() or not method or method.startswith("_"):
        text = f"{target!r} is no call; write it as OS_QueuePut or os.queue_put, with one of {', '.join(_classes())}"
        raise UsageError(text)
    return f"{service}.{method}"


def status_of(call: str, name: str | None) -> int:
    """The status that a call fails with.

    Args:
        call: see `call_name`.
        name: NASA's name of it; None takes the usual one.

    Raises:
        UsageError: no status has that name.
    """
    if name is None:
        usual = codes.OS_ERR_NO_FREE_IDS if call.endswith("_create") else codes.OS_ERROR
        return USUAL.get(call, usual if call.startswith(("os.", "psp.")) else codes.CFE_STATUS_EXTERNAL_RESOURCE_FAIL)
    found = getattr(codes, name, None)
    if not isinstance(found, int) or not name.startswith(("CFE_", "OS_")):
        raise UsageError(f"{name!r} is no status; write one such as OS_QUEUE_FULL or CFE_SB_BUF_ALOC_ERR")
    return codes.to_signed(found)


def why_not_called(fault: Fault) -> str:
    """Why a fault of a function that nobody called never happened."""
    call = call_name(fault.target[0])
    hint = "; pipes are not read by it here: let CFE_SB_ReceiveBuffer fail" if call == QUEUE_GET else ""
    return f"nobody that it is about called {call}{hint}"


def caller_of(task: Task) -> str:
    """The application that a task belongs to, in words."""
    return "the system" if task.owner is None else str(task.owner.name)


class CallFault:
    """Lets calls of one function fail.

    Args:
        fault: what the plan says.
        gate: which calls.
        report: takes what happens.
        kernel: who calls, and when.
    """

    def __init__(self, fault: Fault, gate: Gate, report: FaultReport, kernel: Any) -> None:
        self._fault = fault
        self._gate = gate
        self._report = report
        self._kernel = kernel
        self._call = call_name(fault.target[0])
        self._status = status_of(self._call, fault.options.get("status"))
        self._app: str | None = fault.options.get("app")
        self._object: str | None = fault.options.get("object")

    def power_up(self, processor: Any) -> None:
        """Stand before the function of a new processor."""
        service_name, _, method = self._call.partition(".")
        service = getattr(processor.cfe, service_name)
        setattr(service, method, self._wrapped(getattr(service, method), processor))

    def _wrapped(self, original: Callable[..., Any], processor: Any) -> Callable[..., Any]:
        def call(*args: Any, **named: Any) -> Any:
            caller = caller_of(self._kernel.current)
            if self._is_meant(caller, args, processor) and self._gate.opens(self._kernel.now):
                error = self._error()
                self._report.happened(self._fault, f"lets {self._call} of {caller} fail with {error.name}")
                raise error
            return original(*args, **named)

        return call

    def put_status(self, caller: str, pipe: str) -> int | None:
        """What the Software Bus's put into a pipe fails with, as one of these calls; None when it does not.

        Args:
            caller: who sends the message.
            pipe: its name.
        """
        if self._app not in (None, caller) or self._object not in (None, pipe):
            return None
        if not self._gate.opens(self._kernel.now):
            return None
        text = f"lets {self._call} of {caller} into pipe {pipe} fail with {self._error().name}"
        self._report.happened(self._fault, text)
        return self._status

    def _is_meant(self, caller: str, args: tuple[Any, ...], processor: Any) -> bool:
        if self._app not in (None, caller):
            return False
        return self._object is None or any(self._object == name for name in _names(args, processor))

    def _error(self) -> CfeError:
        kind = OsalError if self._call.startswith(("os.", "psp.")) else CfeError
        return kind(self._status, f"fault {self._fault.name}")


def _names(args: tuple[Any, ...], processor: Any) -> list[str]:
    """What the arguments of a call name: texts, and the objects whose ids they are."""
    found = []
    for each in args:
        if isinstance(each, str):
            found.append(each)
        elif isinstance(each, int):
            found += _name_of(each, processor)
    return found


def _name_of(number: int, processor: Any) -> list[str]:
    """Names of the object that an id is: of a pipe, of an OSAL object, the path of an open file."""
    pipe = processor.cfe.sb.find_pipe(number)
    if pipe is not None:
        return [pipe.name]
    os = processor.cfe.os
    try:
        found = [os.get_resource_name(number)]
        return [*found, os.fd_get_info(number).path] if os.identify_object(number) == OS_STREAM_BASE else found
    except OsalError:
        return []
