"""`cfepy mids`: print the MsgIds of a mission, or write them to its lock file."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from cfepy.cli.failures import booting, writing
from cfepy.cli.main import ENDED_WELL
from cfepy.cli.table import Table, show_tables
from cfepy.mission import MissionSpec, read_mission
from cfepy.mission.mids import MidRow, survey
from cfepy.mission.topics_lock import lock, lock_path, lock_text
from cfepy.status import UsageError

STDOUT = "-"


def run(arguments: argparse.Namespace) -> int:
    """Survey the mission that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: there is no such mission, it cannot boot, or the file cannot be written.
    """
    spec = read_mission(arguments.mission, dict(arguments.launch_args))
    if arguments.lock and spec.ros.spread:
        text = "has no topics.lock: its topics get free MsgIds by themselves; a mission with `launch:` has one"
        raise UsageError(text, file=arguments.mission)
    if arguments.lock:
        return _lock(spec, arguments.board)
    with booting(spec.script):
        rows = survey(spec, arguments.board)
    text = json.dumps([row.to_dict() for row in rows], indent=2) + "\n"
    if arguments.json == STDOUT:
        sys.stdout.write(text)
        return ENDED_WELL
    if arguments.json is not None:
        with writing(arguments.json, "--json"):
            Path(arguments.json).write_text(text, encoding="utf-8")
    show_tables([_table(spec.name, rows)], sys.stdout)
    return ENDED_WELL


def _lock(spec: MissionSpec, board: str | None) -> int:
    with booting(spec.script):
        config = lock(spec, board)
    path, former = lock_path(spec), len(spec.ros.locked_topics) + len(spec.ros.locked_services)
    with writing(path, "--lock"):
        path.write_text(lock_text(config), encoding="utf-8")
    count = len(config.locked_topics) + len(config.locked_services)
    print(f"{path}: {count} MsgIds, {count - former} of them new")
    return ENDED_WELL


def _table(mission: str, rows: list[MidRow]) -> Table:
    table = Table(f"MsgIds of {mission}", ("MsgId", "name", "type", "sent by", "subscribed by"))
    for row in rows:
        senders, subscribers = ", ".join(row.senders) or "-", ", ".join(row.subscribers) or "-"
        table.add(f"0x{row.msg_id:04X}", row.name, row.type, senders, subscribers)
    return table
