"""The part of a run's page that presents a failure as a story: its cause, and the actions of each task before it.

The time range of the failure, on which the timeline opens, is here too.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from cfepy.extra.reports.collector import SWITCH, Collector
from cfepy.extra.reports.html_text import TableCell, section, table
from cfepy.pilot import FailureKind, Flown, RunProblem
from cfepy.units import NS_PER_S
from cfepy.writing.markup import element, escaped

STORY = "story"
"""The anchor of the part."""
STORY_SPAN_NS = 40_000
"""Time range of the timeline around an operation: races are some microseconds wide."""
MOST_SWITCHES = 20
"""Switches of the schedule that the page shows among the problems."""
OPENED_SHARE = 50  # of the run, around a failure without a switch


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
    rows = [_cells(number, row, story.tasks) for number, row in enumerate(story.rows)]
    about = "The operations of the tasks involved in the failure. Each time links to the timeline."
    end = element("p", escaped(story.end))
    return section(
        "What happened", STORY, cause + table("Operations of each task", heads, rows, class_="story") + end, about
    )


def _cells(number: int, row: StoryRow, tasks: Sequence[str]) -> list[str]:
    """Return HTML of a row. Many rows have the same time, so they are sorted by their number.

    On a narrow screen, which has no room for columns, the name of the task stands before the text.
    """
    text = element("strong", escaped(row.text), class_="switch") if row.is_switch else escaped(row.text)
    cells = [""] * len(tasks)
    name = None if row.column is None else tasks[row.column]
    cells[row.column or 0] = text if name is None else element("span", text, class_="act", data_task=name)
    when = "" if row.at_ns is None else instant(row.at_ns, f"{row.at_ns / NS_PER_S:.6f}", STORY_SPAN_NS)
    return [TableCell(when, number), *cells]


def instant(at_ns: int, text: str, span_ns: int | None = None) -> str:
    """Return a link to an instant in the timeline of the page.

    Args:
        at_ns: virtual time.
        text: text of the link.
        span_ns: time range to show; None for a share of the run.
    """
    title = "Show this instant in the timeline"
    return element("a", text, href="#timeline", data_at=at_ns, data_span=span_ns, title=title)


def opened_range(flown: Flown, collector: Collector) -> list[int] | None:
    """Return the range in ns that the timeline shows first, and the instant that it marks; None for the whole run.

    These are the switches of the schedule in a failed run, and otherwise the first problem that has a time.
    """
    problems = [each.at_ns for each in problems_of_page(flown, collector) if each.at_ns is not None]
    if not problems:
        return None
    switches = [mark.at_ns for mark in collector.marks if mark.kind == SWITCH][:MOST_SWITCHES]
    first, last = (switches[0], switches[-1]) if switches else (problems[0], problems[0])
    rim = max(STORY_SPAN_NS, last - first) // 2 if switches else collector.end_ns // (2 * OPENED_SHARE)
    return [max(0, first - rim), last + rim, first]


def problems_of_page(flown: Flown, collector: Collector) -> Iterator[RunProblem]:
    """Yield all problems of a run. A deadlock lasts until its end, so it gets the time of the end."""
    for problem in flown.problems:
        is_at_end = any(failure.kind in (FailureKind.DEADLOCK, FailureKind.STUCK) for failure in problem.failures)
        yield problem._replace(at_ns=collector.end_ns) if problem.at_ns is None and is_at_end else problem
