"""Three nodes in C++ that fly for long: topics, a service, parameters and transforms, once a second each.

`python -m dev.roscfe.endurance --hours 24` flies them in one mission on cfepy, in the profile pool, and asks each for
its housekeeping: no arena may grow after the first minutes, nothing may be lost, and the counters must agree with the
rates.
"""

from __future__ import annotations

import os
import struct
from pathlib import Path
from typing import NamedTuple
from unittest.mock import patch

import cfepy
from cfepy.flight import Flight

FOLDER = Path(__file__).parent
NODES = {"drive": 0x0A10, "guard": 0x0A11, "watch": 0x0A12}
"""MsgIds of their housekeeping."""
MANIFEST = """<package format="2"><name>rover</name><version>1.0.0</version><description>rover</description>
<maintainer email="a@b.c">a</maintainer><license>Apache-2.0</license><depend>roscpp</depend><depend>nav_msgs</depend>
<depend>std_srvs</depend><depend>tf2_ros</depend></package>
"""
ARENA_BYTES = 4 << 20
"""Bytes of a node's arena: most of them are for the samples of a tf2 buffer."""
MISSION = f"launch: [{{file: rover.launch}}]\ncpp_nodes:\n  profile: pool\n  arena_bytes: {ARENA_BYTES}\n  ground:\n"
COMMAND_BIT, SEND_HOUSEKEEPING = 0x1000, 2
LONGEST_WAIT = 30  # tenths of a second: each node waits for at most one second
PACKET = struct.Struct("<BB2x10I")


class Counters(NamedTuple):
    """The packet of housekeeping of a node, in its order."""

    commands: int
    errors: int
    received: int
    dropped: int
    bad: int
    sent: int
    not_sent: int
    callbacks_waiting: int
    calls_waiting: int
    arena_bytes: int
    arena_used: int
    late_allocations: int


def write_mission(folder: Path) -> Path:
    """Write the mission and its package. Returns the mission's folder."""
    package = folder / "rover"
    package.mkdir(parents=True)
    targets = "".join(f"add_executable({name} {name}.cpp)\n" for name in NODES)
    nodes = "".join(f'<node pkg="rover" type="{name}" name="{name}"/>' for name in NODES)
    ground = "".join(f"    /{name}: {{msg_id: 0x{msg_id:04X}}}\n" for name, msg_id in NODES.items())
    texts = {
        "package.xml": MANIFEST,
        "CMakeLists.txt": f"project(rover)\n{targets}",
        "rover.launch": f"<launch>{nodes}</launch>\n",
        "startup.scr": "!\n",
        "mission.yaml": MISSION + ground,
    }
    texts |= {f"{name}.cpp": (FOLDER / f"{name}.cpp").read_text(encoding="utf-8") for name in NODES}
    for name, text in texts.items():
        (package / name).write_text(text, encoding="utf-8")
    return package


def fly(folder: Path, times_s: list[float]) -> list[dict[str, Counters]]:
    """Return the counters of the nodes at times.

    Args:
        folder: an empty folder.
        times_s: seconds of virtual time since the start.
    """
    mission = write_mission(folder)
    with patch.dict(os.environ, {"ROS_PACKAGE_PATH": str(folder)}), cfepy.boot(mission) as flight:
        found = []
        for time in times_s:
            flight.run_until(time)
            found.append({name: _counters(flight, msg_id) for name, msg_id in NODES.items()})
        return found


def _counters(flight: Flight, msg_id: int) -> Counters:
    before = len(flight.log.packets.get(msg_id, []))
    flight.send(struct.pack(">HHHBB", msg_id | COMMAND_BIT, 0xC000, 1, SEND_HOUSEKEEPING, 0))
    for _ in range(LONGEST_WAIT):
        if len(flight.log.packets.get(msg_id, [])) > before:
            break
        flight.run_for(0.1)
    return Counters(*PACKET.unpack(flight.log.packets[msg_id][-1].packet[16:]))
