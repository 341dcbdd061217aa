"""The notebook view of a run: problems first, then tables, and pictures of values over time."""

from __future__ import annotations

import io
import os
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cfepy.ground import DecodedEvent, SeriesSet
from cfepy.plugins import Hook
from cfepy.status import UsageError
from cfepy.units import NS_PER_S
from cfepy.writing.markup import code, folded, headline, lines_of, rows_of, trouble

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from cfepy.pilot import Results

PICTURE: Hook[Callable[[SeriesSet, Sequence[str], str, Path | None], Any]] = Hook("picture")
"""Draws the named values into a matplotlib figure: the values, the names, the title, the file to write or None."""
LAST_LINES = 30  # of the console; all lines are in `Run.console`
SERIOUS = ("ERROR", "CRITICAL")


class Picture:
    """A picture that a notebook displays.

    Attributes:
        figure: the matplotlib figure, to change or save.
    """

    def __init__(self, figure: Figure) -> None:
        self.figure = figure

    def __repr__(self) -> str:
        return f"<Picture of {len(self.figure.axes)} axes>"

    def _repr_png_(self) -> bytes:
        """Return the PNG for a notebook."""
        stream = io.BytesIO()
        self.figure.savefig(stream, format="png")
        return stream.getvalue()


def picture(series: SeriesSet, words: Sequence[str], title: str, file: str | os.PathLike[str] | None) -> Picture:
    """Return a picture of named values, as `cfepy plot` draws it; see `Run.plot`."""
    draw = PICTURE.need("a picture of a run")
    try:
        return Picture(draw(series, words, title, None if file is None else Path(file)))
    except (OSError, ValueError) as error:
        if file is None:
            raise
        raise UsageError(f"cannot be written: {error}", file=os.fspath(file)) from None


def page_of_run(
    results: Results,
    problems: Sequence[str],
    notes: Sequence[str],
    events: Sequence[DecodedEvent],
    console: Sequence[str],
) -> str:
    """Return a run as HTML.

    Args:
        results: its numbers; without a trace while it flies.
        problems: its problems.
        notes: notes for the user.
        events: all events.
        console: all lines.
    """
    about = f"{results.virtual_s:.3f} virtual s, seed {results.seed}, board {results.board}, {results.task_kind}"
    about += f", {results.speed:.1f} x real time" if results.trace else ", flies"
    parts = [headline(results.mission, about), *map(trouble, problems)]
    parts += [headline("note", note) for note in notes]
    parts.append(code(f"trace {results.trace}") if results.trace else "")
    parts += [_topics(results), _apps(results), _events(events, results), _console(console, bool(problems))]
    return f"<div>{''.join(parts)}</div>"


def _topics(results: Results) -> str:
    """Return the table of topics, those with the most messages first."""
    topics = sorted((row for row in results.topics if row.sent), key=lambda row: (-row.sent, row.msg_id))
    rows = [
        (
            f"0x{row.msg_id:04X}",
            row.name,
            row.type,
            row.sent,
            row.delivered,
            row.dropped,
            row.why,
            f"{row.rate_hz:,.1f}",
        )
        for row in topics
    ]
    sent, dropped = sum(row.sent for row in topics), sum(row.dropped for row in topics)
    table = rows_of(("MsgId", "name", "type", "sent", "delivered", "dropped", "why", "Hz"), rows)
    return folded(f"Messages: {len(rows)} topics and packets, {sent:,} sent, {dropped:,} dropped", table, is_open=True)


def _apps(results: Results) -> str:
    """Return the table of the mission's own applications, those that are not RUNNING first."""
    apps = sorted((row for row in results.apps if not row.core), key=lambda row: row.state == "RUNNING")
    rows = [(row.name, row.state, row.cpu_text, row.restarts, row.error or "") for row in apps]
    states = ", ".join(f"{count} {state}" for state, count in Counter(row.state for row in apps).items())
    return folded(f"Applications: {states}", rows_of(("name", "state", "CPU", "restarts", "died of"), rows))


def _events(events: Sequence[DecodedEvent], results: Results) -> str:
    """Return the table of events, the serious ones first."""
    serious = sorted(events, key=lambda event: event.type_name not in SERIOUS)
    rows = [(f"{each.at_ns / NS_PER_S:.3f}", each.app, each.event_id, each.type_name, each.text) for each in serious]
    counts = ", ".join(f"{count} {kind}" for kind, count in results.events.items() if count)
    return folded(f"Events: {counts}", rows_of(("at, s", "of", "id", "type", "text"), rows))


def _console(lines: Sequence[str], is_open: bool) -> str:
    count = f"the last {LAST_LINES} of {len(lines):,}" if len(lines) > LAST_LINES else f"{len(lines)}"
    return folded(f"Console: {count} lines", lines_of(lines[-LAST_LINES:]), is_open)
