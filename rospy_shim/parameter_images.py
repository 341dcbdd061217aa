"""The parameter tables in cFE's Table Services: registered, read, written row by row, and managed for the ground.

Works in the tasks of the application ROS, whose tables they are. May import cfepy.app, cfepy.status and cfepy.tbl.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.status import CFE_TBL_INFO_RECOVERED_TBL, CFE_TBL_INFO_UPDATED, CFE_TBL_WARN_NOT_CRITICAL, CfeError
from cfepy.tbl import OPT_CRITICAL
from rospy_shim import parameter_table as table

if TYPE_CHECKING:
    from cfepy.app import Cfe
    from cfepy.tbl import TableHandle
    from cfepy.tbl.registry import Validator

TABLE_ERR_EID = 5


class ParameterImages:
    """All parameter tables of one application.

    Args:
        cfe: the handle of cFE's services.

    Attributes:
        survived: they were there before the processor was reset.
    """

    def __init__(self, cfe: Cfe) -> None:
        self._cfe = cfe
        self._handles: list[TableHandle] = []
        self._rows = 0
        self.survived = False

    def __len__(self) -> int:
        """How many tables there are."""
        return len(self._handles)

    def register(self, notify_msg_id: int) -> None:
        """Register as many tables as the platform takes, and find what a reset has left of them.

        Args:
            notify_msg_id: of the command that tells of the ground's wishes.

        Raises:
            CfeError: not one table could be had.
        """
        count, self._rows = table.extent(self._cfe.sb.config)
        for number in range(max(1, count)):
            handle = self._register(number)
            if handle is None:
                break
            self._handles.append(handle)
            self.survived = self.survived or handle.status == CFE_TBL_INFO_RECOVERED_TBL
            self._cfe.tbl.notify_by_message(handle, notify_msg_id, 0, number)
        for handle in self._handles:
            if handle.status != CFE_TBL_INFO_RECOVERED_TBL:
                self._cfe.tbl.load(handle, bytes(self._rows * table.ROW_BYTES))

    def _register(self, number: int) -> TableHandle | None:
        """One more table; None when there is no room for it. The first may be one that a reset does not leave."""
        tbl, name = self._cfe.tbl, table.table_name(number)
        try:
            handle = tbl.register(name, self._rows * table.ROW_BYTES, OPT_CRITICAL, self._validator(name))
        except CfeError:
            if number:
                return None
            raise
        if handle.status == CFE_TBL_WARN_NOT_CRITICAL and number:
            tbl.unregister(handle)
            return None
        return handle

    def read(self) -> list[table.Row]:
        """The rows of all tables."""
        rows: list[table.Row] = []
        for handle in self._handles:
            image, _ = self._cfe.tbl.get_address(handle)
            rows += table.unpack(image)
            self._cfe.tbl.release_address(handle)
        return rows

    def write(self, changed: dict[int, None], rows: list[table.Row]) -> None:
        """Put rows into their tables, and forget that they have changed."""
        by_table: dict[int, list[int]] = {}
        for index in changed:
            by_table.setdefault(index // self._rows, []).append(index)
        changed.clear()
        for number, indexes in by_table.items():
            handle = self._handles[number]
            image, _ = self._cfe.tbl.get_address(handle)
            for index in indexes:
                at = index % self._rows * table.ROW_BYTES
                image[at : at + table.ROW_BYTES] = table.pack(rows[index])
            self._cfe.tbl.release_address(handle)
            self._cfe.tbl.modified(handle)

    def manage(self) -> bool:
        """Do what the ground asked for; whether there are other parameters now."""
        answers = [self._cfe.tbl.manage(handle) for handle in self._handles]
        return CFE_TBL_INFO_UPDATED in answers

    def _validator(self, name: str) -> Validator:
        def validate(image: memoryview) -> int:
            fault = table.fault(table.unpack(image))
            if fault is None:
                return 0
            self._cfe.evs.send_err(TABLE_ERR_EID, f"ROS: {name}, {fault}")
            return -1

        return validate
