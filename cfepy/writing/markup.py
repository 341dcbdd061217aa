"""HTML as text: elements, and what a notebook shows: tables that are read on a light and on a dark ground.

All text that comes from a mission is escaped here. A notebook lends its colours to what stands in it, so that only
trouble has one of its own, which its theme tells.
"""

from __future__ import annotations

import html
import re
from collections.abc import Iterable, Sequence

_CONTROLS = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f\ud800-\udfff\ufffe\uffff]")
_TROUBLE = "color: var(--jp-error-color1, var(--vscode-errorForeground, #c62828)); white-space: pre-wrap"
_LINES = "max-height: 24em; overflow: auto; margin: 0; white-space: pre; font-family: monospace"
FEW = 12  # rows of a table that are seen at once
MOST = 100  # rows of a table that there are


def escaped(text: object) -> str:
    """Text for an element or an attribute; characters that no page may have are shown by their number."""
    return html.escape(printable(str(text)))


def printable(text: str) -> str:
    """A text in which characters that neither XML nor a page may have are shown by their number."""
    return _CONTROLS.sub(lambda match: f"\\x{ord(match[0]):02x}", text)


def element(name: str, inside: str = "", **attributes: object) -> str:
    """An element around HTML; `class_` is the attribute class, `data_path` is data-path, None leaves one out."""
    given = "".join(
        f' {key.rstrip("_").replace("_", "-")}="{escaped(value)}"'
        for key, value in attributes.items()
        if value is not None
    )
    return f"<{name}{given}>{inside}</{name}>"


def headline(title: str, about: str) -> str:
    """The first line of what a notebook shows."""
    return element("div", f"{element('b', escaped(title))}: {escaped(about)}")


def trouble(text: str) -> str:
    """A line about something that is wrong."""
    return element("div", escaped(text), style=_TROUBLE)


def code(text: str) -> str:
    """A command, or whatever else is to be copied."""
    return element("div", element("code", escaped(text)))


def folded(title: str, inside: str, is_open: bool = False) -> str:
    """Something below a title that can be opened and closed; nothing when there is nothing inside."""
    head = element("summary", escaped(title), style="cursor: pointer")
    return element("details", head + inside, open="" if is_open else None) if inside else ""


def lines_of(lines: Sequence[str]) -> str:
    """Lines of a console or of source code."""
    return element("pre", escaped("\n".join(lines)), style=_LINES) if lines else ""


def rows_of(titles: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """A table; numbers stand at the right. Of a long one the first rows are seen, the others are folded.

    Args:
        titles: of its columns.
        rows: what is in it, a value for each column.
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
