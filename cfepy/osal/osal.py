"""`Osal`: the operating system abstraction layer as one object, `cfe.os`, combined from its parts.

Names are NASA's in snake case: OS_QueueCreate is `os.queue_create`. A failed call raises OsalError with NASA's OS_*
code. A timeout or an empty queue is None or False.

This module has three parts. The first is the frame around flight software (osapi-common.h, osapi-bsp.h, osapi-heap.h,
osapi-network.h). A mission creates a ready `Osal`, so OS_API_Init has nothing left to do. The second part has the
functions with which ES deletes the objects of an application that ends. NASA does that task by task in
CFE_ES_CleanupTaskResources. The third makes the objects of cFE itself.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import chain
from typing import Any, NamedTuple

from cfepy.config.platform import IDENTITIES, PlatformConfig
from cfepy.ids import (
    OS_BINSEM_BASE,
    OS_CONDVAR_BASE,
    OS_COUNTSEM_BASE,
    OS_DIR_BASE,
    OS_MODULE_BASE,
    OS_MUTEX_BASE,
    OS_QUEUE_BASE,
    OS_RWLOCK_BASE,
    OS_STREAM_BASE,
    OS_TASK_BASE,
    OS_TIMEBASE_BASE,
    OS_TIMECB_BASE,
)
from cfepy.osal.core import EventHandler, Ledger, ObjectSizes, OsObject, Setup, check_size
from cfepy.osal.disks import DiskApi
from cfepy.osal.files import DirectoryApi
from cfepy.osal.filesystem import FileSystem
from cfepy.osal.idmap import IdMapApi
from cfepy.osal.limits import OS_MAX_PATH_LEN
from cfepy.osal.locks import CondVarApi, MutexApi, OsMutex, RwLockApi
from cfepy.osal.modules import ModuleApi
from cfepy.osal.network import Network
from cfepy.osal.paths import PathApi
from cfepy.osal.queues import QueueApi
from cfepy.osal.semaphores import OsSemaphore, SemaphoreApi
from cfepy.osal.shell import ShellApi
from cfepy.osal.sockets import SelectApi
from cfepy.osal.tasks import OsTask, TaskApi
from cfepy.osal.timers import OsTimer, TimerApi
from cfepy.reading.texts import to_bytes
from cfepy.rtos import CpuCosts, Kernel, Mutex, Semaphore, WaitList
from cfepy.status import OS_ERR_NOT_IMPLEMENTED, OS_ERROR, OS_INVALID_POINTER, OS_SUCCESS, OsalError
from cfepy.writing.console import Console

EXIT_SUCCESS, EXIT_FAILURE = 0, 1
CLEANED_UP = (
    OS_TASK_BASE,
    OS_QUEUE_BASE,
    OS_COUNTSEM_BASE,
    OS_BINSEM_BASE,
    OS_MUTEX_BASE,
    OS_STREAM_BASE,
    OS_TIMECB_BASE,
    OS_MODULE_BASE,
)
"""The kinds of objects that ES deletes when an application ends, in the order of OS_ForEachObject."""

CORE_MUTEXES = (
    *(f"DriverMutex-{number:02}" for number in range(1, 8)),
    "ES_DATA_MUTEX",
    "ES_PERF_MUTEX",
    "CDS_MUTEX",
    "CFE_EVS_DataMutex",
    "CFE_FS_SharedMutex",
    "CFE_SB_DataMutex",
    "TBL_REG_MUT",
    "TBL_WRK_MUT",
)
"""The mutexes of the PSP's drivers and of cFE's services. The next one is the mutex of the table services' pool."""

CORE_SEMAPHORES = ("ES_BG_SEM", "TIME_TONE_SEM", "TIME_ONEHZ_SEM")
"""The semaphores of the background task and of Time Services."""

ONE_HZ_TIMER = "cFS-1Hz"
ONE_HZ_US = 1_000_000


class Leftover(NamedTuple):
    """An object that was to be deleted, and the error if that failed."""

    object_id: int
    error: OsalError | None


