"""`run`, `boot` and `replay`: a mission by its name, flown to its end, step by step, or again.

Each takes the mission like the command line, and options by name. For a wrong mission, option or file they raise a
`UsageError`, which names the place and the remedy.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Unpack

from cfepy.attachment import Attachment
from cfepy.flight.log import FlightLog
from cfepy.flight.plans import MissionOptions, MissionWords, RunOptions, fault_attachments, plan_of
from cfepy.flight.run import Run
from cfepy.pilot import Host, LiveRun, RunPlan, fly
from cfepy.rtos import Stopwatch
from cfepy.writing.console import Console

if TYPE_CHECKING:
    from cfepy.flight.flight import Flight


class TimedHost(Host):
    """Measures the wall-clock time of a run."""

    def begin(self, run: LiveRun) -> None:
        super().begin(run)
        self._watch = Stopwatch()

    def wall_ns(self) -> int:
        return self._watch.elapsed_ns()


def run(
    mission: MissionWords,
    *,
    attachments: Sequence[Attachment] = (),
    journal: str | os.PathLike[str] | None = None,
    echo: bool = False,
    **options: Unpack[RunOptions],
) -> Run:
    """Fly a mission to its end, as `cfepy run` does.

        run = cfepy.run("capture", seconds=20, seed=3)
        run.topic("/joint_states").to_numpy("position")

    Args:
        mission: the name of a mission included in cfepy, a folder, a startup script, a launch file or a node's .py
            file; a sequence also has the words after it on the command line.
        attachments: further objects that observe or modify the run.
        journal: file to record the run in; None for none.
        echo: whether to print the console's lines.
        options: `seconds`, `seed`, `board`, `tasks`, `schedule`, `script`, `stop_on_failure`, `faults`, `play`,
            `play_options`, `args`, `stall`, `guard`, `races`, `cpp_nodes`, `settings`, `spacecraft_id`, `processor_id`
            and `beside`, see `RunOptions`.

    Returns:
        The run, with all data sent in it.

    Raises:
        TypeError: for an unknown option.
        UsageError: if the mission does not exist, it or an option is wrong, or it cannot boot.
    """
    plan = plan_of(mission, options, RunOptions.__annotations__)
    return fly_plan(plan, [*fault_attachments(options.get("faults")), *attachments], journal, echo)


def fly_plan(
    plan: RunPlan,
    attachments: Sequence[Attachment] = (),
    journal: str | os.PathLike[str] | None = None,
    echo: bool = False,
) -> Run:
    """Fly a plan to its end; see `run`."""
    spec = plan.spec()
    log = FlightLog(spec)
    watching, console = [log, *attachments], Console(quiet=not echo)
    if journal is None:
        flown = fly(plan, spec=spec, attachments=watching, console=console, host=TimedHost())
    else:
        from cfepy.journal import record

        flown = record(plan, os.fspath(journal), watching, spec=spec, console=console, host=TimedHost())
    return Run(plan, flown.mission, log, flown)


def boot(mission: MissionWords, *, attachments: Sequence[Attachment] = (), **options: Unpack[MissionOptions]) -> Flight:
    """Boot a mission, which is paused at virtual time 0 until you let it run.

        with cfepy.boot("capture") as m:
            m.run_for(2.0)
            m.send("CFE_ES_NOOP")
            m.expect_event("CFE_ES", 3)

    Args:
        mission: see `run`.
        attachments: further objects that observe or modify the run.
        options: `seed`, `board`, `tasks`, `schedule`, `faults`, `play`, `play_options`, `args`, `stall`, `guard`,
            `races`, `cpp_nodes`, `settings`, `spacecraft_id`, `processor_id` and `beside`, see `MissionOptions`.

    Returns:
        The flight, which must be closed; use it as a context manager.

    Raises:
        TypeError: for an unknown option.
        UsageError: see `run`.
    """
    from cfepy.flight.flight import Flight

    plan = plan_of(mission, options, MissionOptions.__annotations__)
    return Flight(plan, attachments=[*fault_attachments(options.get("faults")), *attachments])


def replay(journal: str | os.PathLike[str], *, tasks: str | None = None) -> Run:
    """Repeat the run of a journal, like `cfepy replay`.

    Args:
        journal: the file.
        tasks: "thread", "greenlet" or "auto"; None takes the journal's.

    Returns:
        The run. Its trace equals the journal's if the runs are equal.

    Raises:
        UsageError: if it is not a journal, or its mission cannot fly.
    """
    from cfepy.journal import Replay, read_journal, staged

    journal_of_run = read_journal(os.fspath(journal))
    with staged(journal_of_run) as stage:
        log = FlightLog(stage.spec())
        again = Replay(journal_of_run, stage, tasks=tasks)
        flown = again.fly([log], host=TimedHost())
        _ = log.dictionary  # created now, because the files it is read from are about to disappear
        return Run(again.plan, flown.mission, log, flown)
