"""The interfaces between the core services, as Protocols: the calls that each service may make to the others.

ES, SB, EVS, TIME and TBL need one another (SB reports through EVS, EVS sends through SB), yet none of them knows
another one. A mission makes one `Ports`, passes it to all services, and fills it in once they exist. This module also
has the few numbers that services pass to one another.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any, Protocol

DEBUG, INFORMATION, ERROR, CRITICAL = 1, 2, 3, 4
"""Event types (CFE_EVS_EventType_Enum_t), for `Events.send_event`."""

SYSTEM_CORE_READY = 3
"""The system state in which all core applications run (CFE_ES_SystemState_CORE_READY), for
`AppTable.wait_for_system_state`.
"""

PEND_FOREVER = -1
"""No time limit (CFE_SB_PEND_FOREVER), for `Bus.receive_buffer`."""


class Caller(Protocol):
    """The application that owns a task, as found in `Task.owner`."""

    app_id: int
    name: str
    is_core: bool


def application_of(owner: Any) -> Caller | None:
    """Return the application in `Task.owner`; None for host code and for tasks without an application."""
    return owner if getattr(owner, "app_id", 0) else None


class SysLog(Protocol):
    """The ES system log (CFE_ES_WriteToSysLog)."""

    def write_to_sys_log(self, text: str) -> object:
        """Add a line with the spacecraft time, and print it on the console."""


class Block(Protocol):
    """A block of a memory pool; `memory` has its bytes."""

    memory: memoryview


class AppTable(Protocol):
    """The application table of ES, its application lifecycle calls and its memory."""

    def get_app_id(self) -> int:
        """Return the AppId of the application that the current task belongs to (CFE_ES_GetAppID)."""

    def get_app_name(self, app_id: int) -> str:
        """Return name of an application (CFE_ES_GetAppName)."""

    def get_app_id_by_name(self, name: str) -> int:
        """AppId of a named application (CFE_ES_GetAppIDByName)."""

    def wait_for_system_state(self, state: int, timeout_ms: int) -> None:
        """Block until the mission reached a system state (CFE_ES_WaitForSystemState)."""

    def run_loop(self, status: int = 1) -> bool:
        """Return whether the calling application should continue (CFE_ES_RunLoop)."""

    def exit_app(self, status: int) -> None:
        """End the calling application (CFE_ES_ExitApp)."""

    def create_child_task(
        self, name: str, entry: Callable[[], object], stack_size: int, priority: int, flags: int = 0
    ) -> int:
        """Start a task that belongs to the calling application (CFE_ES_CreateChildTask)."""

    def increment_task_counter(self) -> None:
        """Count a cycle of the calling task (CFE_ES_IncrementTaskCounter)."""

    def perf_log_entry(self, marker: int) -> None:
        """Log the entry of code with a performance marker (CFE_ES_PerfLogEntry)."""

    def perf_log_exit(self, marker: int) -> None:
        """Log the exit of code with a performance marker (CFE_ES_PerfLogExit)."""

    def pool_create(self, size: int, owner: str = "") -> int:
        """Create a memory pool (CFE_ES_PoolCreate).

        `owner` names the owner in the memory accounting if no application makes the call.
        """

    def pool_create_ex_with_alignment(
        self, size: int, block_sizes: Sequence[int], use_mutex: bool, *, owner: str = ""
    ) -> int:
        """Create a memory pool with given block sizes (CFE_ES_PoolCreateEx_WithAlignment).

        `owner` names the owner in the memory accounting if no application makes the call.
        """

    def get_pool_buf(self, pool_id: int, size: int) -> Block:
        """Take a block from a pool (CFE_ES_GetPoolBuf)."""

    def put_pool_buf(self, pool_id: int, block: Any) -> int:
        """Return a block from `get_pool_buf` to its pool (CFE_ES_PutPoolBuf)."""

    def register_cds_ex(self, block_size: int, full_name: str, critical_table: bool) -> tuple[int, int]:
        """Register a block of the Critical Data Store; return its handle and the status (CFE_ES_RegisterCDSEx)."""

    def copy_to_cds(self, handle: int, data: bytes | bytearray | memoryview) -> None:
        """Save a block's data (CFE_ES_CopyToCDS)."""

    def restore_from_cds(self, handle: int) -> bytes:
        """Return a block's data (CFE_ES_RestoreFromCDS)."""

    def delete_cds(self, full_name: str, called_by_tbl_services: bool = False) -> None:
        """Delete a block whose application has ended (CFE_ES_DeleteCDS)."""


