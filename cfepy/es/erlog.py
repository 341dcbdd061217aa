"""The exception and reset log (cfe_es_erlog.c): why and when the processor or an application was restarted."""

from __future__ import annotations

from collections.abc import Callable

from cfepy.es.packets import ER_LOG_FILE_ENTRY
from cfepy.es.reset_data import ErLogEntry, ResetData
from cfepy.msg import sys_time_fields
from cfepy.ports import Ports
from cfepy.reading.texts import to_bytes

CORE, APPLICATION = 1, 2
"""Types of entries (CFE_ES_LogEntryType_*)."""

MAX_DESCRIPTION = 79
NO_CONTEXT = 0
MAX_CONTEXT = 256


class ExceptionResetLog:
    """Entries in a ring of fixed size.

    Args:
        ports: provides the time.
        reset: holds the entries, and the reset variables that an entry records.
        copy_context: returns at most 256 bytes of a processor context by its id; empty for an unknown id.
    """

    def __init__(self, ports: Ports, reset: ResetData, copy_context: Callable[[int], bytes]) -> None:
        self._ports = ports
        self._copy_context = copy_context
        self.reset = reset

    def write(
        self,
        entry_type: int,
        reset_type: int,
        reset_subtype: int,
        description: str,
        app_id: int = 0,
        context_id: int = NO_CONTEXT,
    ) -> None:
        """Add an entry; a full log loses its oldest (CFE_ES_WriteToERLog, CFE_ES_WriteToERLogWithContext).

        Args:
            entry_type: CORE or APPLICATION.
            reset_type: RST_TYPE_*, or APP_RESTART.
            reset_subtype: RST_SUBTYPE_*.
            description: at most 79 characters are kept.
            app_id: the application concerned.
            context_id: id of the processor context in the PSP.
        """
        log, variables = self.reset.er_log, self.reset.variables
        log.slots[log.index] = ErLogEntry(
            entry_type,
            reset_type,
            reset_subtype,
            variables.boot_source,
            variables.processor_reset_count,
            variables.max_processor_reset_count,
            self._ports.time.now(),
            description[:MAX_DESCRIPTION],
            app_id,
            context_id,
        )
        log.index = (log.index + 1) % len(log.slots)
        log.entries += 1

    def clear(self) -> None:
        """Remove all entries."""
        log = self.reset.er_log
        log.slots[:] = [None] * len(log.slots)
        log.index = log.entries = 0

    def file_record(self, number: int) -> bytes:
        """Return a slot as a record of the log's file; an empty slot is all zeros."""
        entry = self.reset.er_log.slots[number]
        if entry is None:
            return bytes(ER_LOG_FILE_ENTRY.size)
        context = self._copy_context(entry.context_id)
        base = {
            "LogEntryType": entry.entry_type,
            "ResetType": entry.reset_type,
            "ResetSubtype": entry.reset_subtype,
            "BootSource": entry.boot_source,
            "ProcessorResetCount": entry.processor_reset_count,
            "MaxProcessorResetCount": entry.max_processor_reset_count,
            "TimeCode": sys_time_fields(entry.time),
            "Description": to_bytes(entry.description)[:MAX_DESCRIPTION],
        }
        return ER_LOG_FILE_ENTRY.pack(BaseInfo=base, ContextSize=len(context), AppID=entry.app_id, Context=context)
