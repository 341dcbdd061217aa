"""A running mission and an operator, with commands, telemetry, and an application that calls the API.

The mission has the application PROBE, as which a test calls services and listens on the bus, and MUTE, which
never registered for events.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from cfepy.app import Cfe
from cfepy.evs import packets as evs_packets
from cfepy.mission import Mission
from cfepy.msg import Command, Telemetry, get_msg_id
from cfepy.writing.console import Console
from tests.mission.flights import write_mission

Result = TypeVar("Result")
GROUND_PRIORITY, PROBE_PRIORITY, LISTENER_PRIORITY = 10, 100, 1
RESTART = Command("CFE_ES_RESTART", 0x1806, 2)
PROCESSOR_RESET, POWERON_RESET = b"\1\0", b"\2\0"
BOOT_S = 3.25

STARTUP = """\
CFE_APP, probe, main, PROBE, 60, 16384, 0x0, 0;
CFE_APP, mute,  main, MUTE,  60, 16384, 0x0, 0;
"""
PROBE = """
    def main(cfe):
        cfe.evs.register()
        while cfe.es.run_loop():
            cfe.os.task_delay(1000)
"""
MUTE = """
    def main(cfe):
        while cfe.es.run_loop():
            cfe.os.task_delay(1000)
"""


class Event(NamedTuple):
    """A long event."""

    app: str
    event_id: int
    event_type: int
    text: str


class Flight:
    """A mission that has booted, on a board whose limits a test may change.

    Args:
        folder: folder for the mission's files.
        listen: MsgIds of telemetry and other messages to record, in addition to events.
        startup: further lines of the startup script.
        sources: further code of the mission, by stem.
        tables: table files by name.
        cfe_version: the release of cFE; most recordings for the tests are from 7.0.0.
        limits: limits of the board.
    """

    def __init__(
        self,
        folder: Path,
        *listen: int,
        startup: str = "",
        sources: dict[str, str] | None = None,
        tables: dict[str, bytes] | None = None,
        cfe_version: str = "7.0.0",
        **limits: int | bool,
    ) -> None:
        self._listen = (evs_packets.LONG_EVENT_MSG_MID, *listen)
        self.packets: list[bytes] = []
        mission = {"mission_yaml": f'cfe_version: "{cfe_version}"', **(sources or {})}
        path = write_mission(folder, STARTUP + startup, probe=PROBE, mute=MUTE, **mission)
        for name, data in (tables or {}).items():
            (folder / name).write_bytes(data)
        board = folder / "board.yaml"
        lines = [f"  {name}: {str(value).lower()}\n" for name, value in limits.items()]
        board.write_text("name: bench\n" + ("limits:\n" + "".join(lines) if lines else ""), encoding="utf-8")
        self.mission = Mission(path, board=str(board), console=Console(quiet=True))
        self._boot()

    def _boot(self) -> None:
        self.mission.run_for(BOOT_S)
        ready: list[bool] = []
        self._spawn("listener", lambda: self._note(ready), LISTENER_PRIORITY)
        self.run_for(0)
        assert ready
        self.packets.clear()

    def _note(self, ready: list[bool]) -> None:
        sb = self.cfe.sb
        pipe = sb.create_pipe(50, "GROUND")
        for msg_id in self._listen:
            sb.subscribe_ex(msg_id, pipe, 0, 50)
        ready.append(True)
        while True:
            packet = sb.receive_buffer(pipe, -1)
            if packet is not None:
                self.packets.append(bytes(packet))

    def _spawn(self, name: str, function: Callable[[], object], priority: int, app: str = "PROBE") -> None:
        owner = next(record for record in self.cfe.es.apps if record.name == app)
        self.mission.kernel.spawn(name, function, priority, owner)

    @property
    def cfe(self) -> Cfe:
        """The services that run now."""
        return self.mission.cfe

    def run_for(self, seconds: float) -> None:
        """Run for a virtual time; zero is a moment."""
        self.mission.run_for(seconds or 0.001)

    def call(self, function: Callable[[], Result], app: str = "PROBE") -> Result:
        """Return a function's result, or raise its exception, as called by an application."""
        results: list[Result] = []
        errors: list[Exception] = []

        def call() -> None:
            try:
                results.append(function())
            except Exception as error:
                errors.append(error)

        self._spawn("caller", call, PROBE_PRIORITY, app)
        self.run_for(0)
        if errors:
            raise errors[0]
        return results[0]

    def transmit(self, packet: bytes) -> None:
        """Put a packet onto the bus, as a link to the ground or to another processor does."""
        self.mission.kernel.spawn("ground", partial(self.cfe.sb.transmit_msg, packet, False), GROUND_PRIORITY)
        self.run_for(0)

    def send(self, command: Command, **fields: Any) -> list[Event]:
        """Send a command. Returns its immediate events."""
        self.packets.clear()
        self.transmit(command.packet(fields))
        return self.events()

    def events(self) -> list[Event]:
        """Return the long events since the last command."""
        return [
            Event(packet_id["AppName"], packet_id["EventID"], packet_id["EventType"], fields["Message"])
            for fields in self.all(evs_packets.LONG_EVENT_MSG)
            for packet_id in [fields["PacketID"]]
        ]

    def all(self, telemetry: Telemetry | Command) -> list[dict[str, Any]]:
        """Return the fields of every packet of a kind since the last command."""
        return [telemetry.read(packet) for packet in self.packets if get_msg_id(packet) == telemetry.msg_id]

    def ask(self, command: Command, telemetry: Telemetry) -> dict[str, Any]:
        """Send a command and read the telemetry that answers it."""
        self.send(command)
        return self.all(telemetry)[-1]

    def reset(self, kind: bytes) -> None:
        """Reset the processor by command, and wait until the mission is up again."""
        packet = bytearray(RESTART.packet() + kind)
        packet[4:6] = (len(packet) - 7).to_bytes(2, "big")
        before = len(self.mission.record.resets)
        self.mission.kernel.spawn("ground", partial(self.cfe.sb.transmit_msg, bytes(packet), False), GROUND_PRIORITY)
        self._boot()
        assert len(self.mission.record.resets) == before + 1
