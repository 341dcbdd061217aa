"""The table registry: which tables exist, which app owns each, and which apps use it through which handle.

Stands for cfe_tbl_regrec.c, cfe_tbl_accdesc.c and cfe_tbl_registry.c. A table lives until its owner and every app that
shares it gave their handles back.
"""

from __future__ import annotations

from collections.abc import Callable

from cfepy.config import PlatformConfig
from cfepy.ids import TBL_HANDLE_BASE, TBL_REGID_BASE, UNDEFINED, IdTable, name_size
from cfepy.status import (
    CFE_SUCCESS,
    CFE_TBL_ERR_DUPLICATE_DIFF_SIZE,
    CFE_TBL_ERR_DUPLICATE_NOT_OWNED,
    CFE_TBL_ERR_HANDLES_FULL,
    CFE_TBL_ERR_INVALID_HANDLE,
    CFE_TBL_ERR_INVALID_NAME,
    CFE_TBL_ERR_INVALID_OPTIONS,
    CFE_TBL_ERR_INVALID_SIZE,
    CFE_TBL_ERR_NO_BUFFER_AVAIL,
    CFE_TBL_ERR_REGISTRY_FULL,
    CFE_TBL_ERR_UNREGISTERED,
    CfeError,
    to_signed,
)
from cfepy.tbl.buffers import Buffer, BufferMemory

OPT_SNGL_BUFFER = 0
OPT_LOAD_DUMP = 0
OPT_DEFAULT = 0
OPT_DBL_BUFFER = 1
OPT_DUMP_ONLY = 2
OPT_USR_DEF_ADDR = 6
OPT_CRITICAL = 8
_USR_DEF_BIT = 4

MAX_NAME_LENGTH = 16
"""Characters of a table's own name, the NUL included (CFE_MISSION_TBL_MAX_NAME_LENGTH)."""

FIRST_PLACE, SECOND_PLACE = -3, -2

Validator = Callable[[memoryview], int]
"""Looks at an image; returns 0 when it is good, a negative number when not."""


class TableHandle(int):
    """A table handle; an int with what CFE_TBL_Register had to say besides "success".

    Attributes:
        status: CFE_SUCCESS, CFE_TBL_WARN_DUPLICATE, CFE_TBL_WARN_NOT_CRITICAL or CFE_TBL_INFO_RECOVERED_TBL.
    """

    status: int = CFE_SUCCESS

    def with_status(self, status: int) -> TableHandle:
        """The same handle with another status."""
        handle = TableHandle(self)
        handle.status = status
        return handle


class Validation:
    """One validation that the ground asked for; `result` is the validator's, once `performed`."""

    __slots__ = ("crc", "of_active", "performed", "result", "table_name")

    def __init__(self, table_name: str, crc: int, of_active: bool) -> None:
        self.table_name = table_name
        self.crc = crc
        self.of_active = of_active
        self.performed = False
        self.result = 0


class DumpControl:
    """One dump that the ground asked for: `source` is copied into `image` first, `image` goes to the file later."""

    __slots__ = ("file_name", "file_time", "image", "performed", "source", "table")

    def __init__(self, table: TableRecord, source: Buffer, image: Buffer, file_name: str) -> None:
        self.table = table
        self.source = source
        self.image = image
        self.file_name = file_name
        self.file_time = (0, 0)
        self.performed = False


