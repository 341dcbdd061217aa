"""A session with the real cFE, flown again: the same applications, and the same commands at the same instants over UDP."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from cfepy import msg
from cfepy.console import Console
from cfepy.mission import Mission
from cfepy.mission.ground import GroundLink
from cfepy.rtos.units import NS_PER_S
from tests.mission.flights import write_mission

DATA = Path(__file__).parents[1] / "data"
STARTUP = """
    CFE_LIB, cfe_assert, CFE_Assert_LibInit, ASSERT_LIB, 0, 0, 0x0, 0;
    CFE_LIB, sample_lib, SAMPLE_LIB_Init, SAMPLE_LIB, 0, 0, 0x0, 0;
    CFE_APP, sample_app, SAMPLE_APP_Main, SAMPLE_APP, 50, 16384, 0x0, 0;
    CFE_APP, ci_lab, CI_LAB_AppMain, CI_LAB, 60, 16384, 0x0, 0;
    CFE_APP, to_lab, TO_LAB_AppMain, TO_LAB, 70, 16384, 0x0, 0;
    CFE_APP, sch_lab, SCH_LAB_AppMain, SCH_LAB, 120, 16384, 0x0, 0;
    CFE_APP, hk, HK_AppMain, HK, 90, 16384, 0x0, 0;
    !
"""
CFE_ASSERT = """
    def CFE_Assert_LibInit(cfe):
        cfe.es.write_to_sys_log("[BEGIN] CFE FUNCTIONAL TEST")
        cfe.es.write_to_sys_log("[BEGIN] 01 CFE-STARTUP")
        return 0
"""
CLOCK_STEP_S = 0.39999999999999997  # by which the recorded spacecraft clock stepped back at its first tone; ours never steps


EXTRA = {} if (Path(__file__).parents[2] / "apps" / "sample_app").exists() else {"sample_app": "from cfepy.apps.sample import *\n"}


class Session(NamedTuple):
    """The packets that came down, and what is on the RAM disk at the end."""

    telemetry: list[bytes]
    files: dict[str, bytes]


def commands() -> list[dict[str, Any]]:
    """The recorded commands: what, when in s, bytes, events."""
    found: list[dict[str, Any]] = json.loads((DATA / "command_events.json").read_text())
    return found


def recorded_telemetry() -> list[dict[str, Any]]:
    """The recorded packets: name, MsgId, bytes."""
    found: list[dict[str, Any]] = json.loads((DATA / "golden_telemetry.json").read_text())
    return found


def instant(command: dict[str, Any]) -> int:
    """Virtual ns at which a command was sent."""
    return round((command["at"] + CLOCK_STEP_S) * NS_PER_S)


@cache
def fly(folder: Path) -> Session:
    """Fly the session up to the processor reset with which it ended."""
    path = write_mission(folder, STARTUP, cfe_assert=CFE_ASSERT, **EXTRA)
    with Mission(path, console=Console(quiet=True)) as mission:
        ground = GroundLink(mission)
        for command in commands()[:-1]:
            mission.run_until(instant(command))
            ground.send(bytes.fromhex(command["hex"]))
        mission.run_until(instant(commands()[-1]))
        names = mission.files.list_dir("/ram")
        return Session(
            [packet for _, packet in ground.received()],
            {name: mission.files.read_file(f"/ram/{name}") for name in names},
        )


def by_msg_id(packets: list[bytes]) -> dict[int, list[bytes]]:
    """Packets in order, by MsgId."""
    found: dict[int, list[bytes]] = {}
    for packet in packets:
        found.setdefault(msg.get_msg_id(packet), []).append(packet)
    return found
