"""The report at the end of a run: what the numbers of `cfepy.mission.results` look like to a person."""

from __future__ import annotations

from typing import TextIO

from cfepy.cli.table import Table, show_tables
from cfepy.mission.results import Results, TopicResult


def show(results: Results, stream: TextIO) -> None:
    """Print all tables and the line about speed."""
    tables = [_topics(results), _apps(results), _events(results)]
    show_tables([*tables, *_resets(results), *_pipes(results), *_memory(results)], stream)
    show_speed(results, stream)


def show_speed(results: Results, stream: TextIO) -> None:
    """Print how long the run was, and what it was on."""
    line = f"{results.virtual_s:.3f} virtual s in {results.wall_s:.3f} s: {results.speed:.1f} x real time"
    print(f"\n{line}, board {results.board}, {results.tasks} tasks, seed {results.seed}", file=stream)


def _topics(results: Results) -> Table:
    table = Table("Messages", ("MsgId", "name", "sent", "delivered", "dropped", "why", "Hz"), right=(2, 3, 4, 6))
    for topic in results.topics:
        if not topic.sent:
            continue
        mark = " !" if topic.too_fast else ""
        table.add(
            f"0x{topic.msg_id:04X}",
            topic.name,
            topic.sent,
            topic.delivered,
            topic.dropped,
            why(topic),
            f"{topic.rate_hz:.1f}{mark}",
        )
    if any(topic.too_fast for topic in results.topics):
        table.note = f"! more than the {results.max_publish_hz} Hz that {results.board} is made for"
    return table


def why(topic: TopicResult) -> str:
    """Why messages were not delivered, or not when their publisher wanted."""
    reasons = (
        ("message limit", topic.dropped_limit),
        ("pipe full", topic.dropped_pipe_full),
        ("segment lost", topic.dropped_segment),
        ("not taken yet", topic.waiting),
        ("held back", topic.held_back),
    )
    said = [f"{count:,} {reason}" for reason, count in reasons if count]
    if topic.no_subscriber:
        said.append("no subscriber")
    return ", ".join(said)


def _apps(results: Results) -> Table:
    table = Table("Applications", ("name", "state", "CPU", "restarts", "died of"), right=(2, 3))
    for app in results.apps:
        table.add(app.name, app.state, f"{app.cpu_share:.2%}", app.restarts, app.error or "")
    return table


def _events(results: Results) -> Table:
    table = Table("Events", ("type", "number"), right=(1,))
    for name, count in results.events.items():
        table.add(name, count)
    return table


def _resets(results: Results) -> list[Table]:
    table = Table("Resets", ("at, s", "type", "why"), right=(0,))
    for reset in results.resets:
        table.add(f"{reset.at_s:.3f}", reset.type, reset.reason)
    return [table] if table.rows else []


def _pipes(results: Results) -> list[Table]:
    """Only pipes that were ever full, or lost something."""
    table = Table("Pipes that were full", ("name", "application", "depth", "peak", "dropped"), right=(2, 3, 4))
    for pipe in results.pipes:
        if pipe.dropped or pipe.peak >= pipe.depth:
            table.add(pipe.name, pipe.app, pipe.depth, pipe.peak, pipe.dropped)
    return [table] if table.rows else []


def _memory(results: Results) -> list[Table]:
    memory = results.memory
    if memory.limit is None:
        return []
    table = Table("Memory, bytes", ("owner", "used"), right=(1,))
    for owner, size in memory.by_owner.items():
        table.add(owner, f"{size:,}")
    table.note = f"peak {memory.peak:,} of {memory.limit:,} ({memory.peak / memory.limit:.1%})"
    return [table]
