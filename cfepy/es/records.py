"""The records of Executive Services about applications, libraries and tasks, and their states."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple, Protocol

from cfepy.es.startup_script import EXCEPTION_RESTART_APP
from cfepy.rtos import Task

SYSTEM_EARLY_INIT = 1
SYSTEM_CORE_STARTUP = 2
SYSTEM_APPS_INIT = 4
SYSTEM_OPERATIONAL = 5
SYSTEM_SHUTDOWN = 6

STATE_NAMES = {1: "EARLY_INIT", 2: "LATE_INIT", 3: "RUNNING", 4: "WAITING", 5: "STOPPED"}
EARLY_INIT = 1
LATE_INIT = 2
RUNNING = 3
WAITING = 4
STOPPED = 5

APP_RUN = 1
APP_EXIT = 2
APP_ERROR = 3
SYS_EXCEPTION = 4
SYS_RESTART = 5
SYS_RELOAD = 6
SYS_DELETE = 7
CORE_APP_INIT_ERROR = 8
CORE_APP_RUNTIME_ERROR = 9

CORE, EXTERNAL, LIBRARY = 1, 2, 3
"""Types of modules (CFE_ES_AppType_*)."""

APP_RESTART = 3
"""In addition to RST_TYPE_*: only an application is restarted (CFE_ES_APP_RESTART)."""

Entry = Callable[[], object]
NODE_SYMBOL = "__main__"
"""The entry point that a startup script gives a ROS node."""


@dataclass(slots=True)
class StartParams:
    """The parameters of the start and restart of an application (CFE_ES_AppStartParams_t).

    `file` is cFE's name of the module, `stack_size` is in bytes, `priority` 0 to 255.
    """

    file: str
    symbol: str
    stack_size: int
    priority: int
    exception_action: int = EXCEPTION_RESTART_APP

    @property
    def is_node(self) -> bool:
        """Whether the application is a ROS node in Python."""
        return self.symbol == NODE_SYMBOL


@dataclass(slots=True, eq=False)
class TaskRecord:
    """A task of an application."""

    task_id: int
    name: str
    stack_size: int
    priority: int
    task: Task | None = None
    execution_counter: int = 0


class FailedTask(NamedTuple):
    """A task that an exception ended: the TaskId stored by the board, its name and its application, if any."""

    task_id: int
    name: str
    app: AppRecord | None


@dataclass(slots=True, eq=False)
class AppRecord:
    """An application. It is the owner of its tasks, so services find the caller there."""

    name: str
    params: StartParams
    entry: Entry | None  # None until its module is loaded, and if no symbol names it
    is_core: bool = False
    app_id: int = 0
    state: int = EARLY_INIT
    control_request: int = APP_RUN
    timer_ms: int = 0
    main_task_id: int = 0
    module_id: int = 0
    error: BaseException | None = None
    tasks: dict[int, TaskRecord] = field(default_factory=dict)

    @property
    def is_node(self) -> bool:
        """Whether it is a ROS node."""
        return self.params.is_node


@dataclass(slots=True)
class AppHistory:
    """The data of an application name that outlive restarts, for the report of the run.

    `failed_ns` is the virtual time of its last death or error exit, in ns.
    """

    name: str
    restarts: int = 0
    deaths: int = 0
    error_exits: int = 0
    cpu_ns: int = 0
    last_error: BaseException | None = None
    failed_ns: int | None = None


@dataclass(slots=True, eq=False)
class LibRecord:
    """A library."""

    name: str
    file: str
    symbol: str
    lib_id: int = 0
    module_id: int = 0


@dataclass(slots=True, eq=False)
class GenCounter:
    """A generic counter."""

    name: str
    count: int = 0


class AppInfo(NamedTuple):
    """The properties of an application or a library (CFE_ES_AppInfo_t); `type` is CORE, EXTERNAL or LIBRARY."""

    resource_id: int
    type: int
    name: str
    entry_point: str
    file_name: str
    stack_size: int = 0
    exception_action: int = 0
    priority: int = 0
    main_task_id: int = 0
    main_task_name: str = ""
    execution_counter: int = 0
    num_of_child_tasks: int = 0


class TaskInfo(NamedTuple):
    """The result of CFE_ES_GetTaskInfo."""

    task_id: int
    task_name: str
    app_id: int
    app_name: str
    stack_size: int
    priority: int
    execution_counter: int


class Loader(Protocol):
    """Finds the code named in a startup script.

    `load` raises `OsalError` for a missing file (its status is the EC of NASA's text) and `SymbolError` for a missing
    entry point.
    """

    def exists(self, file: str) -> bool:
        """Return whether the module exists."""

    def load(self, file: str, symbol: str, app_name: str) -> Entry:
        """Return the main function of an application."""

    def load_library(self, file: str, symbol: str) -> Callable[[int], object]:
        """Return the init function of a library."""

    def unload(self, app_name: str) -> None:
        """Allow the code of an ended application to be unloaded."""
