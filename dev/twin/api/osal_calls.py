"""Calls of the OSAL and the PSP in a script; app/api_osal.c and app/api_psp.c have them in C."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cfepy import osal
from cfepy.osal.clock import time_from_total_nanoseconds
from cfepy.status import OS_ERROR_TIMEOUT, OS_QUEUE_EMPTY, OS_QUEUE_TIMEOUT, CfeError, OsalError, to_signed
from dev.twin.api.in_timer import in_timer
from dev.twin.api.words import Answer, Id, Line

KINDS = {
    "Task": "task",
    "Queue": "queue",
    "MutSem": "mut_sem",
    "BinSem": "bin_sem",
    "CountSem": "count_sem",
    "CondVar": "cond_var",
    "RwLock": "rw_lock",
    "Timer": "timer",
    "TimeBase": "time_base",
}
PLAIN = {
    "Delete": "delete",
    "Take": "take",
    "Give": "give",
    "Flush": "flush",
    "Lock": "lock",
    "Unlock": "unlock",
    "Signal": "signal",
    "Broadcast": "broadcast",
    "ReadTake": "read_take",
    "ReadGive": "read_give",
    "WriteTake": "write_take",
    "WriteGive": "write_give",
}
MORE = {
    "Task": ("stack_size", "priority"),
    "BinSem": ("value",),
    "CountSem": ("value",),
    "Timer": ("interval_time",),
    "TimeBase": ("nominal_interval_time",),
}
PATHS = {
    "OS_remove": "remove",
    "OS_rmdir": "rmdir",
    "OS_CloseFileByName": "close_file_by_name",
    "OS_unmount": "unmount",
    "OS_rmfs": "rmfs",
}


def status_of(call: Callable[..., object], *arguments: object) -> int:
    """Return the status of a call among others."""
    try:
        call(*arguments)
    except CfeError as error:
        return error.status
    return 0


class OsalCalls:
    """The calls. `play` is the player, `w` the arguments."""

    def __init__(self, play: Any) -> None:
        self.play, self.os, self.fired = play, play.cfe.os, 0

    def __getattr__(self, name: str) -> Callable[[Line], Answer]:
        """Return a call that all kinds of objects share."""
        if name in PATHS:
            return lambda w: _none(getattr(self.os, PATHS[name])(w.text(1)))
        for kind, stem in KINDS.items():
            if not name.startswith(f"OS_{kind}"):
                continue
            rest = name[3 + len(kind) :]
            if rest == "GetIdByName":
                return lambda w: (0, w.keep(1, getattr(self.os, f"{stem}_get_id_by_name")(w.text(2))))
            if rest == "GetInfo":
                return lambda w: self._info(kind, getattr(self.os, f"{stem}_get_info")(w.num(1)))
            if rest in PLAIN:
                return lambda w: _none(getattr(self.os, f"{stem}_{PLAIN[rest]}")(w.num(1)))
        raise AttributeError(name)

    def _info(self, kind: str, info: Any) -> Answer:
        return 0, info.name, Id(info.creator), *(getattr(info, field) for field in MORE.get(kind, ()))

    def _fire(self, *arguments: object) -> None:
        self.fired += 1

    def OS_TaskCreate(self, w: Line) -> Answer:
        task = self.os.task_create(w.text(2), self.play.child_main, w.num(3), w.num(4), w.num(5), owner=osal.NOBODY)
        return 0, w.keep(1, task)

    def OS_TaskDelete(self, w: Line) -> Answer:
        self.os.task_delete(w.num(1))
        self.os.task_delay(5)
        return (0,)

    def OS_TaskSetPriority(self, w: Line) -> Answer:
        self.os.task_set_priority(w.num(1), w.num(2))
        return (0,)

    def OS_TaskGetId(self, w: Line) -> Answer:
        return 0, Id(self.os.task_get_id())

    def OS_TaskDelay(self, w: Line) -> Answer:
        self.os.task_delay(w.num(1))
        return (0,)

    def OS_QueueCreate(self, w: Line) -> Answer:
        return 0, w.keep(1, self.os.queue_create(w.text(2), w.num(3), w.num(4), w.num(5)))

    def OS_QueuePut(self, w: Line) -> Answer:
        self.os.queue_put(w.num(1), w.data(2))
        return (0,)

    def OS_QueueGet(self, w: Line) -> Answer:
        found = self.os.queue_get(w.num(1), w.num(3))
        if found is None:
            return (OS_QUEUE_TIMEOUT if w.num(3) else OS_QUEUE_EMPTY,)
        return 0, found

    def OS_MutSemCreate(self, w: Line) -> Answer:
        return 0, w.keep(1, self.os.mut_sem_create(w.text(2), w.num(3)))

    def OS_BinSemCreate(self, w: Line) -> Answer:
        return 0, w.keep(1, self.os.bin_sem_create(w.text(2), w.num(3), w.num(4)))

    def OS_CountSemCreate(self, w: Line) -> Answer:
        return 0, w.keep(1, self.os.count_sem_create(w.text(2), w.num(3), w.num(4)))

    def OS_CondVarCreate(self, w: Line) -> Answer:
        return 0, w.keep(1, self.os.cond_var_create(w.text(2), w.num(3)))

    def OS_RwLockCreate(self, w: Line) -> Answer:
        return 0, w.keep(1, self.os.rw_lock_create(w.text(2), w.num(3)))

    def OS_BinSemTimedWait(self, w: Line) -> Answer:
        return (0 if self.os.bin_sem_timed_wait(w.num(1), w.num(2)) else osal_timeout(),)

    def OS_CountSemTimedWait(self, w: Line) -> Answer:
        return (0 if self.os.count_sem_timed_wait(w.num(1), w.num(2)) else osal_timeout(),)

    def OS_CondVarTimedWait(self, w: Line) -> Answer:
        until = self.os.time_add(self.os.get_local_time(), self.os.time_from_total_milliseconds(w.num(2)))
        return (0 if self.os.cond_var_timed_wait(w.num(1), until) else OS_ERROR_TIMEOUT,)

    def OS_TimerCreate(self, w: Line) -> Answer:
        return 0, w.keep(1, self.os.timer_create(w.text(2), self._fire))

    def OS_TimerAdd(self, w: Line) -> Answer:
        return 0, w.keep(1, self.os.timer_add(w.text(2), w.num(3), self._fire))

    def OS_TimerSet(self, w: Line) -> Answer:
        self.os.timer_set(w.num(1), w.num(2), w.num(3))
        return (0,)

    def OS_TimerFires(self, w: Line) -> Answer:
        self.fired = 0
        status = status_of(self.os.timer_set, w.num(1), w.num(2), w.num(3))
        self.os.task_delay(250)
        fired = min(self.fired, 2)
        status_of(self.os.timer_set, w.num(1), 100000000, 0)
        return status, fired

    def OS_InTimer(self, w: Line) -> Answer:
        answers = [12345]
        timer = self.os.timer_create(
            "IN_TIMER", lambda timer: answers.append(in_timer(self.play.cfe, w.num(1), timer, w.num(2)))
        )
        self.os.timer_set(timer, 20000, 0)
        self.os.task_delay(200)
        status_of(self.os.timer_delete, timer)
        return 0, answers[-1]

    def OS_TimeBaseCreate(self, w: Line) -> Answer:
        def sync(timebase: int) -> int:
            self.os.task_delay(10)
            return 10000

        return 0, w.keep(1, self.os.time_base_create(w.text(2), sync if w.num(3) else None))

    def OS_TimeBaseSet(self, w: Line) -> Answer:
        self.os.time_base_set(w.num(1), w.num(2), w.num(3))
        return (0,)

    def OS_TimeBaseGetFreeRun(self, w: Line) -> Answer:
        self.os.time_base_get_free_run(w.num(1))
        return (0,)

    def OS_OpenCreate(self, w: Line) -> Answer:
        return 0, w.keep(1, self.os.open_create(w.text(2), w.num(3), w.num(4)))

    def OS_close(self, w: Line) -> Answer:
        self.os.close(w.num(1))
        return (0,)

    def OS_read(self, w: Line) -> Answer:
        found = self.os.read(w.num(1), w.num(2))
        return len(found), found

    def OS_TimedRead(self, w: Line) -> Answer:
        found = self.os.timed_read(w.num(1), w.num(2), w.num(3))
        return (OS_ERROR_TIMEOUT,) if found is None else (len(found), found)

    def OS_write(self, w: Line) -> Answer:
        return (self.os.write(w.num(1), w.data(2)),)

    def OS_TimedWrite(self, w: Line) -> Answer:
        size = self.os.timed_write(w.num(1), w.data(2), w.num(3))
        return (OS_ERROR_TIMEOUT if size is None else size,)

    def OS_FileAllocate(self, w: Line) -> Answer:
        self.os.file_allocate(w.num(1), w.num(2), w.num(3))
        return (0,)

    def OS_FileTruncate(self, w: Line) -> Answer:
        self.os.file_truncate(w.num(1), w.num(2))
        return (0,)

    def OS_lseek(self, w: Line) -> Answer:
        return (to_signed(self.os.lseek(w.num(1), w.num(2), w.num(3))),)  # C has 32 bits for it

    def OS_chmod(self, w: Line) -> Answer:
        self.os.chmod(w.text(1), w.num(2))
        return (0,)

    def OS_stat(self, w: Line) -> Answer:
        found = self.os.stat(w.text(1))
        is_folder = self.os.filestat_isdir(found)
        return (0, 1) if is_folder else (0, 0, found.file_size)

    def OS_FileOpenCheck(self, w: Line) -> Answer:
        return (0 if self.os.file_open_check(w.text(1)) else -1,)

    def OS_mkdir(self, w: Line) -> Answer:
        self.os.mkdir(w.text(1), w.num(2))
        return (0,)

    def OS_rename(self, w: Line) -> Answer:
        self.os.rename(w.text(1), w.text(2))
        return (0,)

    def OS_cp(self, w: Line) -> Answer:
        self.os.cp(w.text(1), w.text(2))
        return (0,)

    def OS_mv(self, w: Line) -> Answer:
        self.os.mv(w.text(1), w.text(2))
        return (0,)

    def OS_FDGetInfo(self, w: Line) -> Answer:
        info = self.os.fd_get_info(w.num(1))
        return 0, info.path, Id(info.user), info.is_valid

    def OS_DirectoryOpen(self, w: Line) -> Answer:
        return 0, w.keep(1, self.os.directory_open(w.text(2)))

    def OS_DirectoryClose(self, w: Line) -> Answer:
        self.os.directory_close(w.num(1))
        return (0,)

    def OS_DirectoryRewind(self, w: Line) -> Answer:
        self.os.directory_rewind(w.num(1))
        return (0,)

    def OS_DirectoryCount(self, w: Line) -> Answer:
        count = 0
        try:
            while self.os.directory_read(w.num(1)) is not None:
                count += 1
        except OsalError:
            pass
        return 0, count

    def OS_TranslatePath(self, w: Line) -> Answer:
        self.os.translate_path(w.text(1))
        return (0,)

    def OS_Clock(self, w: Line) -> Answer:
        os, first, second = self.os, time_from_total_nanoseconds(w.num(1)), time_from_total_nanoseconds(w.num(2))
        return (
            0,
            os.time_get_total_nanoseconds(os.time_add(first, second)),
            os.time_get_total_nanoseconds(os.time_subtract(first, second)),
            os.time_get_total_seconds(first),
            os.time_get_total_milliseconds(first),
            os.time_get_total_microseconds(first),
            os.time_get_fractional_part(first),
            os.time_get_subseconds_part(first),
            os.time_get_milliseconds_part(first),
            os.time_get_microseconds_part(first),
            os.time_get_nanoseconds_part(first),
            os.time_equal(first, second),
            os.time_get_sign(first),
            os.time_compare(first, second),
        )

    def OS_Assemble(self, w: Line) -> Answer:
        os, pair, one = self.os, (w.num(1), w.num(2)), w.num(1)
        times = (
            os.time_assemble_from_nanoseconds(*pair),
            os.time_assemble_from_microseconds(*pair),
            os.time_assemble_from_milliseconds(*pair),
            os.time_assemble_from_subseconds(*pair),
            os.time_from_total_seconds(one),
            os.time_from_total_milliseconds(one),
            os.time_from_total_microseconds(one),
        )
        return 0, *map(os.time_get_total_nanoseconds, times)

    def OS_HeapGetInfo(self, w: Line) -> Answer:
        self.os.heap_get_info()
        return (0,)

    def OS_GetResourceName(self, w: Line) -> Answer:
        return 0, self.os.get_resource_name(w.num(1))

    def OS_IdentifyObject(self, w: Line) -> Answer:
        return 0, self.os.identify_object(w.num(1))

    def OS_ConvertToArrayIndex(self, w: Line) -> Answer:
        self.os.convert_to_array_index(w.num(1))
        return (0,)

    def OS_ObjectIdToArrayIndex(self, w: Line) -> Answer:
        self.os.object_id_to_array_index(w.num(1), w.num(2))
        return (0,)

    def OS_ForEachObjectOfType(self, w: Line) -> Answer:
        found: list[int] = []
        self.os.for_each_object_of_type(w.num(1), self.os.task_get_id(), lambda each, arg: found.append(each))
        return 0, len(found)

    def OS_GetErrorName(self, w: Line) -> Answer:
        name = self.os.get_error_name(w.num(1))
        return (-1,) if name.startswith("OS_UNKNOWN") else (0, name)

    def OS_StatusToString(self, w: Line) -> Answer:
        return 0, self.os.status_to_string(w.num(1))

    def OS_strnlen(self, w: Line) -> Answer:
        return 0, self.os.strnlen(w.text(1).encode() + b"\0", w.num(2))

    def OS_SelectSingle(self, w: Line) -> Answer:
        found = self.os.select_single(w.num(1), w.num(2), w.num(3))
        return (OS_ERROR_TIMEOUT if found is None else 0,)

    def OS_mkfs(self, w: Line) -> Answer:
        self.os.mkfs(w.text(1), w.text(2), w.num(3), w.num(4))
        return (0,)

    def OS_initfs(self, w: Line) -> Answer:
        self.os.initfs(w.text(1), w.text(2), w.num(3), w.num(4))
        return (0,)

    def OS_mount(self, w: Line) -> Answer:
        self.os.mount(w.text(1), w.text(2))
        return (0,)

    def OS_FS_GetPhysDriveName(self, w: Line) -> Answer:
        self.os.fs_get_phys_drive_name(w.text(1))
        return (0,)


def _none(result: object) -> Answer:
    return (0,)


def osal_timeout() -> int:
    from cfepy.status import OS_SEM_TIMEOUT

    return OS_SEM_TIMEOUT


class PspCalls:
    """The calls of the PSP."""

    def __init__(self, play: Any) -> None:
        self.psp = play.cfe.psp

    def PSP_Ids(self, w: Line) -> Answer:
        return 0, self.psp.get_processor_id(), self.psp.get_spacecraft_id(), self.psp.get_processor_name()

    def PSP_Times(self, w: Line) -> Answer:
        first, second = self.psp.get_time(), self.psp.get_time()
        return 0, first <= second, self.psp.get_timer_ticks_per_second(), self.psp.get_timer_low32_rollover()

    def PSP_ReadFromCDS(self, w: Line) -> Answer:
        self.psp.read_from_cds(w.num(1), w.num(2))
        return (0,)

    def PSP_GetCDSSize(self, w: Line) -> Answer:
        return 0, self.psp.get_cds_size()

    def PSP_Areas(self, w: Line) -> Answer:
        self.psp.get_reset_area()
        size = len(self.psp.get_user_reserved_area())
        others = self.psp.get_volatile_disk_mem, self.psp.get_kernel_text_segment_info
        return 0, 0, size, *map(status_of, others)

    def PSP_MemRanges(self, w: Line) -> Answer:
        return (self.psp.mem_ranges(),)

    def PSP_MemRangeGet(self, w: Line) -> Answer:
        found = self.psp.mem_range_get(w.num(1))
        if w.num(1) <= 1:
            return (0,)
        return 0, found.memory_type, found.size, found.word_size, found.attributes

    def PSP_MemRangeSet(self, w: Line) -> Answer:
        self.psp.mem_range_set(*(w.num(word) for word in range(1, 7)))
        return (0,)

    def PSP_MemValidateRange(self, w: Line) -> Answer:
        self.psp.mem_validate_range(w.num(1), w.num(2), w.num(3))
        return (0,)

    def PSP_Exceptions(self, w: Line) -> Answer:
        psp = self.psp
        return (
            psp.exception_get_count(),
            status_of(psp.exception_get_summary),
            status_of(psp.exception_copy_context, w.num(1), 100),
        )

    def PSP_PortRead(self, w: Line) -> Answer:
        psp, at = self.psp, w.num(1)
        reads = psp.port_read8, psp.port_read16, psp.port_read32
        return *(status_of(read, at) for read in reads), status_of(psp.port_write8, at, 0)

    def PSP_Eeprom(self, w: Line) -> Answer:
        psp, bank = self.psp, w.num(1)
        calls = psp.eeprom_write_enable, psp.eeprom_write_disable, psp.eeprom_power_up, psp.eeprom_power_down
        return tuple(status_of(call, bank) for call in calls)

    def PSP_Watchdog(self, w: Line) -> Answer:
        self.psp.watchdog.set(w.num(1))
        self.psp.watchdog.service()
        return 0, self.psp.watchdog_get()

    def PSP_StatusToString(self, w: Line) -> Answer:
        return 0, self.psp.status_to_string(w.num(1))
