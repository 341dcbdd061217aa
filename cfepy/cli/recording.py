"""`--record FILE`: the journal of a run, as the command line asks for it."""

from __future__ import annotations

import argparse
import contextlib
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from cfepy.mission.run_plan import RUN, RunPlan
from cfepy.rtos.schedule import Schedule

if TYPE_CHECKING:
    from cfepy.journal.recorder import JournalRecorder


def plan_of(arguments: argparse.Namespace, words: Sequence[str], command: str = RUN) -> RunPlan:
    """What a command line asks for, apart from what comes from outside.

    Args:
        arguments: of the command line, as they were before anybody changed them.
        words: what follows the command.
        command: as of `RunPlan`.
    """
    return RunPlan(
        words=tuple(words),
        command=command,
        launch_args=tuple(getattr(arguments, "launch_args", ())),
        seconds=arguments.seconds,
        seed=arguments.seed,
        board=arguments.board,
        tasks=arguments.tasks,
        schedule=Schedule.parse(arguments.schedule, arguments.seed).text(),
        script=arguments.script,
        stop_on_failure=getattr(arguments, "stop_on_failure", False),
        faults=getattr(arguments, "faults", None),
        play=getattr(arguments, "play", None),
    )


def arguments_of(plan: RunPlan, **options: Any) -> argparse.Namespace:
    """The command line of `cfepy run` that a plan stands for, as `cfepy.cli.run.fly` takes it.

    Args:
        plan: what to run.
        options: what the run leaves behind and shows, such as json and quiet.
    """
    return argparse.Namespace(
        **options,
        seconds=plan.virtual_s,
        seed=plan.seed,
        board=plan.board,
        tasks=plan.tasks,
        schedule=plan.schedule,
        script=plan.script,
        stop_on_failure=plan.stop_on_failure,
        faults=plan.faults,
        realtime=None,
        port=[],
    )


@contextlib.contextmanager
def recording(
    arguments: argparse.Namespace, words: Sequence[str], command: str = RUN
) -> Iterator[JournalRecorder | None]:
    """Around reading a mission and running it: what writes its journal, None when none is asked for.

    Args:
        arguments: of the command line.
        words: what follows the command.
        command: as of `RunPlan`.

    Raises:
        UsageError: the journal cannot be written.
    """
    if arguments.record is None:
        yield None
        return
    from cfepy.journal.mission_files import CARRIED
    from cfepy.journal.recorder import JournalRecorder

    plan = plan_of(arguments, words, command)
    with JournalRecorder(
        arguments.record,
        plan,
        carried=0 if arguments.record_no_files else CARRIED,
        paced=arguments.realtime,
        policy=Schedule.parse(plan.schedule).policy(),
    ) as recorder:
        yield recorder
