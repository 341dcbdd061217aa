"""Parts of the page: sections, numbers under their paths, tables that can be sorted."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from cfepy.writing.markup import element, escaped


def json_text(value: Any) -> str:
    """Return JSON for a script element, with all characters escaped that could end the element."""
    text = json.dumps(value, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


class PageSection(str):
    """HTML of a part of the page, which has a heading and an anchor to link to."""

    heading: str
    anchor: str

    def __new__(cls, heading: str, anchor: str, inside: str) -> PageSection:
        """Make a section from HTML."""
        part = super().__new__(cls, inside)
        part.heading, part.anchor = heading, anchor
        return part


def section(title: str, anchor: str, inside: str, about: str = "") -> PageSection:
    """Make a part of the page with a heading; `about` is HTML that explains its content."""
    lead = element("p", about, class_="about") if about else ""
    head = element("h2", escaped(title), id=f"{anchor}-title")
    return PageSection(
        title, anchor, element("section", head + lead + inside, id=anchor, aria_labelledby=f"{anchor}-title")
    )


class Numbers:
    """The numbers of a run; each number must appear on the page under its path, such as "topics.3.sent".

    Args:
        results: the results as `cfepy run --json` writes them.
    """

    def __init__(self, results: Mapping[str, Any]) -> None:
        self._left = dict(numbers_in(results))

    def show(self, path: str, text: str | None = None) -> str:
        """Return a number as a `data` element with its exact value.

        Args:
            path: its path in the results.
            text: the visible text; None shows the number itself.

        Returns:
            HTML.
        """
        value = self._left.pop(path, None)
        if value is None:
            return "" if text is None else escaped(text)
        shown = _plain(value) if text is None else text
        return element("data", escaped(shown), value=json.dumps(value), data_path=path)

    def rest(self) -> list[tuple[str, str]]:
        """Return path and element of all numbers that were not shown yet."""
        return [(path, self.show(path)) for path in list(self._left)]


def numbers_in(value: Any, path: str = "") -> Iterator[tuple[str, int | float]]:
    """Yield path and value of every number in nested data, without booleans."""
    if isinstance(value, Mapping):
        for key, item in value.items():
            yield from numbers_in(item, f"{path}.{key}" if path else str(key))
    elif isinstance(value, list | tuple):
        for index, item in enumerate(value):
            yield from numbers_in(item, f"{path}.{index}" if path else str(index))
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield path, value


def _plain(value: int | float) -> str:
    return f"{value:,}" if isinstance(value, int) else f"{value:,.6g}"


class TableCell(str):
    """HTML of a cell of a table; `order` is the sort key of the cell, None for its text."""

    order: int | float | None

    def __new__(cls, inside: str, order: int | float | None = None) -> TableCell:
        """Make a cell from HTML."""
        cell = super().__new__(cls, inside)
        cell.order = order
        return cell


def table(
    caption: str, heads: Sequence[str], rows: Iterable[Sequence[str]], numeric: Sequence[int] = (), **more: Any
) -> str:
    """Return a table that scrolls separately if it is too wide.

    Args:
        caption: text that describes it.
        heads: titles of its columns.
        rows: HTML of its cells; the first cell of each row is its name.
        numeric: columns whose cells are numbers.
        more: attributes of the table.
    """
    marks = ["number" if index in numeric else None for index in range(len(heads))]
    head = "".join(
        element("th", escaped(text), scope="col", class_=mark) for text, mark in zip(heads, marks, strict=True)
    )
    body = "".join(element("tr", "".join(_cells(row, marks))) for row in rows)
    parts = element("caption", escaped(caption)) + element("thead", element("tr", head)) + element("tbody", body)
    return element(
        "div", element("table", parts, **more), class_="scroll", tabindex="0", role="region", aria_label=caption
    )


def _cells(row: Sequence[str], marks: Sequence[str | None]) -> Iterator[str]:
    for index, (inside, mark) in enumerate(zip(row, marks, strict=True)):
        order = getattr(inside, "order", None)
        if index:
            yield element("td", inside, class_=mark, data_order=order)
        else:
            yield element("th", inside, scope="row", class_=mark, data_order=order)


def meter(share: float, text: str, is_lost: bool = True, has_limit: bool = True) -> str:
    """Return a bar from 0 to 1 with a text; more than 1 is shown as full.

    Args:
        share: the used share.
        text: HTML to the right of the bar.
        is_lost: True if a full bar is a problem.
        has_limit: False if the whole is no limit, so that a large share has no colour.
    """
    level = "high" if share >= 0.95 and is_lost else "raised" if share >= 0.75 else None
    level = level if has_limit else None
    width = f"--share:{min(max(share, 0.0), 1.0) * 100:.2f}%"
    return element("span", element("span", "", class_="bar", style=width), class_=f"meter {level or ''}".strip()) + text
