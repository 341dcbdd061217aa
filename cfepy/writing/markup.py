"""HTML as text: elements, and tables for notebooks with a light or a dark theme.

All text from a mission is escaped here. The output takes its colours from the notebook. Only error lines have a colour
of their own, which the notebook's theme sets.
"""

from __future__ import annotations

import html
import re
from collections.abc import Iterable, Sequence

_CONTROLS = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f\ud800-\udfff\ufffe\uffff]")
_TROUBLE = "color: var(--jp-error-color1, var(--vscode-errorForeground, #c62828)); white-space: pre-wrap"
_LINES = "max-height: 24em; overflow: auto; margin: 0; white-space: pre; font-family: monospace"
FEW = 12  # rows of a table that are visible at once
MOST = 100  # maximum number of rows of a table


def escaped(text: object) -> str:
    """Return text for an element or an attribute, with characters that a page cannot have replaced by their number."""
    return html.escape(printable(str(text)))


def printable(text: str) -> str:
    """Return a text with characters that neither XML nor a page can have replaced by their number."""
    return _CONTROLS.sub(lambda match: f"\\x{ord(match[0]):02x}", text)


def element(name: str, inside: str = "", **attributes: object) -> str:
    """Return an element around HTML.

    Args:
        name: name of the element.
        inside: the HTML inside it.
        attributes: `class_` is the attribute class and `data_path` is data-path; None omits an attribute.
    """
    given = "".join(
        f' {key.rstrip("_").replace("_", "-")}="{escaped(value)}"'
        for key, value in attributes.items()
        if value is not None
    )
    return f"<{name}{given}>{inside}</{name}>"


def headline(title: str, about: str) -> str:
    """Return the first line of a notebook's output."""
    return element("div", f"{element('b', escaped(title))}: {escaped(about)}")


def trouble(text: str) -> str:
    """Return a line that reports an error."""
    return element("div", escaped(text), style=_TROUBLE)


def code(text: str) -> str:
    """Return a command or other text to copy."""
    return element("div", element("code", escaped(text)))


def folded(title: str, inside: str, is_open: bool = False) -> str:
    """Return a title with a part that the reader can open and close; an empty text if `inside` is empty."""
    head = element("summary", escaped(title), style="cursor: pointer")
    return element("details", head + inside, open="" if is_open else None) if inside else ""


def lines_of(lines: Sequence[str]) -> str:
    """Return lines of a console or of source code."""
    return element("pre", escaped("\n".join(lines)), style=_LINES) if lines else ""


def rows_of(titles: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """Return a table with numbers aligned right. Of a long table the first rows are visible and the others are folded.

    Args:
        titles: titles of its columns.
        rows: its rows, each with a value for every column.
    """
    if not rows:
        return ""
    more = rows[FEW:MOST]
    left_out = f", {len(rows) - MOST} left out" if len(rows) > MOST else ""
    return _table(titles, rows[:FEW]) + folded(f"{len(more)} more{left_out}", _table(titles, more) if more else "")


def _table(titles: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    sides = ["right" if isinstance(value, int | float) else "left" for value in rows[0]]
    head = _row("th", titles, sides)
    body = "".join(_row("td", map(_shown, row), sides) for row in rows)
    return element("table", element("thead", head) + element("tbody", body))


def _row(kind: str, values: Iterable[str], sides: Sequence[str]) -> str:
    cells = zip(values, sides, strict=True)
    return element("tr", "".join(element(kind, escaped(value), style=f"text-align: {side}") for value, side in cells))


def _shown(value: object) -> str:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return str(value)
    return f"{value:,}" if isinstance(value, int) else f"{value:,.6g}"
