"""`cfepy new faults`: print a random fault plan for a mission, or list the faults that it can have."""

from __future__ import annotations

import argparse
import sys

from cfepy.cli.main import ENDED_WELL
from cfepy.cli.text_table import Table, show_tables
from cfepy.mission import read_mission
from cfepy.pilot import booting


def run(arguments: argparse.Namespace) -> int:
    """Run the command.

    Returns:
        The exit status.

    Raises:
        UsageError: there is no such mission.
    """
    from cfepy.faults import Found, look_at, random_plan

    spec = read_mission(arguments.mission, dict(arguments.launch_args))
    with booting(spec.script):
        found: Found = look_at(spec)
    if arguments.seed is not None:
        print(random_plan(arguments.seed, found.targets, arguments.intensity).to_yaml(), end="")
        return ENDED_WELL
    table = Table("Possible targets of faults", ("kind", "name", "number"), right=(2,))
    targets = found.targets
    for name, count in targets.messages:
        table.add("message", name, count)
    for kind, names in (
        ("app", targets.apps),
        ("pipe", targets.pipes),
        ("table", targets.tables),
        ("file", targets.files),
    ):
        for name in names:
            table.add(kind, name, "")
    show_tables([table], sys.stdout)
    return ENDED_WELL
