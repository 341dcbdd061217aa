"""Shared helpers of API functions for pointers."""

from __future__ import annotations

from collections.abc import Callable

from cfepy.extra.c.memory import CMemory
from cfepy.status import CFE_SUCCESS, CfeError


def need(status: int, *pointers: object) -> None:
    """Refuse NULL pointers, and texts that are NULL.

    Raises:
        CfeError: `status`.
    """
    if None in pointers or 0 in pointers:
        raise CfeError(status, "unexpected NULL pointer")


def name_into(
    memory: CMemory, get: Callable[[int], str], no_room: int, too_long: int
) -> Callable[[int, int, int], None]:
    """Return a function `(char *buffer, id, size_t size)` that writes a name.

    Args:
        memory: of C.
        get: gives the name of an id.
        no_room: the status for no buffer, or one of size 0.
        too_long: the status when the name had to be cut; CFE_SUCCESS if C does not report that.
    """

    def call(buffer: int, key: int, size: int) -> None:
        if not buffer or not size:
            raise CfeError(no_room, "the buffer has no room for a name")
        try:
            name = get(key)
        except CfeError:
            memory.poke(buffer, b"\0")
            raise
        if not memory.put_text(buffer, name, size) and too_long != CFE_SUCCESS:
            raise CfeError(too_long, f"a buffer of {size} bytes is too small for {name!r}")

    return call
