"""`cfepy graph`: senders, messages and receiving pipes as text, drawing, graphviz or JSON; or the table of MsgIds."""

from __future__ import annotations

import argparse
import shutil
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace

from cfepy.attachment import Attachment
from cfepy.cli.flying_progress import FlyingProgress
from cfepy.cli.json_output import check_json, write_json, write_text
from cfepy.cli.main import ENDED_WELL
from cfepy.cli.options import plan_of
from cfepy.cli.text_table import Table, show_tables
from cfepy.cli.user_notes import tell, tell_briefly, writing
from cfepy.ground import (
    LOOK_S,
    MidRow,
    Survey,
    graph_dot,
    graph_of,
    graph_svg,
    graph_text,
    lock_path,
    lock_text,
    locked,
    spread_out,
)
from cfepy.mission import Mission, MissionSpec
from cfepy.pilot import RunPlan, idle_nodes, loose_ends, never_happened, takeoff
from cfepy.status import UsageError

WIDEST = 100  # characters of a line if the output is not a terminal


def run(arguments: argparse.Namespace) -> int:
    """Fly the mission that the command line names for a while, and show its graph.

    Returns:
        The exit status.

    Raises:
        UsageError: there is no such mission, it cannot boot, or a file cannot be written.
    """
    check_json(arguments)
    if arguments.mids or arguments.lock:
        return _mids(arguments)
    survey = Survey()
    with _surveyed(*_survey_plan(arguments), [survey]) as mission:
        graph = graph_of(mission, survey.senders)
    graph = graph if arguments.everything else graph.of_interest()
    write_json(arguments, graph.to_dict())
    for option, make in (("svg", graph_svg), ("dot", graph_dot)):
        file = getattr(arguments, option)
        if file is not None:
            write_text(file, make(graph), f"--{option}", arguments)
    width = min(shutil.get_terminal_size().columns, WIDEST) if sys.stdout.isatty() else WIDEST
    sys.stdout.write(graph_text(graph, width))
    return ENDED_WELL


def _mids(arguments: argparse.Namespace) -> int:
    """Print the table of MsgIds, or write the lock file. Returns the exit status."""
    plan, spec = _survey_plan(arguments)
    if arguments.lock and spec.ros.spread:
        text = "cannot have a topics.lock, because its topics get free MsgIds; use a mission with `launch:`"
        raise UsageError(text, file=arguments.mission)
    if arguments.lock:
        return _lock(plan, spec)
    survey = Survey()
    with _surveyed(plan, spec, [survey]):
        rows = survey.rows()
    write_json(arguments, [row.to_dict() for row in rows])
    show_tables([_table(spec.name, rows)], sys.stdout)
    return ENDED_WELL


def _lock(plan: RunPlan, spec: MissionSpec) -> int:
    with _surveyed(plan, spread_out(spec)) as mission:
        config = locked(spec, mission)
    path, former = lock_path(spec), len(spec.ros.locked_topics) + len(spec.ros.locked_services)
    with writing(path, "--lock"):
        path.write_text(lock_text(config), encoding="utf-8")
    count = len(config.locked_topics) + len(config.locked_services)
    print(f"{path}: {count} MsgIds, {count - former} of them new")
    return ENDED_WELL


def _table(mission: str, rows: list[MidRow]) -> Table:
    table = Table(f"MsgIds of {mission}", ("MsgId", "name", "type", "sent by", "subscribed by"), least=(2,))
    for row in rows:
        senders, subscribers = ", ".join(row.senders) or "-", ", ".join(row.subscribers) or "-"
        table.add(f"0x{row.msg_id:04X}", row.name, row.type, senders, subscribers)
    return table


def _survey_plan(arguments: argparse.Namespace) -> tuple[RunPlan, MissionSpec]:
    """Return the plan of the flight, and the mission.

    Raises:
        UsageError: there is no such mission.
    """
    plan = plan_of(arguments, [arguments.mission])
    plan = replace(plan, seconds=LOOK_S) if plan.seconds is None and plan.script is None else plan
    return plan, plan.spec()


@contextmanager
def _surveyed(plan: RunPlan, spec: MissionSpec, attachments: Sequence[Attachment] = ()) -> Iterator[Mission]:
    """Yield a mission that has flown for the time of the plan, and has not been shut down."""
    with takeoff(plan, spec=spec, attachments=attachments, host=FlyingProgress()) as run:
        tell_briefly(run.notes)
        run.run_until(run.course.until_ns)
        problems = [*run.problems(), *never_happened(run.mission), *loose_ends(run.mission), *idle_nodes(run.mission)]
        yield run.mission
    tell(problems)
