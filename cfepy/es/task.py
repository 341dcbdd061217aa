"""The Executive Services application: command pipe, dispatch, housekeeping (cfe_es_task.c, cfe_es_dispatch.c)."""

from __future__ import annotations

from cfepy.config.versions import MODULES, Numbers
from cfepy.core_app import Replies, serve
from cfepy.es import events as ev
from cfepy.es import packets as pk
from cfepy.es.background import PRIORITY, STACK_SIZE, TASK_NAME, AppScan, BackgroundTask, Job
from cfepy.es.commands import AppControlCommands, CdsCommands, LogCommands, PerfCommands, QueryCommands, ResetCommands
from cfepy.es.exceptions import ExceptionScan
from cfepy.es.perf import DELAY_MS, PerfDump
from cfepy.es.service import ExecutiveServices
from cfepy.msg import BAD_CODE, BAD_MSG_ID, DONE, CommandTable
from cfepy.psp import RST_TYPE_POWERON
from cfepy.status import CfeError

_VERSION_PARTS = ("MajorVersion", "MinorVersion", "Revision", "MissionRevision")
PIPE_NAME = "ES_CMD_PIPE"
PIPE_DEPTH = 12
MAIN_PERF_ID = 1


def housekeeping(es: ExecutiveServices, replies: Replies, dump: PerfDump, checksum: int) -> dict[str, object]:
    """Return the fields of the housekeeping packet.

    Args:
        es: the service.
        replies: the command counters.
        dump: the number of performance log entries still to write.
        checksum: checksum of the executive's code, 16 bits.
    """
    return {
        "CommandCounter": replies.command_counter & 0xFF,
        "CommandErrorCounter": replies.error_counter & 0xFF,
        "CFECoreChecksum": checksum,
        **_versions("CFE", es.config.release.cfe),
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


def _versions(name: str, version: Numbers) -> dict[str, int]:
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
    """Return the free memory of the board as fields; empty if it is unknown."""
    try:
        heap = es.osal.heap_get_info()
    except CfeError:
        return {}
    return {
        "HeapBytesFree": heap.free_bytes,
        "HeapBlocksFree": heap.free_blocks,
        "HeapMaxBlockSize": heap.largest_free_block,
    }


class EsTask:
    """The core application CFE_ES.

    Args:
        es: the service.
        mission_name: name for the version events.
        build: text of the build event: "Build ... by ...".
        checksum: checksum of the executive's code, 16 bits.
    """

    def __init__(self, es: ExecutiveServices, mission_name: str, build: str, checksum: int) -> None:
        self.es = es
        self.ports = es.ports
        self.mission_name = mission_name
        self.build = build
        self.checksum = checksum
        self.replies = Replies(es.ports)
        self.perf_dump = PerfDump(es.perf_log, es.osal, es.ports)
        self.background = BackgroundTask(es, self._jobs())
        self.commands = CommandTable(
            (pk.NOOP, self._noop),
            (pk.RESET_COUNTERS, self._reset_counters),
            *ResetCommands(es, self.replies).handlers(),
            *AppControlCommands(es, self.replies).handlers(),
            *QueryCommands(es, self.replies).handlers(),
            *LogCommands(es, self.replies).handlers(),
            *PerfCommands(es, self.replies, self.perf_dump).handlers(),
            *CdsCommands(es, self.replies).handlers(),
        )
        self.commands.handle(pk.SEND_HK, self._send_housekeeping, any_length=True)  # NASA's code does not check it

    def _jobs(self) -> tuple[Job, ...]:
        es = self.es
        rate = es.config.es_app_scan_rate_ms
        return (
            Job(AppScan(es, lambda: self.replies.command_counter).run, rate // 4, rate),
            Job(self.perf_dump.run, DELAY_MS, DELAY_MS * 1000),
            Job(ExceptionScan(es).run, rate, rate),
            Job(es.ports.fs.run_background_file_dump, rate, rate),
            Job(lambda elapsed_ms: True, rate - 1, rate),  # as in NASA's table, so the task wakes a ms earlier
        )

    def task_main(self) -> None:
        """Run the main task of CFE_ES (CFE_ES_TaskMain)."""
        self.es.perf_log_entry(MAIN_PERF_ID)
        pipe = self._init()
        serve(self.ports, self.es.config, pipe, MAIN_PERF_ID, self._process_and_wake)

    def _process_and_wake(self, packet: bytes) -> None:
        self.process(packet)
        self.es.background_wakeup()  # a command may have requested work of a background job

    def _init(self) -> int:
        """Initialize the task before its loop (CFE_ES_TaskInit); return the command pipe."""
        es, sb = self.es, self.ports.sb
        powered_on = es.get_reset_type().reset_type == RST_TYPE_POWERON
        config = es.config
        es.syslog.set_mode(config.es_default_por_syslog_mode if powered_on else config.es_default_pr_syslog_mode)
        self.ports.evs.register(())
        pipe = sb.create_pipe(PIPE_DEPTH, PIPE_NAME)
        sb.subscribe(pk.SEND_HK_MID, pipe)
        sb.subscribe(pk.CMD_MID, pipe)
        self._announce()
        es.create_child_task(TASK_NAME, self.background.main, STACK_SIZE, PRIORITY)
        return pipe

    def _announce(self) -> None:
        send = self.replies.send
        send(ev.INIT_INF_EID, f"cFE ES Initialized: {self.es.config.release.text('CFE_ES')}")
        release = self.es.config.release
        send(ev.INITSTATS_INF_EID, f"cFS Versions: {release.bundle}. cFE chksm {self.checksum}")
        send(ev.VERSION_INF_EID, f"Version Info: Mission {self.mission_name}, version {release.module('CORE_API')}")
        for module in MODULES:
            send(ev.VERSION_INF_EID, f"Version Info: Module {module}, version {release.module(module)}")
        send(ev.BUILD_INF_EID, self.build)

    def process(self, packet: bytes) -> None:
        """Handle a packet from the command pipe (CFE_ES_TaskPipe)."""
        done = self.commands.dispatch(packet)
        if done.outcome == DONE:
            return
        if done.outcome == BAD_MSG_ID:
            event, text = ev.MID_ERR_EID, f"Invalid command pipe message ID: 0x{done.msg_id:X}"
        elif done.outcome == BAD_CODE:
            event, text = ev.CC1_ERR_EID, f"Invalid ground command code: ID = 0x{done.msg_id:X}, CC = {done.fcn_code}"
        else:
            event, text = ev.LEN_ERR_EID, done.length_text()
        self.replies.reject(event, text)

    def _noop(self, packet: bytes) -> None:
        self.replies.send(ev.BUILD_INF_EID, self.build)
        self.replies.accept(ev.NOOP_INF_EID, f"No-op command:\n cFS Versions: {self.es.config.release.bundle}")

    def _reset_counters(self, packet: bytes) -> None:
        self.replies.reset()
        self.replies.send(ev.RESET_INF_EID, "Reset Counters command")

    def _send_housekeeping(self, packet: bytes) -> None:
        fields = housekeeping(self.es, self.replies, self.perf_dump, self.checksum)
        self.ports.sb.transmit_msg(pk.HK_TLM.packet(fields))
