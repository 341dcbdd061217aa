"""Executive Services: boot, resets, applications, tasks, logs, critical data, memory pools, counters (cFE ES).

The five services do not import each other; what ES needs of them it finds in its `Ports`.
"""

from cfepy.es.apps import SymbolError
from cfepy.es.boot import Boot, CoreApp, ObjectTable
from cfepy.es.packets import COMMANDS, TELEMETRY
from cfepy.es.records import (
    APP_ERROR,
    APP_EXIT,
    APP_RUN,
    SYSTEM_OPERATIONAL,
    AppRecord,
    Loader,
)
from cfepy.es.service import ExecutiveServices
from cfepy.es.task import EsTask

__all__ = [
    "APP_ERROR",
    "APP_EXIT",
    "APP_RUN",
    "COMMANDS",
    "SYSTEM_OPERATIONAL",
    "TELEMETRY",
    "AppRecord",
    "Boot",
    "CoreApp",
    "EsTask",
    "ExecutiveServices",
    "Loader",
    "ObjectTable",
    "SymbolError",
]