class TableRecord:
    """A registered table (CFE_TBL_RegistryRec_t).

    Attributes:
        owner: AppId, or 0 once the owner unregistered it.
        buffers: its own one or two; none for a user-defined address.
        active: the image that apps see; None until the first load.
        loading: the image of a load in progress.
        cds_handle: the block of the CDS that keeps a critical table's image; 0 for all others.
        accesses: the handles on it.
        validations: what the owner shall validate: True stands for the active image, False for the inactive one.
        notify: (message id, function code, parameter) of the owner's wish to be told of requests.
    """

    def __init__(self, name: str, size: int, options: int, validator: Validator | None, owner: int) -> None:
        self.name = name
        self.size = size
        self.double_buffered = bool(options & OPT_DBL_BUFFER)
        self.dump_only = bool(options & OPT_DUMP_ONLY)
        self.user_defined = bool(options & _USR_DEF_BIT)
        self.cds_handle = UNDEFINED
        self.validator = validator
        self.owner = owner
        self.reg_id = UNDEFINED
        self.buffers: list[Buffer] = []
        self.active: Buffer | None = None
        self.loading: Buffer | None = None
        self.accesses: list[Access] = []
        self.last_file = ""
        self.last_update = (0, 0)
        self.modified = False
        self.validations: dict[bool, Validation] = {}
        self.dump: DumpControl | None = None
        self.notify: tuple[int, int, int] | None = None

    @property
    def critical(self) -> bool:
        """Whether its image outlives a processor reset."""
        return self.cds_handle != UNDEFINED

    @property
    def is_update_pending(self) -> bool:
        """Whether the load in progress waits for the owner to switch to it."""
        return self.loading is not None and self.loading.is_valid and self.loading.activate_requested

    def judge(self, image: memoryview) -> int:
        """What the validator says of an image, a number of 32 bits; 0 without one.

        Raises:
            TypeError: it did not say a number; a mistake of the application.
        """
        result = 0 if self.validator is None else self.validator(image)
        if not isinstance(result, int):
            raise TypeError(f"the validator of {self.name!r} returned {result!r}, it must return 0 for a good image")
        return to_signed(result)

    def take_validation(self) -> Validation | None:
        """The validation that is next, inactive image first; it does not wait any more."""
        return self.validations.pop(False, None) or self.validations.pop(True, None)

    def inactive(self) -> Buffer | None:
        """The image that is not in use: the load in progress, else the previous one of a double-buffered table."""
        if self.loading is None and self.double_buffered and self.active is not None:
            return next(buffer for buffer in self.buffers if buffer is not self.active)
        return self.loading

    def next_buffer(self) -> Buffer:
        """The own buffer that the next update goes to: the only one, or the one that is not active."""
        return next((buffer for buffer in self.buffers if buffer is not self.active), self.buffers[0])

    def locker_of(self, buffer: Buffer) -> Access | None:
        """A handle whose address is on that buffer at this moment."""
        return next((access for access in self.accesses if access.locked and access.buffer is buffer), None)


class Access:
    """What one app knows a table by (CFE_TBL_AccessDescriptor_t).

    Attributes:
        locked: the app has the address of `buffer`.
        updated: the content changed since the app last got the address.
    """

    __slots__ = ("app_id", "buffer", "handle", "locked", "table", "updated")

    def __init__(self, table: TableRecord, app_id: int) -> None:
        self.table = table
        self.app_id = app_id
        self.handle = TableHandle(UNDEFINED)
        self.locked = False
        self.buffer: Buffer | None = None
        self.updated = not table.dump_only and table.active is not None


