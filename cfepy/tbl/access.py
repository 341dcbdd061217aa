"""The functions for every application with a handle on a table, owner or not (CFE_TBL_GetAddress and its relatives)."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from cfepy.ids import UNDEFINED
from cfepy.ports import Ports, application_of
from cfepy.rtos import Kernel
from cfepy.status import (
    CFE_ES_ERR_RESOURCEID_NOT_VALID,
    CFE_SUCCESS,
    CFE_TBL_ERR_INVALID_HANDLE,
    CFE_TBL_ERR_NEVER_LOADED,
    CFE_TBL_ERR_NO_ACCESS,
    CFE_TBL_ERR_UNREGISTERED,
    CFE_TBL_INFO_DUMP_PENDING,
    CFE_TBL_INFO_UPDATE_PENDING,
    CFE_TBL_INFO_UPDATED,
    CFE_TBL_INFO_VALIDATION_PENDING,
    CfeError,
)
from cfepy.tbl.registry import Access, TableRegistry

MODIFIED_MARK = "(*)"
BAD_TABLE_HANDLE = -1
ULONG = 0xFFFFFFFFFFFFFFFF
_NO_ACCESS = "App({app}) does not have access to Tbl Handle={handle}"


class TableInfo(NamedTuple):
    """The result of CFE_TBL_GetInfo; times are (seconds, subseconds)."""

    size: int
    num_users: int
    file_time: tuple[int, int]
    crc: int
    time_of_last_update: tuple[int, int]
    table_loaded_once: bool
    dump_only: bool
    double_buffered: bool
    user_def_addr: bool
    critical: bool
    last_file_loaded: str


class TableAccess:
    """The part of Table Services that changes no table.

    Args:
        kernel: provides the running task.
        ports: the other services.
        registry: the tables.
    """

    def __init__(self, kernel: Kernel, ports: Ports, registry: TableRegistry) -> None:
        self._kernel = kernel
        self._ports = ports
        self.registry = registry

    def get_addresses_in_c(self, handles: Iterable[int]) -> tuple[list[memoryview | None], int]:
        """Return the addresses of several tables like CFE_TBL_GetAddresses in C: it continues after a failure and
        releases nothing.

        Returns:
            The images, with None for a failure; and the first status that is not CFE_SUCCESS.
        """
        images: list[memoryview | None] = []
        first = CFE_SUCCESS
        for handle in handles:
            image, status = None, CFE_SUCCESS
            try:
                image, updated = self._image_of(self._access("GetAddresses", handle, log=""))
                status = CFE_TBL_INFO_UPDATED if updated else CFE_SUCCESS
            except CfeError as error:
                status = error.status
            images.append(image)
            first = first or status
            if status == CFE_ES_ERR_RESOURCEID_NOT_VALID:
                self._log("GetAddresses", "Bad AppId=0")
                break
        return images, first

    def get_address(self, handle: int) -> tuple[memoryview, bool]:
        """Return the active image, locked until `release_address` (CFE_TBL_GetAddress).

        Returns:
            A view of the bytes, and whether they have changed since the last call (CFE_TBL_INFO_UPDATED).

        Raises:
            CfeError: CFE_TBL_ERR_NEVER_LOADED, CFE_TBL_ERR_UNREGISTERED, or no access.
        """
        return self._image_of(self._access("GetAddress", handle, log="Bad AppId={app}"))

    def _image_of(self, access: Access) -> tuple[memoryview, bool]:
        table, active = access.table, self.registry.active(access.table)
        if table.owner == UNDEFINED:
            self._log(
                "TxnGetTableAddress", f"App({access.app_id}) attempt to access unowned Tbl Handle={int(access.handle)}"
            )
            raise CfeError(CFE_TBL_ERR_UNREGISTERED, f"{table.name!r} was released by its owner")
        if active is None:
            raise CfeError(CFE_TBL_ERR_NEVER_LOADED, f"{table.name!r} was never loaded")
        updated, access.updated = access.updated, False
        access.locked, access.buffer_id = True, active.load_id
        return table.image(active), updated

    def release_address(self, handle: int) -> int:
        """Release the address, so that the table can be updated (CFE_TBL_ReleaseAddress).

        Returns:
            CFE_SUCCESS, or CFE_TBL_INFO_UPDATED if the table has changed meanwhile.
        """
        access = self._access("ReleaseAddress", handle)
        access.locked = False
        if not access.table.is_loaded:
            raise CfeError(CFE_TBL_ERR_NEVER_LOADED, f"{access.table.name!r} was never loaded")
        return CFE_TBL_INFO_UPDATED if access.updated else CFE_SUCCESS

    def get_addresses(self, handles: Iterable[int]) -> list[tuple[memoryview, bool]]:
        """Return the results of `get_address` for several tables; after a failure, release the earlier ones
        (CFE_TBL_GetAddresses).
        """
        taken: list[int] = []
        found = []
        try:
            for handle in handles:
                found.append(self.get_address(handle))
                taken.append(handle)
        except CfeError:
            self.release_addresses(taken)
            raise
        return found

    def release_addresses(self, handles: Iterable[int]) -> int:
        """Release the addresses of several tables (CFE_TBL_ReleaseAddresses).

        Returns:
            The first status that is not CFE_SUCCESS.

        Raises:
            CfeError: if that status is an error; the tables after it are released too.
        """
        answers: list[int | CfeError] = []
        for handle in handles:
            try:
                answers.append(self.release_address(handle))
            except CfeError as error:
                answers.append(error)
        first = next((answer for answer in answers if answer != CFE_SUCCESS), CFE_SUCCESS)
        if isinstance(first, CfeError):
            raise first
        return first

    def get_status(self, handle: int) -> int:
        """Return the pending request of a table (CFE_TBL_GetStatus).

        Returns:
            CFE_SUCCESS, or CFE_TBL_INFO_VALIDATION_PENDING, _UPDATE_PENDING, _DUMP_PENDING, in this order of
                precedence.
        """
        table = self._access("GetStatus", handle).table
        if table.validations:
            return CFE_TBL_INFO_VALIDATION_PENDING
        if self.registry.is_update_pending(table):
            return CFE_TBL_INFO_UPDATE_PENDING
        return CFE_TBL_INFO_DUMP_PENDING if table.dump_id != UNDEFINED else CFE_SUCCESS

    def get_info(self, full_name: str) -> TableInfo:
        """Return the properties of a table, by its full name (CFE_TBL_GetInfo).

        Raises:
            CfeError: CFE_TBL_ERR_INVALID_NAME.
        """
        table = self.registry.by_name(full_name)
        active = self.registry.active(table)
        return TableInfo(
            size=table.size,
            num_users=len(table.accesses),
            file_time=active.file_time if active else (0, 0),
            crc=active.crc if active else 0,
            time_of_last_update=table.last_update,
            table_loaded_once=active is not None,
            dump_only=table.dump_only,
            double_buffered=table.double_buffered,
            user_def_addr=table.user_defined,
            critical=table.critical,
            last_file_loaded=table.last_file + MODIFIED_MARK * table.modified,
        )

    def handle_to_id(self, handle: int) -> int:
        """Return the resource id of a handle, 0 for CFE_TBL_BAD_TABLE_HANDLE (CFE_TBL_HandleToID)."""
        return UNDEFINED if handle == BAD_TABLE_HANDLE else int(handle)

    def handle_from_id(self, handle_id: int) -> int:
        """Return the handle of a resource id, CFE_TBL_BAD_TABLE_HANDLE for 0 (CFE_TBL_HandleFromID)."""
        return BAD_TABLE_HANDLE if handle_id == UNDEFINED else handle_id

    def handle_id_is_equal(self, first: int, second: int) -> bool:
        """Return whether two handle ids are the same (CFE_TBL_HandleID_IsEqual)."""
        return first == second

    def handle_id_as_int(self, handle_id: int) -> int:
        """Return the handle id as a number for display (CFE_TBL_HandleID_AsInt)."""
        return int(handle_id)

    def handle_id_is_defined(self, handle_id: int) -> bool:
        """Return whether the handle id is not 0 (CFE_TBL_HandleID_IsDefined)."""
        return handle_id != UNDEFINED

    def _caller(self) -> tuple[int, str]:
        caller = application_of(self._kernel.current.owner)
        if caller is None:
            raise CfeError(CFE_ES_ERR_RESOURCEID_NOT_VALID, "the caller must be a task of an application")
        return caller.app_id, caller.name

    def _access(self, function: str, handle: int, owner_only: bool = False, log: str = _NO_ACCESS) -> Access:
        """Return the access descriptor of a handle, after checking that the caller may use it.

        Args:
            function: name of the called function.
            handle: its argument.
            owner_only: whether the caller must own the table; otherwise it must own the handle.
            log: line for the system log after a failure; "" for none.

        Raises:
            CfeError: CFE_TBL_ERR_INVALID_HANDLE or CFE_TBL_ERR_NO_ACCESS.
        """
        try:
            app_id, _ = self._caller()
        except CfeError as refused:
            if log:
                self._log(function, log.format(app=0, handle=0, status=refused.status & ULONG))
            raise
        access = self.registry.accesses.find(handle)
        if access is None:
            error = CfeError(CFE_TBL_ERR_INVALID_HANDLE, f"invalid table handle 0x{int(handle) & 4294967295:x}")
        elif app_id in (access.table.owner if owner_only else access.app_id, self.registry.services_app_id):
            return access
        elif owner_only:
            error = CfeError(CFE_TBL_ERR_NO_ACCESS, f"{access.table.name!r} belongs to another app")
        else:
            error = CfeError(CFE_TBL_ERR_NO_ACCESS, f"this handle on {access.table.name!r} is another app's")
        if log:
            self._log(function, log.format(app=app_id, handle=int(handle), status=error.status & ULONG))
        raise error

    def _log(self, function: str, text: str) -> None:
        self._ports.syslog.write_to_sys_log(f"CFE_TBL_{function}: {text}")
