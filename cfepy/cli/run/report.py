"""The report at the end of a run: the numbers of `cfepy.pilot.results` as text for a person, and the verdict in one
line for programs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, TextIO

from cfepy.cli.text_table import Table, show_paragraph, show_tables
from cfepy.cli.user_notes import left_out_nodes
from cfepy.pilot import FailureKind, Flown, Results, RunProblem
from cfepy.plugins import Hook
from cfepy.units import NS_PER_S, time_text

PASSED, FAILED, INCONCLUSIVE, INTERRUPTED = "passed", "failed", "inconclusive", "interrupted"
_COUNTED = {
    "steps": (FailureKind.EXPECTATION,),
    "invariants": (FailureKind.INVARIANT,),
    "deadlines": (FailureKind.DEADLINE,),
    "crashes": (FailureKind.DIED, FailureKind.RAISED, FailureKind.ENDED, FailureKind.RESET, FailureKind.OVERWRITE),
    "hangs": (FailureKind.DEADLOCK, FailureKind.STUCK, FailureKind.STALLED),
    "races": (FailureKind.RACE,),
    "events": (FailureKind.EVENT,),
}
_OTHERS = "others"

REPORT_TABLES: Hook[Callable[[Results], Iterable[Table]]] = Hook("report_tables")
"""Functions that make more tables for the end of a report."""


def load_add_ons() -> None:
    """Import the add-ons that make tables before a run; an error after the run would cost its report.

    Raises:
        UsageError: an add-on of another package cannot be imported.
    """
    list(REPORT_TABLES.all())


def outcome_of(flown: Flown) -> str:
    """Return the outcome of a run: PASSED, FAILED, INCONCLUSIVE or INTERRUPTED. Problems decide it, if any."""
    if flown.interrupted:
        return INTERRUPTED
    if flown.results.problems:
        return FAILED
    is_flown = flown.results.booted_s is not None or flown.mission.over or flown.outcome is not None
    return PASSED if is_flown else INCONCLUSIVE


def verdict_of(flown: Flown) -> dict[str, Any]:
    """Return the outcome of a run, the numbers of its problems by kind, and the nodes that are left out."""
    counts = dict.fromkeys((*_COUNTED, _OTHERS), 0)
    for problem in flown.problems:
        counts[_kind_of(problem)] += 1
    return {"outcome": outcome_of(flown), **counts, "left_out": left_out_nodes(flown.known)}


def _kind_of(problem: RunProblem) -> str:
    if problem.is_step:
        return "steps"
    kinds = {each.kind for each in problem.failures}
    return next((name for name, counted in _COUNTED.items() if kinds.intersection(counted)), _OTHERS)


def verdict_line(flown: Flown) -> str:
    """Return the verdict in one line, always of the same form; nodes that are left out are named at its end."""
    verdict = verdict_of(flown)
    outcome, left_out = verdict.pop("outcome"), verdict.pop("left_out")
    counts = ", ".join(f"{name} {count}" for name, count in verdict.items())
    missing = f"; left out: {', '.join(left_out)}" if left_out else ""
    return f"verdict: {outcome}; {counts}{missing}"


def failed_steps(flown: Flown) -> list[str]:
    """Return the lines of the script's failed steps."""
    return [] if flown.outcome is None else [*flown.outcome.failed_lines()]


def show(results: Results, stream: TextIO) -> None:
    """Print all tables and the line about speed."""
    tables = [_topics(results), _apps(results), _events(results)]
    more = [
        *_resets(results),
        *faults(results),
        *_peers("ROS outside", results.ros_peers),
        *_peers("Viewers", results.viewer_peers),
        *_beside(results),
        *_pipes(results),
        *_deadlines(results),
        *_inversions(results),
        *_invariants(results),
        *_memory(results),
        *_held(results),
        *(table for make in REPORT_TABLES.all() for table in make(results)),
    ]
    show_tables([*tables, *more], stream)
    show_speed(results, stream)


def show_speed(results: Results, stream: TextIO) -> None:
    """Print the length of the run, the board, the kind of tasks and the seed."""
    line = f"{results.virtual_s:.3f} virtual s in {results.wall_s:.3f} s: {results.speed:.1f} x real time"
    stream.write("\n")
    show_paragraph(f"{line}, board {results.board}, {results.task_kind}, seed {results.seed}", stream)


def _topics(results: Results) -> Table:
    table = Table(
        "Messages", ("MsgId", "name", "sent", "delivered", "dropped", "why", "Hz"), right=(2, 3, 4, 6), least=(0, 3)
    )
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
            topic.why,
            f"{topic.rate_hz:.1f}{mark}",
        )
    if any(topic.too_fast for topic in results.topics):
        table.note = f"! more than the {results.max_publish_hz} Hz that {results.board} is made for"
    return table


