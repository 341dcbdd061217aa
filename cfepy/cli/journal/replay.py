"""`cfepy replay`: repeat the run of a journal, and report whether it was the same."""

from __future__ import annotations

import argparse
import contextlib
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from itertools import islice
from typing import TextIO

from cfepy.attachment import Attachment
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS, INTERRUPTED
from cfepy.cli.ros.node import NodeView
from cfepy.cli.ros.view import NodesView
from cfepy.cli.run.run import View, fly_again
from cfepy.cli.trace_text import TraceText
from cfepy.cli.user_notes import tell
from cfepy.journal import Journal, Replay, ReplayVerdict, read_journal, staged
from cfepy.mission import Mission
from cfepy.pilot import LAUNCH, NODE, STALLED, SUDDEN, RunPlan
from cfepy.plugins import Hook
from cfepy.rtos import GREENLET, THREAD, has_greenlets, task_kind
from cfepy.trace import TimedRecords
from cfepy.units import NS_PER_S

MOST_LINES = 12
FlyWithStops = Callable[[argparse.Namespace, Replay, View, Sequence[Attachment]], tuple[int, Replay]]
STOPPED_REPLAY: Hook[FlyWithStops] = Hook("replay_stops")
"""Flies a replay that stops for a debugger. Arguments: the command line, the replay, its view, and the attachments of
each flight. Returns the exit status, and the last of the replays.
"""
_FILES = ("json", "save_files", "bag", "trace")  # outputs of a replay


def show_info(journal: Journal, stream: TextIO) -> None:
    """Write a summary of the journal, a line for each property."""
    header, end = journal.header, journal.end
    carried = sum(each.packed is not None for each in journal.files.values())
    events = sum(len(pause.events) for pause in journal.pauses) + len(journal.answers)
    rows = {
        "command": journal.plan.command_line(),
        "mission": f"{header.mission}, from {header.startup}",
        "recorded with": ", ".join(f"{name} {version}" for name, version in header.versions.items()),
        "on": f"{header.host.get('system', '?')} {header.host.get('machine', '?')}, in {header.cwd}",
        "files": f"{len(journal.files)}, of which the journal carries {carried}; hash {journal.mission_hash}",
        "from outside": f"{events} events" + (f", paced {header.paced:g} times real time" if header.paced else ""),
        "schedule": f"{len(journal.decisions):,} of {journal.decided:,} decisions were not fifo's",
        "goes to": f"{max(0, journal.known_until_ns) / NS_PER_S:g} s of virtual time",
        "end": "none: its process came to a sudden end" if end is None else end.reason,
    }
    if end is not None:
        rows["records"] = f"{end.records:,}"
        rows["trace"] = end.trace
    for name, value in rows.items():
        print(f"{name + ':':<14} {value}", file=stream)


class RecordLines(Attachment):
    """Converts records to text, with the mission's names of objects."""

    def __init__(self) -> None:
        self._mission: Mission | None = None

    def begin(self, mission: Mission) -> None:
        self._mission = mission

    def describe(self, records: TimedRecords) -> list[str]:
        """Return the first lines of the records."""
        text = TraceText()
        text.task = "?"
        if self._mission is not None:
            text.watch(self._mission)
        return list(islice(text.lines(records), MOST_LINES))


def run(arguments: argparse.Namespace) -> int:
    """Replay the journal that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: it is not a journal, or its mission cannot run.
    """
    journal = read_journal(arguments.journal)
    if arguments.info:
        show_info(journal, sys.stdout)
        return ENDED_WELL
    if journal.end is None:
        known = (
            f"the journal has no end record, because the run was killed; it reaches {_seconds(journal.known_until_ns)}"
        )
        print(f"cfepy: {known}; continue with --until SECONDS", file=sys.stderr)
    elif journal.end.reason in SUDDEN:
        how = "a task did not give up the CPU" if journal.end.reason == STALLED else "Ctrl-C was pressed"
        text = f"{how}, and the run was interrupted in the middle of a task; its end is not compared"
        print(f"cfepy: {text}", file=sys.stderr)
    with replaying(arguments, journal) as replay:
        status, replay = _fly(arguments, replay)
        if journal.end is not None and replay.verdict.whole:
            tell(journal.end.beside)
        _tell(replay, sys.stderr)
    if status == INTERRUPTED:
        return INTERRUPTED
    return ENDED_WELL if replay.verdict.proven and not replay.problems else FOUND_PROBLEMS


