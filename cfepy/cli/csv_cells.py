"""CSV rows that a spreadsheet may open: `--quote-formulas` keeps it from evaluating texts as formulas."""

from __future__ import annotations

import argparse
import csv
from collections.abc import Iterable
from typing import Any, TextIO

_BEGINS_FORMULA = ("=", "+", "-", "@", "\t", "\r")


def add_quote_formulas(parser: argparse.ArgumentParser) -> None:
    """Add the option `--quote-formulas`."""
    parser.add_argument(
        "--quote-formulas",
        action="store_true",
        help="put ' before a text that a spreadsheet takes for a formula: one that begins with =, +, - or @",
    )


def write_rows(stream: TextIO, rows: Iterable[Iterable[Any]], quotes: bool) -> None:
    """Write rows as comma-separated values.

    Args:
        stream: the output.
        rows: rows of cells; the first row has the names of the columns.
        quotes: put a ' in front of texts that a spreadsheet would take for formulas.
    """
    written = (map(_quoted, row) for row in rows) if quotes else rows
    csv.writer(stream, lineterminator="\n").writerows(written)


def _quoted(cell: Any) -> Any:
    if not isinstance(cell, str) or not cell.startswith(_BEGINS_FORMULA):
        return cell
    try:
        float(cell)
    except ValueError:
        return f"'{cell}"
    return cell
