"""The part of a run's page that presents a failure as a story: its cause, and the actions of each task before it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from cfepy.extra.reports.html_text import TableCell, section, table
from cfepy.units import NS_PER_S
from cfepy.writing.markup import element, escaped

STORY = "story"
"""The anchor of the part."""


class StoryRow(NamedTuple):
    """A row of the story.

    Attributes:
        at_ns: virtual time; None for a row that stands for others.
        column: column of the acting task; None for a row that stands for others.
        text: the action, or the number of repetitions of the rows above.
        is_switch: True for an action of the schedule.
    """

    at_ns: int | None
    column: int | None
    text: str
    is_switch: bool = False


@dataclass(frozen=True, slots=True)
class PageStory:
    """A failure as a story.

    Attributes:
        cause: a sentence; empty if it is not known.
        tasks: titles of the columns.
        rows: rows in the order of time.
        end: the failure, one line.
    """

    cause: str
    tasks: Sequence[str]
    rows: Sequence[StoryRow]
    end: str


def story_section(story: PageStory) -> str:
    """Return the part itself."""
    cause = element("p", f"Cause: {escaped(story.cause)}", class_="banner bad") if story.cause else ""
    heads = ("At, s", *story.tasks)
    rows = [_cells(number, row, len(story.tasks)) for number, row in enumerate(story.rows)]
    about = "The operations of the tasks involved in the failure. Each time links to the timeline."
    end = element("p", escaped(story.end))
    return section(
        "What happened", STORY, cause + table("Operations of each task", heads, rows, class_="story") + end, about
    )


def _cells(number: int, row: StoryRow, columns: int) -> list[str]:
    """Return HTML of a row. Many rows have the same time, so they are sorted by their number."""
    text = escaped(row.text)
    cells = [""] * columns
    cells[row.column or 0] = element("strong", text, class_="switch") if row.is_switch else text
    when = "" if row.at_ns is None else instant(row.at_ns, f"{row.at_ns / NS_PER_S:.6f}")
    return [TableCell(when, number), *cells]


def instant(at_ns: int, text: str) -> str:
    """Return a link to an instant in the timeline of the page."""
    return element("a", text, href="#timeline", data_at=at_ns, title="Show this instant in the timeline")
