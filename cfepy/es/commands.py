"""The commands of Executive Services (cfe_es_task.c), with the handlers in groups by subject.

The groups are resets, applications, queries, the two logs, the performance log and the Critical Data Store. Commands
about the task itself (no-op, counters, housekeeping) are in `cfepy.es.task`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any

from cfepy.core_app import Replies
from cfepy.es import events as ev
from cfepy.es import packets as pk
from cfepy.es.cds import CdsBlock
from cfepy.es.dump_files import APP_INFO_FILE, CDS_REGISTRY_FILE, SYS_LOG_FILE, TASK_INFO_FILE, write_dump
from cfepy.es.perf import DELAY_MS, ENTRIES_BETWEEN_DELAYS, TRIGGER_END, TRIGGER_START, PerfDump, PerformanceLog
from cfepy.es.records import AppInfo, StartParams, TaskInfo
from cfepy.es.reset_data import PERF_MASK_WORDS
from cfepy.es.service import ExecutiveServices
from cfepy.es.startup_script import EXCEPTION_PROC_RESTART
from cfepy.fs import (
    SUBTYPE_ES_ERLOG,
    FileCategory,
    FileWriteEvent,
    FileWriteMetaData,
    dump_file_name,
    parse_input_file_name,
)
from cfepy.msg import Command, Handler, telemetry
from cfepy.psp import RST_TYPE_POWERON, RST_TYPE_PROCESSOR
from cfepy.status import (
    CFE_ES_CDS_OWNER_ACTIVE_ERR,
    CFE_ES_CDS_WRONG_TYPE_ERR,
    CFE_ES_ERR_NAME_NOT_FOUND,
    CFE_STATUS_REQUEST_ALREADY_PENDING,
    CfeError,
    to_signed,
)

Handlers = tuple[tuple[Command, Handler], ...]
ER_LOG_FILE = "/ram/cfe_erlog.log"
ER_LOG_DESCRIPTION = "ES ERlog data file"
PERF_FILE = "/ram/cfe_es_perf.dat"
# The event for each reason why a block cannot be deleted.
_CDS_REFUSALS = {
    CFE_ES_CDS_WRONG_TYPE_ERR: (
        ev.CDS_DELETE_TBL_ERR_EID,
        "CDS '{name}' is a Critical Table CDS. Must be deleted via TBL Command",
    ),
    CFE_ES_CDS_OWNER_ACTIVE_ERR: (
        ev.CDS_OWNER_ACTIVE_EID,
        "CDS '{name}' not deleted because owning app is active",
    ),
    CFE_ES_ERR_NAME_NOT_FOUND: (ev.CDS_NAME_ERR_EID, "Unable to locate '{name}' in CDS Registry"),
}
_OTHER_CDS_REFUSAL = (ev.CDS_DELETE_ERR_EID, "Error while deleting '{name}' from CDS, See SysLog.(Err={status})")


class CommandGroup(ABC):
    """The base class of the groups.

    Args:
        es: the service.
        replies: the replies to commands.
    """

    def __init__(self, es: ExecutiveServices, replies: Replies) -> None:
        self._es = es
        self._replies = replies

    @abstractmethod
    def handlers(self) -> Handlers:
        """Return the handler of each command."""


class ResetCommands(CommandGroup):
    """Resets of the processor."""

    def handlers(self) -> Handlers:
        return (
            (pk.RESTART, self._restart),
            (pk.RESET_PR_COUNT, self._reset_count),
            (pk.SET_MAX_PR_COUNT, self._set_max_count),
        )

    def _restart(self, packet: bytes) -> None:
        kind = pk.RESTART.read(packet)["RestartType"]
        if kind in (RST_TYPE_PROCESSOR, RST_TYPE_POWERON):
            self._es.reset_cfe(kind)
        else:
            self._replies.reject(ev.BOOT_ERR_EID, f"Invalid cFE restart type: {kind}")

    def _reset_count(self, packet: bytes) -> None:
        self._es.reset.variables.processor_reset_count = 0
        self._replies.accept(ev.RESET_PR_COUNT_EID, "Set Processor Reset Count to Zero")

    def _set_max_count(self, packet: bytes) -> None:
        count = pk.SET_MAX_PR_COUNT.read(packet)["MaxPRCount"]
        self._es.reset.variables.max_processor_reset_count = count
        self._replies.accept(ev.SET_MAX_PR_COUNT_EID, f"Maximum Processor Reset Count set to: {count}")


class AppControlCommands(CommandGroup):
    """The start, end and restart of applications."""

    def handlers(self) -> Handlers:
        return (
            (pk.START_APP, self._start),
            (pk.STOP_APP, self._stop),
            (pk.RESTART_APP, self._restart),
            (pk.RELOAD_APP, self._reload),
        )

    def _start(self, packet: bytes) -> None:
        fields = pk.START_APP.read(packet)
        name = fields["Application"] = pk.START_APP.read_name(packet, "Application")
        fields["AppEntryPoint"] = pk.START_APP.read_name(packet, "AppEntryPoint")
        refusal = _why_not_start(fields)
        if refusal is not None:
            self._replies.reject(*refusal)
            return
        file = parse_input_file_name(fields["AppFileName"], FileCategory.DYNAMIC_MODULE)
        stack = fields["StackSize"] or self._es.config.es_default_stack_size
        params = StartParams(file, fields["AppEntryPoint"], stack, fields["Priority"], fields["ExceptionAction"])
        try:
            app_id = self._es.create_app(name, params)
        except CfeError as failure:
            self._replies.reject(ev.START_ERR_EID, f"Failed to start {name} from {file}, RC = {failure.hex}")
            return
        self._replies.accept(ev.START_INF_EID, f"Started {name} from {file}, AppID = {app_id}")

    def _stop(self, packet: bytes) -> None:
        name = pk.STOP_APP.read_name(packet, "Application")
        self._control(name, "Stop", self._es.delete_app, ev.STOP_DBG_EID, ev.STOP_ERR1_EID, ev.STOP_ERR2_EID)

    def _restart(self, packet: bytes) -> None:
        name = pk.RESTART_APP.read_name(packet, "Application")
        ids = ev.RESTART_APP_DBG_EID, ev.RESTART_APP_ERR1_EID, ev.RESTART_APP_ERR2_EID
        self._control(name, "Restart", self._es.restart_app, *ids)

    def _reload(self, packet: bytes) -> None:
        fields = pk.RELOAD_APP.read(packet)

        def reload(app_id: int) -> None:
            self._es.reload_app(app_id, parse_input_file_name(fields["AppFileName"], FileCategory.DYNAMIC_MODULE))

        ids = ev.RELOAD_APP_DBG_EID, ev.RELOAD_APP_ERR1_EID, ev.RELOAD_APP_ERR2_EID
        self._control(pk.RELOAD_APP.read_name(packet, "Application"), "Reload", reload, *ids)

    def _control(
        self, name: str, action: str, call: Callable[[int], None], begun: int, failed: int, unknown: int
    ) -> None:
        """Request an action on a running application, which the background task carries out."""
        try:
            app_id = self._es.get_app_id_by_name(name)
        except CfeError as missing:
            text = f"{action} Application {name}, GetAppIDByName failed. RC = {missing.hex}."
            self._replies.reject(unknown, text)
            return
        try:
            call(app_id)
        except CfeError as failure:
            self._replies.reject(failed, f"{action} Application {name} Failed, RC = {failure.hex}")
            return
        self._replies.accept(begun, f"{action} Application {name} Initiated.", ev.DEBUG)


def _why_not_start(fields: dict[str, Any]) -> tuple[int, str] | None:
    """Return the event id and text for an invalid START_APP command, or None."""
    command = "CFE_ES_StartAppCmd: "
    try:
        parse_input_file_name(fields["AppFileName"], FileCategory.DYNAMIC_MODULE)
    except CfeError as bad:
        text = f"{command}invalid filename, status={bad.status & 0xFFFFFFFFFFFFFFFF:x}"
        return ev.START_INVALID_FILENAME_ERR_EID, text
    if not fields["AppEntryPoint"]:
        return ev.START_INVALID_ENTRY_POINT_ERR_EID, f"{command}App Entry Point is empty."
    if not fields["Application"]:
        return ev.START_NULL_APP_NAME_ERR_EID, f"{command}App Name is empty."
    if fields["Priority"] > 255:
        return ev.START_PRIORITY_ERR_EID, f"{command}Priority is too large: {fields['Priority']}."
    if fields["ExceptionAction"] > EXCEPTION_PROC_RESTART:
        text = f"{command}Invalid Exception Action: {fields['ExceptionAction']}."
        return ev.START_EXC_ACTION_ERR_EID, text
    return None


class QueryCommands(CommandGroup):
    """Information about applications, libraries, tasks and memory pools."""

    def handlers(self) -> Handlers:
        return (
            (pk.QUERY_ONE, self._query_one),
            (pk.QUERY_ALL, self._query_all),
            (pk.QUERY_ALL_TASKS, self._query_all_tasks),
            (pk.SEND_MEM_POOL_STATS, self._send_pool_stats),
        )

    def _query_one(self, packet: bytes) -> None:
        name = pk.QUERY_ONE.read_name(packet, "Application")
        try:
            info = self._es.get_module_info(self._find_module(name))
        except CfeError as missing:
            text = f"Failed to send {name} application data: GetAppIDByName Failed, RC = {missing.hex}"
            self._replies.reject(ev.ONE_APPID_ERR_EID, text)
            return
        try:
            self._es.ports.sb.transmit_msg(bytes(telemetry(pk.APP_TLM_MID, app_info_record(info))))
        except CfeError as failure:
            text = f"Failed to send {name} application data, RC = {failure.hex}"
            self._replies.reject(ev.ONE_ERR_EID, text)
            return
        self._replies.accept(ev.ONE_APP_EID, f"Sent {name} application data", ev.DEBUG)

    def _find_module(self, name: str) -> int:
        """Return the id of the application with a name, or otherwise of the library."""
        try:
            return self._es.get_app_id_by_name(name)
        except CfeError as error:
            if error.status != CFE_ES_ERR_NAME_NOT_FOUND:
                raise
            return self._es.get_lib_id_by_name(name)

    def _query_all(self, packet: bytes) -> None:
        records = [app_info_record(info) for info in self._es.modules()]
        write_dump(self._es, self._replies, APP_INFO_FILE, pk.QUERY_ALL.read(packet)["FileName"], records)

    def _query_all_tasks(self, packet: bytes) -> None:
        records = [task_info_record(info) for info in self._es.tasks()]
        write_dump(self._es, self._replies, TASK_INFO_FILE, pk.QUERY_ALL_TASKS.read(packet)["FileName"], records)

    def _send_pool_stats(self, packet: bytes) -> None:
        handle = pk.SEND_MEM_POOL_STATS.read(packet)["PoolHandle"]
        if handle not in self._es.pools:
            text = f"Cannot telemeter memory pool stats. Illegal Handle (0x{handle:08X})"
            self._replies.reject(ev.INVALID_POOL_HANDLE_ERR_EID, text)
            return
        statistics = self._es.get_mem_pool_stats(handle)
        self._es.ports.sb.transmit_msg(pk.MEMSTATS_TLM.packet(PoolHandle=handle, PoolStats=statistics))
        text = f"Successfully telemetered memory pool stats for 0x{handle:08X}"
        self._replies.accept(ev.TLM_POOL_STATS_INFO_EID, text, ev.DEBUG)


def app_info_record(info: AppInfo) -> bytes:
    """Return an application or library as a record of packets and files; memory addresses are 0."""
    return pk.APP_INFO.pack(
        ResourceId=info.resource_id,
        Type=info.type,
        Name=info.name,
        EntryPoint=info.entry_point,
        FileName=info.file_name,
        StackSize=info.stack_size,
        ExceptionAction=info.exception_action,
        Priority=info.priority,
        MainTaskId=info.main_task_id,
        ExecutionCounter=info.execution_counter,
        MainTaskName=info.main_task_name,
        NumOfChildTasks=info.num_of_child_tasks,
    )


def task_info_record(info: TaskInfo) -> bytes:
    """Return a task as a record of the task info file."""
    return pk.TASK_INFO.pack(
        TaskId=info.task_id,
        ExecutionCounter=info.execution_counter,
        TaskName=info.task_name,
        AppId=info.app_id,
        AppName=info.app_name,
        StackSize=info.stack_size,
        Priority=info.priority,
    )


class LogCommands(CommandGroup):
    """The two logs."""

    def __init__(self, es: ExecutiveServices, replies: Replies) -> None:
        super().__init__(es, replies)
        self._er_log_file = FileWriteMetaData(
            "", SUBTYPE_ES_ERLOG, ER_LOG_DESCRIPTION, self._er_log_record, self._er_log_written
        )

    def handlers(self) -> Handlers:
        return (
            (pk.CLEAR_SYS_LOG, self._clear_sys_log),
            (pk.WRITE_SYS_LOG, self._write_sys_log),
            (pk.OVER_WRITE_SYS_LOG, self._set_sys_log_mode),
            (pk.CLEAR_ER_LOG, self._clear_er_log),
            (pk.WRITE_ER_LOG, self._write_er_log),
        )

    # -- the system log --------------------------------------------------------------------------------------------

    def _clear_sys_log(self, packet: bytes) -> None:
        self._es.syslog.clear()
        self._replies.accept(ev.SYSLOG1_INF_EID, "Cleared Executive Services log data")

    def _write_sys_log(self, packet: bytes) -> None:
        name = pk.WRITE_SYS_LOG.read(packet)["FileName"]
        lines = self._es.syslog.read().splitlines(keepends=True)
        write_dump(self._es, self._replies, SYS_LOG_FILE, name, lines)

    def _set_sys_log_mode(self, packet: bytes) -> None:
        mode = pk.OVER_WRITE_SYS_LOG.read(packet)["Mode"]
        try:
            self._es.syslog.set_mode(mode & 0xFF)  # CFE_ES_LogMode_Enum_t has 8 bits, the field has 32
        except CfeError:
            text = f"Set OverWriteSysLog Command: Invalid Mode setting = {to_signed(mode)}"
            self._replies.reject(ev.ERR_SYSLOGMODE_EID, text)
            return
        text = f"Set OverWriteSysLog Command Received with Mode setting = {to_signed(mode)}"
        self._replies.accept(ev.SYSLOGMODE_EID, text, ev.DEBUG)

    # -- the exception and reset log -------------------------------------------------------------------------------

    def _clear_er_log(self, packet: bytes) -> None:
        self._es.er_log.clear()
        self._replies.accept(ev.ERLOG1_INF_EID, "Cleared ES Exception and Reset Log data")

    def _write_er_log(self, packet: bytes) -> None:
        """Request that the background task writes the file; an event follows when it is written."""
        file = self._er_log_file
        try:
            if file.is_pending:
                raise CfeError(CFE_STATUS_REQUEST_ALREADY_PENDING, "the log is being written")
            file.file_name = dump_file_name(pk.WRITE_ER_LOG.read(packet)["FileName"], ER_LOG_FILE)
            self._es.ports.fs.background_file_dump_request(file)
        except CfeError as error:
            if error.status == CFE_STATUS_REQUEST_ALREADY_PENDING:
                self._replies.reject(ev.ERLOG_PENDING_ERR_EID, "Error log write already in progress")
            else:
                self._replies.reject(ev.ERLOG2_ERR_EID, f"Error creating file, RC = {error.status}")
            return
        self._replies.command_counter += 1

    def _er_log_record(self, number: int) -> tuple[bytes, bool]:
        last = len(self._es.reset.er_log.slots) - 1
        return self._es.er_log.file_record(number), number >= last

    def _er_log_written(self, event: FileWriteEvent, status: int, record: int, block: int, position: int) -> None:
        path, send = self._er_log_file.file_name, self._replies.send
        if event == FileWriteEvent.COMPLETE:
            send(ev.ERLOG2_EID, f"{path} written:Size={position}", ev.DEBUG)
        elif event == FileWriteEvent.CREATE_ERROR:
            send(ev.ERLOG2_ERR_EID, f"Error creating file {path}, RC = {status}", ev.ERROR)
        else:
            text = f"File write,byte cnt err,file {path},request={block},actual={status & 0xFFFFFFFF}"
            send(ev.FILEWRITE_ERR_EID, text, ev.ERROR)


class PerfCommands(CommandGroup):
    """The performance log.

    Args:
        es: the service.
        replies: the replies to commands.
        dump: writes the log's file.
    """

    def __init__(self, es: ExecutiveServices, replies: Replies, dump: PerfDump) -> None:
        super().__init__(es, replies)
        self._dump = dump

    @property
    def _log(self) -> PerformanceLog:
        return self._es.perf_log

    def handlers(self) -> Handlers:
        return (
            (pk.START_PERF_DATA, self._start),
            (pk.STOP_PERF_DATA, self._stop),
            (pk.SET_PERF_FILTER_MASK, self._set_filter_mask),
            (pk.SET_PERF_TRIGGER_MASK, self._set_trigger_mask),
        )

    def _start(self, packet: bytes) -> None:
        mode = pk.START_PERF_DATA.read(packet)["TriggerMode"]
        what = "Cannot start collecting performance data,"
        if self._dump.is_busy:
            self._replies.reject(ev.PERF_STARTCMD_ERR_EID, f"{what}perf data write in progress")
        elif mode > TRIGGER_END:
            text = f"{what} trigger mode ({to_signed(mode)}) out of range ({TRIGGER_START} to {TRIGGER_END})"
            self._replies.reject(ev.PERF_STARTCMD_TRIG_ERR_EID, text)
        else:
            self._log.start(mode)
            text = f"Start collecting performance data cmd received, trigger mode = {mode}"
            self._replies.accept(ev.PERF_STARTCMD_EID, text, ev.DEBUG)

    def _stop(self, packet: bytes) -> None:
        if self._dump.is_busy:
            text = "Stop performance data cmd ignored,perf data write in progress"
            self._replies.reject(ev.PERF_STOPCMD_ERR2_EID, text)
            return
        self._log.stop()
        try:
            path = dump_file_name(pk.STOP_PERF_DATA.read(packet)["DataFileName"], PERF_FILE)
        except CfeError as error:
            self._replies.reject(ev.PERF_LOG_ERR_EID, f"Error parsing filename, RC = {error.status}")
            return
        self._dump.start(path)
        self._es.background_wakeup()
        count = self._log.data.count
        delays = f"{DELAY_MS}mS dly every {ENTRIES_BETWEEN_DELAYS} entries"
        self._replies.accept(ev.PERF_STOPCMD_EID, f"Perf Stop Cmd Rcvd, will write {count} entries.{delays}", ev.DEBUG)

    def _set_filter_mask(self, packet: bytes) -> None:
        fields = pk.SET_PERF_FILTER_MASK.read(packet)
        number, mask = fields["FilterMaskNum"], fields["FilterMask"]
        if number >= PERF_MASK_WORDS:
            text = f"Performance Filter Mask Cmd Error,Index({number})out of range({PERF_MASK_WORDS})"
            self._replies.reject(ev.PERF_FILTMSKERR_EID, text)
            return
        self._log.data.filter_mask[number] = mask
        text = f"Set Performance Filter Mask Cmd rcvd, num {number}, val 0x{mask:08X}"
        self._replies.accept(ev.PERF_FILTMSKCMD_EID, text, ev.DEBUG)

    def _set_trigger_mask(self, packet: bytes) -> None:
        fields = pk.SET_PERF_TRIGGER_MASK.read(packet)
        number, mask = fields["TriggerMaskNum"], fields["TriggerMask"]
        if number >= PERF_MASK_WORDS:
            text = f"Performance Trigger Mask Cmd Error,Index({number})out of range({PERF_MASK_WORDS})"
            self._replies.reject(ev.PERF_TRIGMSKERR_EID, text)
            return
        self._log.data.trigger_mask[number] = mask
        text = f"Set Performance Trigger Mask Cmd rcvd,num {number}, val 0x{mask:08X}"
        self._replies.accept(ev.PERF_TRIGMSKCMD_EID, text, ev.DEBUG)


class CdsCommands(CommandGroup):
    """The critical data store."""

    def handlers(self) -> Handlers:
        return (pk.DELETE_CDS, self._delete), (pk.DUMP_CDS_REGISTRY, self._dump_registry)

    def _delete(self, packet: bytes) -> None:
        name = pk.DELETE_CDS.read_name(packet, "CdsName")
        try:
            self._es.delete_cds(name)
        except CfeError as error:
            event, text = _CDS_REFUSALS.get(error.status, _OTHER_CDS_REFUSAL)
            self._replies.reject(event, text.format(name=name, status=error.hex))
            return
        self._replies.accept(ev.CDS_DELETED_INFO_EID, f"Successfully removed '{name}' from CDS")

    def _dump_registry(self, packet: bytes) -> None:
        name = pk.DUMP_CDS_REGISTRY.read(packet)["DumpFilename"]
        write_dump(self._es, self._replies, CDS_REGISTRY_FILE, name, map(_cds_record, self._es.cds_blocks()))


def _cds_record(block: CdsBlock) -> bytes:
    return pk.CDS_REG_DUMP_RECORD.pack(Handle=block.handle, Size=block.user_size, Table=block.is_table, Name=block.name)
