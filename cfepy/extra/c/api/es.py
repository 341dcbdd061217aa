"""CFE_ES_*: Executive Services for C, except pools (`memory_pools`) and the Critical Data Store (`cds`)."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, NoReturn

from cfepy.es import AppInfo
from cfepy.extra.c.api.pointers import name_into, need
from cfepy.extra.c.memory import chars
from cfepy.extra.c.stacks import LEAST
from cfepy.ids import ES_APPID_BASE, ES_LIBID_BASE, get_base
from cfepy.status import CFE_ES_BAD_ARGUMENT, CFE_SUCCESS, CfeError

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

BAD = CFE_ES_BAD_ARGUMENT
APP_RUN = 1
APP_INFO = struct.Struct("<II20s20s64sQI4xQQQQQQQBxHII20sI4x")
"""CFE_ES_AppInfo_t on a 64-bit computer."""
TASK_INFO = struct.Struct("<II20sI20s4xQH6x")
"""CFE_ES_TaskInfo_t."""


def declare(api: Declarations, c: CRuntime) -> None:
    _declare_lives(api, c)
    _declare_ids(api, c)
    _declare_info(api, c)
    _declare_tasks(api, c)
    _declare_counters(api, c)
    _declare_rest(api, c)


def refuse(c: CRuntime, text: str) -> NoReturn:
    """Log a missing pointer, and refuse the call.

    Raises:
        CfeError: CFE_ES_BAD_ARGUMENT.
    """
    c.handle.es.write_to_sys_log(text)
    raise CfeError(BAD, text)


def _declare_lives(api: Declarations, c: CRuntime) -> None:
    """Add functions for the life of applications and of the processor."""
    es, memory = c.handle.es, c.memory

    def run_loop(status: int) -> bool:
        wish = memory.u32(status) if status else APP_RUN
        goes_on = es.run_loop(wish)
        if not goes_on and status and wish == APP_RUN:
            memory.put_u32(status, es.control_request())
        return goes_on

    def get_reset_type(subtype: int) -> int:
        kind = es.get_reset_type()
        if subtype:
            memory.put_u32(subtype, int(kind.subtype))
        return int(kind.reset_type)

    def reload_app(app_id: int, file: str) -> None:
        need(BAD, file)
        es.reload_app(app_id, file)

    api.add("CFE_ES_RunLoop", "$p", run_loop)
    api.add("CFE_ES_ExitApp", "I", es.exit_app)
    api.add("CFE_ES_WaitForStartupSync", "I", es.wait_for_startup_sync)
    api.add("CFE_ES_WaitForSystemState", "II", es.wait_for_system_state)
    api.add("CFE_ES_GetResetType", "p", get_reset_type)
    api.add("CFE_ES_ResetCFE", "I", es.reset_cfe)
    api.add("CFE_ES_RestartApp", "I", es.restart_app)
    api.add("CFE_ES_ReloadApp", "Is", reload_app)
    api.add("CFE_ES_DeleteApp", "I", es.delete_app)


def _declare_ids(api: Declarations, c: CRuntime) -> None:
    """Add functions for ids and names."""
    es = c.handle.es
    for what, to_index in (
        ("App", es.app_id_to_index),
        ("Lib", es.lib_id_to_index),
        ("Task", es.task_id_to_index),
        ("Counter", es.counter_id_to_index),
    ):
        api.add(f"CFE_ES_{what}ID_ToIndex", "I4", to_index, BAD)
    api.add("CFE_ES_GetAppID", "~4", es.get_app_id, BAD)
    api.add("CFE_ES_GetTaskID", "~4", es.get_task_id, BAD)
    for what, find in (
        ("App", es.get_app_id_by_name),
        ("Lib", es.get_lib_id_by_name),
        ("Task", es.get_task_id_by_name),
        ("GenCounter", es.get_gen_counter_id_by_name),
    ):
        api.add(f"CFE_ES_Get{what}IDByName", "~4S", find, BAD)
    api.add("CFE_ES_GetCDSBlockIDByName", "~4S", es.get_cds_block_id_by_name, BAD)
    for what, name_of in (
        ("App", es.get_app_name),
        ("Lib", es.get_lib_name),
        ("Task", es.get_task_name),
        ("GenCounter", es.get_gen_counter_name),
        ("CDSBlock", es.get_cds_block_name),
    ):
        too_long = BAD if what == "Task" else CFE_SUCCESS  # OSAL reports a cut name of a task
        api.add(f"CFE_ES_Get{what}Name", "pIQ", name_into(c.memory, name_of, BAD, too_long))


def _declare_info(api: Declarations, c: CRuntime) -> None:
    """Add functions for information about applications, libraries and tasks."""
    es, memory = c.handle.es, c.memory

    def put_info(at: int, info: AppInfo) -> None:
        image = c.applications.get(info.name) or c.libraries.get(info.file_name)
        code = (0,) * 8
        if image is not None:
            entry = image.symbols.get(info.entry_point, 0)
            code = (0,) * 7 + (entry,)
            if c.tells_code:
                code = (1, image.base, image.size, image.base, 1, image.base, 1, entry)
        is_known, code_address, code_size, data_address, data_size, bss_address, bss_size, start = code
        raw = APP_INFO.pack(
            info.resource_id,
            info.type,
            chars(info.name, 20),
            chars(info.entry_point, 20),
            chars(info.file_name, 64),
            info.stack_size,
            is_known,
            code_address,
            code_size,
            data_address,
            data_size,
            bss_address,
            bss_size,
            start,
            info.exception_action,
            info.priority,
            info.main_task_id,
            info.execution_counter,
            chars(info.main_task_name, 20),
            info.num_of_child_tasks,
        )
        memory.poke(at, raw)

    def need_room(at: int, what: str) -> None:
        if not at:
            refuse(c, f"CFE_ES_Get{what}Info: Invalid Parameter ( Null Pointer )")

    def get_app_info(at: int, app_id: int) -> None:
        need_room(at, "App")
        put_info(at, es.get_app_info(app_id))

    def get_lib_info(at: int, lib_id: int) -> None:
        need_room(at, "Lib")
        put_info(at, es.get_lib_info(lib_id))

    def get_module_info(at: int, module_id: int) -> None:
        what = {ES_APPID_BASE: "App", ES_LIBID_BASE: "Lib"}.get(get_base(module_id))
        if what is not None:
            need_room(at, what)
        put_info(at, es.get_module_info(module_id))

    api.add("CFE_ES_GetAppInfo", "pI", get_app_info)
    api.add("CFE_ES_GetLibInfo", "pI", get_lib_info)
    api.add("CFE_ES_GetModuleInfo", "pI", get_module_info)

    def get_task_info(at: int, task_id: int) -> None:
        need_room(at, "Task")
        info = es.get_task_info(task_id)
        raw = TASK_INFO.pack(
            info.task_id,
            info.execution_counter,
            chars(info.task_name, 20),
            info.app_id,
            chars(info.app_name, 20),
            info.stack_size,
            info.priority,
        )
        memory.poke(at, raw)

    api.add("CFE_ES_GetTaskInfo", "pI", get_task_info)


def _declare_tasks(api: Declarations, c: CRuntime) -> None:
    """Add functions for child tasks."""
    es, memory = c.handle.es, c.memory

    def create(out: int, name: str | None, entry: int, stack: int, size: int, priority: int, flags: int) -> None:
        if not out:
            lost = "and Name Pointer Parameters are" if name is None else "Pointer Parameter is"
            end = "." if name is None else f" for Task '{name}'."
            refuse(c, f"CFE_ES_CreateChildTask: Task Id {lost} NULL{end}")
        if name is None:
            refuse(c, "CFE_ES_CreateChildTask: TaskName Parameter is NULL")
        if not entry:
            refuse(c, f"CFE_ES_CreateChildTask: Function Pointer Parameter is NULL for Task '{name}'")
        room = size if stack else max(size, LEAST)
        made = es.create_child_task(name, lambda: c.run(entry, stack=stack, size=room), size, priority, flags)
        memory.put_u32(out, made)

    api.add("CFE_ES_CreateChildTask", "psppQHI", create)
    api.add("CFE_ES_DeleteChildTask", "I", es.delete_child_task)
    api.add("CFE_ES_ExitChildTask", "", es.exit_child_task)
    api.add("CFE_ES_IncrementTaskCounter", "", es.increment_task_counter)


def _declare_counters(api: Declarations, c: CRuntime) -> None:
    """Add functions for generic counters."""
    es = c.handle.es
    api.add("CFE_ES_RegisterGenCounter", "4S", es.register_gen_counter, BAD)
    api.add("CFE_ES_DeleteGenCounter", "I", es.delete_gen_counter)
    api.add("CFE_ES_IncrementGenCounter", "I", es.increment_gen_counter)
    api.add("CFE_ES_SetGenCount", "II", es.set_gen_count)
    api.add("CFE_ES_GetGenCount", "I4", es.get_gen_count, BAD)


def _declare_rest(api: Declarations, c: CRuntime) -> None:
    """Add functions for the system log, performance, checksums and the background task."""
    es, memory = c.handle.es, c.memory

    def calculate_crc(data: int, size: int, crc: int, kind: int) -> int:
        return es.calculate_crc(memory.peek(data, size), crc, kind) if data and size else crc

    def status_to_string(status: int, text: int) -> int:
        if text:
            memory.poke(text, es.status_to_string(status).encode() + b"\0")
        return text

    api.add("CFE_ES_WriteToSysLog", "f", es.write_to_sys_log, BAD)
    api.add("CFE_ES_PerfLogAdd", "II", es.perf_log_add)
    api.add("CFE_ES_CalculateCRC", "pQII", calculate_crc)
    api.add("CFE_ES_StatusToString", "ip", status_to_string)
    api.add("CFE_ES_ProcessAsyncEvent", "", es.process_async_event)
    api.add("CFE_ES_BackgroundWakeup", "", es.background_wakeup)
