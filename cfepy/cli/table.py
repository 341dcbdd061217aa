"""Tables: drawn by rich on a terminal, plain columns of text everywhere else."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TextIO


class Table:
    """A table of text.

    Args:
        title: above it.
        columns: their heads.
        right: indices of the columns of numbers.

    Attributes:
        note: a line below it.
    """

    def __init__(self, title: str, columns: Sequence[str], right: Sequence[int] = ()) -> None:
        self.title = title
        self.columns = tuple(columns)
        self.right = frozenset(right)
        self.rows: list[tuple[str, ...]] = []
        self.note = ""

    def add(self, *cells: object) -> None:
        """Add a row; numbers of thousands get their comma."""
        self.rows.append(tuple(f"{cell:,}" if isinstance(cell, int) else str(cell) for cell in cells))


def show_tables(tables: Sequence[Table], stream: TextIO) -> None:
    """Print tables one below the other."""
    draw = _draw if stream.isatty() else _write
    for table in tables:
        draw(table, stream)


def _write(table: Table, stream: TextIO) -> None:
    rows = [table.columns, *table.rows]
    widths = [max(len(row[at]) for row in rows) for at in range(len(table.columns))]
    stream.write(f"\n{table.title}\n")
    for row in rows:
        cells = (
            cell.rjust(width) if at in table.right else cell.ljust(width)
            for at, (cell, width) in enumerate(zip(row, widths, strict=True))
        )
        stream.write(("  " + "  ".join(cells)).rstrip() + "\n")
    if table.note:
        stream.write(f"  {table.note}\n")


def _draw(table: Table, stream: TextIO) -> None:
    from rich import box
    from rich.console import Console
    from rich.table import Table as RichTable
    from rich.text import Text

    drawn = RichTable(
        title=table.title, title_justify="left", box=box.SIMPLE_HEAD, pad_edge=False, caption=table.note or None
    )
    for at, column in enumerate(table.columns):
        is_last = at == len(table.columns) - 1
        drawn.add_column(column, justify="right" if at in table.right else "left", no_wrap=not is_last)
    for row in table.rows:
        drawn.add_row(*(Text(cell) for cell in row))
    Console(file=stream).print(drawn)
