"""A mission with SCH, its sent messages, and an operator, for tests."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from apps.sch import packets as pk
from apps.sch.definition import activity, message_image, schedule_image
from cfepy.mission import Mission
from cfepy.mission.packet_watch import PacketWatch, Seen
from cfepy.msg import command, init
from cfepy.tbl import build
from cfepy.units import NS_PER_MS, NS_PER_S
from cfepy.writing.console import Console

FIRST, SECOND, THIRD = 0x18F1, 0x18F2, 0x18F3
MESSAGES = {1: init(FIRST, 8), 2: init(SECOND, 8), 3: command(THIRD, 5, b"\1\2"), 4: init(0x1896, 8)}
SLOTS = {
    0: [activity(1)],
    25: [activity(2, 2, 1, groups=0x02000001), activity(3, 1, 0, groups=0x02000002, enabled=False)],
    99: [activity(4)],
}

SCH = "CFE_APP, sch, SCH_AppMain, SCH, 40, 16384, 0x0, 0;\n"
DEBUG_ON = command(0x1801, 5, b"SCH".ljust(20, b"\0") + b"\x0f\0")


class Flight:
    """A mission with SCH, its sent messages, and an operator."""

    def __init__(self, folder: Path, board: str | None = None) -> None:
        self.seen: list[Seen] = []
        shown = (FIRST, SECOND, THIRD, pk.HK_TLM_MID, pk.DIAG_TLM_MID)
        watch = PacketWatch(self.seen.append, shown.__contains__)
        self.mission = Mission(str(folder), board=board, console=Console(quiet=True), attachments=[watch])

    def send(self, *commands: bytes | bytearray) -> None:
        """Send commands from the ground."""
        for packet in commands:
            task = partial(self.mission.cfe.sb.transmit_msg, bytes(packet), False)
            self.mission.kernel.spawn("ground", task, 10)

    def run_to(self, second: float) -> None:
        """Run to a second of virtual time after the first tone of the clock."""
        self.mission.run_until(round(second * NS_PER_S))

    def events(self) -> list[str]:
        """Return SCH's events, each as "id: text", except for the start event."""
        lines = [line.partition(" 66/1/SCH ")[2] for line in self.mission.console.lines]
        return [line for line in lines if line and not line.startswith("1:")]

    def times(self, msg_id: int) -> list[float]:
        """When a message was sent, in ms from the first tone."""
        tone = self.tone_ns
        return [(seen.at_ns - tone) / NS_PER_MS for seen in self.seen if seen.msg_id == msg_id]

    @property
    def tone_ns(self) -> int:
        """The virtual time of the first message of slot 0."""
        return next(seen.at_ns for seen in self.seen if seen.msg_id == FIRST)

    def housekeeping(self) -> dict[str, int]:
        """Return the last housekeeping packet."""
        return pk.HK_TLM.read([seen.packet for seen in self.seen if seen.msg_id == pk.HK_TLM_MID][-1])


def write_mission(folder: Path, startup: str = SCH, **sources: str) -> Path:
    folder.mkdir(exist_ok=True)
    (folder / "startup.scr").write_text(startup + "!\n", encoding="utf-8")
    (folder / "sch_def_schtbl.tbl").write_bytes(build(schedule_image(SLOTS)))
    (folder / "sch_def_msgtbl.tbl").write_bytes(build(message_image(MESSAGES)))
    for name, source in sources.items():
        (folder / f"{name}.py").write_text(source, encoding="utf-8")
    return folder
