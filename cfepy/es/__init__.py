"""Executive Services: boot, resets, applications, tasks, logs, critical data, memory pools, counters (cFE ES).

The five services do not import each other; what ES needs of them it finds in its `Ports`.
"""

from __future__ import annotations

from cfepy.es.apps import SymbolError
from cfepy.es.boot import Boot, CoreApp, ObjectTable
from cfepy.es.packets import COMMANDS, TELEMETRY
from cfepy.es.pools import PoolBlock
from cfepy.es.records import (
    APP_ERROR,
    APP_EXIT,
    APP_RUN,
    SYSTEM_APPS_INIT,
    SYSTEM_CORE_STARTUP,
    SYSTEM_EARLY_INIT,
    SYSTEM_OPERATIONAL,
    SYSTEM_SHUTDOWN,
    AppRecord,
    Loader,
)
from cfepy.es.service import ExecutiveServices
from cfepy.es.task import EsTask
from cfepy.ports import SYSTEM_CORE_READY

__all__ = [
    "APP_ERROR",
    "APP_EXIT",
    "APP_RUN",
    "COMMANDS",
    "SYSTEM_APPS_INIT",
    "SYSTEM_CORE_READY",
    "SYSTEM_CORE_STARTUP",
    "SYSTEM_EARLY_INIT",
    "SYSTEM_OPERATIONAL",
    "SYSTEM_SHUTDOWN",
    "TELEMETRY",
    "AppRecord",
    "Boot",
    "CoreApp",
    "EsTask",
    "ExecutiveServices",
    "Loader",
    "ObjectTable",
    "PoolBlock",
    "SymbolError",
]
