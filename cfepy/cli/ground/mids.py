"""`cfepy mids`: print the MsgIds of a mission, or write them to its lock file."""

from __future__ import annotations

import argparse
import sys

from cfepy.cli.ground.survey_flight import survey_plan, surveyed
from cfepy.cli.json_output import check_json, write_json
from cfepy.cli.main import ENDED_WELL
from cfepy.cli.text_table import Table, show_tables
from cfepy.cli.user_notes import writing
from cfepy.ground import MidRow, Survey, lock_path, lock_text, locked, spread_out
from cfepy.mission import MissionSpec
from cfepy.pilot import RunPlan
from cfepy.status import UsageError


def run(arguments: argparse.Namespace) -> int:
    """Survey the mission that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: there is no such mission, it cannot boot, or the file cannot be written.
    """
    check_json(arguments)
    plan, spec = survey_plan(arguments)
    if arguments.lock and spec.ros.spread:
        text = "cannot have a topics.lock, because its topics get free MsgIds; use a mission with `launch:`"
        raise UsageError(text, file=arguments.mission)
    if arguments.lock:
        return _lock(plan, spec)
    survey = Survey()
    with surveyed(plan, spec, [survey]):
        rows = survey.rows()
    write_json(arguments, [row.to_dict() for row in rows])
    show_tables([_table(spec.name, rows)], sys.stdout)
    return ENDED_WELL


def _lock(plan: RunPlan, spec: MissionSpec) -> int:
    with surveyed(plan, spread_out(spec)) as mission:
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
