"""Executive Services: boot, resets, applications, tasks, logs, critical data, memory pools, counters (cFE ES).

NASA's ES belongs here: the functions for applications, the ground commands, and its own background work. The five
services are independent of one another; ES reaches the others through its `Ports`. The central file is
`cfepy/es/service.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.es.apps import SymbolError
    from cfepy.es.boot import Boot, CoreApp, ObjectTable
    from cfepy.es.cds import DamagedData
    from cfepy.es.packets import COMMANDS, TELEMETRY
    from cfepy.es.pools import MAX_BUCKETS, ForeignMemory, MemPool, PoolBlock, min_size
    from cfepy.es.records import (
        APP_ERROR,
        APP_EXIT,
        APP_RUN,
        NODE_SYMBOL,
        STATE_NAMES,
        SYSTEM_APPS_INIT,
        SYSTEM_CORE_STARTUP,
        SYSTEM_EARLY_INIT,
        SYSTEM_OPERATIONAL,
        SYSTEM_SHUTDOWN,
        AppHistory,
        AppInfo,
        AppRecord,
        Loader,
        StartParams,
    )
    from cfepy.es.service import ExecutiveServices
    from cfepy.es.startup_script import CFE_APP, CFE_LIB, BadLine, StartupEntry, entries, parse
    from cfepy.es.task import EsTask
from cfepy.ports import SYSTEM_CORE_READY

__all__ = [
    "APP_ERROR",
    "APP_EXIT",
    "APP_RUN",
    "CFE_APP",
    "CFE_LIB",
    "COMMANDS",
    "MAX_BUCKETS",
    "NODE_SYMBOL",
    "STATE_NAMES",
    "SYSTEM_APPS_INIT",
    "SYSTEM_CORE_READY",
    "SYSTEM_CORE_STARTUP",
    "SYSTEM_EARLY_INIT",
    "SYSTEM_OPERATIONAL",
    "SYSTEM_SHUTDOWN",
    "TELEMETRY",
    "AppHistory",
    "AppInfo",
    "AppRecord",
    "BadLine",
    "Boot",
    "CoreApp",
    "DamagedData",
    "EsTask",
    "ExecutiveServices",
    "ForeignMemory",
    "Loader",
    "MemPool",
    "ObjectTable",
    "PoolBlock",
    "StartParams",
    "StartupEntry",
    "SymbolError",
    "entries",
    "min_size",
    "parse",
]

if not TYPE_CHECKING:  # type checkers see only the names above
    __getattr__, __dir__ = face(
        __name__,
        {
            ".apps": ("SymbolError",),
            ".boot": (
                "Boot",
                "CoreApp",
                "ObjectTable",
            ),
            ".cds": ("DamagedData",),
            ".packets": (
                "COMMANDS",
                "TELEMETRY",
            ),
            ".pools": (
                "MAX_BUCKETS",
                "ForeignMemory",
                "MemPool",
                "PoolBlock",
                "min_size",
            ),
            ".records": (
                "APP_ERROR",
                "APP_EXIT",
                "APP_RUN",
                "NODE_SYMBOL",
                "STATE_NAMES",
                "SYSTEM_APPS_INIT",
                "SYSTEM_CORE_STARTUP",
                "SYSTEM_EARLY_INIT",
                "SYSTEM_OPERATIONAL",
                "SYSTEM_SHUTDOWN",
                "AppHistory",
                "AppInfo",
                "AppRecord",
                "Loader",
                "StartParams",
            ),
            ".service": ("ExecutiveServices",),
            ".startup_script": (
                "CFE_APP",
                "CFE_LIB",
                "BadLine",
                "StartupEntry",
                "entries",
                "parse",
            ),
            ".task": ("EsTask",),
        },
    )
