"""Missions whose node sets parameters, and which the ground resets or sends tables to."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from cfepy.attachment import Attachment
from cfepy.mission import Mission, MissionSpec
from cfepy.mission.limits import MissionLimits
from cfepy.msg import command
from cfepy.tbl import build
from cfepy.tbl.packets import ACTIVATE, ACTIVE_BUFFER, DUMP, LOAD, VALIDATE
from cfepy.writing.console import Console
from rospy_shim.parameters.table import TABLES, Row, rows_for, unpack
from rospy_shim.types.config import NodeConfig, RosConfig

PROCESSOR_RESET, POWERON_RESET = 1, 2


def fly(
    folder: Path,
    node: str,
    *,
    params: Mapping[str, Any] | None = None,
    private: Mapping[str, Any] | None = None,
    limits: Mapping[str, Any] | None = None,
    board: str = "linux",
    tasks: str = "thread",
    attachments: Sequence[Attachment] = (),
) -> Mission:
    """Return a mission with one node, N, which has not run yet."""
    (folder / "n.py").write_text(textwrap.dedent(node), encoding="utf-8")
    script = folder / "startup.scr"
    script.write_text("CFE_APP, n, __main__, N, 100, 16384, 0x0, 0;\n!\n", encoding="utf-8")
    ros = RosConfig({"N": NodeConfig("N", params=private or {})}, params=params or {})
    spec = MissionSpec("test", folder, script, None, board, ros, limits=MissionLimits(limits or {}))
    return Mission(spec, tasks=tasks, console=Console(quiet=True), attachments=attachments)


def printed(mission: Mission) -> list[str]:
    """Return the output of the node, whose ROS name is n."""
    return [line.removeprefix("[n] ") for line in mission.console.lines if line.startswith("[n] ")]


def events(mission: Mission) -> list[str]:
    """Return the texts of ROS's events."""
    return [line.partition("/ROS ")[2] for line in mission.console.lines if "/ROS " in line]


def reset(mission: Mission, kind: int) -> None:
    """Reset by the ground command CFE_ES_RESTART."""
    mission.cfe.sb.transmit_msg(command(0x1806, 2, bytes([kind, 0])), is_origination=False)
    mission.run_for(2)


def load(mission: Mission, number: int, values: Mapping[str, str]) -> None:
    """Load a table of parameters with these texts from a file, validate it, and activate it."""
    rows = [row for name, text in values.items() for row in rows_for(name, text)]
    table = TABLES[number]
    image = table.image([{"Name": name, "Value": value} for name, value in rows])
    mission.files.write_file("/ram/params.tbl", build(image))
    for packet in (
        LOAD.packet(LoadFilename="/ram/params.tbl"),
        VALIDATE.packet(ActiveTableFlag=0, TableName=table.name),
        ACTIVATE.packet(TableName=table.name),
    ):
        mission.cfe.sb.transmit_msg(packet, is_origination=False)
        mission.run_for(1.5)


def dump(mission: Mission, number: int) -> bytes:
    """Return the file that the ground gets when it dumps a table of parameters."""
    packet = DUMP.packet(ActiveTableFlag=ACTIVE_BUFFER, TableName=TABLES[number].name, DumpFilename="/ram/dump.tbl")
    mission.cfe.sb.transmit_msg(packet, is_origination=False)
    mission.cfe.sb.transmit_msg(command(0x180C, 0), is_origination=False)  # CFE_TBL writes with its housekeeping
    mission.run_for(1)
    node = mission.files.find("/ram/dump.tbl")
    assert node is not None
    return bytes(node.data)


def rows_of(mission: Mission) -> list[Row]:
    """Return the rows that are not free, of all tables that there are."""
    registry = mission.cfe.tbl.registry
    tables = [found for table in TABLES if (found := registry.find(table.name)) is not None]
    images = [table.image(active) for table in tables if (active := registry.active(table)) is not None]
    rows = [row for image in images for row in unpack(image)]
    return [row for row in rows if row != ("", "")]
