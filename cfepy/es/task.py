"""The Executive Services application: command pipe, commands, housekeeping (cfe_es_task.c, cfe_es_dispatch.c)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cfepy.es import events as ev
from cfepy.es import packets as pk
from cfepy.es.background import PRIORITY, STACK_SIZE, TASK_NAME, BackgroundTask
from cfepy.es.records import RUNNING, StartParams
from cfepy.es.service import ExecutiveServices
from cfepy.es.startup_script import EXCEPTION_PROC_RESTART
from cfepy.es.syslog import DISCARD, OVERWRITE
from cfepy.fs import FileCategory, parse_input_file_name
from cfepy.msg import CMD_HEADER_SIZE, CommandTable, Layout, telemetry
from cfepy.msg.dispatch import BAD_CODE, BAD_MSG_ID, DONE
from cfepy.ports import PEND_FOREVER, SYSTEM_CORE_READY
from cfepy.psp.psp import RST_SUBTYPE_POWER_CYCLE, RST_TYPE_POWERON, RST_TYPE_PROCESSOR
from cfepy.status import CfeError
from cfepy.versions import CFE_VERSION, OFFICIAL, OSAL_VERSION, PSP_VERSION, version_string

PIPE_NAME = "ES_CMD_PIPE"
PIPE_DEPTH = 32
MODULES = ("CORE_API", "ES", "EVS", "FS", "SB", "TBL", "TIME", "OSAL", "PSP", "MSG", "SBR", "RESOURCEID", "CONFIG")


class EsTask:
    """The core application CFE_ES.

    Args:
        es: the service.
        mission_name: for the version events.
        build: what the build event says: "Build ... by ...".
        checksum: of the executive's code, 16 bits.
    """

    def __init__(self, es: ExecutiveServices, mission_name: str, build: str, checksum: int) -> None:
        self.es = es
        self.ports = es.ports
        self.background = BackgroundTask(es)
        self.mission_name = mission_name
        self.build = build
        self.checksum = checksum
        self.command_counter = self.error_counter = 0
        self.commands = CommandTable()
        handlers: tuple[tuple[int, Layout | None, Callable[[bytes], None]], ...] = (
            (pk.NOOP_CC, None, self._noop),
            (pk.RESET_COUNTERS_CC, None, self._reset_counters),
            (pk.RESTART_CC, pk.RESTART_COMMAND, self._restart),
            (pk.START_APP_CC, pk.START_APP_COMMAND, self._start_app),
            (pk.STOP_APP_CC, pk.APP_NAME_COMMAND, self._stop_app),
            (pk.RESTART_APP_CC, pk.APP_NAME_COMMAND, self._restart_app),
            (pk.RELOAD_APP_CC, pk.APP_RELOAD_COMMAND, self._reload_app),
            (pk.QUERY_ONE_CC, pk.APP_NAME_COMMAND, self._query_one),
            (pk.CLEAR_SYS_LOG_CC, None, self._clear_sys_log),
            (pk.OVER_WRITE_SYS_LOG_CC, pk.OVER_WRITE_SYS_LOG_COMMAND, self._over_write_sys_log),
            (pk.SEND_MEM_POOL_STATS_CC, pk.POOL_COMMAND, self._send_pool_stats),
        )
        for code, layout, handler in handlers:
            size = CMD_HEADER_SIZE + (layout.size if layout is not None else 0)
            self.commands.add(pk.CMD_MID, code, size, handler)
        self.commands.add_message(pk.SEND_HK_MID, CMD_HEADER_SIZE, self._send_housekeeping)

    def task_main(self) -> None:
        """The main task of CFE_ES (CFE_ES_TaskMain)."""
        es, sb = self.es, self.ports.sb
        self.ports.evs.register(())
        pipe = sb.create_pipe(PIPE_DEPTH, PIPE_NAME)
        sb.subscribe(pk.SEND_HK_MID, pipe)
        sb.subscribe(pk.CMD_MID, pipe)
        self._announce()
        es.create_child_task(TASK_NAME, self.background.main, STACK_SIZE, PRIORITY)
        es.wait_for_system_state(SYSTEM_CORE_READY, es.config.es_core_max_startup_ms)
        while True:
            es.increment_task_counter()
            packet = sb.receive_buffer(pipe, PEND_FOREVER)
            if packet is not None:
                self.process(packet)
                self.background.wake()  # a command may have asked for something that the scan does

    def _announce(self) -> None:
        self._send(ev.INIT_INF_EID, f"cFE ES Initialized: {version_string('CFE_ES')}")
        self._send(
            ev.INITSTATS_INF_EID,
            f"cFS Versions: cfe {CFE_VERSION}, osal {OSAL_VERSION}, psp {PSP_VERSION}. cFE chksm {self.checksum}",
        )
        self._send(ev.VERSION_INF_EID, f"Version Info: Mission {self.mission_name}, version git:{OFFICIAL}")
        for module in MODULES:
            self._send(ev.VERSION_INF_EID, f"Version Info: Module {module}, version git:{OFFICIAL}")
        self._send(ev.BUILD_INF_EID, self.build)

    def process(self, packet: bytes) -> None:
        """Handle one packet of the command pipe (CFE_ES_TaskPipe)."""
        done = self.commands.dispatch(packet)
        if done.outcome == DONE:
            return
        if done.outcome == BAD_MSG_ID:
            event, text = ev.MID_ERR_EID, f"Invalid command pipe message ID: 0x{done.msg_id:X}"
        elif done.outcome == BAD_CODE:
            event, text = ev.CC1_ERR_EID, f"Invalid ground command code: ID = 0x{done.msg_id:X}, CC = {done.fcn_code}"
        else:
            event, text = ev.LEN_ERR_EID, done.length_text()
        self.error_counter += 1
        self._send(event, text, ev.ERROR)

    def _send(self, event_id: int, text: str, kind: int = ev.INFORMATION) -> None:
        self.ports.evs.send_event(event_id, kind, text)

    def _accept(self, event_id: int, text: str, kind: int = ev.INFORMATION) -> None:
        self.command_counter += 1
        self._send(event_id, text, kind)

    def _reject(self, event_id: int, text: str) -> None:
        self.error_counter += 1
        self._send(event_id, text, ev.ERROR)

    # -- commands --------------------------------------------------------------------------------------------------

    def _noop(self, packet: bytes) -> None:
        self.command_counter += 1
        self._send(ev.BUILD_INF_EID, self.build)
        versions = f" cFS Versions: cfe {CFE_VERSION}, osal {OSAL_VERSION}, psp {PSP_VERSION}"
        self._send(ev.NOOP_INF_EID, f"No-op command:\n{versions}")

    def _reset_counters(self, packet: bytes) -> None:
        self.command_counter = self.error_counter = 0
        self._send(ev.RESET_INF_EID, "Reset Counters command")

    def _restart(self, packet: bytes) -> None:
        kind = pk.RESTART_COMMAND.unpack(packet, CMD_HEADER_SIZE)["RestartType"]
        if kind not in (RST_TYPE_PROCESSOR, RST_TYPE_POWERON):
            self._reject(ev.BOOT_ERR_EID, f"Invalid cFE restart type: {kind}")
            return
        name = "PROCESSOR" if kind == RST_TYPE_PROCESSOR else "POWERON"
        self.es.write_to_sys_log(f"CFE_ES_ResetCFE: {name} RESET called from CFE_ES_ResetCFE (Commanded).")
        self.es.on_reset(kind, f"{name} RESET (Commanded)")

    def _start_app(self, packet: bytes) -> None:
        fields = pk.START_APP_COMMAND.unpack(packet, CMD_HEADER_SIZE)
        name = fields["Application"]
        refusal = self._why_not_start(fields)
        if refusal is not None:
            self._reject(*refusal)
            return
        file = parse_input_file_name(fields["AppFileName"], FileCategory.DYNAMIC_MODULE)
        stack = fields["StackSize"] or self.es.config.es_default_stack_size
        action = fields["ExceptionAction"]
        try:
            params = StartParams(file, fields["AppEntryPoint"], stack, fields["Priority"], action)
            app_id = self.es.create_app(name, params)
        except CfeError as failure:
            status = failure.hex
            self._reject(ev.START_ERR_EID, f"Failed to start {name} from {file}, RC = {status}")
            return
        self._accept(ev.START_INF_EID, f"Started {name} from {file}, AppID = {app_id}")

    def _why_not_start(self, fields: dict[str, Any]) -> tuple[int, str] | None:
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

    def _stop_app(self, packet: bytes) -> None:
        self._control(packet, "Stop", self.es.delete_app, ev.STOP_DBG_EID, ev.STOP_ERR1_EID, ev.STOP_ERR2_EID)

    def _restart_app(self, packet: bytes) -> None:
        ids = ev.RESTART_APP_DBG_EID, ev.RESTART_APP_ERR1_EID, ev.RESTART_APP_ERR2_EID
        self._control(packet, "Restart", self.es.restart_app, *ids)

    def _reload_app(self, packet: bytes) -> None:
        file = pk.APP_RELOAD_COMMAND.unpack(packet, CMD_HEADER_SIZE)["AppFileName"]

        def reload(app_id: int) -> None:
            self.es.reload_app(app_id, parse_input_file_name(file, FileCategory.DYNAMIC_MODULE))

        ids = ev.RELOAD_APP_DBG_EID, ev.RELOAD_APP_ERR1_EID, ev.RELOAD_APP_ERR2_EID
        self._control(packet, "Reload", reload, *ids)

    def _control(
        self, packet: bytes, action: str, call: Callable[[int], None], begun: int, failed: int, unknown: int
    ) -> None:
        name = pk.APP_NAME_COMMAND.unpack(packet, CMD_HEADER_SIZE)["Application"]
        try:
            app_id = self.es.get_app_id_by_name(name)
        except CfeError as missing:
            status = missing.hex
            self._reject(unknown, f"{action} Application {name}, GetAppIDByName failed. RC = {status}.")
            return
        try:
            call(app_id)
        except CfeError as failure:
            self._reject(failed, f"{action} Application {name} Failed, RC = {failure.hex}")
            return
        self._accept(begun, f"{action} Application {name} Initiated.", ev.DEBUG)

    def _query_one(self, packet: bytes) -> None:
        name = pk.APP_NAME_COMMAND.unpack(packet, CMD_HEADER_SIZE)["Application"]
        try:
            info = self.es.get_app_info(self.es.get_app_id_by_name(name))
        except CfeError as missing:
            status = missing.hex
            text = f"Failed to send {name} application data: GetAppIDByName Failed, RC = {status}"
            self._reject(ev.ONE_APPID_ERR_EID, text)
            return
        payload = pk.APP_INFO.pack(
            ResourceId=info.app_id,
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
        self.ports.sb.transmit_msg(bytes(telemetry(pk.APP_TLM_MID, payload)))
        self._accept(ev.ONE_APP_EID, f"Sent {name} application data", ev.DEBUG)

    def _clear_sys_log(self, packet: bytes) -> None:
        self.es.syslog.clear()
        self._accept(ev.SYSLOG1_INF_EID, "Cleared Executive Services log data")

    def _over_write_sys_log(self, packet: bytes) -> None:
        mode = pk.OVER_WRITE_SYS_LOG_COMMAND.unpack(packet, CMD_HEADER_SIZE)["Mode"]
        if mode not in (OVERWRITE, DISCARD):
            text = f"Set OverWriteSysLog Command: Invalid Mode setting = {mode}"
            self._reject(ev.ERR_SYSLOGMODE_EID, text)
            return
        self.es.syslog.mode = mode
        text = f"Set OverWriteSysLog Command Received with Mode setting = {mode}"
        self._accept(ev.SYSLOGMODE_EID, text, ev.DEBUG)

    def _send_pool_stats(self, packet: bytes) -> None:
        handle = pk.POOL_COMMAND.unpack(packet, CMD_HEADER_SIZE)["PoolHandle"]
        try:
            statistics = self.es.get_mem_pool_stats(handle)
        except CfeError:
            text = f"Cannot telemeter memory pool stats. Illegal Handle (0x{handle:08X})"
            self._reject(ev.INVALID_POOL_HANDLE_ERR_EID, text)
            return
        payload = pk.POOL_STATS_TLM.pack(PoolHandle=handle, PoolStats=statistics)
        self.ports.sb.transmit_msg(bytes(telemetry(pk.MEMSTATS_TLM_MID, payload)))
        text = f"Successfully telemetered memory pool stats for 0x{handle:08X}"
        self._accept(ev.TLM_POOL_STATS_INFO_EID, text, ev.DEBUG)

    # -- telemetry -------------------------------------------------------------------------------------------------

    def _send_housekeeping(self, packet: bytes) -> None:
        payload = pk.HOUSEKEEPING.pack(self.housekeeping())
        self.ports.sb.transmit_msg(bytes(telemetry(pk.HK_TLM_MID, payload)))

    def housekeeping(self) -> dict[str, int]:
        """The fields of the housekeeping packet; what this release does not have yet is 0."""
        es = self.es
        return {
            "CommandCounter": self.command_counter & 0xFF,
            "CommandErrorCounter": self.error_counter & 0xFF,
            "CFECoreChecksum": self.checksum,
            **{f"{name}MajorVersion": 7 for name in ("CFE", "OSAL", "PSP")},
            "SysLogBytesUsed": es.syslog.bytes_used,
            "SysLogSize": es.syslog.size,
            "SysLogEntries": len(es.syslog.entries),
            "SysLogMode": es.syslog.mode,
            "RegisteredCoreApps": sum(app.is_core for app in es.apps),
            "RegisteredExternalApps": sum(not app.is_core and app.state <= RUNNING for app in es.apps),
            "RegisteredTasks": sum(len(app.tasks) for app in es.apps),
            "RegisteredLibs": len(es.libs),
            "ResetType": RST_TYPE_POWERON,
            "ResetSubtype": RST_SUBTYPE_POWER_CYCLE,
            "ProcessorResets": self.background.processor_resets,
            "MaxProcessorResets": es.config.es_max_processor_resets,
            "BootSource": 1,
        }
