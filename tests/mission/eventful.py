"""A flight with many events, for tests of determinism: `python eventful.py MISSION TASKS PIECES SCHEDULE` prints its
digest.

It has traffic on the ground link, commands on the bus, a processor reset by command and a power-on reset by the host.
"""

from __future__ import annotations

import sys

from apps.to_lab import packets as to_lab
from cfepy import msg
from cfepy.ground.link import GroundLink
from cfepy.mission import Mission
from cfepy.psp.psp import RST_TYPE_POWERON, RST_TYPE_PROCESSOR
from cfepy.rtos import SeededRandom
from cfepy.writing.console import Console

ES_CMD = 0x1806
RESTART, NOOP = 2, 0


def fly(name: str, tasks: str, pieces: int, schedule: int | None) -> str:
    """Fly a mission with these options.

    Args:
        name: name of the mission.
        tasks: "thread" or "greenlet".
        pieces: number of pieces of each leg of the run.
        schedule: seed of a random order among equals; None for first come, first served.
    """
    policy = None if schedule is None else SeededRandom(schedule)
    with (
        Mission(name, console=Console(quiet=True), tasks=tasks, policy=policy) as mission,
        GroundLink(mission) as ground,
    ):
        _leg(mission, 900, pieces)
        ground.send(to_lab.OUTPUT_ENABLE.packet(dest_IP="127.0.0.1"))
        for code in range(12):
            ground.send(bytes(msg.command(ES_CMD, code * 2 + 9, bytes(code))))
            mission.cfe.sb.transmit_msg(bytes(msg.command(ES_CMD, NOOP)))
        _leg(mission, 1_500, pieces)
        mission.cfe.sb.transmit_msg(bytes(msg.command(ES_CMD, RESTART, bytes([RST_TYPE_PROCESSOR, 0]))))
        _leg(mission, 700, pieces)
        mission.processor.psp.restart(RST_TYPE_POWERON, "the test wants it")
        _leg(mission, 800, pieces)
        down = len(ground.received())
        mission.shut_down_nodes()
        return f"{mission.trace.digest()} {mission.kernel.now} {len(mission.record.resets)} {down}"


def _leg(mission: Mission, duration_ms: int, pieces: int) -> None:
    start = mission.kernel.now
    for number in range(1, pieces + 1):
        mission.run_until(start + duration_ms * 1_000_000 * number // pieces)


if __name__ == "__main__":
    asked = sys.argv[1:]
    print(fly(asked[0], asked[1], int(asked[2]), int(asked[3]) if asked[3:] else None))
