"""The table registry: the existing tables, their owners, and the handles of apps.

It replaces cfe_tbl_regrec.c, cfe_tbl_accdesc.c and cfe_tbl_registry.c. A table exists until its owner and every app
that shares it have released their handles.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from cfepy.config.platform import PlatformConfig
from cfepy.ids import TBL_HANDLE_BASE, TBL_REGID_BASE, UNDEFINED, IdTable, name_size
from cfepy.ports import Ports
from cfepy.rtos import Kernel
from cfepy.status import (
    CFE_SUCCESS,
    CFE_TBL_ERR_DUPLICATE_DIFF_SIZE,
    CFE_TBL_ERR_DUPLICATE_NOT_OWNED,
    CFE_TBL_ERR_HANDLES_FULL,
    CFE_TBL_ERR_INVALID_HANDLE,
    CFE_TBL_ERR_INVALID_NAME,
    CFE_TBL_ERR_INVALID_OPTIONS,
    CFE_TBL_ERR_INVALID_SIZE,
    CFE_TBL_ERR_REGISTRY_FULL,
    CFE_TBL_ERR_UNREGISTERED,
    CfeError,
    to_signed,
)
from cfepy.tbl.buffers import SHARED, Buffer, BufferMemory

OPT_SNGL_BUFFER = 0
OPT_LOAD_DUMP = 0
OPT_DEFAULT = 0
OPT_DBL_BUFFER = 1
OPT_DUMP_ONLY = 2
OPT_USR_DEF_ADDR = 6
OPT_CRITICAL = 8
_USR_DEF_BIT = 4

MAX_NAME_LENGTH = 16
"""Characters of a table's own name, including the NUL (CFE_MISSION_TBL_MAX_NAME_LENGTH)."""

Validator = Callable[[memoryview], int]
"""Checks an image; returns 0 if it is valid, otherwise a negative number."""


class TableHandle(int):
    """A table handle: an int with the status of CFE_TBL_Register.

    Attributes:
        status: CFE_SUCCESS, CFE_TBL_WARN_DUPLICATE, CFE_TBL_WARN_NOT_CRITICAL or CFE_TBL_INFO_RECOVERED_TBL.
    """

    status: int = CFE_SUCCESS

    def with_status(self, status: int) -> TableHandle:
        """Return the same handle with another status."""
        handle = TableHandle(self)
        handle.status = status
        return handle


class TableRecord:
    """A registered table (CFE_TBL_RegistryRec_t).

    Attributes:
        owner: AppId, or 0 once the owner has unregistered it.
        buffers: its own one or two buffers.
        active_id: id of the buffer that apps see; 0 until the first load. The buffer itself may have another id
            meanwhile.
        previous_id: id of the buffer that was active before.
        next_id: id of the buffer of a load in progress.
        cds_handle: the CDS block of a critical table's image; 0 for other tables.
        critical: whether its image outlives a processor reset.
        accesses: the handles on it.
        validations: ids of the pending validations of the owner. A release with one request at a time has it under
            None; the other release has one for the active image under True and one for the inactive image under False.
        dump_id: id of a dump that the owner should take or has taken.
        notify: (message id, function code, parameter) of the notification that the owner wants for requests.
    """

    def __init__(self, name: str, size: int, options: int, validator: Validator | None, owner: int) -> None:
        self.name = name
        self.size = size
        self.double_buffered = bool(options & OPT_DBL_BUFFER)
        self.dump_only = bool(options & OPT_DUMP_ONLY)
        self.user_defined = bool(options & _USR_DEF_BIT)
        self.cds_handle = UNDEFINED
        self.critical = False
        self.validator = validator
        self.owner = owner
        self.reg_id = UNDEFINED
        self.buffers: list[Buffer] = []
        self.active_id = self.previous_id = self.next_id = UNDEFINED
        self.accesses: list[Access] = []
        self.last_file = ""
        self.last_update = (0, 0)
        self.modified = False
        self.validations: dict[bool | None, int] = {}
        self.dump_id = UNDEFINED
        self.notify: tuple[int, int, int] | None = None

    @property
    def is_loaded(self) -> bool:
        """Whether it has an image for apps."""
        return self.active_id != UNDEFINED

    @property
    def is_loading(self) -> bool:
        """Whether a load is in progress."""
        return self.next_id != UNDEFINED

    def judge(self, image: memoryview) -> int:
        """Return the validator's result for an image, a 32-bit number; 0 without a validator.

        Raises:
            TypeError: if the validator did not return a number, which is an error of the application.
        """
        result = 0 if self.validator is None else self.validator(image)
        if not isinstance(result, int):
            raise TypeError(f"the validator of {self.name!r} must return a number, 0 for a good image, not {result!r}")
        return to_signed(result)

    def set_active(self, buffer: Buffer) -> None:
        """Make a buffer the active one (CFE_TBL_SetActiveBuffer)."""
        self.previous_id, self.active_id = self.active_id, buffer.load_id

    def image(self, buffer: Buffer) -> memoryview:
        """Return the memory of the whole table in a buffer, including parts that were never written."""
        return buffer.data[: self.size]

    def note_load(self, source: str, time: tuple[int, int]) -> None:
        """Record the source and time of the active image (CFE_TBL_RegRecResetLoadInfo)."""
        self.last_file, self.last_update, self.modified = source, time, False

    def tell_users(self) -> None:
        """Mark the content as new for every handle (CFE_TBL_NotifyTblUsersOfUpdate)."""
        for access in self.accesses:
            access.updated = True