class Bus(Protocol):
    """The Software Bus as a service or an app uses it."""

    def create_pipe(self, depth: int, name: str) -> int:
        """Create a pipe (CFE_SB_CreatePipe)."""

    def subscribe(self, msg_id: int, pipe_id: int) -> None:
        """Route a MsgId to a pipe (CFE_SB_Subscribe)."""

    def subscribe_ex(self, msg_id: int, pipe_id: int, qos: int, msg_limit: int) -> None:
        """Route a MsgId to a pipe with a message limit (CFE_SB_SubscribeEx)."""

    def subscribe_local(self, msg_id: int, pipe_id: int, msg_limit: int) -> None:
        """Route a MsgId to a pipe, on this processor only (CFE_SB_SubscribeLocal)."""

    def unsubscribe(self, msg_id: int, pipe_id: int) -> None:
        """Remove a route (CFE_SB_Unsubscribe)."""

    def transmit_msg(self, packet: bytes, is_origination: bool = True) -> None:
        """Send a packet to all subscribers (CFE_SB_TransmitMsg)."""

    def receive_buffer(self, pipe_id: int, timeout_ms: int) -> bytes | None:
        """Return the next packet of a pipe, or None after a timeout (CFE_SB_ReceiveBuffer)."""

    def cleanup_app(self, app_id: int) -> None:
        """Release everything that an application holds."""


class Events(Protocol):
    """Event services (CFE_EVS_*)."""

    def register(self, filters: Iterable[tuple[int, int]] = ()) -> None:
        """Register the calling application with its (event id, mask) filters (CFE_EVS_Register)."""

    def send_event(self, event_id: int, event_type: int, text: str) -> object:
        """Send an event of the calling application (CFE_EVS_SendEvent)."""

    def send_event_with_app_id(self, event_id: int, event_type: int, app_id: int, text: str) -> object:
        """Send an event in the name of an application (CFE_EVS_SendEventWithAppID)."""

    def cleanup_app(self, app_id: int) -> None:
        """Remove an ended application from the event services."""


class SpacecraftClock(Protocol):
    """Time Services as seen by the other services."""

    def now(self) -> tuple[int, int]:
        """Spacecraft time (TAI or UTC as configured) as (seconds, subseconds of 2**-32 s)."""

    def stamp(self) -> int:
        """Return the same as the 48-bit integer of a telemetry secondary header: seconds << 16 | upper subseconds."""

    def text(self) -> str:
        """Return the same time in the format of CFE_TIME_Print: "1980-012-14:03:20.00000"."""

    def print_(self, time: tuple[int, int]) -> str:
        """Return any time in the format of CFE_TIME_Print."""

    def cleanup_app(self, app_id: int) -> None:
        """Release everything that an application holds."""


class Cleanup(Protocol):
    """A service that holds resources for applications and releases them when an application ends."""

    def cleanup_app(self, app_id: int) -> None:
        """Release everything that an application holds."""


class PipeQueues(Protocol):
    """OSAL's queues, of which each pipe of the Software Bus has one."""

    def pipe_queue_create(self, name: str, depth: int) -> int:
        """Make the queue of a pipe, and return its id (OS_QueueCreate)."""

    def pipe_queue_delete(self, queue_id: int) -> None:
        """Delete the queue of a pipe (OS_QueueDelete)."""


class Files(Protocol):
    """File Services as seen by the other services."""

    def write_header(self, filedes: int, file_header: Any) -> int:
        """Write a cFE header, with ids and time filled in, at the start of an open file (CFE_FS_WriteHeader)."""

    def write_whole_header(self, filedes: int, file_header: Any) -> None:
        """Write a header like `write_header`; a short write is an error, with the number of bytes as its status."""

    def background_file_dump_request(self, meta: Any) -> None:
        """Request that the background task writes a file (CFE_FS_BackgroundFileDumpRequest)."""

    def run_background_file_dump(self, elapsed_ms: int) -> bool:
        """Write a part of the waiting files; return whether more is left (CFE_FS_RunBackgroundFileDump)."""


class Memory(Protocol):
    """The memory of the board, as far as cfepy accounts for it."""

    def claim(self, owner: str, kind: str, size: int) -> int:
        """Claim bytes for an owner, such as ("HK", "pipe HK_PIPE", 1280).

        Returns:
            A token, with which `release` frees the bytes.
        """

    def release(self, token: int) -> None:
        """Free the bytes of a claim."""


class Ports:
    """The services of one mission, as they see each other; `cfepy.mission` fills it in."""

    __slots__ = ("es", "evs", "fs", "memory", "queues", "sb", "syslog", "tbl", "time")

    es: AppTable
    syslog: SysLog
    sb: Bus
    evs: Events
    time: SpacecraftClock
    tbl: Cleanup
    memory: Memory
    queues: PipeQueues
    fs: Files
