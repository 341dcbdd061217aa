"""The ground's side of a mission in a test: sends commands, sees events, telemetry and files."""

from __future__ import annotations

import re
from typing import Any

from cfepy.mission import Mission
from cfepy.msg import Command, Layout, Telemetry, command

EVS_CMD_MID, ENABLE_APP_EVENT_TYPE_CC = 0x1801, 5
_APP_BITS = Layout("CFE_EVS_AppNameBitMaskCmd_Payload_t", [("AppName", "char[20]"), ("BitMask", "u8"), ("Spare", "u8")])
_EVENT = re.compile(r"^EVS Port1 \S+ \d+/\d+/(.*)")


class Ground:
    """A ground station.

    Args:
        mission: one that has booted.
    """

    def __init__(self, mission: Mission) -> None:
        self.mission = mission

    def show_debug_events(self, app: str) -> None:
        """Let an application's DEBUG events come down."""
        self.send(command(EVS_CMD_MID, ENABLE_APP_EVENT_TYPE_CC, _APP_BITS.pack(AppName=app, BitMask=0x0F)))

    def send(self, packet: bytes | bytearray, seconds: float = 0.2) -> list[str]:
        """Send a packet and run for some time. Returns the events meanwhile, as "APP id: text"."""
        before = len(self.mission.console.lines)
        self.mission.cfe.sb.transmit_msg(bytes(packet), is_origination=False)
        self.mission.run_for(seconds)
        return [found[1] for line in self.mission.console.lines[before:] if (found := _EVENT.match(line))]

    def command(self, kind: Command, seconds: float = 0.2, /, **fields: Any) -> list[str]:
        """Send a command and run for some time. Returns the events meanwhile."""
        return self.send(kind.packet(fields), seconds)

    def answer(self, kind: Command, telemetry: Telemetry, /, **fields: Any) -> dict[str, Any]:
        """Send a command or request. Returns the fields of the one packet that answers it."""
        sb = self.mission.cfe.sb
        pipe = sb.create_pipe(4, "GROUND_PIPE")
        sb.subscribe(telemetry.msg_id, pipe)
        self.send(kind.packet(fields))
        packet = sb.receive_buffer(pipe, 0)
        sb.delete_pipe(pipe)
        assert packet is not None
        assert len(packet) == telemetry.length
        return telemetry.read(packet)

    def file(self, path: str) -> bytes:
        """Bring a file down."""
        return self.mission.files.read_file(path)

    def lines(self, start: str) -> list[str]:
        """Console lines that begin so, after their time stamp if they have one."""
        bare = (re.sub(r"^\d{4}-\d{3}-\S+ ", "", line) for line in self.mission.console.lines)
        return [line for line in bare if line.startswith(start)]
