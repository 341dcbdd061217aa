"""Calls of Executive Services in a script; app/api_es.c has them in C."""

from __future__ import annotations

from typing import Any

from cfepy.es.pools import PoolBlock
from dev.twin.api.words import Answer, Id, Line


def _info(info: Any) -> Answer:
    return (
        Id(info.resource_id),
        info.type,
        info.name,
        info.entry_point,
        info.file_name,
        info.stack_size,
        info.exception_action,
        info.priority,
        Id(info.main_task_id),
        info.main_task_name,
        info.num_of_child_tasks,
    )


def _task(info: Any) -> Answer:
    return (
        Id(info.task_id),
        info.task_name,
        Id(info.app_id),
        info.app_name,
        info.stack_size,
        info.priority,
    )


class EsCalls:
    """The calls. `play` is the player, `w` the arguments."""

    def __init__(self, play: Any) -> None:
        self.play, self.es = play, play.cfe.es
        self.blocks: dict[int, PoolBlock] = {}

    def ES_GetAppName(self, w: Line) -> Answer:
        return 0, self.es.get_app_name(w.num(1))

    def ES_GetLibName(self, w: Line) -> Answer:
        return 0, self.es.get_lib_name(w.num(1))

    def ES_GetTaskName(self, w: Line) -> Answer:
        return 0, self.es.get_task_name(w.num(1))

    def ES_GetGenCounterName(self, w: Line) -> Answer:
        return 0, self.es.get_gen_counter_name(w.num(1))

    def ES_GetCDSBlockName(self, w: Line) -> Answer:
        return 0, self.es.get_cds_block_name(w.num(1))

    def ES_GetAppIDByName(self, w: Line) -> Answer:
        return 0, w.keep(1, self.es.get_app_id_by_name(w.text(2)))

    def ES_GetLibIDByName(self, w: Line) -> Answer:
        return 0, w.keep(1, self.es.get_lib_id_by_name(w.text(2)))

    def ES_GetTaskIDByName(self, w: Line) -> Answer:
        return 0, w.keep(1, self.es.get_task_id_by_name(w.text(2)))

    def ES_GetGenCounterIDByName(self, w: Line) -> Answer:
        return 0, w.keep(1, self.es.get_gen_counter_id_by_name(w.text(2)))

    def ES_RegisterGenCounter(self, w: Line) -> Answer:
        return 0, w.keep(1, self.es.register_gen_counter(w.text(2)))

    def ES_GetCDSBlockIDByName(self, w: Line) -> Answer:
        return 0, w.keep(1, self.es.get_cds_block_id_by_name(w.text(2)))

    def ES_AppID_ToIndex(self, w: Line) -> Answer:
        return 0, self.es.app_id_to_index(w.num(1))

    def ES_LibID_ToIndex(self, w: Line) -> Answer:
        return 0, self.es.lib_id_to_index(w.num(1))

    def ES_TaskID_ToIndex(self, w: Line) -> Answer:
        return 0, self.es.task_id_to_index(w.num(1))

    def ES_CounterID_ToIndex(self, w: Line) -> Answer:
        return 0, self.es.counter_id_to_index(w.num(1))

    def ES_GetAppID(self, w: Line) -> Answer:
        return 0, w.keep(1, self.es.get_app_id())

    def ES_GetTaskID(self, w: Line) -> Answer:
        return 0, w.keep(1, self.es.get_task_id())

    def ES_GetAppInfo(self, w: Line) -> Answer:
        return 0, *_info(self.es.get_app_info(w.num(1)))

    def ES_GetLibInfo(self, w: Line) -> Answer:
        return 0, *_info(self.es.get_lib_info(w.num(1)))

    def ES_GetModuleInfo(self, w: Line) -> Answer:
        return 0, *_info(self.es.get_module_info(w.num(1)))

    def ES_GetTaskInfo(self, w: Line) -> Answer:
        return 0, *_task(self.es.get_task_info(w.num(1)))

    def ES_CreateChildTask(self, w: Line) -> Answer:
        task = self.es.create_child_task(w.text(2), self.play.child_main, w.num(3), w.num(4), w.num(5))
        self.play.cfe.os.task_delay(5)
        return 0, w.keep(1, task)

    def ES_DeleteChildTask(self, w: Line) -> Answer:
        self.es.delete_child_task(w.num(1))
        self.play.cfe.os.task_delay(5)
        return (0,)

    def ES_ExitChildTask(self, w: Line) -> Answer:
        self.es.exit_child_task()
        return (0,)

    def ES_IncrementTaskCounter(self, w: Line) -> Answer:
        self.es.increment_task_counter()
        return (0,)

    def ES_ExecutionCounter(self, w: Line) -> Answer:
        return 0, self.es.get_task_info(w.num(1)).execution_counter

    def ES_BackgroundWakeup(self, w: Line) -> Answer:
        self.es.background_wakeup()
        self.play.cfe.os.task_delay(5)
        return (0,)

    def ES_ProcessAsyncEvent(self, w: Line) -> Answer:
        self.es.process_async_event()
        return (0,)

    def ES_WaitForSystemState(self, w: Line) -> Answer:
        self.es.wait_for_system_state(w.num(1), w.num(2))
        return (0,)

    def ES_WaitForStartupSync(self, w: Line) -> Answer:
        self.es.wait_for_startup_sync(w.num(1))
        return (0,)

    def ES_GetResetType(self, w: Line) -> Answer:
        found = self.es.get_reset_type()
        return found.reset_type, found.subtype

    def ES_RestartApp(self, w: Line) -> Answer:
        self.es.restart_app(w.num(1))
        return (0,)

    def ES_ReloadApp(self, w: Line) -> Answer:
        self.es.reload_app(w.num(1), w.text(2))
        return (0,)

    def ES_DeleteApp(self, w: Line) -> Answer:
        self.es.delete_app(w.num(1))
        return (0,)

    def ES_ResetCFE(self, w: Line) -> Answer:
        self.es.reset_cfe(w.num(1))
        return (0,)

    def ES_RunLoop(self, w: Line) -> Answer:
        goes_on = self.es.run_loop(w.num(1))
        self.es.run_loop(1)
        return 0, goes_on

    def ES_WriteToSysLog(self, w: Line) -> Answer:
        return (self.es.write_to_sys_log(w.text(1)),)

    def ES_CalculateCRC(self, w: Line) -> Answer:
        return 0, self.es.calculate_crc(w.data(1), w.num(2), w.num(3))

    def ES_PerfLogAdd(self, w: Line) -> Answer:
        self.es.perf_log_add(w.num(1), w.num(2))
        return (0,)

    def ES_StatusToString(self, w: Line) -> Answer:
        return 0, self.es.status_to_string(w.num(1))

    def ES_RegisterCDS(self, w: Line) -> Answer:
        handle = self.es.register_cds(w.num(2), w.text(3))
        return handle.status, w.keep(1, handle)

    def ES_CopyToCDS(self, w: Line) -> Answer:
        self.es.copy_to_cds(w.num(1), w.data(2))
        return (0,)

    def ES_RestoreFromCDS(self, w: Line) -> Answer:
        return 0, self.es.restore_from_cds(w.num(1))[: w.num(2)]

    def ES_PoolCreate(self, w: Line) -> Answer:
        return 0, w.keep(1, self.es.pool_create(w.num(2)))

    def ES_PoolCreateNoSem(self, w: Line) -> Answer:
        return 0, w.keep(1, self.es.pool_create_no_sem(w.num(2)))

    def ES_PoolCreateEx(self, w: Line) -> Answer:
        sizes = [w.num(word) for word in range(5, len(w) + 1)]
        return 0, w.keep(1, self.es.pool_create_ex(w.num(2), sizes or None, bool(w.num(3))))

    def ES_PoolDelete(self, w: Line) -> Answer:
        self.es.pool_delete(w.num(1))
        return (0,)

    def ES_GetPoolBuf(self, w: Line) -> Answer:
        block = self.es.get_pool_buf(w.num(1), w.num(2))
        self.blocks[w.num(3)] = block
        return w.num(2), block.offset

    def ES_GetPoolBufInfo(self, w: Line) -> Answer:
        block = self.blocks.get(w.num(2))
        return (self.es.get_pool_buf_info(w.num(1), block) if block is not None else 0,)

    def ES_PutPoolBuf(self, w: Line) -> Answer:
        block = self.blocks.get(w.num(2))
        return (self.es.put_pool_buf(w.num(1), block) if block is not None else 0,)

    def ES_GetMemPoolStats(self, w: Line) -> Answer:
        stats = self.es.get_mem_pool_stats(w.num(1))
        rows = [row[name] for row in stats["BlockStats"] for name in ("BlockSize", "NumCreated", "NumFree")]
        return 0, *(stats[n] for n in ("PoolSize", "NumBlocksRequested", "CheckErrCtr", "NumFreeBytes")), *rows

    def ES_DeleteGenCounter(self, w: Line) -> Answer:
        self.es.delete_gen_counter(w.num(1))
        return (0,)

    def ES_IncrementGenCounter(self, w: Line) -> Answer:
        self.es.increment_gen_counter(w.num(1))
        return (0,)

    def ES_SetGenCount(self, w: Line) -> Answer:
        self.es.set_gen_count(w.num(1), w.num(2))
        return (0,)

    def ES_GetGenCount(self, w: Line) -> Answer:
        return 0, self.es.get_gen_count(w.num(1))
