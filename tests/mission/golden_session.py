"""A session with the real cFE, flown again: the same applications, and the same commands at the same instants."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from cfepy import msg
from cfepy.ground.link import GroundLink
from cfepy.mission import Mission
from cfepy.units import NS_PER_S
from cfepy.writing.console import Console
from tests.mission.flights import write_mission

DATA = Path(__file__).parents[1] / "data"
STARTUP = """
    CFE_LIB, cfe_assert, CFE_Assert_LibInit, ASSERT_LIB, 0, 0, 0x0, 0;
    CFE_LIB, sample_lib, SAMPLE_LIB_Init, SAMPLE_LIB, 0, 0, 0x0, 0;
    CFE_APP, sample_app, SAMPLE_APP_Main, SAMPLE_APP, 50, 16384, 0x0, 0;
    CFE_APP, ci_lab, CI_LAB_AppMain, CI_LAB, 60, 16384, 0x0, 0;
    CFE_APP, to_lab, TO_LAB_AppMain, TO_LAB, 70, 16384, 0x0, 0;
    CFE_APP, sch_lab, SCH_LAB_AppMain, SCH_LAB, 80, 16384, 0x0, 0;
    CFE_APP, hk, HK_AppMain, HK, 90, 16384, 0x0, 0;
    !
"""
CFE_ASSERT = """
    def CFE_Assert_LibInit(cfe):
        cfe.es.write_to_sys_log("[BEGIN] CFE FUNCTIONAL TEST")
        cfe.es.write_to_sys_log("[BEGIN] 01 CFE-STARTUP")
        return 0
"""
CLOCK_STEP_S = 0.85  # step back of the recorded spacecraft clock at its first tone; ours never steps
STAMP = re.compile(r"^EVS Port1 \S+ 66/1/")
UPLINK_LEAD_S = 0.45  # the record has the time of a command's effect; before, it waited for CI_LAB's next pass


class Session(NamedTuple):
    """The packets that came down, the lines of the event port after each command, and the RAM disk at the end."""

    telemetry: list[bytes]
    events: list[list[str]]
    files: dict[str, bytes]


def commands() -> list[dict[str, Any]]:
    """Return the recorded commands: name, time in s, bytes, events."""
    found: list[dict[str, Any]] = json.loads((DATA / "command_events.json").read_text(encoding="utf-8"))
    return found


def recorded_telemetry() -> list[dict[str, Any]]:
    """Return the recorded packets: name, MsgId, bytes."""
    found: list[dict[str, Any]] = json.loads((DATA / "golden_telemetry.json").read_text(encoding="utf-8"))
    return found


def instant(command: dict[str, Any]) -> int:
    """Return the virtual ns at which a command was sent."""
    return round((command["at"] + CLOCK_STEP_S - UPLINK_LEAD_S) * NS_PER_S)


@cache
def fly(folder: Path) -> Session:
    """Fly the session up to its final processor reset. The files are from shortly before."""
    path = write_mission(folder, STARTUP, cfe_assert=CFE_ASSERT, mission_yaml='cfe_version: "7.0.0"')
    (folder / "hk_cpy_tbl.tbl").write_bytes((DATA / "hk_cpy_tbl.tbl").read_bytes())  # NASA's, with its wrong offsets
    with Mission(path, console=Console(quiet=True)) as mission:
        ground, marks = GroundLink(mission), []
        for command in commands():
            mission.run_until(instant(command))
            marks.append(len(mission.console.lines))
            ground.send(bytes.fromhex(command["hex"]))
        files = {name: mission.files.read_file(f"/ram/{name}") for name in mission.files.list_dir("/ram")}
        while not mission.record.resets:
            mission.run_for(0.1)
        ends = [*marks[1:], len(mission.console.lines)]
        lines = [mission.console.lines[begin:end] for begin, end in zip(marks, ends, strict=True)]
        return Session([packet for _, packet in ground.received()], [list(events_in(each)) for each in lines], files)


def events_in(lines: list[str]) -> Iterator[str]:
    """Yield the lines of the event port, without their stamps."""
    for line in lines:
        if STAMP.match(line):
            yield STAMP.sub("", line)


def by_msg_id(packets: list[bytes]) -> dict[int, list[bytes]]:
    """Packets in order, by MsgId."""
    found: dict[int, list[bytes]] = {}
    for packet in packets:
        found.setdefault(msg.get_msg_id(packet), []).append(packet)
    return found
