"""The housekeeping packet of Executive Services (CFE_ES_SendHkCmd)."""

from __future__ import annotations

from cfepy.core_app import Replies
from cfepy.es.perf_dump import PerfDump
from cfepy.es.service import ExecutiveServices
from cfepy.status import CfeError
from cfepy.versions import VERSION_NUMBER

_VERSION_PARTS = ("MajorVersion", "MinorVersion", "Revision", "MissionRevision")


def housekeeping(es: ExecutiveServices, replies: Replies, dump: PerfDump, checksum: int) -> dict[str, object]:
    """The fields of the packet.

    Args:
        es: the service.
        replies: the command counters.
        dump: for how much of the performance log is still to be written.
        checksum: of the executive's code, 16 bits.
    """
    return {
        "CommandCounter": replies.command_counter & 0xFF,
        "CommandErrorCounter": replies.error_counter & 0xFF,
        "CFECoreChecksum": checksum,
        **_versions("CFE", VERSION_NUMBER),
        **_versions("OSAL", es.osal.get_version_number()),
        **_versions("PSP", es.psp.get_version_number()),
        **_logs(es),
        "RegisteredCoreApps": sum(app.is_core for app in es.apps),
        "RegisteredExternalApps": sum(not app.is_core for app in es.apps),
        "RegisteredTasks": sum(len(app.tasks) for app in es.apps),
        "RegisteredLibs": len(es.libs),
        **_resets(es),
        **_performance(es, dump),
        **_heap(es),
    }


def _versions(name: str, version: tuple[int, int, int, int]) -> dict[str, int]:
    return {f"{name}{part}": number for part, number in zip(_VERSION_PARTS, version, strict=True)}


def _logs(es: ExecutiveServices) -> dict[str, int]:
    syslog, er_log = es.syslog.data, es.reset.er_log
    return {
        "SysLogBytesUsed": syslog.end_index,
        "SysLogSize": len(syslog.memory),
        "SysLogEntries": syslog.entries,
        "SysLogMode": syslog.mode,
        "ERLogIndex": er_log.index,
        "ERLogEntries": er_log.entries,
    }


def _resets(es: ExecutiveServices) -> dict[str, int]:
    variables = es.reset.variables
    return {
        "ResetType": variables.reset_type,
        "ResetSubtype": variables.reset_subtype,
        "ProcessorResets": variables.processor_reset_count,
        "MaxProcessorResets": variables.max_processor_reset_count,
        "BootSource": variables.boot_source,
    }


def _performance(es: ExecutiveServices, dump: PerfDump) -> dict[str, object]:
    data = es.reset.perf
    return {
        "PerfState": data.state,
        "PerfMode": data.mode,
        "PerfTriggerCount": data.trigger_count,
        "PerfFilterMask": data.filter_mask,
        "PerfTriggerMask": data.trigger_mask,
        "PerfDataStart": data.start,
        "PerfDataEnd": data.end,
        "PerfDataCount": data.count,
        "PerfDataToWrite": dump.remaining,
    }


def _heap(es: ExecutiveServices) -> dict[str, int]:
    """What is left of the board's memory; zeros where that is not known."""
    try:
        heap = es.osal.heap_get_info()
    except CfeError:
        return {}
    return {
        "HeapBytesFree": heap.free_bytes,
        "HeapBlocksFree": heap.free_blocks,
        "HeapMaxBlockSize": heap.largest_free_block,
    }
