"""CFE_EVS_*: Event Services for C."""

from __future__ import annotations

import struct
from contextlib import suppress
from typing import TYPE_CHECKING

from cfepy.ports import CRITICAL, application_of
from cfepy.status import CFE_ES_BAD_ARGUMENT, CFE_EVS_INVALID_PARAMETER, CfeError

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

NO_SCHEME = -1
"""No filter scheme: a registration with it fails, and clears an earlier one."""
_FILTER = struct.Struct("<HH")


def declare(api: Declarations, c: CRuntime) -> None:
    evs, memory = c.handle.evs, c.memory

    def register(filters: int, count: int, scheme: int) -> None:
        if count and not filters:
            with suppress(CfeError):
                evs.register(filter_scheme=NO_SCHEME)
            raise CfeError(CFE_ES_BAD_ARGUMENT, f"NULL pointer for {count} filters")
        raw = memory.peek(filters, _FILTER.size * count) if count else b""
        evs.register([(event_id, mask) for event_id, mask in _FILTER.iter_unpack(raw)], scheme)

    api.add("CFE_EVS_Register", "pHH", register)
    api.add("CFE_EVS_SendEvent", "HHf", evs.send_event, CFE_EVS_INVALID_PARAMETER)
    api.add(
        "CFE_EVS_SendEventWithAppID",
        "HHIf",
        lambda event_id, kind, app_id, text: evs.send_event_with_app_id(event_id, kind, app_id, text),
        CFE_EVS_INVALID_PARAMETER,
    )
    api.add("CFE_EVS_SendTimedEvent", "tHHf", evs.send_timed_event, CFE_EVS_INVALID_PARAMETER)
    api.add("CFE_EVS_ResetFilter", "H", evs.reset_filter)
    api.add("CFE_EVS_ResetAllFilters", "", evs.reset_all_filters)
    api.add("CFE_EVS_SetTypeEnable", "Hb", lambda kind, enabled: _set_type_enable(c, kind, enabled))


def _set_type_enable(c: CRuntime, event_type: int, enabled: bool) -> None:
    """Enable or disable an event type. The function is internal (cfe_evs_core_internal.h), but NASA's tests call it."""
    owner = application_of(c.kernel.current.owner)
    app = c.cfe.evs.apps.get(owner.app_id) if owner is not None else None
    if app is not None and 0 < event_type <= CRITICAL:
        app.set_types(1 << event_type - 1, enabled)
