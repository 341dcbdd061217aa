"""Table Services for apps (CFE_TBL_*): register, load, validate, update and inspect tables.

`TableAccess` (`access.py`) has the functions for every app with a handle. `TableServices` adds the functions for
owners. A failed call raises CfeError with NASA's status. A call with a warning or information as its result returns
that number. Host code can look tables up (`get_info`), but owns no tables and has no handles. The ground's side is in
`cfepy.tbl.task`.
"""

from __future__ import annotations

from collections.abc import Callable

from cfepy.config.platform import PlatformConfig
from cfepy.ports import Ports
from cfepy.rtos import Kernel
from cfepy.status import (
    CFE_SUCCESS,
    CFE_TBL_ERR_DUPLICATE_DIFF_SIZE,
    CFE_TBL_ERR_DUPLICATE_NOT_OWNED,
    CFE_TBL_ERR_INVALID_NAME,
    CFE_TBL_ERR_INVALID_OPTIONS,
    CFE_TBL_ERR_NO_ACCESS,
    CFE_TBL_INFO_DUMP_PENDING,
    CFE_TBL_INFO_NO_VALIDATION_PENDING,
    CFE_TBL_INFO_UPDATE_PENDING,
    CFE_TBL_INFO_UPDATED,
    CFE_TBL_INFO_VALIDATION_PENDING,
    CFE_TBL_WARN_DUPLICATE,
    CFE_TBL_WARN_NOT_CRITICAL,
    CfeError,
)
from cfepy.tbl import events as ev
from cfepy.tbl.access import ULONG, TableAccess
from cfepy.tbl.buffers import BufferMemory, BufferPlaces, Bytes
from cfepy.tbl.critical import CriticalTables
from cfepy.tbl.dumps import Dumps
from cfepy.tbl.loads import SRC_ADDRESS, SRC_FILE, Loads
from cfepy.tbl.registry import OPT_CRITICAL, Access, TableHandle, TableRecord, TableRegistry, Validator
from cfepy.tbl.reports import Reports
from cfepy.tbl.table_file import LoadFile, Refused, TableStorage
from cfepy.tbl.task import Parts, TableTask
from cfepy.tbl.validations import Validations

_NO_ACCESS = "App({app}) does not have access to Tbl Handle={handle}"
_NOT_NOTIFIED = "App={app} Handle={handle} status code={status:x}"


