"""Shared helpers of the OSAL modules for C: ids and properties as outputs, timeouts as status codes, times."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from struct import Struct
from typing import Any

from cfepy.extra.c.memory import CMemory, chars
from cfepy.osal import OS_MAX_API_NAME
from cfepy.status import OS_ERR_INVALID_SIZE, OS_INVALID_POINTER, CfeError, OsalError

BAD = OS_INVALID_POINTER
"""OSAL's status for a NULL pointer."""
NAMED = Struct(f"<{OS_MAX_API_NAME}sI")
"""The properties of objects with only a name and a creator, such as OS_queue_prop_t."""
_TOO_LARGE = 0x7FFFFFFF


def properties(memory: CMemory, layout: Struct, fields: Callable[[int], Iterable[Any]]) -> Callable[[int, int], None]:
    """Return a function `(id, structure *)` that fills a structure; all bytes are 0 if there is no such object.

    Args:
        memory: of C.
        layout: of the structure.
        fields: gives its fields; texts are put into arrays of OSAL's names.
    """
    blank = bytes(layout.size)

    def call(object_id: int, at: int) -> None:
        memory.poke(at, blank)
        values = [chars(each, OS_MAX_API_NAME) if isinstance(each, str) else each for each in fields(object_id)]
        memory.poke(at, layout.pack(*values))

    return call


def new_id(create: Callable[..., int], *late: int) -> Callable[..., tuple[int, int]]:
    """Return a function that makes an object, for a signature with "=". It returns a status and the id.

    OSAL takes an id before the operating system makes the object. A later failure leaves 0 as the id. An earlier
    failure leaves the caller's variable as it is.

    Args:
        create: makes it; raises a status.
        late: the statuses of failures of the operating system.
    """

    def call(*args: Any) -> tuple[int, int]:
        try:
            return 0, create(*args)
        except CfeError as error:
            if error.status not in late:
                raise
            return error.status, 0

    return call


def in_time(call: Callable[..., Any], status: int) -> Callable[..., Any]:
    """Return a function that raises a status where OSAL returns None or False after a timeout."""

    def timed(*args: Any) -> Any:
        result = call(*args)
        if result is None or result is False:
            raise OsalError(status)
        return None if result is True else result

    return timed


def check_size(size: int) -> None:
    """Refuse a size of 0, or one larger than any memory (OS_CHECK_SIZE).

    Raises:
        OsalError: OS_ERR_INVALID_SIZE.
    """
    if not 0 < size < _TOO_LARGE:
        raise OsalError(OS_ERR_INVALID_SIZE, f"{size} bytes")
