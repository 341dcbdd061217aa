"""`cfepy mids`: print the MsgIds of a mission."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from cfepy.cli.main import BAD_USAGE, ENDED_WELL
from cfepy.cli.table import Table, show_tables
from cfepy.mission import read_mission
from cfepy.mission.mids import MidRow, survey
from cfepy.status import CfeError, UsageError

STDOUT = "-"


def run(arguments: argparse.Namespace) -> int:
    """Survey the mission that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: there is no such mission, or the file cannot be written.
    """
    spec = read_mission(arguments.mission)
    try:
        rows = survey(spec, arguments.board)
    except CfeError as error:
        print(f"cfepy: {spec.script}: the mission cannot boot: {error}", file=sys.stderr)
        return BAD_USAGE
    text = json.dumps([row.to_dict() for row in rows], indent=2) + "\n"
    if arguments.json == STDOUT:
        sys.stdout.write(text)
        return ENDED_WELL
    if arguments.json is not None:
        _save(arguments.json, text)
    show_tables([_table(spec.name, rows)], sys.stdout)
    return ENDED_WELL


def _table(mission: str, rows: list[MidRow]) -> Table:
    table = Table(f"MsgIds of {mission}", ("MsgId", "name", "type", "sent by", "subscribed by"))
    for row in rows:
        senders, subscribers = ", ".join(row.senders) or "-", ", ".join(row.subscribers) or "-"
        table.add(f"0x{row.msg_id:04X}", row.name, row.type, senders, subscribers)
    return table


def _save(file: str, text: str) -> None:
    try:
        Path(file).write_text(text, encoding="utf-8")
    except OSError as error:
        raise UsageError(f"cannot be written: {error.strerror}", file=file, field="--json") from None
