"""The frame around flight software: start, idle loop, end, and what it can ask about its computer.

These are the functions of osapi-common.h, osapi-bsp.h, osapi-heap.h and osapi-network.h.

A mission makes an `Osal` ready to use, so OS_API_Init has nothing left to do. May import cfepy.rtos, status and its
neighbours in cfepy.osal.
"""

from __future__ import annotations

from typing import NamedTuple

from cfepy.osal.cleanup import CleanupApi
from cfepy.osal.core import EventHandler, Setup, check_size
from cfepy.osal.limits import OS_MAX_PATH_LEN
from cfepy.rtos import WaitList
from cfepy.status import OS_ERR_NOT_IMPLEMENTED, OS_ERROR, OS_INVALID_POINTER, OS_SUCCESS, OsalError

EXIT_SUCCESS, EXIT_FAILURE = 0, 1


class HeapInfo(NamedTuple):
    """What `heap_get_info` tells (OS_heap_prop_t), in bytes."""

    free_bytes: int
    free_blocks: int
    largest_free_block: int


def strnlen(text: bytes, maxlen: int) -> int:
    """Length of a C string up to its NUL, `maxlen` at most (OS_strnlen)."""
    nul = text.find(b"\0", 0, maxlen)
    return nul if nul >= 0 else min(len(text), maxlen)


class ApplicationApi(CleanupApi):
    """The functions around an application; `exit_code` is what OS_BSP_SetExitCode left."""

    strnlen = staticmethod(strnlen)

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        self.exit_code = OS_SUCCESS
        self._is_shut_down = False
        self._idle = WaitList("shutdown")
        self._resource_type_config: dict[int, int] = {}

    def api_init(self) -> None:
        """Nothing: OSAL is ready when it was made, and a second call is ignored in NASA's too (OS_API_Init)."""

    def api_teardown(self) -> None:
        """Delete every object, then let the idle loop end (OS_API_Teardown)."""
        self.delete_all_objects()
        self.application_shutdown(True)

    def delete_all_objects(self) -> None:
        """Delete every object and task but the caller (OS_DeleteAllObjects)."""
        self._delete_where(lambda record: not self._is_caller(record))

    def register_event_handler(self, handler: EventHandler) -> None:
        """Tell `handler` of every object made or deleted, and every task that starts (OS_RegisterEventHandler).

        Args:
            handler: called with OS_EVENT_*, the object's id, and None. A status other than 0 for
                OS_EVENT_RESOURCE_ALLOCATED refuses the object, whose creation fails with it.

        Raises:
            OsalError: OS_INVALID_POINTER for what cannot be called.
        """
        if not callable(handler):
            raise OsalError(OS_INVALID_POINTER, "the event handler cannot be called")
        self._event_handler = handler

    def application_run(self) -> None:
        """What the main task does when all is started: idle until the application is shut down (OS_Application_Run)."""
        self.idle_loop()

    def idle_loop(self) -> None:
        """Wait until `application_shutdown` (OS_IdleLoop)."""
        while not self._is_shut_down:
            self.kernel.wait_on(self._idle)

    def application_shutdown(self, flag: bool) -> None:
        """Let `idle_loop` end, if `flag` is true (OS_ApplicationShutdown)."""
        self._is_shut_down |= flag
        self.kernel.wake_all(self._idle)

    def application_exit(self, status: int) -> None:
        """End the run at once (OS_ApplicationExit); a task does not come back from it.

        Args:
            status: OS_SUCCESS ends it with exit code 0, anything else with 1.
        """
        self.exit_code = EXIT_SUCCESS if status == OS_SUCCESS else EXIT_FAILURE
        self.kernel.stop()
        if self.kernel.current is not self.kernel.host:
            self.kernel.exit_task()

    def heap_get_info(self) -> HeapInfo:
        """How much of the board's RAM is left (OS_HeapGetInfo); it does not fragment.

        Raises:
            OsalError: OS_ERR_NOT_IMPLEMENTED where memory is not counted, as on NASA's Linux.
        """
        free = None if self._setup.memory is None else self._setup.memory.free
        if free is None:
            raise OsalError(OS_ERR_NOT_IMPLEMENTED, "this board has no limit of memory")
        return HeapInfo(free, 1 if free else 0, free)

    def network_get_id(self) -> int:
        """Number of this computer in its network: the processor id (OS_NetworkGetID)."""
        return self.config.processor_id

    def network_get_host_name(self, name_len: int = OS_MAX_PATH_LEN) -> str:
        """Name of this computer in its network: the processor's (OS_NetworkGetHostName).

        Args:
            name_len: bytes that there are for the name and a NUL.

        Raises:
            OsalError: OS_ERR_INVALID_SIZE for none, OS_ERROR when the name does not fit.
        """
        check_size(name_len, "host name")
        name = self.config.processor_name
        if len(name.encode("utf-8", "replace")) >= name_len:
            raise OsalError(OS_ERROR, f"the host name {name} does not fit in {name_len} bytes")
        return name

    def bsp_get_argc(self) -> int:
        """How many words the command line of the flight software has (OS_BSP_GetArgC)."""
        return len(self.bsp_get_argv())

    def bsp_get_argv(self) -> tuple[str, ...]:
        """Its words: the name of NASA's executable for this processor, without options (OS_BSP_GetArgV)."""
        return (f"core-{self.config.processor_name}",)

    def bsp_set_exit_code(self, code: int) -> None:
        """Leave a code for whoever started the run (OS_BSP_SetExitCode)."""
        self.exit_code = code

    def bsp_set_resource_type_config(self, resource_type: int, config_option_value: int) -> None:
        """Keep an option for a kind of object (OS_BSP_SetResourceTypeConfig); nothing here asks for one."""
        self._resource_type_config[resource_type] = config_option_value

    def bsp_get_resource_type_config(self, resource_type: int) -> int:
        """The option kept for a kind of object, 0 when there is none (OS_BSP_GetResourceTypeConfig)."""
        return self._resource_type_config.get(resource_type, 0)