class CleanupApi(
    TaskApi,
    QueueApi,
    SemaphoreApi,
    MutexApi,
    CondVarApi,
    RwLockApi,
    TimerApi,
    SelectApi,
    PathApi,
    DirectoryApi,
    ModuleApi,
):
    """Deletion of everything that belongs to an application."""

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        # NASA's order; NASA's CFE_ES_CleanupObjectCallback leaves behind the kinds after the timers.
        self._deleters: dict[int, Callable[[int], None]] = {
            OS_TASK_BASE: self.task_delete,
            OS_QUEUE_BASE: self.queue_delete,
            OS_COUNTSEM_BASE: self.count_sem_delete,
            OS_BINSEM_BASE: self.bin_sem_delete,
            OS_MUTEX_BASE: self.mut_sem_delete,
            OS_STREAM_BASE: self.close,
            OS_TIMECB_BASE: self.timer_delete,
            OS_TIMEBASE_BASE: self.time_base_delete,
            OS_DIR_BASE: self.directory_close,
            OS_CONDVAR_BASE: self.cond_var_delete,
            OS_RWLOCK_BASE: self.rw_lock_delete,
            OS_MODULE_BASE: self.module_unload,
        }

    def delete_objects_of(self, owner: Any) -> list[Leftover]:
        """Delete the tasks of an application, the youngest first, each after all objects that it created.

        The calling task is not deleted.

        Args:
            owner: the `Task.owner` of these tasks.

        Returns:
            The objects that could not be deleted.
        """
        for task_id, record in reversed(self._tasks_of(owner)):
            self.delete_objects_of_task(task_id)
            if not record.deleted:
                self.task_delete(task_id)
        # Again for the rest: mutexes that a task held until it ended, and objects of tasks that had ended before.
        return self._delete_where(lambda record: record.owner is owner and not self._is_caller(record))

    def delete_objects_of_task(self, task_id: int) -> list[Leftover]:
        """Delete every object that a task created, other tasks included, but not the task (OS_ForEachObject).

        Returns:
            The objects that could not be deleted.
        """
        return self._delete_where(lambda record: record.creator == task_id and not self._is_caller(record))

    def clean_up_task(self, task_id: int) -> list[Leftover]:
        """Delete the objects of some kinds that a task created, in one pass over the tables.

        ES repeats the pass (CFE_ES_CleanupObjectCallback). Open directories, time bases, condition variables and
        readers-writer locks are left behind, as in NASA's ES.

        Args:
            task_id: the task.

        Returns:
            The objects that were found, with the error if one could not be deleted.
        """
        found: list[Leftover] = []
        for base in CLEANED_UP:
            for object_id, record in self._tables[base].items():
                if record.deleted or record.creator != task_id or self._is_caller(record):
                    continue
                try:
                    self._deleters[base](object_id)
                    found.append(Leftover(object_id, None))
                except OsalError as error:
                    found.append(Leftover(object_id, error))
        return found

    def _tasks_of(self, owner: Any) -> list[tuple[int, OsTask]]:
        return [
            (task_id, record)
            for task_id, record in sorted(self._tasks.items())
            if record.task is not None and record.task.owner is owner and not self._is_caller(record)
        ]

    def _is_caller(self, record: OsObject) -> bool:
        return isinstance(record, OsTask) and record.task is self.kernel.current

    def _delete_where(self, belongs: Callable[[OsObject], bool]) -> list[Leftover]:
        leftovers: list[Leftover] = []
        for base, delete in self._deleters.items():
            for object_id, record in self._tables[base].items():
                if record.deleted or not belongs(record):
                    continue
                try:
                    delete(object_id)
                except OsalError as error:
                    leftovers.append(Leftover(object_id, error))
        return leftovers


class HeapInfo(NamedTuple):
    """The result of `heap_get_info` (OS_heap_prop_t), in bytes."""

    free_bytes: int
    free_blocks: int
    largest_free_block: int


def strnlen(text: bytes, maxlen: int) -> int:
    """Return the length of a C string up to its NUL, at most `maxlen` (OS_strnlen)."""
    nul = text.find(b"\0", 0, maxlen)
    return nul if nul >= 0 else min(len(text), maxlen)


