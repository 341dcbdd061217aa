"""What `cfepy trace` and `cfepy report` look at: a journal's run, replayed, or a mission that is flown for them."""

from __future__ import annotations

import argparse
import shlex
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from cfepy.attachment import Attachment
from cfepy.cli.failures import booting
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.cli.recording import plan_of
from cfepy.mission.run_plan import Flown
from cfepy.rtos.units import NS_PER_S
from cfepy.status import UsageError

_OF_A_MISSION = ("seconds", "seed", "board", "tasks", "schedule", "script", "faults", "launch_args")
_USUAL = {"seed": 0, "tasks": "thread", "schedule": "fifo"}  # of these options; that of others is nothing


@dataclass(frozen=True, slots=True)
class LookedAt:
    """A run that was looked at.

    Attributes:
        flown: the run.
        command: does it again.
        schedule: who went first.
        notes: what is good to know.
        warnings: why it is not the run that is meant; none when it is.
    """

    flown: Flown
    command: str
    schedule: str
    notes: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()

    def status(self) -> int:
        """The exit status of the command; notes and warnings go to standard error."""
        sys.stdout.flush()
        for text in (*self.notes, *self.warnings):
            print(f"cfepy: {text}", file=sys.stderr)
        return FOUND_PROBLEMS if self.warnings else ENDED_WELL


def look_at(arguments: argparse.Namespace, attachments: Sequence[Attachment]) -> LookedAt:
    """Do the run that the command line names.

    Args:
        arguments: of the command line.
        attachments: what looks on.

    Raises:
        UsageError: there is no such run, or an option is for the other kind of source.
    """
    if _is_journal(arguments.source):
        return _replay(arguments, attachments)
    for name, option in (("until", "--until"), ("from_disk", "--from-disk")):
        if getattr(arguments, name):
            raise UsageError(f"is for the replay of a journal, and {arguments.source} is none", field=option)
    return _fly(arguments, attachments)


def _is_journal(source: str) -> bool:
    from cfepy.journal.frames import is_journal

    try:
        return is_journal(source)
    except OSError:
        return False


def _fly(arguments: argparse.Namespace, attachments: Sequence[Attachment]) -> LookedAt:
    plan = plan_of(arguments, [arguments.source])
    spec = plan.spec()
    with booting(spec.script):
        flown = plan.fly(attachments, spec=spec)
    return LookedAt(flown, plan.command_line(), plan.schedule)


def _replay(arguments: argparse.Namespace, attachments: Sequence[Attachment]) -> LookedAt:
    from cfepy.journal.journal import read_journal
    from cfepy.journal.replay import Replay
    from cfepy.journal.stage import staged

    for name in _OF_A_MISSION:
        if getattr(arguments, name) not in (_USUAL.get(name), None, []):
            option = {"seconds": "--for", "launch_args": "--arg"}.get(name, f"--{name}")
            raise UsageError(f"{arguments.source} is a journal, which says that itself; leave it out", field=option)
    journal = read_journal(arguments.source)
    until_ns = None if arguments.until is None else round(arguments.until * NS_PER_S)
    with staged(journal, arguments.from_disk) as stage:
        again = Replay(journal, stage, until_ns=until_ns)
        with booting(Path(journal.header.startup)):
            flown = again.fly(attachments)
    verdict = again.verdict
    warnings: tuple[str, ...] = ()
    if not verdict.same:
        warnings = (f"this is not the run of {arguments.source}: the replay differs", *stage.reasons)
    until = [] if arguments.until is None else ["--until", f"{arguments.until:g}"]
    command = shlex.join(["cfepy", "replay", arguments.source, *until])
    return LookedAt(flown, command, journal.plan.schedule, stage.notes, warnings)
