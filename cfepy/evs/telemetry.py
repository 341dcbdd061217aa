"""The housekeeping packet of Event Services (CFE_EVS_SendHkCmd)."""

from __future__ import annotations

from collections.abc import Mapping

from cfepy.evs.apps import AppEvents
from cfepy.evs.core import EventCore
from cfepy.evs.packets import APPS_IN_HOUSEKEEPING
from cfepy.ids import ES_APPID_BASE, to_index


def apps_by_slot(core: EventCore) -> list[AppEvents]:
    """The registered applications in the order of their slots in ES's table."""
    slots = core.config.es_max_applications
    return sorted(core.apps.values(), key=lambda app: to_index(app.app_id, ES_APPID_BASE, slots))


def housekeeping(core: EventCore, commands: int, errors: int) -> Mapping[str, object]:
    """Fields of the housekeeping packet; 8-bit counters wrap.

    Args:
        core: the state.
        commands: command counter.
        errors: command error counter.
    """
    return {
        "CommandCounter": commands & 0xFF,
        "CommandErrorCounter": errors & 0xFF,
        "MessageFormatMode": core.format_mode,
        "MessageTruncCounter": core.truncated & 0xFF,
        "UnregisteredAppCounter": core.unregistered_count & 0xFF,
        "OutputPort": core.ports_mask,
        "LogFullFlag": int(core.log.is_full),
        "LogMode": core.log.mode,
        "MessageSendCounter": core.sent,
        "LogOverflowCounter": core.log.overflow & 0xFFFF,
        "LogEnabled": 1,
        "AppData": [
            {
                "AppID": app.app_id,
                "AppMessageSentCounter": app.sent,
                "AppEnableStatus": int(app.active),
                "AppMessageSquelchedCounter": app.squelch.dropped,
            }
            for app in apps_by_slot(core)[:APPS_IN_HOUSEKEEPING]
        ],
    }
