"""The validations requested by the ground, until housekeeping has reported their results.

It replaces cfe_tbl_valresult.c. Release 7.0.1 allows a table one request at a time. Release 7.0.0 accepts any number
until all slots are used. There, a request for the same image replaces the one before, which then gets no result.
"""

from __future__ import annotations

from cfepy.ids import TBL_VALRESULTID_BASE, UNDEFINED, IdTable
from cfepy.tbl.registry import TableRecord


class Validation:
    """A request (CFE_TBL_ValidationResult_t); `result` is the validator's result, once `performed`."""

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
        capacity: maximum number of requests (CFE_PLATFORM_TBL_MAX_NUM_VALIDATIONS).
        one_at_a_time: whether a table has one request at a time.
    """

    def __init__(self, capacity: int, one_at_a_time: bool) -> None:
        self._slots: IdTable[Validation] = IdTable(TBL_VALRESULTID_BASE, capacity)
        self._one_at_a_time = one_at_a_time

    @property
    def is_full(self) -> bool:
        """Whether no more requests fit."""
        return len(self._slots) >= self._slots.capacity

    def add(self, request: Validation) -> None:
        """Keep a request until its result was reported.

        Raises:
            CfeError: if there are too many.
        """
        request.number = self._slots.create(request)

    def ask(self, table: TableRecord, request: Validation) -> None:
        """Keep a request for the table's owner."""
        self.add(request)
        table.validations[None if self._one_at_a_time else request.of_active] = request.number

    def asked(self, table: TableRecord) -> Validation | None:
        """Return a table's request, in a release with one request at a time."""
        return self._slots.find(table.validations.get(None, UNDEFINED))

    def take(self, table: TableRecord) -> Validation | None:
        """Return the next request, inactive image first, and remove it from the table
        (CFE_TBL_CheckValidationRequest).
        """
        for which in (None, False, True):
            request = self._slots.find(table.validations.pop(which, UNDEFINED))
            if request is not None:
                return request
        return None

    def tell(self) -> Validation | None:
        """Return one finished request and remove it; the next one waits, so that the ground misses none."""
        for number in range(self._slots.capacity):
            request = self._slots.at(number)
            if request is not None and request.performed:
                return self._slots.delete(request.number)
        return None
