"""The flight that `cfepy mids` and `cfepy graph` make to look at a mission: 10 virtual seconds by default."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace

from cfepy.attachment import Attachment
from cfepy.cli.options import plan_of
from cfepy.cli.user_notes import tell
from cfepy.ground import LOOK_S
from cfepy.mission import Mission, MissionSpec
from cfepy.pilot import RunPlan, never_happened, takeoff


def survey_plan(arguments: argparse.Namespace) -> tuple[RunPlan, MissionSpec]:
    """Return the plan of the flight, and the mission.

    Raises:
        UsageError: there is no such mission.
    """
    plan = plan_of(arguments, [arguments.mission])
    plan = replace(plan, seconds=LOOK_S) if plan.seconds is None and plan.script is None else plan
    return plan, plan.spec()


@contextmanager
def surveyed(plan: RunPlan, spec: MissionSpec, attachments: Sequence[Attachment] = ()) -> Iterator[Mission]:
    """Yield a mission that has flown for the time of the plan, and has not been shut down."""
    with takeoff(plan, spec=spec, attachments=attachments) as run:
        tell(run.notes)
        run.run_until(run.course.until_ns)
        problems = [*run.problems(), *never_happened(run.mission)]
        yield run.mission
    tell(problems)
