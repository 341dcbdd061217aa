"""OS_API_Init, OS_HeapGetInfo, OS_BSP_* and related functions: the environment of flight software, for C.

OS_Application_Startup can be found by its name, as on a board; it runs there before there are applications.
"""

from __future__ import annotations

from struct import Struct
from typing import TYPE_CHECKING

from cfepy.extra.c.api.osal_values import BAD, check_size
from cfepy.extra.c.crashes import CFault
from cfepy.reading.texts import to_bytes
from cfepy.status import CfeError

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

HEAP_INFO = Struct("<QQQ")
"""OS_heap_prop_t: free bytes, free blocks, the largest one."""
_SIGN = 1 << 31


def declare(api: Declarations, c: CRuntime) -> None:
    _declare_frame(api, c)
    _declare_board(api, c)
    _declare_host(api, c)
    _declare_versions(api, c)


def _declare_frame(api: Declarations, c: CRuntime) -> None:
    os = c.handle.os

    def register_event_handler(handler: int) -> None:
        def tell(event: int, object_id: int, data: object) -> int:
            status = c.run(handler, event, object_id, 0) & 0xFFFFFFFF
            return (status ^ _SIGN) - _SIGN

        os.register_event_handler(tell)

    def startup() -> None:
        raise CFault("OS_Application_Startup() must not be called by an application; the board calls it")

    api.add("OS_Application_Startup", "", startup)
    api.add("OS_API_Init", "", os.api_init)
    api.add("OS_API_Teardown", "", os.api_teardown)
    api.add("OS_Application_Run", "", os.application_run)
    api.add("OS_IdleLoop", "", os.idle_loop)
    api.add("OS_DeleteAllObjects", "", os.delete_all_objects)
    api.add("OS_ApplicationShutdown", "B", lambda flag: os.application_shutdown(flag == 1))
    api.add("OS_ApplicationExit", "i", os.application_exit)
    api.add("OS_RegisterEventHandler", "P", register_event_handler, BAD)


def _declare_board(api: Declarations, c: CRuntime) -> None:
    os = c.handle.os
    api.add("OS_BSP_SetResourceTypeConfig", "II", os.bsp_set_resource_type_config)
    api.add("OS_BSP_GetResourceTypeConfig", "I", os.bsp_get_resource_type_config)
    api.add("OS_BSP_GetArgC", "", os.bsp_get_argc)
    api.add("OS_BSP_GetArgV", "", lambda: c.constants.texts(os.bsp_get_argv()))
    api.add("OS_BSP_SetExitCode", "i", os.bsp_set_exit_code)


def _declare_host(api: Declarations, c: CRuntime) -> None:
    """Add functions for memory, network and shell."""
    os, memory = c.handle.os, c.memory

    def heap_info(at: int) -> None:
        memory.poke(at, HEAP_INFO.pack(*os.heap_get_info()))

    def host_name(buffer: int, size: int) -> None:
        check_size(size)
        try:
            name = os.network_get_host_name(size)
        except CfeError:
            memory.poke(buffer, b"\0")
            raise
        memory.poke(buffer, to_bytes(name) + b"\0")

    api.add("OS_HeapGetInfo", "P", heap_info, BAD)
    api.add("OS_NetworkGetID", "", os.network_get_id)
    api.add("OS_NetworkGetHostName", "PQ", host_name, BAD)
    api.add("OS_ShellOutputToFile", "SI", os.shell_output_to_file, BAD)


def _declare_versions(api: Declarations, c: CRuntime) -> None:
    os, text = c.handle.os, c.constants.text

    def version_number(at: int) -> None:
        if at:
            c.memory.poke(at, bytes(os.get_version_number()))

    api.add("OS_GetVersionString", "", lambda: text(os.get_version_string()))
    api.add("OS_GetVersionCodeName", "", lambda: text(os.get_version_code_name()))
    api.add("OS_GetVersionNumber", "p", version_number)
    api.add("OS_GetBuildNumber", "", os.get_build_number)
