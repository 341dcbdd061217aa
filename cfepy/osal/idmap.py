"""OSAL's id map (osapi-idmap.h), error names, console output and versions: functions for all kinds of objects."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cfepy.config.versions import VersionFunctions
from cfepy.ids import OS_CONSOLE_BASE, equal, from_integer, get_base, is_defined, to_integer
from cfepy.osal.core import Core, OsObject, OsObjectTable, Setup
from cfepy.osal.limits import (
    OS_BUFFER_SIZE,
    OS_ERROR_NAME_LENGTH,
    OS_OBJECT_CREATOR_ANY,
)
from cfepy.reading.texts import to_bytes
from cfepy.status import OS_ERR_INVALID_ID, OsalError, name_of, status_to_decimal, to_signed


class IdMapApi(VersionFunctions, Core):
    """The functions on object ids of any kind, and OS_printf."""

    object_id_to_integer = staticmethod(to_integer)
    object_id_from_integer = staticmethod(from_integer)
    object_id_equal = staticmethod(equal)
    object_id_defined = staticmethod(is_defined)
    status_to_integer = staticmethod(to_signed)
    status_to_string = staticmethod(status_to_decimal)

    def __init__(self, setup: Setup) -> None:
        super().__init__(setup)
        self._version = setup.config.release.osal_version
        self._printf_enabled = True
        self._line = ""
        consoles: OsObjectTable[OsObject] = self._table("console", OS_CONSOLE_BASE, 1)
        self._reserve(consoles, OsObject(""))

    def get_resource_name(self, object_id: int) -> str:
        """Return the name of any OSAL object, or the path of an open file or folder (OS_GetResourceName).

        Raises:
            OsalError: OS_ERR_INVALID_ID.
        """
        return self._object(object_id).resource_name

    def identify_object(self, object_id: int) -> int:
        """Return the kind of an id, one of the OS_*_BASE numbers, or the same bits of any other number
        (OS_IdentifyObject).
        """
        return get_base(object_id)

    def convert_to_array_index(self, object_id: int) -> int:
        """Return the index of an object, unique among existing objects of its kind and counted from 0
        (OS_ConvertToArrayIndex).

        Raises:
            OsalError: OS_ERR_INVALID_ID for a number that is not an OSAL id.
        """
        return self.object_id_to_array_index(0, object_id)

    def object_id_to_array_index(self, idtype: int, object_id: int) -> int:
        """Return the index of an object of a given kind; see `convert_to_array_index` (OS_ObjectIdToArrayIndex).

        Args:
            idtype: one of the OS_*_BASE numbers, 0 for any.
            object_id: the id.

        Raises:
            OsalError: OS_ERR_INVALID_ID for an id of another kind.
        """
        base = get_base(object_id)
        table = self._tables.get(base)
        if table is None or (idtype and idtype != base):
            raise OsalError(OS_ERR_INVALID_ID, f"{object_id:#x} is not an id of kind {idtype or 'any'}")
        return table.index(object_id)

    def for_each_object(
        self, creator_id: int, callback: Callable[[int, Any], object], callback_arg: Any = None
    ) -> None:
        """Call a function for every object that a task created (OS_ForEachObject).

        Args:
            creator_id: the task; OS_OBJECT_CREATOR_ANY (0) for all objects.
            callback: called with the id and `callback_arg`; it may delete the object.
            callback_arg: second argument of the callback.
        """
        for base in sorted(self._tables):
            self.for_each_object_of_type(base, creator_id, callback, callback_arg)

    def for_each_object_of_type(
        self, objtype: int, creator_id: int, callback: Callable[[int, Any], object], callback_arg: Any = None
    ) -> None:
        """Call a function for every object of one kind; see `for_each_object` (OS_ForEachObjectOfType)."""
        table = self._tables.get(objtype)
        for object_id, record in table.items() if table is not None else ():
            if not record.deleted and creator_id in (OS_OBJECT_CREATOR_ANY, record.creator):
                callback(object_id, callback_arg)

    def get_error_name(self, status: int) -> str:
        """Return NASA's name of an OS_* status, or "OS_UNKNOWN(n)" for others (OS_GetErrorName)."""
        name = name_of(status)
        if status == 0:
            return "OS_SUCCESS"
        return name[: OS_ERROR_NAME_LENGTH - 1] if name.startswith("OS_") else f"OS_UNKNOWN({status})"

    def printf(self, text: str) -> None:
        """Write a text to the console as lines of its own, at most 171 characters (OS_printf)."""
        if self._printf_enabled:
            self.console.write(text[: OS_BUFFER_SIZE - 1])

    def printf_piece(self, text: str) -> None:
        """Write text that may be a part of a line, at most 171 bytes (OS_printf as in C).

        A line appears once it is complete, however long it is.
        """
        if self._printf_enabled:
            piece = to_bytes(text)[: OS_BUFFER_SIZE - 1].decode("utf-8", "surrogateescape")
            *lines, self._line = (self._line + piece).split("\n")
            for line in lines:
                self.console.write(line)

    def printf_disable(self) -> None:
        """Disable `printf` (OS_printf_disable)."""
        self._printf_enabled = False

    def printf_enable(self) -> None:
        """Enable `printf` again (OS_printf_enable)."""
        self._printf_enabled = True

    def _object(self, object_id: int) -> OsObject:
        table = self._tables.get(get_base(object_id))
        record: OsObject | None = table.find(object_id) if table is not None else None
        if record is None:
            raise OsalError(OS_ERR_INVALID_ID, f"invalid OSAL object id {object_id:#x}")
        return record
