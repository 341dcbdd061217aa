"""CFE_ResourceId_*: resource ids for C. The base of an id is in its place (0x110000), not shifted down (0x11)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy import ids
from cfepy.status import CFE_ES_BAD_ARGUMENT, CFE_ES_ERR_RESOURCEID_NOT_VALID, CfeError

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime


def declare(api: Declarations, c: CRuntime) -> None:
    def is_used_by(check: int, resource_id: int) -> bool:
        return bool(c.run(check, resource_id) & 0xFF)

    def find_next(start: int, size: int, check: int) -> int:
        return ids.find_next(start, size, lambda each: is_used_by(check, each)) if check else ids.UNDEFINED

    def find_next_ex(start: int, increment: int, argument: int, check: int) -> int:
        if not check or not increment:
            return ids.UNDEFINED
        return ids.find_next_ex(
            start,
            lambda each: c.run(increment, each, argument) & 0xFFFFFFFF,
            lambda each: is_used_by(check, each),
        )

    api.add("CFE_ResourceId_GetBase", "I", lambda resource_id: ids.get_base(resource_id) << ids.SHIFT)
    api.add("CFE_ResourceId_GetSerial", "I", ids.get_serial)
    api.add("CFE_ResourceId_FindNext", "IIp", find_next)
    api.add("CFE_ResourceId_FindNextEx", "Ippp", find_next_ex)
    api.add("CFE_ResourceId_ToIndex", "III4", _to_index, CFE_ES_BAD_ARGUMENT)


def _to_index(resource_id: int, base: int, size: int) -> int:
    """Use the arithmetic of NASA's C code: an id of another kind is accepted if its offset from the base matches."""
    serial = resource_id - base & 0xFFFFFFFF
    if serial > ids.SERIAL_MAX or size == 0:
        raise CfeError(CFE_ES_ERR_RESOURCEID_NOT_VALID, f"id 0x{resource_id:x} is not one of base 0x{base:x}")
    return serial % size
