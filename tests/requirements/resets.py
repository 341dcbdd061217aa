"""A mission for resets: a library, an application, and code that requests resets, with the resulting telemetry."""

from __future__ import annotations

from pathlib import Path

from cfepy.es import packets as pk
from cfepy.mission import Mission
from cfepy.psp.psp import RST_TYPE_POWERON, RST_TYPE_PROCESSOR
from cfepy.writing.console import Console
from tests.mission.flights import write_mission
from tests.requirements.ground import Ground

PROCESSOR, POWERON = RST_TYPE_PROCESSOR, RST_TYPE_POWERON
STARTUP = """
    CFE_LIB, tools, tools_init, TOOLS, 0, 0, 0x0, 0;
    CFE_APP, looper, looper_main, LOOPER, 50, 16384, 0x0, 0;
    !
"""
SOURCES = {
    "tools": """
        def tools_init(cfe):
            cfe.os.printf("TOOLS ready")
            return 0
    """,
    "looper": """
        def looper_main(cfe):
            cfe.os.printf("LOOPER starts")
            while cfe.es.run_loop():
                cfe.os.task_delay(100)
    """,
    "resets": """
        def resets_main(cfe):
            cfe.es.reset_cfe(1)
            cfe.os.printf("came back from a reset")
    """,
    "powers": """
        def powers_main(cfe):
            cfe.es.reset_cfe(2)
            cfe.os.printf("came back from a reset")
    """,
    "broken": """
        def broken_main(cfe):
            cfe.es.run_loop()
            raise ValueError("always")
    """,
}


def booted(folder: Path) -> Mission:
    """Return the mission, operational."""
    mission = Mission(write_mission(folder, STARTUP, **SOURCES), console=Console(quiet=True))
    mission.run_for(2)
    return mission


def housekeeping(ground: Ground) -> dict[str, int]:
    """Return the housekeeping packet of Executive Services."""
    return ground.answer(pk.SEND_HK, pk.HK_TLM)


def reset(ground: Ground, kind: int) -> None:
    """Reset the processor by command, and wait until it is up again."""
    ground.command(pk.RESTART, 3, RestartType=kind)


def causes(ground: Ground) -> list[tuple[int, int, str]]:
    """Return the entries of the exception and reset log: type, subtype, description."""
    slots = ground.mission.cfe.es.reset.er_log.slots
    return [(entry.reset_type, entry.reset_subtype, entry.description) for entry in slots if entry is not None]
