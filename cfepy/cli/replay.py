"""`cfepy replay`: do the run of a journal again, and say whether it was the same."""

from __future__ import annotations

import argparse
import contextlib
import os
import sys
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, TextIO

from cfepy.attachment import Attachment
from cfepy.cli.journal_info import show_info
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS, INTERRUPTED
from cfepy.cli.node import run_node
from cfepy.cli.recording import arguments_of
from cfepy.cli.ros_view import RosView
from cfepy.cli.run import View, run_spec
from cfepy.cli.trace_text import TraceText
from cfepy.journal.journal import Journal, read_journal
from cfepy.journal.replay import Replay, Verdict
from cfepy.journal.stage import staged
from cfepy.mission import Mission
from cfepy.mission.course import BROKEN_OFF
from cfepy.mission.run_plan import LAUNCH, NODE
from cfepy.rtos.units import NS_PER_S

if TYPE_CHECKING:
    from cfepy.debugger.debugger import Debugger

MOST_LINES = 12
_FILES = ("json", "save_files", "bag", "trace")  # what a replay leaves behind
_OPTIONS = ("bag_topics", "quiet")


class RecordLines(Attachment):
    """Makes text of records, with the names that the mission has for things."""

    def __init__(self) -> None:
        self._mission: Mission | None = None

    def begin(self, mission: Mission) -> None:
        """See `Attachment.begin`."""
        self._mission = mission

    def describe(self, records: Sequence[bytes], now_ns: int) -> list[str]:
        """The first lines of them."""
        text = TraceText()
        text.now_ns, text.task = now_ns, "?"
        if self._mission is not None:
            text.watch(self._mission)
        return list(text.lines(records[: 3 * MOST_LINES]))[:MOST_LINES]


def run(arguments: argparse.Namespace) -> int:
    """Replay the journal that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: it is no journal, or its mission cannot run.
    """
    journal = read_journal(arguments.journal)
    if arguments.info:
        show_info(journal, sys.stdout)
        return ENDED_WELL
    if journal.end is None:
        known = f"the journal has no end, which was sudden; it goes to {_seconds(journal.known_until_ns)}"
        print(f"cfepy: {known}: --until SECONDS goes on", file=sys.stderr)
    elif journal.end.reason == BROKEN_OFF:
        text = "a second Ctrl-C broke the run off in the middle of a task; its end is not compared"
        print(f"cfepy: {text}", file=sys.stderr)
    with replaying(arguments, journal) as replay:
        status = fly_again(arguments, replay)
        _tell(replay, sys.stderr)
    if status == INTERRUPTED:
        return INTERRUPTED
    return ENDED_WELL if replay.verdict.same else FOUND_PROBLEMS


@contextlib.contextmanager
def replaying(arguments: argparse.Namespace, journal: Journal) -> Iterator[Replay]:
    """Around the replay of a journal: what makes it one, and where its files are."""
    lines = RecordLines()
    for name in _FILES:  # the working directory is about to change
        path = getattr(arguments, name)
        setattr(arguments, name, None if path is None else os.path.abspath(path))
    with staged(journal, arguments.from_disk) as stage:
        for note in stage.notes:
            print(f"cfepy: {note}", file=sys.stderr, flush=True)
        begins_there = (arguments.step or arguments.pdb is not None) and not arguments.stops
        until_ns = None if arguments.until is None or begins_there else round(arguments.until * NS_PER_S)
        tasks = arguments.tasks if arguments.pdb is None else "thread"  # only a thread has a debugger of its own
        replay = Replay(journal, stage, tasks=tasks, until_ns=until_ns, describe=lines.describe)
        replay.attachments.append(lines)
        yield replay


def fly_again(arguments: argparse.Namespace, replay: Replay) -> int:
    """Fly the mission of a replay, and report as its command does; the exit status of that.

    Args:
        arguments: of `cfepy replay`.
        replay: the replay; it has a verdict afterwards.
    """
    plan = replay.plan
    again = arguments_of(plan, **{name: getattr(arguments, name) for name in (*_FILES, *_OPTIONS)})
    spec = replay.stage.spec()
    debugger: Debugger | None = None
    view = RosView() if plan.command == LAUNCH and not arguments.console else View()
    if arguments.stops or arguments.step or arguments.pdb is not None:
        from cfepy.cli.debugging import DebugView, debugger_of

        debugger, view = debugger_of(arguments, spec, replay), DebugView(view)
        replay.attachments.append(debugger)
    if plan.command == NODE:
        status = run_node(again, spec, replay=replay)
    else:
        status = run_spec(again, spec, view, replay=replay)
    sys.stdout.flush()
    for line in debugger.missed if debugger is not None else ():
        print(f"cfepy: {line}", file=sys.stderr)
    return status


def _tell(replay: Replay, stream: TextIO) -> None:
    """Say whether it was the same run."""
    sys.stdout.flush()
    journal, verdict = replay.journal, replay.verdict
    agreed = verdict.agreed
    if verdict.difference is None:
        print(f"cfepy: {_same(journal, verdict)}", file=stream)
        if verdict.other_results:
            print("cfepy: and yet the numbers of the report are others: compare them (--json)", file=stream)
        return
    recorded = verdict.difference.before
    text = f"not the run of {journal.path}: the same up to record {agreed.records:,} at {_seconds(agreed.now_ns)}"
    print(f"cfepy: {text}, not up to record {recorded.records:,} at {_seconds(recorded.now_ns)}", file=stream)
    print("cfepy: this is what the replay did next:", file=stream)
    for line in verdict.difference.lines or ("nothing more",):
        print(f"  {line}", file=stream)
    for reason in replay.stage.reasons:
        print(f"cfepy: {reason}", file=stream)


def _same(journal: Journal, verdict: Verdict) -> str:
    if verdict.whole and not verdict.other_results:
        return f"the same run as {journal.path}"
    if verdict.whole:
        return f"the same trace as {journal.path}"
    where = f"record {verdict.agreed.records:,} at {_seconds(verdict.agreed.now_ns)}"
    return f"the same run as {journal.path} up to {where}, where it was compared for the last time"


def _seconds(time_ns: int) -> str:
    return f"{time_ns / NS_PER_S:.6f} s"