class ApplicationApi(CleanupApi):
    """The functions around an application; `exit_code` is the code set with OS_BSP_SetExitCode."""

    strnlen = staticmethod(strnlen)

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        self.exit_code = OS_SUCCESS
        self._idle = WaitList("shutdown")
        self._resource_type_config: dict[int, int] = {}

    def api_init(self) -> None:
        """Make OSAL ready again after `api_teardown` (OS_API_Init), as after a start, except for the clock.

        Without a teardown it does nothing: an Osal is created ready to use, and NASA's OSAL ignores a second call too.
        """
        if self._is_shut_down:
            self._is_shut_down = False
            self._event_handler = None

    def api_teardown(self) -> None:
        """Delete every object, then end the idle loop; new objects are refused from then on (OS_API_Teardown)."""
        self.delete_all_objects()
        self.application_shutdown(True)

    def delete_all_objects(self) -> None:
        """Delete every object and task except the caller (OS_DeleteAllObjects)."""
        self._delete_where(lambda record: not self._is_caller(record))

    def register_event_handler(self, handler: EventHandler) -> None:
        """Register a handler for every created or deleted object and every task that starts (OS_RegisterEventHandler).

        Args:
            handler: called with OS_EVENT_*, the object's id, and None. A status other than 0 for
                OS_EVENT_RESOURCE_ALLOCATED refuses the object, and its creation fails with this status.

        Raises:
            OsalError: OS_INVALID_POINTER if the handler cannot be called.
        """
        if not callable(handler):
            raise OsalError(OS_INVALID_POINTER, "the event handler must be callable")
        self._event_handler = handler

    def application_run(self) -> None:
        """Run the main task after the start: idle until the application is shut down (OS_Application_Run)."""
        self.idle_loop()

    def idle_loop(self) -> None:
        """Wait until `application_shutdown` (OS_IdleLoop)."""
        while not self._is_shut_down:
            self.kernel.wait_on(self._idle)

    def application_shutdown(self, flag: bool) -> None:
        """If `flag` is true, end `idle_loop` and refuse new objects (OS_ApplicationShutdown)."""
        self._is_shut_down |= flag
        self.kernel.wake_all(self._idle)

    def application_exit(self, status: int) -> None:
        """End the run at once (OS_ApplicationExit); the call does not return to a task.

        Args:
            status: OS_SUCCESS ends it with exit code 0, anything else with 1.
        """
        self.exit_code = EXIT_SUCCESS if status == OS_SUCCESS else EXIT_FAILURE
        self.kernel.stop()
        if self.kernel.current is not self.kernel.host:
            self.kernel.exit_task()

    def heap_get_info(self) -> HeapInfo:
        """Return the free RAM of the board (OS_HeapGetInfo); it does not fragment.

        Raises:
            OsalError: OS_ERR_NOT_IMPLEMENTED if memory is not accounted for, as on NASA's Linux.
        """
        free = None if self._setup.memory is None else self._setup.memory.free
        if free is None:
            raise OsalError(OS_ERR_NOT_IMPLEMENTED, "this board has no memory limit")
        return HeapInfo(free, 1 if free else 0, free)

    def network_get_id(self) -> int:
        """Return the number of this computer in its network, the processor id (OS_NetworkGetID)."""
        return self.config.processor_id

    def network_get_host_name(self, name_len: int = OS_MAX_PATH_LEN) -> str:
        """Return the name of this computer in its network, the processor name (OS_NetworkGetHostName).

        Args:
            name_len: bytes available for the name and its NUL.

        Raises:
            OsalError: OS_ERR_INVALID_SIZE for 0, OS_ERROR if the name does not fit.
        """
        check_size(name_len, "host name")
        name = self.config.processor_name
        if len(to_bytes(name)) >= name_len:
            raise OsalError(OS_ERROR, f"a buffer of {name_len} bytes is too small for the host name {name}")
        return name

    def bsp_get_argc(self) -> int:
        """Return the number of words on the command line of the flight software (OS_BSP_GetArgC)."""
        return len(self.bsp_get_argv())

    def bsp_get_argv(self) -> tuple[str, ...]:
        """Return these words: the name of NASA's executable for this processor, and the ids given to it
        (OS_BSP_GetArgV).
        """
        config = self.config
        ids = [(option, str(getattr(config, name))) for name, option in IDENTITIES.items() if name in config.given]
        return (f"core-{self.config.processor_name}", *chain.from_iterable(ids))

    def bsp_set_exit_code(self, code: int) -> None:
        """Set the exit code for the program that started the run (OS_BSP_SetExitCode)."""
        self.exit_code = code

    def bsp_set_resource_type_config(self, resource_type: int, config_option_value: int) -> None:
        """Set an option for a kind of object (OS_BSP_SetResourceTypeConfig); no code here uses it."""
        self._resource_type_config[resource_type] = config_option_value

    def bsp_get_resource_type_config(self, resource_type: int) -> int:
        """Return the option of a kind of object, or 0 if none is set (OS_BSP_GetResourceTypeConfig)."""
        return self._resource_type_config.get(resource_type, 0)


