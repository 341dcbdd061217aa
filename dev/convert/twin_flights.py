"""Packages of twins: a launch file flies a node in C++, or its twin in Python with `suffix:=.py`, for comparison.

Each package of the folder twins has such a launch file, with a stimulus and the recorder of the package twin_tools.
"""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple
from unittest.mock import patch

from cfepy.extra.convert import build_for_flight
from cfepy.mission import Mission
from cfepy.mission.launch import read_launch
from cfepy.writing.console import Console
from rospy_shim.types.msgs import shipped

TWINS = Path(__file__).parents[2] / "tests/extra/convert/twins"
PACKAGES = sorted(each.parent.parent.name for each in TWINS.glob("*/launch/twin.launch"))
SECONDS = 12.0


class Recorded(NamedTuple):
    """A message: when it came in microseconds, its topic, type and bytes.

    Times that rospy waits for are floats, and so a few nanoseconds longer or shorter.
    """

    time: int
    topic: str
    type: str
    data: bytes


class TwinFlight(NamedTuple):
    """Results of a flight: messages in order of arrival, all lines of the console, the digest."""

    messages: list[Recorded]
    lines: list[str]
    digest: str


def fly(package: str, *, python: bool, tasks: str = "thread", seconds: float = SECONDS) -> TwinFlight:
    """Fly the launch file of a package of twins.

    Args:
        package: its name.
        python: fly the node in Python instead of the one in C++.
        tasks: "thread" or "greenlet".
        seconds: virtual time.
    """
    launch = TWINS / package / "launch/twin.launch"
    with patch.dict(os.environ, {"ROS_PACKAGE_PATH": str(TWINS)}):
        spec = read_launch(launch, {"suffix": ".py"} if python else {}, build_for_flight)
        assert not spec.notes, spec.notes
        with Mission(
            replace(spec, board=str(TWINS / "free.yaml")), tasks=tasks, console=Console(quiet=True)
        ) as mission:
            mission.run_for(seconds)
            lines = list(mission.console.lines)
            messages = [recorded(line, python) for line in lines if line.startswith("[recorder] RECORD ")]
            return TwinFlight(messages, lines, mission.trace.digest())


def recorded(line: str, python: bool) -> Recorded:
    """Parse a line of the recorder. Sequence numbers of a publisher count as in roscpp.

    In header.seq, roscpp numbers the messages of a publisher from 0 and rospy from 1. ROS has the same difference. It
    is the only one that the bytes of both may have.
    """
    _, _, time, topic, kind, text = [*line.split(" "), ""][:6]
    data = bytes.fromhex(text)
    if python and shipped().spec(kind).has_header:
        data = (int.from_bytes(data[:4], "little") - 1).to_bytes(4, "little") + data[4:]
    return Recorded(round(int(time) / 1000), topic, kind, data)
