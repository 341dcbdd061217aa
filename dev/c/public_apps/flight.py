"""A flight of one application: it boots, and every MsgId of its command pipes gets the command with code 0.

That command is NOOP in applications of cFS, or a request for housekeeping.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from cfepy.es import StartupEntry, entries
from cfepy.evs.packets import LONG_EVENT_MSG_MID
from cfepy.mission import Mission, PacketWatch, Seen
from cfepy.mission.host_actions import PACKET
from cfepy.msg import command
from cfepy.writing.console import Console

BOOT_S, ANSWER_S = 10, 3
COMMAND_BIT = 0x1000
LONGEST_S = 120  # of wall time, for a run that hangs
SCRIPT = "startup.scr"


class Flown(NamedTuple):
    """The result of a flight.

    Attributes:
        runs: whether the application still ran at the end, without a reset of the processor.
        answers: events or telemetry that it sent in answer to commands.
        reason: the console's first line about a failure; empty if there is none.
    """

    runs: bool
    answers: tuple[str, ...]
    reason: str


def fly(folder: Path) -> Flown:
    """Fly the last application of a mission folder in a process of its own."""
    try:
        done = subprocess.run(
            [sys.executable, "-m", "dev.c.public_apps", "fly", str(folder)],
            capture_output=True,
            text=True,
            timeout=LONGEST_S,
        )
    except subprocess.TimeoutExpired:
        return Flown(False, (), f"the run took more than {LONGEST_S} s")
    lines = done.stdout.splitlines()
    if done.returncode or not lines:
        return Flown(False, (), (done.stderr.strip().splitlines() or ["the run ended without a result"])[-1][:200])
    found = json.loads(lines[-1])
    return Flown(found["runs"], tuple(found["answers"]), found["reason"])


def flown(folder: Path) -> Flown:
    """Fly the last application of a mission folder in this process."""
    entry = entries((folder / SCRIPT).read_bytes())[-1]
    sent: list[Seen] = []
    telemetry = PacketWatch(sent.append, lambda msg_id: not msg_id & COMMAND_BIT and msg_id != LONG_EVENT_MSG_MID)
    with Mission(str(folder), console=Console(quiet=True), attachments=[telemetry]) as mission:
        mission.run_for(BOOT_S)
        wanted = [each for each in subscribed_to(mission.cfe.sb, entry.name) if each & COMMAND_BIT]
        lines, packets = len(mission.console.lines), len(sent)
        for msg_id in wanted:
            mission.outside.act(PACKET, bytes(command(msg_id, 0)))
            mission.run_for(ANSWER_S / len(wanted))
        answers = list(_events(mission.console.lines[lines:], entry.name))
        answers += [
            f"telemetry 0x{each.msg_id:04X}, {len(each.packet)} bytes"
            for each in sent[packets:]
            if each.sender == entry.name
        ]
        is_there = any(each.name == entry.name for each in mission.cfe.es.apps)
        reason = next((each for each in mission.console.lines if _is_failure(each, entry)), "")
        return Flown(is_there and not mission.record.resets, tuple(dict.fromkeys(answers))[:5], reason)


def subscribed_to(bus: Any, app: str) -> list[int]:
    """Return the MsgIds that an application subscribes to."""
    ids: list[int] = []
    bus.routing.for_each_route_id(ids.append)
    routes = [bus.routing.route(each) for each in ids]
    return [each.msg_id for each in routes if any(one.pipe.app_name == app for one in each.destinations)]


def _events(lines: Sequence[str], app: str) -> Iterator[str]:
    for each in lines:
        if found := re.search(rf"/{re.escape(app)} (\d+: .*)", each):
            yield f"event {found[1]}"


_FAILURE = re.compile("CFault|fault at|cannot be loaded|Error loading|Could not|could not|not found|Exit|exit")


def _is_failure(line: str, entry: StartupEntry) -> bool:
    names_it = entry.name in line or entry.file.rpartition("/")[2] in line or "CFault" in line
    return names_it and _FAILURE.search(line) is not None