class TableServices(TableAccess):
    """The table registry of one mission and its API.

    Args:
        kernel: provides the running task.
        ports: the other services.
        config: limits and identities.
        files: the file system of the table files.
    """

    def __init__(self, kernel: Kernel, ports: Ports, config: PlatformConfig, files: TableStorage) -> None:
        memory = BufferMemory(
            ports,
            size=config.tbl_buf_memory_bytes,
            shared=config.tbl_max_simultaneous_loads,
            shared_size=config.tbl_max_sngl_table_size,
            tables=config.tbl_max_num_tables,
        )
        registry = TableRegistry(kernel, config, memory, ports)
        super().__init__(kernel, ports, registry)
        self._config = config
        self._memory = memory
        self._critical = CriticalTables(ports, config, registry)
        self._loads = Loads(registry, memory, ports, files, self._critical)
        self._dumps = Dumps(registry, memory, config, ports, files)
        self._validations = Validations(
            config.tbl_max_num_validations, one_at_a_time=config.release.one_validation_at_a_time
        )
        self._reports = Reports(ports, config, registry)
        parts = Parts(registry, self._loads, self._dumps, memory, self._critical, self._validations, self._reports)
        self.task = TableTask(ports, config, files, parts)

    def early_init(self) -> None:
        """Prepare the buffer pool and the critical table registry, before any task runs (CFE_TBL_EarlyInit)."""
        self._memory.early_init()
        self._critical.early_init()

    def task_main(self) -> None:
        """Run the CFE_TBL task."""
        self.task.main()

    # --- registration ---

    def register(self, name: str, size: int, options: int = 0, validate: Validator | None = None) -> TableHandle:
        """Create a table of the calling app (CFE_TBL_Register).

        Args:
            name: 1 to 15 characters; the full name is "APP.name".
            size: bytes.
            options: OPT_* joined by |. With OPT_CRITICAL the image outlives a processor reset.
            validate: called with each image before it is used; None accepts any.

        Returns:
            The handle; `handle.status` is CFE_SUCCESS, CFE_TBL_WARN_DUPLICATE (the app already has that table),
            CFE_TBL_INFO_RECOVERED_TBL (a critical table with its image from before the reset) or
            CFE_TBL_WARN_NOT_CRITICAL (the CDS refused it).

        Raises:
            CfeError: the status that NASA's function returns; an event also reports it to the ground.
        """
        try:
            app_id, app_name = self._caller()
        except CfeError as error:
            self._log("Register", f"Bad AppId(0), status={error.status & ULONG:x}")
            raise
        try:
            access = self._duplicate(full_name := self._checked(app_name, name, size, options), size, app_id)
            if access is not None:
                return access.handle.with_status(CFE_TBL_WARN_DUPLICATE)
            access = self.registry.add(TableRecord(full_name, size, options, validate, app_id))
        except CfeError as error:
            text = f"{app_name} Failed to Register table '{name}', Status={error.hex}"
            self._reports.send(ev.REGISTER_ERR_EID, ev.ERROR, text)
            raise
        return access.handle.with_status(self._make_critical(access.table)) if options & OPT_CRITICAL else access.handle

    def _checked(self, app_name: str, name: str, size: int, options: int) -> str:
        """Return the full name of a new table; an error is also in the system log (CFE_TBL_TxnCheckConfig)."""
        try:
            return self.registry.check(app_name, name, size, options)
        except CfeError as error:
            text = {
                CFE_TBL_ERR_INVALID_NAME: f"bad table name: '{name}' (0x{error.status & ULONG:x})",
                CFE_TBL_ERR_INVALID_OPTIONS: f"bad TblOptionFlags combination for '{name}' (0x{options:x})",
            }.get(error.status, f"Table '{name}' has invalid size ({size})")
            self._log("TxnCheckConfig", text)
            raise

    def _duplicate(self, full_name: str, size: int, app_id: int) -> Access | None:
        """Return the result of `registry.duplicate`, with lines in the system log
        (CFE_TBL_TxnCheckDuplicateRegistration).
        """
        table = self.registry.find(full_name)
        try:
            return self.registry.duplicate(full_name, size, app_id)
        except CfeError as error:
            if table is not None and error.status == CFE_TBL_ERR_DUPLICATE_DIFF_SIZE:
                text = f"Attempt to register existing table ('{full_name}') with different size({size}!={table.size})"
                self._log("TxnCheckDuplicateRegistration", text)
            elif table is not None and error.status == CFE_TBL_ERR_DUPLICATE_NOT_OWNED:
                text = f"App({app_id}) Registering Duplicate Table '{full_name}' owned by App({table.owner})"
                self._log("TxnCheckDuplicateRegistration", text)
            raise

    def _make_critical(self, table: TableRecord) -> int:
        try:
            return self._critical.register(table)
        except CfeError as error:
            self._log("Register", f"Failed to register '{table.name}' as a CDS (ErrCode={error.hex})")
            return CFE_TBL_WARN_NOT_CRITICAL

    def share(self, full_name: str) -> TableHandle:
        """Return a handle on another app's table, "APP.name" (CFE_TBL_Share).

        Raises:
            CfeError: CFE_TBL_ERR_INVALID_NAME, CFE_TBL_ERR_HANDLES_FULL.
        """
        app_id, app_name = self._caller()
        try:
            return self.registry.connect(self.registry.by_name(full_name), app_id).handle
        except CfeError as error:
            if error.status == CFE_TBL_ERR_INVALID_NAME:
                self._log("Share", f"Table '{full_name}' not found in Registry")
            text = f"{app_name} Failed to Share '{full_name}', Status={error.hex}"
            self._reports.send(ev.SHARE_ERR_EID, ev.ERROR, text)
            raise

    def unregister(self, handle: int) -> None:
        """Release a handle; the owner's handle releases the table (CFE_TBL_Unregister)."""
        try:
            self.registry.release(self._access("Unregister", handle))
        except CfeError as error:
            text = f"{self._caller()[1]} Failed to Unregister '?', Status={error.hex}"
            self._reports.send(ev.UNREGISTER_ERR_EID, ev.ERROR, text)
            raise

    # --- loading ---

    def load(
        self,
        handle: int,
        source: str | Bytes,
        *,
        address: int | None = None,
        read: Callable[[], bytes] | None = None,
        source_type: int | None = None,
    ) -> int:
        """Load a table of the calling app and switch to the new image (CFE_TBL_Load).

        Args:
            handle: the owner's handle.
            source: path of a table file, or the image's bytes (for OPT_USR_DEF_ADDR the app's own bytearray, which then
                becomes the table).
            address: address of the image in C.
            read: reads the image later, when it may have disappeared.
            source_type: the source type that C code passed, if it is neither a file nor an address.

        Returns:
            CFE_SUCCESS, CFE_TBL_WARN_SHORT_FILE, CFE_TBL_WARN_PARTIAL_LOAD, or CFE_TBL_INFO_TABLE_LOCKED if an
            application has the table's address; `manage` then switches later.

        Raises:
            CfeError: the error; an event also reports it to the ground, and the table stays unchanged.
        """
        caller = self._caller()[1]
        try:
            table = self._access("Load", handle, owner_only=True, log="").table
        except CfeError as error:
            self._load_denied(error, handle, caller)
            raise
        file = LoadFile(source, self._config) if isinstance(source, str) else None
        if source_type is None:
            source_type = SRC_FILE if file is not None else SRC_ADDRESS
        try:
            self._loads.reserve(table, source_type)
        except Refused as refused:
            self._reports.load_refused(refused, caller, table)
            raise
        try:
            status = self._fill(table, file, source, address, read)
            faults = self._loads.validate(table)
        except Refused as refused:
            self.registry.discard_load(table)
            if file is None:
                self._reports.load_refused(refused, caller, table)
            else:
                self._reports.file_refused(refused, caller, file, table)
            raise
        except BaseException:  # an error of the app's validator must not leave the table half loaded
            self.registry.discard_load(table)
            raise
        if faults:
            self.registry.discard_load(table)
            for fault in faults:
                self._reports.load_refused(fault, caller, table)
            raise faults[-1]
        return self._finish_load(table, handle, caller, status)

    def _load_denied(self, error: CfeError, handle: int, caller: str) -> None:
        """Report a load through a handle without the right to it, or, in some releases, through an invalid one."""
        access = self.registry.accesses.find(handle)
        if access is not None:
            refused = Refused(error.status, ev.HANDLE_ACCESS_ERR_EID, "No access to Tbl Handle")
            self._reports.load_refused(refused, caller, access.table)
        elif self._config.release.reports_invalid_handle:
            refused = Refused(error.status, ev.NO_SUCH_TABLE_ERR_EID, "Unable to locate in Table Registry")
            self._reports.load_refused(refused, caller, None)

    def _fill(
        self,
        table: TableRecord,
        file: LoadFile | None,
        source: str | Bytes,
        address: int | None,
        read: Callable[[], bytes] | None,
    ) -> int:
        if file is not None:
            self._loads.open(file)
            self._loads.fill_from_file(table, file)
            return file.completeness(table)
        if not isinstance(source, str):
            self._loads.fill_from_memory(table, source, address, read)
        return CFE_SUCCESS

    def _finish_load(self, table: TableRecord, handle: int, caller: str, status: int) -> int:
        is_first = not table.is_loaded
        result = self._loads.update(table, handle)
        if result != CFE_SUCCESS:
            text = f"{caller}: Failed to update '{table.name}' (Stat={result})"
            self._reports.send(ev.UPDATE_ERR_EID, ev.ERROR, text)
            return result
        text = f"Successfully loaded '{table.name}' from '{table.last_file}'"
        self._reports.send(ev.LOAD_SUCCESS_INF_EID, ev.DEBUG if is_first else ev.INFORMATION, text)
        self.task.note_update(table)
        return status

    def update(self, handle: int) -> int:
        """Switch to the loaded image (CFE_TBL_Update).

        Returns:
            CFE_SUCCESS, CFE_TBL_INFO_NO_UPDATE_PENDING or CFE_TBL_INFO_TABLE_LOCKED.
        """
        try:
            access = self._access("Update", handle, owner_only=True)
        except CfeError as error:
            text = f"{self._caller()[1]} Failed to update table, Status={error.hex}"
            self._reports.send(ev.UPDATE_ERR_EID, ev.ERROR, text)
            raise
        table = access.table
        status = self._loads.update(table, handle)
        if status == CFE_SUCCESS:
            text = f"{self._caller()[1]} Successfully Updated '{table.name}'"
            self._reports.send(ev.UPDATE_SUCCESS_INF_EID, ev.INFORMATION, text)
            self.task.note_update(table)
            return status
        text = f"App({self._caller()[0]}) fail to update Tbl '{table.name}' (Stat=0x{status:08X})"
        self._log("Update", text)
        return status

    def validate(self, handle: int) -> int:
        """Run the validator for a request of the ground (CFE_TBL_Validate).

        Returns:
            CFE_SUCCESS for any result of the validator, or CFE_TBL_INFO_NO_VALIDATION_PENDING.
        """
        table = self._access("Validate", handle, owner_only=True).table
        request = self._validations.take(table)
        if request is None:
            return CFE_TBL_INFO_NO_VALIDATION_PENDING
        which = "active" if request.of_active else "inactive"
        buffer = self.registry.active(table) if request.of_active else self.registry.loading(table)
        result = -1
        try:
            if buffer is not None:
                result = table.judge(table.image(buffer))
                if result == 0 or self._config.release.failed_validation_unmarks:
                    buffer.is_valid = result == 0
        finally:  # the ground gets a result even if the validator raises
            request.result, request.performed = result, True
        caller = self._caller()[1]
        if result == 0:
            text = f"{caller} validation successful for {which} '{table.name}'"
            self._reports.send(ev.VALIDATION_INF_EID, ev.INFORMATION, text)
            return CFE_SUCCESS
        status = f"0x{result & 0xFFFFFFFF:08X}"
        told = status if self._config.release.failed_validation_has_status else "0x00000000"
        text = f"{caller} validation failed for {table.name} '{which}', Status={told}"
        self._reports.send(ev.VALIDATION_ERR_EID, ev.ERROR, text)
        if result > 0:
            app = self.registry.services_app_id
            text = f"App({app}) Validation func return code invalid (Stat={status}) for '{table.name}'"
            self._log("Validate", text)
        return CFE_SUCCESS

    def manage(self, handle: int) -> int:
        """Carry out the ground's requests on a table: validate, update or dump (CFE_TBL_Manage).

        Returns:
            CFE_SUCCESS if there was no request, CFE_TBL_INFO_UPDATED if the table changed, otherwise the result of
            `validate`, `update` or `dump_to_buffer`.
        """
        while True:
            status = self.get_status(handle)
            if status == CFE_TBL_INFO_VALIDATION_PENDING:
                self.validate(handle)
            elif status == CFE_TBL_INFO_DUMP_PENDING:
                return self.dump_to_buffer(handle)
            elif status == CFE_TBL_INFO_UPDATE_PENDING:
                return self.update(handle) or CFE_TBL_INFO_UPDATED
            else:
                return status

    def dump_to_buffer(self, handle: int) -> int:
        """Take the snapshot of a dump-only table for a request of the ground (CFE_TBL_DumpToBuffer).

        Returns:
            CFE_SUCCESS or CFE_TBL_INFO_NO_DUMP_PENDING.

        Raises:
            CfeError: CFE_TBL_ERR_INVALID_HANDLE if the image cannot be copied; see `Dumps.take_snapshot`.
        """
        access = self._access(
            "DumpToBuffer", handle, log="App({app:x}) does not have access to Tbl Handle=0x{handle:x}"
        )
        return self._dumps.take_snapshot(access.table, access)

    def modified(self, handle: int) -> None:
        """Report that the app changed the table's content itself (CFE_TBL_Modified)."""
        access = self._access("Modified", handle)
        table = access.table
        active, app_id = self.registry.active(table), self._caller()[0]
        if active is not None:
            table.modified, table.last_update = True, self._ports.time.now()
            active.recompute_crc()
            for other in table.accesses:
                other.updated = other.updated or other.app_id != app_id
        if table.critical:
            self._critical.save(table)

    def notify_by_message(self, handle: int, msg_id: int, fcn_code: int, parameter: int) -> None:
        """Request a command for each request of the ground on the table (CFE_TBL_NotifyByMessage).

        Args:
            handle: the owner's handle.
            msg_id: MsgId of the command.
            fcn_code: its function code.
            parameter: 32 bits of payload.
        """
        access = self._access("NotifyByMessage", handle, log=_NOT_NOTIFIED)
        app_id = self._caller()[0]
        if access.table.owner != app_id:
            status = CFE_TBL_ERR_NO_ACCESS & ULONG
            self._log("NotifyByMessage", _NOT_NOTIFIED.format(app=app_id, handle=int(handle), status=status))
            raise CfeError(CFE_TBL_ERR_NO_ACCESS, f"{access.table.name!r} belongs to another app")
        access.table.notify = (msg_id, fcn_code, parameter & 0xFFFFFFFF)

    @property
    def pool_id(self) -> int:
        """The handle of the table buffer pool; 0 before it exists."""
        return self._memory.pool_id

    def buffer_sizes(self) -> dict[str, list[int]]:
        """Return the bytes of the buffers in the table buffer pool by the full names of tables; shared buffers are
        under "".
        """
        found = {"": [len(buffer.data) for buffer in self._memory]}
        for table in self.registry.tables:
            found[table.name] = [table.size for buffer in table.buffers if buffer.block is not None]
        return found

    def place_buffers(self, places: BufferPlaces) -> None:
        """Set the provider of memory for new images outside the table buffer pool."""
        self._memory.places = places

    def leave_memory(self, is_leaving: Callable[[memoryview], bool]) -> None:
        """Copy the buffers whose memory is about to disappear.

        Args:
            is_leaving: returns whether a buffer's memory is about to disappear.
        """
        for buffer in (*self._memory, *(each for table in self.registry.tables for each in table.buffers)):
            if len(buffer.data) and is_leaving(buffer.data):
                buffer.leave()

    def cleanup_app(self, app_id: int) -> None:
        """Release all tables, handles and dumps of an ended app (CFE_TBL_CleanUpApp)."""
        self._dumps.forget_owner(app_id)
        for access in self.registry.accesses:
            if access.app_id == app_id:
                self.registry.release(access)