class CoreObjectApi(SemaphoreApi, MutexApi, TimerApi):
    """Adds the OSAL objects that cFE and the PSP make for themselves, with NASA's names, in the order of their ids.

    They count against OSAL's limits, take names and ids, and OS_ForEachObject reports them. Nothing in cfepy waits for
    them: cfepy's services run between two calls of the kernel, so they need no mutexes. They were observed on NASA's
    cFE 7.0.1 on Linux. The queues of pipes and the modules of applications come later, with their owners. A mission
    calls this once for each start of a processor.
    """

    def add_core_objects(self) -> None:
        """Add the mutexes and semaphores."""
        for name in CORE_MUTEXES:
            self._reserve(self._mutexes, OsMutex(name, Mutex(self.kernel, name, stays_locked=not self.config.safe)))
        for name in CORE_SEMAPHORES:
            self._reserve(self._bin_sems, OsSemaphore(name, Semaphore(self.kernel, 0, 1, name)))

    def add_one_hz_timer(self, timebase_id: int) -> None:
        """Add the timer of Time Services to the time base of the PSP. It never expires: TIME keeps its own seconds."""
        timebase = self._time_base(timebase_id)
        timer = self._reserve(self._timers, OsTimer(ONE_HZ_TIMER, timebase, lambda _: None, False))
        timer.interval_us = ONE_HZ_US
        timebase.timers.append(timer)


class Osal(ShellApi, ApplicationApi, CoreObjectApi, DiskApi, IdMapApi):
    """The whole interface; see the other modules of this package for its parts.

    Args:
        kernel: the simulated real-time kernel.
        config: limits (cfepy.config.platform).
        console: the output of `printf`.
        files: the virtual file system; None makes one with an empty /cf and /ram.
        network: the virtual network; None makes a new one.
        memory: the account for stacks and objects; None does not account.
        sizes: memory used by each object, in bytes.
        costs: virtual CPU time of a call and of copying bytes; None for no time.
        epoch_ns: local time at virtual time 0, in ns.
    """

    def __init__(
        self,
        kernel: Kernel,
        config: PlatformConfig | None = None,
        console: Console | None = None,
        *,
        files: FileSystem | None = None,
        network: Network | None = None,
        memory: Ledger | None = None,
        sizes: ObjectSizes | None = None,
        costs: CpuCosts | None = None,
        epoch_ns: int = 0,
    ) -> None:
        super().__init__(
            Setup(
                kernel,
                config or PlatformConfig(),
                console or Console(),
                files or FileSystem(),
                network or Network(),
                memory,
                sizes or ObjectSizes(),
                costs or CpuCosts(),
                epoch_ns,
            )
        )

    def api_init(self) -> None:
        """Make OSAL ready again, also without file systems and with OS_printf enabled."""
        was_shut_down = self._is_shut_down
        super().api_init()
        if was_shut_down:
            self._forget_disks()
            self.printf_enable()
