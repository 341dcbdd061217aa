"""`cfepy replay`: do the run of a journal again, and say whether it was the same."""

from __future__ import annotations

import argparse
import contextlib
import sys
from collections.abc import Iterator, Sequence
from typing import TextIO

from cfepy.attachment import Attachment
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS, INTERRUPTED
from cfepy.cli.node import run_node
from cfepy.cli.recording import arguments_of
from cfepy.cli.ros_view import RosView
from cfepy.cli.run import View, run_spec
from cfepy.cli.trace_text import TraceText
from cfepy.journal.journal import Journal, read_journal
from cfepy.journal.replay import Replay, Verdict
from cfepy.journal.stage import Stage, staged
from cfepy.mission import Mission
from cfepy.mission.run_plan import LAUNCH, NODE
from cfepy.rtos.units import NS_PER_S

MOST_LINES = 12
_OPTIONS = ("json", "save_files", "bag", "bag_topics", "trace", "quiet")


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
    with replaying(arguments, journal) as (replay, stage):
        status = fly_again(arguments, replay, stage)
        _tell(journal, replay.verdict, stage, sys.stderr)
    if status == INTERRUPTED and not _ended_so(journal):
        return INTERRUPTED
    return ENDED_WELL if replay.verdict.same else FOUND_PROBLEMS


@contextlib.contextmanager
def replaying(arguments: argparse.Namespace, journal: Journal) -> Iterator[tuple[Replay, Stage]]:
    """Around the replay of a journal: what makes it one, and where its files are."""
    lines = RecordLines()
    with staged(journal, arguments.from_disk) as stage:
        for note in stage.notes:
            print(f"cfepy: {note}", file=sys.stderr, flush=True)
        until_ns = None if arguments.until is None else round(arguments.until * NS_PER_S)
        replay = Replay(
            journal,
            tasks=arguments.tasks,
            until_ns=until_ns,
            plan=stage.plan,
            root=stage.root,
            describe=lines.describe,
        )
        replay.attachments.append(lines)
        yield replay, stage


def fly_again(arguments: argparse.Namespace, replay: Replay, stage: Stage) -> int:
    """Fly the mission of a replay, and report as its command does; the exit status of that.

    Args:
        arguments: of `cfepy replay`.
        replay: the replay; it has a verdict afterwards.
        stage: where its files are.
    """
    plan = replay.plan
    again = arguments_of(plan, **{name: getattr(arguments, name) for name in _OPTIONS})
    spec = stage.spec()
    if plan.command == NODE:
        return run_node(again, spec, replay=replay)
    view = RosView() if plan.command == LAUNCH and not arguments.console else View()
    return run_spec(again, spec, view, replay=replay)


def _ended_so(journal: Journal) -> bool:
    return False


def _tell(journal: Journal, verdict: Verdict, stage: Stage, stream: TextIO) -> None:
    """Say whether it was the same run."""
    sys.stdout.flush()
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
    for reason in stage.reasons:
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
