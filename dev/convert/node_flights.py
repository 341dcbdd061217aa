"""Missions of the packages in the folder nodes: launch files with nodes in C++, flown on cfepy."""

from __future__ import annotations

import os
from pathlib import Path
from unittest.mock import patch

from cfepy.extra.convert import build_for_flight
from cfepy.mission import Mission
from cfepy.mission.launch import read_launch
from cfepy.writing.console import Console
from dev.convert.twin_flights import TWINS

NODES = Path(__file__).parents[2] / "tests/extra/convert/nodes"


def mission_of(package: str, launch: str = "all", **args: str) -> Mission:
    """Return the mission of a package's launch file, not begun yet.

    Args:
        package: its name.
        launch: name of the file.
        args: of the launch file.
    """
    with patch.dict(os.environ, {"ROS_PACKAGE_PATH": f"{NODES}:{TWINS}"}):
        spec = read_launch(NODES / package / f"launch/{launch}.launch", args, build_for_flight)
    assert not spec.notes, spec.notes
    return Mission(spec, console=Console(quiet=True))
