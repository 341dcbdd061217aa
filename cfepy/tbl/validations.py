"""The validations that the ground asked for, until housekeeping has told their results.

Stands for cfe_tbl_valresult.c. Release 7.0.1 lets a table have one request at a time. Release 7.0.0 takes any number
until all slots are used: a request for the same image replaces the one before, which then nobody answers.
"""

from __future__ import annotations

from cfepy.ids import TBL_VALRESULTID_BASE, UNDEFINED, IdTable
from cfepy.tbl.registry import TableRecord


class Validation:
    """One request (CFE_TBL_ValidationResult_t); `result` is the validator's, once `performed`."""

    __slots__ = ("crc", "number", "of_active", "performed", "result", "table_name")

    def __init__(self, table_name: str, crc: int, of_active: bool) -> None:
        self.table_name = table_name
        self.crc = crc
        self.of_active = of_active
        self.performed = False
        self.result = 0
        self.number = UNDEFINED


class Validations:
    """All requests of a mission.

    Args:
        capacity: how many there may be (CFE_PLATFORM_TBL_MAX_NUM_VALIDATIONS).
        one_at_a_time: whether a table has one request at a time.
    """

    def __init__(self, capacity: int, one_at_a_time: bool) -> None:
        self._slots: IdTable[Validation] = IdTable(TBL_VALRESULTID_BASE, capacity)
        self._one_at_a_time = one_at_a_time

    @property
    def is_full(self) -> bool:
        """Whether no more can be asked for."""
        return len(self._slots) >= self._slots.capacity

    def add(self, request: Validation) -> None:
        """Keep a request until its result was told.

        Raises:
            CfeError: if there are too many already.
        """
        request.number = self._slots.create(request)

    def ask(self, table: TableRecord, request: Validation) -> None:
        """Keep a request that the table's owner answers."""
        self.add(request)
        table.validations[None if self._one_at_a_time else request.of_active] = request.number

    def asked(self, table: TableRecord) -> Validation | None:
        """The request that a table has, where it has one at a time."""
        return self._slots.find(table.validations.get(None, UNDEFINED))

    def take(self, table: TableRecord) -> Validation | None:
        """The request that is next, inactive image first, and waits no more (CFE_TBL_CheckValidationRequest)."""
        for which in (None, False, True):
            request = self._slots.find(table.validations.pop(which, UNDEFINED))
            if request is not None:
                return request
        return None

    def tell(self) -> Validation | None:
        """Take one request that was performed; the next one waits, so that the ground misses none."""
        for number in range(self._slots.capacity):
            request = self._slots.at(number)
            if request is not None and request.performed:
                return self._slots.delete(request.number)
        return None
