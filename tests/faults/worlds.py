"""Small missions for faults: applications that print the effects that they notice."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from cfepy.faults import FaultInjector, FaultPlan
from cfepy.mission import Mission
from cfepy.writing.console import Console
from tests.mission.flights import write_mission

STARTUP = """
    CFE_APP, source, source_main, SOURCE, 50, 16384, 0x0, 0;
    CFE_APP, taker,  taker_main,  TAKER,  60, 16384, 0x0, 0;
    CFE_APP, other,  taker_main,  OTHER,  70, 16384, 0x0, 0;
    !
"""
SOURCE = """
    from cfepy import msg
    from cfepy.msg import Command, Layout, Telemetry

    NUMBER_MID = 0x0883
    ORDER_MID = 0x1883
    NUMBER = Telemetry("NUMBER_TLM", NUMBER_MID, Layout("number", [("Value", "u32")]))
    ORDER = Command("ORDER_CMD", ORDER_MID, 3, Layout("order", [("Value", "u32")]))
    TELEMETRY = [NUMBER]
    COMMANDS = [ORDER]

    def source_main(cfe):
        cfe.evs.register()
        cfe.os.task_delay(1000)
        for number in range(1000):
            cfe.sb.transmit_msg(NUMBER.packet(Value=number))
            cfe.sb.transmit_msg(ORDER.packet(Value=number))
            cfe.es.run_loop()
            cfe.os.task_delay(100)
"""
TAKER = """
    from cfepy import msg
    from cfepy.app import CfeError

    def taker_main(cfe):
        name = cfe.es.get_app_name(cfe.es.get_app_id())
        pipe = cfe.sb.create_pipe(4, f"{name}_PIPE")
        cfe.sb.subscribe(0x0883, pipe)
        cfe.sb.subscribe(0x1883, pipe)
        cfe.es.run_loop()
        before = None
        while cfe.es.run_loop():
            packet = cfe.sb.receive_buffer(pipe)
            value = int.from_bytes(packet[-4:], "little")
            sequence = msg.get_sequence_count(packet)
            if packet[0] & 0x10:
                if not msg.validate_checksum(packet):
                    cfe.os.printf(f"{name} sees a bad checksum in order {value}")
                continue
            if before is not None and sequence != before + 1:
                cfe.os.printf(f"{name} got {sequence} after {before}")
            before = sequence
            cfe.os.printf(f"{name} takes {value} at {cfe.time.get_met().seconds}")
"""


def fly(
    folder: Path,
    *faults: dict[str, Any],
    seconds: float = 3.0,
    tasks: str = "thread",
    startup: str = STARTUP,
    seed: int = 0,
    board: str | None = None,
    **sources: str,
) -> Mission:
    """Fly the mission with some faults to its end. Its final state can be inspected."""
    path = write_mission(folder, startup, **({"source": SOURCE, "taker": TAKER, "other": TAKER} | sources))
    injector = FaultInjector(FaultPlan.from_dict({"faults": list(faults)}))
    console = Console(quiet=True)
    with Mission(path, seed=seed, board=board, tasks=tasks, console=console, attachments=[injector]) as mission:
        mission.run_for(seconds)
        mission.shut_down_nodes()
    return mission


def told(mission: Mission, start: str) -> list[str]:
    """Return the lines of an application."""
    return [line for line in mission.console.lines if line.startswith(start)]


def values(mission: Mission, app: str = "TAKER") -> list[int]:
    """Return the numbers that an application took."""
    return [int(line.split()[2]) for line in told(mission, f"{app} takes ")]


def row(mission: Mission, name: str) -> dict[str, Any]:
    """Return the report's row of a fault."""
    return next(each for each in mission.record.rows("faults") if each["name"] == name)