class TableRegistry:
    """All tables and handles of a mission.

    Args:
        config: the limits.
        memory: where the tables' buffers come from.

    Attributes:
        services_app_id: AppId of Table Services, which may use every handle; 0 before their task runs.
    """

    def __init__(self, config: PlatformConfig, memory: BufferMemory) -> None:
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
        """The table of a full name, or None."""
        return next((table for table in self.tables if table.name == name), None)

    def by_name(self, name: str) -> TableRecord:
        """The table of a full name.

        Raises:
            CfeError: CFE_TBL_ERR_INVALID_NAME.
        """
        table = self.find(name)
        if table is None:
            raise CfeError(CFE_TBL_ERR_INVALID_NAME, f"no table is called {name!r}")
        return table

    def check(self, app_name: str, name: str, size: int, options: int) -> str:
        """The full name of a table to be, once name, options and size are found good, in that order.

        Raises:
            CfeError: CFE_TBL_ERR_INVALID_NAME, _OPTIONS or _SIZE.
        """
        if not 0 < name_size(name) < MAX_NAME_LENGTH:
            text = f"table name {name!r} has {name_size(name)} bytes, it must have 1 to {MAX_NAME_LENGTH - 1}"
            raise CfeError(CFE_TBL_ERR_INVALID_NAME, text)
        if options & OPT_DUMP_ONLY and options & (OPT_DBL_BUFFER | OPT_CRITICAL):
            raise CfeError(CFE_TBL_ERR_INVALID_OPTIONS, "a dump-only table is neither double-buffered nor critical")
        if options & _USR_DEF_BIT and not options & OPT_DUMP_ONLY:
            raise CfeError(CFE_TBL_ERR_INVALID_OPTIONS, "only a dump-only table can be at an address of the app's")
        double = options & OPT_DBL_BUFFER
        limit = self._config.tbl_max_dbl_table_size if double else self._config.tbl_max_sngl_table_size
        if not 0 < size <= limit:
            raise CfeError(CFE_TBL_ERR_INVALID_SIZE, f"table {name!r} of {size} bytes; it must have 1 to {limit}")
        return f"{app_name}.{name}"

    def duplicate(self, full_name: str, size: int, app_id: int) -> Access | None:
        """The handle that an app already has on a table of its own of that name and size; None for a new name.

        Raises:
            CfeError: CFE_TBL_ERR_DUPLICATE_NOT_OWNED, _DUPLICATE_DIFF_SIZE, or _UNREGISTERED when it has no handle.
        """
        table = self.find(full_name)
        if table is None:
            return None
        if table.owner != app_id:
            raise CfeError(CFE_TBL_ERR_DUPLICATE_NOT_OWNED, f"table {full_name!r} belongs to app 0x{table.owner:x}")
        if table.size != size:
            text = f"table {full_name!r} exists with {table.size} bytes and cannot become one of {size}"
            raise CfeError(CFE_TBL_ERR_DUPLICATE_DIFF_SIZE, text)
        for access in table.accesses:
            if access.app_id == app_id:
                return access
        raise CfeError(CFE_TBL_ERR_UNREGISTERED, f"the owner of {full_name!r} has no handle on it")

    def add(self, table: TableRecord) -> Access:
        """Enter a new table, with its buffers, and give its owner a handle.

        Raises:
            CfeError: no registry entry, no handle or no buffer memory left; nothing is entered then.
        """
        table.reg_id = self.tables.create(table)
        try:
            access = self.connect(table, table.owner)
            self._allocate(table)
        except CfeError:
            self._forget(table)
            raise
        if table.dump_only and not table.user_defined:
            table.active = table.buffers[0]
        return access

    def connect(self, table: TableRecord, app_id: int) -> Access:
        """One more handle on a table.

        Raises:
            CfeError: CFE_TBL_ERR_HANDLES_FULL.
        """
        access = Access(table, app_id)
        access.handle = TableHandle(self.accesses.create(access))
        table.accesses.append(access)
        return access

    def release(self, access: Access) -> None:
        """Take a handle back; with the last one of a table without owner the table goes too."""
        table = access.table
        if table.owner == access.app_id:
            table.owner = UNDEFINED
        table.accesses.remove(access)
        self.accesses.delete(access.handle)
        if table.owner == UNDEFINED and not table.accesses:
            self._forget(table)

    def discard_load(self, table: TableRecord) -> None:
        """Drop a load in progress; a shared buffer is free again."""
        buffer, table.loading = table.loading, None
        if buffer is not None and buffer.is_shared:
            self._memory.release_shared(buffer)

    def exclusive_buffer(self, table: TableRecord) -> Buffer:
        """The own buffer that comes next, when no app holds its address.

        Raises:
            CfeError: CFE_TBL_ERR_NO_BUFFER_AVAIL when another app does; the text names it.
        """
        buffer = table.next_buffer()
        holder = table.locker_of(buffer)
        if holder is not None:
            text = f"Inactive Buff Locked for '{table.name}' by AppId={holder.app_id}"
            raise CfeError(CFE_TBL_ERR_NO_BUFFER_AVAIL, text)
        return buffer

    def _allocate(self, table: TableRecord) -> None:
        places = [] if table.user_defined else [FIRST_PLACE, SECOND_PLACE][: 1 + table.double_buffered]
        for place in places:
            table.buffers.append(self._memory.allocate(table.size, place))

    def _forget(self, table: TableRecord) -> None:
        self.discard_load(table)
        for buffer in table.buffers:
            self._memory.free(buffer)
        for access in table.accesses:
            self.accesses.delete(access.handle)
        self.tables.delete(table.reg_id)