@contextlib.contextmanager
def replaying(arguments: argparse.Namespace, journal: Journal) -> Iterator[Replay]:
    """Yield the replay of a journal, with its files in place."""
    lines = RecordLines()
    for name in _FILES:  # the working directory is about to change
        path = getattr(arguments, name)
        setattr(arguments, name, None if path is None else os.path.abspath(path))
    with staged(journal, arguments.from_disk) as stage:
        for note in () if arguments.quiet else stage.notes:
            print(f"cfepy: {note}", file=sys.stderr, flush=True)
        begins_there = (arguments.step or _looks_into(arguments)) and not arguments.stops
        until_ns = None if arguments.until is None or begins_there else round(arguments.until * NS_PER_S)
        tasks = _tasks(arguments, stage.plan)
        replay = Replay(journal, stage, tasks=tasks, until_ns=until_ns, describe=lines.describe)
        replay.attachments.append(lines)
        yield replay


def _fly(arguments: argparse.Namespace, replay: Replay) -> tuple[int, Replay]:
    """Fly the mission of a replay, and report as the recorded command does.

    Args:
        arguments: the command line of `cfepy replay`.
        replay: the replay.

    Returns:
        The exit status, and the replay that has the verdict. It is the given one, or the last of those that were flown
        to go back in time.
    """
    view = _view(replay.plan.command, arguments)
    if not (arguments.stops or arguments.step or _looks_into(arguments) or _goes_back(arguments)):
        return fly_again(arguments, replay, view), replay
    looking_on = [each for each in replay.attachments if isinstance(each, RecordLines)]
    return STOPPED_REPLAY.need("a replay that stops")(arguments, replay, view, looking_on)


def _tasks(arguments: argparse.Namespace, plan: RunPlan) -> str | None:
    """Return the task kind for the replay, or None for the recorded one. The run is the same with either."""
    asked: str | None = arguments.tasks
    if arguments.pdb is not None:
        if task_kind(asked or plan.tasks).name != THREAD:
            text = "tasks run on threads, because Python's debugger requires a thread of its own"
            print(f"cfepy: {text}", file=sys.stderr, flush=True)
        return THREAD
    if asked is None and _goes_back(arguments) and arguments.gdb is None and has_greenlets():
        return GREENLET  # going back is faster with greenlets
    return asked


def _goes_back(arguments: argparse.Namespace) -> bool:
    """Return True if the replay stops at its end, to go back from there."""
    return bool(arguments.back) or arguments.back_to is not None


def _looks_into(arguments: argparse.Namespace) -> bool:
    """Return True if a debugger is opened in an application."""
    return arguments.pdb is not None or arguments.gdb is not None


def _view(command: str, arguments: argparse.Namespace) -> View:
    """Return the view of the run, as the recorded command shows it."""
    if command == NODE:
        return NodeView(arguments)
    return NodesView(arguments) if command == LAUNCH and not arguments.console else View(arguments)


def _tell(replay: Replay, stream: TextIO) -> None:
    """Report whether it was the same run."""
    sys.stdout.flush()
    journal, verdict = replay.journal, replay.verdict
    agreed = verdict.agreed
    if verdict.difference is None:
        print(f"cfepy: {_same(journal, verdict)}", file=stream)
        if verdict.other_results:
            print("cfepy: but the numbers of the report differ; compare them with --json", file=stream)
        return
    recorded = verdict.difference.before
    text = f"not the run of {journal.path}: the same up to record {agreed.records:,} at {_seconds(agreed.now_ns)}"
    print(f"cfepy: {text}, not up to record {recorded.records:,} at {_seconds(recorded.now_ns)}", file=stream)
    print("cfepy: the replay continued with:", file=stream)
    for line in verdict.difference.lines or ("nothing more",):
        print(f"  {line}", file=stream)
    for reason in replay.stage.reasons:
        print(f"cfepy: {reason}", file=stream)


def _same(journal: Journal, verdict: ReplayVerdict) -> str:
    if not verdict.compared:
        why = "it is truncated before its first checkpoint" if verdict.cut_off else "its first checkpoint comes later"
        return f"nothing was compared with {journal.path}: {why}"
    if verdict.whole and not verdict.other_results:
        return f"the same run as {journal.path}"
    if verdict.whole:
        return f"the same trace as {journal.path}"
    where = f"record {verdict.agreed.records:,} at {_seconds(verdict.agreed.now_ns)}"
    rest = "; the journal is truncated, and the rest of the run is not known" if verdict.cut_off else ""
    return f"the same run as {journal.path} up to {where}, where it was compared for the last time{rest}"


def _seconds(time_ns: int) -> str:
    return f"{time_ns / NS_PER_S:.6f} s"
