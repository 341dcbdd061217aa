"""The calls of cFE, OSAL and PSP that a fault plan can make fail, with their names and usual errors."""

from __future__ import annotations

import re

from cfepy import status as codes
from cfepy.es import ExecutiveServices
from cfepy.evs import EventServices
from cfepy.fs import FileServices
from cfepy.osal import Osal
from cfepy.psp import Psp
from cfepy.reading.suggestions import did_you_mean
from cfepy.sb import SoftwareBus
from cfepy.status import UsageError
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
"""Default error of each call."""
QUEUE_PUT, QUEUE_GET = "os.queue_put", "os.queue_get"


def call_name(target: str) -> str:
    """Return the name of a call in applications, "os.queue_put", from that name or NASA's, OS_QueuePut.

    Raises:
        UsageError: if no service has such a name.
    """
    found = _call_name(target)
    service, _, method = found.partition(".")
    functions = [name for name in dir(_classes()[service]) if not name.startswith("_")]
    if method not in functions:
        hint = did_you_mean(method, functions, before="; ", form=f"{service}.{{}}")
        raise UsageError(f"unknown function {target!r} of {service}{hint}")
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
        hint = did_you_mean(service, _classes(), before="; ", form=f"{{}}.{method}") if dot else ""
        known = ", ".join(_classes())
        text = f"invalid call {target!r}; write it as OS_QueuePut or os.queue_put, with one of {known}{hint}"
        raise UsageError(text)
    return f"{service}.{method}"


def status_of(call: str, name: str | None) -> int:
    """Return the status with which a call fails.

    Args:
        call: see `call_name`.
        name: NASA's name of the status; None for the usual one.

    Raises:
        UsageError: if no status has that name.
    """
    if name is None:
        usual = codes.OS_ERR_NO_FREE_IDS if call.endswith("_create") else codes.OS_ERROR
        return USUAL.get(call, usual if call.startswith(("os.", "psp.")) else codes.CFE_STATUS_EXTERNAL_RESOURCE_FAIL)
    found = getattr(codes, name, None)
    if not isinstance(found, int) or not name.startswith(("CFE_", "OS_")):
        names = [each for each in vars(codes) if each.startswith(("CFE_", "OS_"))]
        hint = did_you_mean(name, names, "expected a name such as OS_QUEUE_FULL or CFE_SB_BUF_ALOC_ERR")
        raise UsageError(f"unknown status {name!r}; {hint}")
    return codes.to_signed(found)
