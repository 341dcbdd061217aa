"""Determines for which of cFE's two ABIs an object was compiled, as far as its debug data shows it.

A build with OMIT_DEPRECATED has a CFE_TBL_Handle_t of 32 bits, other builds one of 16. Nothing in the code itself shows
this, so an object of one build runs with the other, and passes invalid handles.
"""

from __future__ import annotations

from enum import Enum

from cfepy.extra.c.elf import SharedObject
from cfepy.extra.c.structs import structs_of

_HANDLE = "CFE_TBL_Handle_t"
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
    size = structs_of(source.data).size_of(_HANDLE)
    if size == 0:
        return AbiProfile.UNKNOWN
    return AbiProfile.DEPRECATED if size == 2 else AbiProfile.OMIT_DEPRECATED
