"""The definition of a table, declared once by its app, for the app itself and for ground tools.

An app package offers its tables as `TABLES` next to its entry point, where tools find them. The module replaces a C
app's table header and CFE_TBL_FILEDEF.
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
"""Rows from the first one on, the fields of one row, or rows by their number."""


@dataclass(frozen=True, slots=True)
class TableType:
    """A table that is an array of equal structs, or a single struct.

    Args:
        name: full name, "APP.Table".
        row: layout of a row.
        rows: number of rows.
        file: the file that the app loads at its start; empty for none.
        description: description in its file, at most 31 characters.
        fault: the application's validation, for tools: given a whole image, it returns why the application would refuse
            it, or None.
        telemetry: for tools, the packets that the application makes according to the table: it gets a whole image and
            the other declared telemetry by MsgId.

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
        """The name without the application's, as for CFE_TBL_Register: "Table"."""
        return self.name.partition(".")[2]

    @property
    def size(self) -> int:
        """The bytes of the whole table."""
        return self.rows * self.row.size

    def pack(self, values: Rows) -> bytes:
        """Return the table's bytes; missing rows and fields are zero.

        Args:
            values: the fields of the only row, a sequence of rows, or rows by their number, from 0.

        Raises:
            UsageError: for too many rows, an unknown field, or a value that does not fit; `field` has its path.
        """
        return pack_rows(self.row, self._in_order(values), self.rows)

    def unpack(self, data: bytes | bytearray | memoryview) -> list[dict[str, Any]]:
        """Return all rows of a table image, including zero rows.

        Raises:
            UsageError: if the size of the image differs from the table.
        """
        if len(data) != self.size:
            raise UsageError(f"must have {self.size} bytes for {self.name}, not {len(data)}", field="data")
        return unpack_rows(self.row, data)

    def image(self, values: Rows) -> TableImage:
        """Return the image of a table file for `cfepy.tbl.build`; see `pack` for the errors."""
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
