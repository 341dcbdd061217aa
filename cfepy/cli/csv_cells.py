"""Rows of CSV that a spreadsheet may open: `--quote-formulas` keeps texts in them from being taken for formulas."""

from __future__ import annotations

import argparse
import csv
from collections.abc import Iterable
from typing import Any, TextIO

_BEGINS_FORMULA = ("=", "+", "-", "@", "\t", "\r")


def add_quote_formulas(parser: argparse.ArgumentParser) -> None:
    """The option."""
    parser.add_argument(
        "--quote-formulas",
        action="store_true",
        help="put ' before a text that a spreadsheet takes for a formula: one that begins with =, +, - or @",
    )


def write_rows(stream: TextIO, rows: Iterable[Iterable[Any]], quotes: bool) -> None:
    """Write rows as comma-separated values.

    Args:
        stream: where to.
        rows: cells, the names of the columns first.
        quotes: texts that a spreadsheet takes for formulas get a ' in front.
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
