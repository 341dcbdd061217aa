"""OS_ForEachObject, OS_GetResourceName, OS_GetErrorName and related functions: object ids and status codes for C."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.extra.c.api.osal_values import BAD, check_size
from cfepy.reading.texts import to_bytes
from cfepy.status import OS_ERR_NAME_TOO_LONG, OS_ERROR, OsalError

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

ERROR_NAME = 35
"""Characters of os_err_name_t, with a NUL."""


def declare(api: Declarations, c: CRuntime) -> None:
    _declare_ids(api, c)
    _declare_errors(api, c)


def _declare_ids(api: Declarations, c: CRuntime) -> None:
    os, memory = c.handle.os, c.memory

    def get_name(object_id: int, buffer: int, size: int) -> None:
        check_size(size)
        memory.poke(buffer, b"\0")
        name = to_bytes(os.get_resource_name(object_id))
        memory.poke(buffer, name[: size - 1] + b"\0")
        if len(name) >= size:
            raise OsalError(OS_ERR_NAME_TOO_LONG, f"a buffer of {size} bytes is too small for {name!r}")

    def for_each(creator: int, callback: int, argument: int) -> None:
        os.for_each_object(creator, lambda object_id, arg: c.run(callback, object_id, arg), argument)

    def for_each_of_type(kind: int, creator: int, callback: int, argument: int) -> None:
        os.for_each_object_of_type(kind, creator, lambda object_id, arg: c.run(callback, object_id, arg), argument)

    api.add("OS_GetResourceName", "$IPQ", get_name, BAD)
    api.add("OS_IdentifyObject", "I", os.identify_object)
    api.add("OS_ConvertToArrayIndex", "I4", os.convert_to_array_index, BAD)
    api.add("OS_ObjectIdToArrayIndex", "II4", os.object_id_to_array_index, BAD)
    api.add("OS_ForEachObject", "$Ipp", for_each)
    api.add("OS_ForEachObjectOfType", "$IIpp", for_each_of_type)


def _declare_errors(api: Declarations, c: CRuntime) -> None:
    os, memory = c.handle.os, c.memory

    def error_name(status: int, at: int) -> None:
        name = os.get_error_name(status)
        memory.put_text(at, name, ERROR_NAME)
        if name.startswith("OS_UNKNOWN"):
            raise OsalError(OS_ERROR, f"{status} is not an error status")

    def status_to_string(status: int, at: int) -> int:
        if at:
            memory.poke(at, os.status_to_string(status).encode() + b"\0")
        return at

    api.add("OS_GetErrorName", "iP", error_name, BAD)
    api.add("OS_StatusToString", "ip", status_to_string)
