"""The public functions of OSAL, the PSP and cFE in C's terms: a module for each service.

Each module has `declare(api, c)`, which adds its functions to the API. A declaration has the name, the signature
(`engine/calls.c` lists the letters), the Python function, and the status for a NULL pointer where it is not allowed.
Functions raise `CfeError` or `OsalError` for a status, as the services do.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

from cfepy.extra.c.api import (
    cds,
    config,
    cpp,
    device_files,
    error_texts,
    es,
    evs,
    fs,
    gcov,
    hwlib,
    memory_pools,
    osal_disks,
    osal_files,
    osal_locks,
    osal_modules,
    osal_objects,
    osal_queues,
    osal_select,
    osal_semaphores,
    osal_sockets,
    osal_system,
    osal_tasks,
    osal_time,
    posix_files,
    posix_memory,
    posix_names,
    posix_pipes,
    posix_select,
    posix_sockets,
    posix_time,
    psp,
    psp_iodriver,
    psp_memory,
    pthread,
    resource_ids,
    sb,
    sorting,
    stdio,
    streams,
    tbl,
    text,
    time,
    unsent,
)

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

_OSAL = (
    *(osal_tasks, osal_semaphores, osal_locks, osal_queues, osal_time, osal_files, osal_disks),
    *(osal_sockets, osal_select, osal_modules, osal_objects, osal_system),
)
_PSP = (psp, psp_memory, psp_iodriver)
_TOOLS = (streams, error_texts, sorting, cpp, pthread, gcov, unsent, posix_time, hwlib)
_POSIX = (device_files, posix_files, posix_memory, posix_pipes, stdio, posix_sockets, posix_select, posix_names)
_CORE = (text, es, memory_pools, cds, evs, sb, tbl, time, fs, config, resource_ids)
_MODULES = (*_CORE, *_TOOLS, *_POSIX, *_OSAL, *_PSP)


def declare(api: Declarations, c: CRuntime) -> None:
    """Add all functions.

    Args:
        api: receives the functions.
        c: the C side of the processor that answers.
    """
    for module in _MODULES:
        module.declare(api, c)


class _Anything:
    """A stand-in for a processor when only the names of functions are wanted."""

    def __getattr__(self, name: str) -> _Anything:
        return self

    def __call__(self, *args: object, **options: object) -> _Anything:
        return self


def function_names() -> set[str]:
    """Return the names of the functions that compiled code can call."""
    from cfepy.extra.c.calls import Declarations

    api = Declarations()
    declare(api, cast("Any", _Anything()))
    return {*api.functions, *api.data, *api.places}
