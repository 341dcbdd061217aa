"""Determines for which of cFE's two ABIs an object was compiled, as far as its debug data shows it.

A build with OMIT_DEPRECATED has a CFE_TBL_Handle_t of 32 bits, other builds one of 16. Nothing in the code itself shows
this, so an object of one build runs with the other, and passes invalid handles.
"""

from __future__ import annotations

from collections.abc import Iterator
from enum import Enum
from functools import lru_cache
from io import BytesIO
from typing import Any

from cfepy.extra.c.elf import SharedObject, elf_file

_HANDLE = b"CFE_TBL_Handle_t"
_WITH_HANDLES = frozenset(
    (
        *("CFE_TBL_DumpToBuffer", "CFE_TBL_GetAddress", "CFE_TBL_GetAddresses", "CFE_TBL_GetStatus", "CFE_TBL_Load"),
        *("CFE_TBL_Manage", "CFE_TBL_Modified", "CFE_TBL_NotifyByMessage", "CFE_TBL_Register"),
        *("CFE_TBL_ReleaseAddress", "CFE_TBL_ReleaseAddresses", "CFE_TBL_Share", "CFE_TBL_Unregister"),
        *("CFE_TBL_Update", "CFE_TBL_Validate"),
    )
)
"""Functions with a handle among their parameters."""


class AbiProfile(Enum):
    """The ABI that an object was compiled for."""

    EITHER = "either"
    """It calls no table function; the ABIs differ only for these."""
    UNKNOWN = "unknown"
    """It has no debug data for table handles."""
    DEPRECATED = "with OMIT_DEPRECATED=false, where handles of tables are int16"
    OMIT_DEPRECATED = "with OMIT_DEPRECATED=true, where handles of tables are ids of 32 bits"

    def contradicts(self, omit_deprecated: bool) -> bool:
        """Return True if this certainly differs from the mission's setting."""
        return self is (AbiProfile.DEPRECATED if omit_deprecated else AbiProfile.OMIT_DEPRECATED)


def abi_profile(source: SharedObject) -> AbiProfile:
    """Return the ABI that an object was compiled for.

    Args:
        source: the object.
    """
    if _WITH_HANDLES.isdisjoint(source.wanted()):
        return AbiProfile.EITHER
    size = _size_of_handle(source.data)
    if size == 0:
        return AbiProfile.UNKNOWN
    return AbiProfile.DEPRECATED if size == 2 else AbiProfile.OMIT_DEPRECATED


@lru_cache(64)  # a mission may boot many times in a process
def _size_of_handle(data: bytes) -> int:
    """Return the bytes of a CFE_TBL_Handle_t; 0 if that is not known."""
    elf = elf_file(BytesIO(data))
    try:
        return next(_sizes(elf), 0)
    except Exception:  # debug data may be damaged: pyelftools raises errors of many types
        return 0


def _sizes(elf: Any) -> Iterator[int]:
    """Yield the size of CFE_TBL_Handle_t from each unit that has it."""
    for unit in elf.get_dwarf_info().iter_CUs() if elf.has_dwarf_info() else ():
        for entry in unit.get_top_DIE().iter_children():
            name = entry.attributes.get("DW_AT_name")
            if entry.tag == "DW_TAG_typedef" and name is not None and name.value == _HANDLE:
                yield _size_of(entry)


def _size_of(entry: Any) -> int:
    """Return the bytes of a type; for a typedef, of the type behind it."""
    while "DW_AT_byte_size" not in entry.attributes:
        if "DW_AT_type" not in entry.attributes:
            return 0
        entry = entry.get_DIE_from_attribute("DW_AT_type")
    return int(entry.attributes["DW_AT_byte_size"].value)
