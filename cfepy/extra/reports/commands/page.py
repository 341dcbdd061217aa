"""`cfepy report`: a run as an HTML page. The report that a run prints is in `cfepy.cli.run.report`."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path
from typing import Any

from cfepy.cli.user_notes import check_writable, writing
from cfepy.cli.viewed_runs import look_at
from cfepy.extra.reports import About, Collector, PageStory, StoryRow, page_of
from cfepy.ground import SeriesRecorder
from cfepy.pilot import RunPlan
from cfepy.plugins import Hook

STORY_OF_RUN: Hook[Callable[[RunPlan, str], Any]] = Hook("story_of_run")
"""Returns the story of a failed run: a table of tasks and rows, the cause, and the end; None if it did not fail.

Its arguments are the plan, and the folder of the plan's files, which is empty if they have their own paths.
"""
MOST_KEPT = 10_000  # messages of each topic and packet whose values are drawn


def run(arguments: argparse.Namespace) -> int:
    """Write the page of the run that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: there is no such run, or the page cannot be written.
    """
    path = Path(arguments.output)
    check_writable(path, "--output")
    collector, recorder = Collector(), SeriesRecorder(most=MOST_KEPT)
    looked_at = look_at(arguments, [collector, recorder], collector.policy, story_of=_story)
    warnings, story = looked_at.warnings, looked_at.story
    about = About(looked_at.command, looked_at.schedule, arguments.source, warnings, story, looked_at.journal)
    with writing(path, "--output"):
        path.write_text(page_of(looked_at.flown, collector, about, recorder), encoding="utf-8")
    print(f"{path}: {path.stat().st_size:,} bytes; open it in a browser")
    return looked_at.status()


def _story(plan: RunPlan, root: str) -> PageStory | None:
    """Return the story of a run with deviations, as `cfepy explore` finds them; None without a failure."""
    find_story = STORY_OF_RUN.first()
    story = None if find_story is None else find_story(plan, root)
    if story is None:
        return None
    tasks, rows = story.table()
    shown = [StoryRow(at_ns, tasks.index(task) if task else None, text, moves) for at_ns, task, text, moves in rows]
    return PageStory(story.cause, tasks, shown, story.end)
