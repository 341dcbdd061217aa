"""Commands that tell about applications, libraries, tasks and memory pools, in packets and in files (CFE_ES_Query*)."""

from __future__ import annotations

from cfepy.es import events as ev
from cfepy.es import packets as pk
from cfepy.es.command_group import CommandGroup, Handlers
from cfepy.es.dump_files import APP_INFO_FILE, TASK_INFO_FILE, write_dump
from cfepy.es.records import AppInfo, TaskInfo
from cfepy.msg import telemetry
from cfepy.status import CFE_ES_ERR_NAME_NOT_FOUND, CfeError


class QueryCommands(CommandGroup):
    """Telling about applications, libraries, tasks and memory pools."""

    def handlers(self) -> Handlers:
        return (
            (pk.QUERY_ONE, self._query_one),
            (pk.QUERY_ALL, self._query_all),
            (pk.QUERY_ALL_TASKS, self._query_all_tasks),
            (pk.SEND_MEM_POOL_STATS, self._send_pool_stats),
        )

    def _query_one(self, packet: bytes) -> None:
        name = pk.QUERY_ONE.read(packet)["Application"]
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
        """Id of an application, or else a library, of that name."""
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
    """An application or a library as in packets and files; memory addresses are 0."""
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
    """A task as in the file about tasks."""
    return pk.TASK_INFO.pack(
        TaskId=info.task_id,
        ExecutionCounter=info.execution_counter,
        TaskName=info.task_name,
        AppId=info.app_id,
        AppName=info.app_name,
        StackSize=info.stack_size,
        Priority=info.priority,
    )
