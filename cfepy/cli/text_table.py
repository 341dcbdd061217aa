"""Tables: drawn by rich on a terminal, plain columns of text everywhere else."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from typing import TextIO

from cfepy.writing.escapes import rich_console, visible, visible_line

USUAL_WIDTH = 80
NARROW_TEXT = 14  # columns of text are folded into lines of so many characters before one is left out
GAP = 3  # between two columns


class Table:
    """A table of text.

    Args:
        title: title above it.
        columns: the column titles.
        right: indices of the columns of numbers.
        least: indices of the columns that a narrow terminal omits, the least important one first.

    Attributes:
        note: a line below it.
    """

    def __init__(
        self, title: str, columns: Sequence[str], right: Sequence[int] = (), least: Sequence[int] = ()
    ) -> None:
        self.title = visible_line(title)
        self.columns = tuple(map(visible_line, columns))
        self.right = frozenset(right)
        self.least = tuple(least)
        self.rows: list[tuple[str, ...]] = []
        self.note = ""

    def add(self, *cells: object) -> None:
        """Add a row. Integers get thousands separators, and each text becomes one line."""
        self.rows.append(tuple(f"{cell:,}" if isinstance(cell, int) else visible_line(cell) for cell in cells))


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
        stream.write(f"  {visible_line(table.note)}\n")


def print_lines(names: Iterable[str]) -> None:
    """Print names on standard output, a line each."""
    for name in names:
        print(visible_line(name))


def show_paragraph(text: str, stream: TextIO) -> None:
    """Print a text that is not a table; on a terminal, wrap lines between words."""
    text = visible(text)
    if stream.isatty():
        import textwrap

        lines = (textwrap.fill(line, _width(stream), break_on_hyphens=False) for line in text.split("\n"))
        text = "\n".join(lines)
    stream.write(f"{text}\n")


def _width(stream: TextIO) -> int:
    """Return the columns of a terminal; the environment variable COLUMNS takes precedence."""
    said = os.environ.get("COLUMNS", "")
    if said.isdecimal() and int(said):
        return int(said)
    try:
        return os.get_terminal_size(stream.fileno()).columns or USUAL_WIDTH
    except (ValueError, OSError):
        return USUAL_WIDTH


def fitting(table: Table, width: int) -> list[int]:
    """Return the columns that fit: if necessary, first empty ones and then the least important ones are omitted."""
    widest = [max(len(row[at]) for row in (table.columns, *table.rows)) for at in range(len(table.columns))]
    empty = [at for at in range(len(table.columns)) if table.rows and not any(row[at] for row in table.rows)]
    shown = list(range(len(table.columns)))
    for at in (*empty, *table.least):
        narrowest = (widest[each] if each in table.right else min(widest[each], NARROW_TEXT) for each in shown)
        if sum(narrowest) + GAP * len(shown) <= width:
            break
        shown = [each for each in shown if each != at]
    return shown


def _draw(table: Table, stream: TextIO) -> None:
    from rich import box
    from rich.table import Table as RichTable
    from rich.text import Text

    width = _width(stream)
    drawn = RichTable(
        title=Text(table.title, style="table.title"),
        title_justify="left",
        box=box.SIMPLE_HEAD,
        pad_edge=False,
        caption=Text(visible_line(table.note), style="table.caption") if table.note else None,
        caption_justify="left",
    )
    shown = fitting(table, width)
    for at in shown:
        is_number = at in table.right
        drawn.add_column(
            Text(table.columns[at]), justify="right" if is_number else "left", no_wrap=is_number, overflow="fold"
        )
    for row in table.rows:
        drawn.add_row(*(Text(row[at]) for at in shown))
    rich_console(stream, width=width).print(drawn)