def _apps(results: Results) -> Table:
    table = Table("Applications", ("name", "state", "CPU", "restarts", "died of"), right=(2, 3))
    for app in results.apps:
        table.add(app.name, app.state, app.cpu_text, app.restarts, app.error or "")
    return table


def _events(results: Results) -> Table:
    table = Table("Events", ("type", "number"), right=(1,))
    for name, count in results.events.items():
        table.add(name, count)
    return table


def _resets(results: Results) -> list[Table]:
    table = Table("Resets", ("at, s", "type", "why"), right=(0,))
    for reset in results.resets:
        table.add(f"{reset.at_s:.6f}", reset.type, reset.reason)
    return [table] if table.rows else []


def faults(results: Results) -> list[Table]:
    """Return a table with the faults of the plan and how often each happened, or no table without faults."""
    table = Table(
        "Faults", ("name", "what", "times", "first at, s", "last at, s", "what happened"), right=(2, 3, 4), least=(4, 3)
    )
    for row in results.faults:
        times = [f"{row[key]:.3f}" for key in ("first_at_s", "last_at_s")] if row["times"] else ["", ""]
        said = row["details"][0] if row["times"] else f"never happened: {row['never']}"
        table.add(row["name"], row["what"], row["times"], *times, said)
    return [table] if table.rows else []


def _peers(title: str, rows: list[dict[str, Any]]) -> list[Table]:
    """Return a table with the external peers by topic, and the messages lost on the way."""
    table = Table(
        title,
        ("name", "peer", "way", "messages", "dropped", "connected", "ended", "refused", "why"),
        right=(3, 4, 5, 6, 7),
        least=(8, 1),
    )
    for row in rows:
        counts = [row[key] for key in ("messages", "dropped", "connections", "ended", "refused")]
        table.add(row["name"], row["peer"], row["direction"], *counts, row["why"])
    return [table] if table.rows else []


def _beside(results: Results) -> list[Table]:
    """Return a table with the missions that flew beside this one, and their datagrams."""
    table = Table(
        "Beside it",
        ("mission", "booted, s", "sent", "taken", "lost", "resets", "died of", "trace"),
        right=(1, 2, 3, 4, 5),
    )
    for row in results.beside:
        booted = "" if row["booted_s"] is None else f"{row['booted_s']:.3f}"
        counts = [row[key] for key in ("sent", "taken", "lost", "resets")]
        table.add(row["mission"], booted, *counts, row["died"], row["trace"])
    return [table] if table.rows else []


def _pipes(results: Results) -> list[Table]:
    """Return a table with the pipes that were ever full, or dropped messages."""
    table = Table("Pipes that were full", ("name", "application", "depth", "peak", "dropped"), right=(2, 3, 4))
    for pipe in results.pipes:
        if pipe.dropped or pipe.peak >= pipe.depth:
            table.add(pipe.name, pipe.app, pipe.depth, pipe.peak, pipe.dropped)
    return [table] if table.rows else []


def _deadlines(results: Results) -> list[Table]:
    """Return a table with the mission's deadlines, each with its worst case."""
    table = Table(
        "Deadlines",
        ("of", "what", "limit", "measured", "missed", "worst", "first at, s"),
        right=(3, 4, 5, 6),
        least=(3, 6),
    )
    for each in results.deadlines:
        table.add(
            each.owner,
            each.kind,
            each.limit_text,
            each.checked,
            each.overruns,
            "" if each.worst_s is None else time_text(round(each.worst_s * NS_PER_S)),
            "" if each.first_at_s is None else f"{each.first_at_s:.6f}",
        )
    return [table] if table.rows else []


def _inversions(results: Results) -> list[Table]:
    """Return a table of priority inversions: for each delayed task, the longest delay by a lower-priority task that did
    not hold the resource.
    """
    table = Table(
        "Priority inversions", ("of", "times", "longest", "at, s", "what happened"), right=(1, 2, 3), least=(4,)
    )
    for each in results.inversions:
        longest = time_text(round(each.worst_s * NS_PER_S))
        table.add(each.victim, each.times, longest, f"{each.at_s:.6f}", each.text)
    return [table] if table.rows else []


def _invariants(results: Results) -> list[Table]:
    """Return a table with the invariants of messages; it marks those that were never judged."""
    table = Table(
        "Invariants", ("name", "judged", "violated", "first at, s", "what was wrong"), right=(1, 2, 3), least=(3, 1)
    )
    for each in results.invariants:
        at = "" if each.first_at_s is None else f"{each.first_at_s:.6f}"
        table.add(each.name, each.judged, each.violated, at, each.first or ("" if each.judged else "never judged"))
    return [table] if table.rows else []


def _held(results: Results) -> list[Table]:
    """Return a table of the resources that applications held at the end of a run with the guard."""
    table = Table("Held at the end", ("application", "what", "number", "since, s"), right=(2, 3), least=(1,))
    for each in results.held:
        table.add(each.app, each.what, each.number, f"{each.since_s:.6f}")
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
