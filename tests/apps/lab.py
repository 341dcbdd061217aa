"""A mission with only CI_LAB and TO_LAB, and a ground system that talks to it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from cfepy.ground.link import GroundLink
from cfepy.mission import Mission
from cfepy.msg import Telemetry
from cfepy.writing.console import Console

STARTUP = """\
CFE_APP, ci_lab, CI_LAB_AppMain, CI_LAB, 60, 16384, 0x0, 0;
CFE_APP, to_lab, TO_LAB_AppMain, TO_LAB, 70, 16384, 0x0, 0;
!
"""


class Lab:
    """The mission and the ground."""

    def __init__(self, mission: Mission, ground: GroundLink) -> None:
        self.mission = mission
        self.ground = ground

    def events(self, *packets: bytes, seconds: float = 1.5, app: str = "") -> list[str]:
        """Send packets and run for a while. Returns the new events, without times, of one application or of all."""
        before = len(self.mission.console.lines)
        for packet in packets:
            assert self.ground.send(packet)
        self.mission.run_for(seconds)
        lines = self.mission.console.lines[before:]
        events = [line.partition(" 66/1/")[2] for line in lines if line.startswith("EVS Port1")]
        return [event for event in events if event.startswith(app)]

    def packets(self, telemetry: Telemetry) -> list[bytes]:
        """Return packets of a kind that arrived since the last call. All other packets are dropped."""
        start = telemetry.msg_id.to_bytes(2, "big")
        return [packet for _, packet in self.ground.received() if packet.startswith(start)]

    def latest(self, telemetry: Telemetry, *requests: bytes) -> dict[str, Any]:
        """Send requests and run for a while. Returns the fields of the last packet of a kind."""
        self.events(*requests)
        return telemetry.read(self.packets(telemetry)[-1])


@contextmanager
def lab(folder: Path, tasks: str = "thread", before: str = "", **options: Any) -> Iterator[Lab]:
    """Boot a mission in a folder. `before` are lines of its startup script before the two applications."""
    (folder / "startup.scr").write_text(before + STARTUP, encoding="utf-8")
    mission = Mission(str(folder), tasks=tasks, console=Console(quiet=True), **options)
    with mission, GroundLink(mission) as ground:
        mission.run_for(1)
        yield Lab(mission, ground)