class Access:
    """An app's handle on a table (CFE_TBL_AccessDescriptor_t).

    Attributes:
        locked: whether the app has the address of a buffer.
        buffer_id: id of that buffer at the time.
        updated: whether the content has changed since the app last got the address.
    """

    __slots__ = ("app_id", "buffer_id", "handle", "locked", "table", "updated")

    def __init__(self, table: TableRecord, app_id: int) -> None:
        self.table = table
        self.app_id = app_id
        self.handle = TableHandle(UNDEFINED)
        self.locked = False
        self.buffer_id = UNDEFINED
        self.updated = not table.dump_only and table.is_loaded


class WaitingLoad(NamedTuple):
    """A load that cannot be made active because an application holds the address of the buffer that it needs.

    Attributes:
        table: full name of the table.
        source: the loaded file or address; empty if the load was refused, as for a double-buffered table.
        since_ns: virtual time of the first refusal in ns.
        holder: the handle through which the application holds the address.
    """

    table: str
    source: str
    since_ns: int
    holder: Access


class TableRegistry:
    """All tables and handles of a mission.

    Args:
        kernel: its clock.
        config: the limits.
        memory: the source of the tables' buffers.
        ports: provides the system log.

    Attributes:
        services_app_id: AppId of Table Services, which may use every handle; 0 before its task runs.
    """

    def __init__(self, kernel: Kernel, config: PlatformConfig, memory: BufferMemory, ports: Ports) -> None:
        self._kernel = kernel
        self._refused: dict[TableRecord, tuple[int, Access]] = {}  # the first refusal, and who held the address
        self._ports = ports
        self.services_app_id = UNDEFINED
        self._config = config
        self._memory = memory
        capacity = config.tbl_max_num_tables
        self.tables: IdTable[TableRecord] = IdTable(TBL_REGID_BASE, capacity, full=CFE_TBL_ERR_REGISTRY_FULL)
        self.accesses: IdTable[Access] = IdTable(
            TBL_HANDLE_BASE,
            config.tbl_max_num_handles,
            full=CFE_TBL_ERR_HANDLES_FULL,
            invalid=CFE_TBL_ERR_INVALID_HANDLE,
        )

    def find(self, name: str) -> TableRecord | None:
        """Return the table with a full name, or None."""
        return next((table for table in self.tables if table.name == name), None)

    def by_name(self, name: str) -> TableRecord:
        """Return the table with a full name.

        Raises:
            CfeError: CFE_TBL_ERR_INVALID_NAME.
        """
        table = self.find(name)
        if table is None:
            raise CfeError(CFE_TBL_ERR_INVALID_NAME, f"unknown table {name!r}")
        return table

    def check(self, app_name: str, name: str, size: int, options: int) -> str:
        """Check name, options and size of a new table, in that order, and return its full name.

        Raises:
            CfeError: CFE_TBL_ERR_INVALID_NAME, _OPTIONS or _SIZE.
        """
        if not 0 < name_size(name) < MAX_NAME_LENGTH:
            text = f"table name {name!r} must have 1 to {MAX_NAME_LENGTH - 1} bytes, not {name_size(name)}"
            raise CfeError(CFE_TBL_ERR_INVALID_NAME, text)
        if options & OPT_DUMP_ONLY and options & (OPT_DBL_BUFFER | OPT_CRITICAL):
            raise CfeError(CFE_TBL_ERR_INVALID_OPTIONS, "a dump-only table cannot be double-buffered or critical")
        if options & _USR_DEF_BIT and not options & OPT_DUMP_ONLY:
            raise CfeError(CFE_TBL_ERR_INVALID_OPTIONS, "a table at an address of the app must be dump-only")
        double = options & OPT_DBL_BUFFER
        limit = self._config.tbl_max_dbl_table_size if double else self._config.tbl_max_sngl_table_size
        if not 0 < size <= limit:
            raise CfeError(CFE_TBL_ERR_INVALID_SIZE, f"table {name!r} must have 1 to {limit} bytes, not {size}")
        return f"{app_name}.{name}"

    def duplicate(self, full_name: str, size: int, app_id: int) -> Access | None:
        """Return the app's existing handle on its own table of the same name and size; None for a new name.

        Raises:
            CfeError: CFE_TBL_ERR_DUPLICATE_NOT_OWNED, _DUPLICATE_DIFF_SIZE, or _UNREGISTERED if it has no handle.
        """
        table = self.find(full_name)
        if table is None:
            return None
        if table.owner != app_id:
            raise CfeError(CFE_TBL_ERR_DUPLICATE_NOT_OWNED, f"table {full_name!r} belongs to app 0x{table.owner:x}")
        if table.size != size:
            text = f"table {full_name!r} already exists with {table.size} bytes, so it cannot have {size}"
            raise CfeError(CFE_TBL_ERR_DUPLICATE_DIFF_SIZE, text)
        for access in table.accesses:
            if access.app_id == app_id:
                return access
        raise CfeError(CFE_TBL_ERR_UNREGISTERED, f"the owner of {full_name!r} has no handle on it")

    def add(self, table: TableRecord) -> Access:
        """Add a new table with its buffers, and give its owner a handle.

        Raises:
            CfeError: if no registry entry, handle or buffer memory is left; the table is then not added.
        """
        table.reg_id = self.tables.create(table)
        try:
            access = self.connect(table, table.owner)
            self._allocate(table)
        except CfeError:
            self._forget(table)
            raise
        if table.dump_only and not table.user_defined:
            buffer = self.exclusive_buffer(table)
            assert buffer is not None  # no app has an address of a new table
            table.set_active(buffer)
        return access

    def connect(self, table: TableRecord, app_id: int) -> Access:
        """Add a handle on a table.

        Raises:
            CfeError: CFE_TBL_ERR_HANDLES_FULL.
        """
        access = Access(table, app_id)
        access.handle = TableHandle(self.accesses.create(access))
        table.accesses.append(access)
        return access

    def release(self, access: Access) -> None:
        """Release a handle. The last handle of a table without an owner also removes the table."""
        table = access.table
        if table.owner == access.app_id:
            table.owner = UNDEFINED
        table.accesses.remove(access)
        self.accesses.delete(access.handle)
        if table.owner == UNDEFINED and not table.accesses:
            self._forget(table)

    # -- buffers of a table, by their ids --

    def locate(self, table: TableRecord, buffer_id: int) -> Buffer | None:
        """Return the buffer that an id refers to, even if it has another id now (CFE_TBL_LocateLoadBufferByID)."""
        if buffer_id == UNDEFINED:
            return None
        category, number = self._memory.ids.split(buffer_id)
        if category == SHARED:
            return self._memory.shared(number)
        return table.buffers[number if table.double_buffered else 0]

    def active(self, table: TableRecord) -> Buffer | None:
        """Return the active buffer; None before the first load."""
        return self.locate(table, table.active_id)

    def loading(self, table: TableRecord) -> Buffer | None:
        """Return the buffer of the load in progress (CFE_TBL_GetLoadInProgressBuffer)."""
        buffer = self.locate(table, table.next_id)
        if buffer is None or buffer.load_id == table.next_id:
            return buffer
        table.next_id = UNDEFINED
        text = f"WARNING: Cleared stale load in progress on table {table.name}"
        self._ports.syslog.write_to_sys_log(text)
        return None

    def inactive(self, table: TableRecord) -> Buffer | None:
        """Return the buffer of the load in progress, otherwise the previously active one
        (CFE_TBL_GetInactiveBuffer).
        """
        return self.loading(table) or self.locate(table, table.previous_id)

    def is_update_pending(self, table: TableRecord) -> bool:
        """Return whether a loaded image waits for the owner's update; some releases require an activation."""
        buffer = self.locate(table, table.next_id)
        if buffer is None or buffer.load_id != table.next_id:
            return False
        return buffer.is_valid and (buffer.activate_requested or not self._config.release.update_needs_activation)

    def is_private(self, table: TableRecord, buffer: Buffer) -> bool:
        """Return whether a buffer belongs to the table itself (CFE_TBL_LoadBuffIsPrivate)."""
        return self._memory.ids.split(buffer.load_id)[0] == self._category(table)

    def place(self, table: TableRecord) -> int:
        """Return the number of the buffer of the load in progress in a registry dump."""
        return self._memory.ids.place(table.next_id)

    def discard_load(self, table: TableRecord) -> None:
        """Drop a load in progress (CFE_TBL_DiscardWorkingBuffer).

        The buffer of a single-buffered table becomes free, even if it is the table's own.
        """
        buffer = None if table.double_buffered else self.locate(table, table.next_id)
        table.next_id = UNDEFINED
        if buffer is not None:
            buffer.load_id = UNDEFINED

    def exclusive_buffer(self, table: TableRecord) -> Buffer | None:
        """Return the table's next own buffer; None if an app holds its address (CFE_TBL_GetInactiveBufferExclusive)."""
        next_id = self._memory.ids.after(table.active_id, self._category(table))
        buffer = self.locate(table, next_id)
        if buffer is None or buffer.load_id == next_id:
            return buffer
        holder = self._holder(table, buffer) if buffer.load_id != UNDEFINED else None
        if holder is not None:
            if self._refused.get(table, (0, None))[1] is not holder:
                self._refused[table] = self._kernel.now, holder
            text = f"Inactive Buff Locked for '{table.name}' by AppId={holder.app_id}"
            self._ports.syslog.write_to_sys_log(f"CFE_TBL_GetInactiveBufferExclusive: {text}")
            return None
        self._refused.pop(table, None)
        buffer.load_id = next_id
        return buffer

    def waiting_loads(self) -> list[WaitingLoad]:
        """Return the loads that were refused because of a held address, if the address is still held."""
        return [
            WaitingLoad(table.name, self._source_of_load(table), at_ns, holder)
            for table, (at_ns, holder) in self._refused.items()
            if self._is_in_the_way(table, holder)
        ]

    def _is_in_the_way(self, table: TableRecord, holder: Access) -> bool:
        buffer = self.locate(table, self._memory.ids.after(table.active_id, self._category(table)))
        held = self.locate(table, holder.buffer_id) if holder.locked and holder in table.accesses else None
        return buffer is not None and buffer is held and buffer.load_id != UNDEFINED

    def _source_of_load(self, table: TableRecord) -> str:
        buffer = self.locate(table, table.next_id)
        return buffer.source if buffer is not None and buffer.load_id == table.next_id else ""

    def working_buffer(self, table: TableRecord) -> Buffer | None:
        """Return the buffer of the load in progress, and start a load if there is none (CFE_TBL_GetWorkingBuffer)."""
        buffer = self.loading(table)
        if buffer is not None:
            return buffer
        buffer = self._new_buffer(table) if table.is_loaded else self.exclusive_buffer(table)
        if buffer is not None:
            table.next_id = buffer.load_id
        return buffer

    def _new_buffer(self, table: TableRecord) -> Buffer | None:
        """Return a buffer with a copy of the active image, because a file may have only a part of the table."""
        buffer = self.exclusive_buffer(table) if table.double_buffered else self._memory.acquire_shared()
        if buffer is None:
            return None
        active = self.active(table)
        if active is not None:
            buffer.copy(active.view())
        buffer.is_valid = buffer.activate_requested = False
        return buffer

    def _holder(self, table: TableRecord, buffer: Buffer) -> Access | None:
        """Return a handle that holds the address of a buffer now, or None."""
        locked = (access for access in table.accesses if access.locked)
        return next((access for access in locked if self.locate(table, access.buffer_id) is buffer), None)

    def _category(self, table: TableRecord) -> int:
        return self.tables.index(table.reg_id) + 1

    def _allocate(self, table: TableRecord) -> None:
        if table.user_defined:
            table.buffers.append(self._memory.external())
            return
        for _ in range(1 + table.double_buffered):
            table.buffers.append(self._memory.allocate(table.size, table.name))

    def _forget(self, table: TableRecord) -> None:
        self._refused.pop(table, None)
        if not table.user_defined:
            self.discard_load(table)
        for buffer in table.buffers:
            self._memory.free(buffer)
        for access in table.accesses:
            self.accesses.delete(access.handle)
        self.tables.delete(table.reg_id)
