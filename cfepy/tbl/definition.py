"""The definition of a table, declared once by the app that owns it: for the app itself and for the tools on the ground.

An app package offers its tables as `TABLES` next to its entry point, where tools find them. Stands for what a C app
says in its table header and in CFE_TBL_FILEDEF.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, cast

from cfepy.msg import Layout, Telemetry
from cfepy.status import UsageError
from cfepy.tbl.image import TableImage, pack_rows, unpack_rows

Row = Mapping[str, Any]
Rows = Sequence[Row] | Mapping[str, Any] | Mapping[int, Row]
"""Rows from the first on, one row's fields, or rows by their number."""


@dataclass(frozen=True, slots=True)
class TableType:
    """A table that is an array of equal structs, or a single struct.

    Args:
        name: full name, "APP.Table".
        row: layout of a row.
        rows: how many of them.
        file: where the app loads it from at its start; empty when it does not.
        description: of its file, at most 31 characters.
        fault: the application's validation, for those who cannot ask the application: given a whole image, it says
            what the application refuses it for, or None.
        telemetry: for those who cannot ask the application, the packets that it makes as the table says: given a whole
            image, and the telemetry that is declared otherwise, by MsgId.

    >>> point = TableType("APP.Points", Layout("Point", [("X", "u8"), ("Y", "u8")]), rows=3)
    >>> point.pack({1: {"X": 7}}).hex()
    '000007000000'
    >>> point.unpack(bytes([1, 2, 0, 0, 5, 6]))
    [{'X': 1, 'Y': 2}, {'X': 0, 'Y': 0}, {'X': 5, 'Y': 6}]
    """

    name: str
    row: Layout
    rows: int = 1
    file: str = ""
    description: str = ""
    fault: Callable[[bytes | memoryview], str | None] | None = field(default=None, compare=False)
    telemetry: Callable[[bytes | memoryview, Mapping[int, Telemetry]], Iterable[Telemetry]] | None = field(
        default=None, compare=False
    )

    @property
    def own_name(self) -> str:
        """The name without the application's, as CFE_TBL_Register takes it: "Table"."""
        return self.name.partition(".")[2]

    @property
    def size(self) -> int:
        """Bytes of the whole table."""
        return self.rows * self.row.size

    def pack(self, values: Rows) -> bytes:
        """The table's bytes; rows and fields that are not given are zero.

        Args:
            values: the fields of the only row, a sequence of rows, or rows by their number, which begins at 0.

        Raises:
            UsageError: too many rows, an unknown field, or a value that does not fit; `field` says which.
        """
        return pack_rows(self.row, self._in_order(values), self.rows)

    def unpack(self, data: bytes | bytearray | memoryview) -> list[dict[str, Any]]:
        """All rows of a table image, zero rows included.

        Raises:
            UsageError: the image has another size than the table.
        """
        if len(data) != self.size:
            raise UsageError(f"must have {self.size} bytes for {self.name}, not {len(data)}", field="data")
        return unpack_rows(self.row, data)

    def image(self, values: Rows) -> TableImage:
        """The image of a table file, ready for `cfepy.tbl.build`; errors as `pack`."""
        return TableImage(self.name, self.pack(values), self.description)

    def _in_order(self, values: Rows) -> Sequence[Row]:
        if isinstance(values, Sequence):
            return values
        numbered = {key: row for key, row in values.items() if isinstance(key, int)}
        if not numbered:
            return [cast(Row, values)]
        wrong = [key for key in values if key not in range(self.rows)]
        if wrong:
            raise UsageError(
                f"row out of range; {self.name} has {self.rows} rows, counted from 0", field=f"rows[{wrong[0]}]"
            )
        return [numbered.get(number, {}) for number in range(max(numbered) + 1)]
