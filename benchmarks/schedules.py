"""Exploring: schedules of missions/capture per second of CPU time, in this process and forked.

It measures CPU time instead of wall time, because exploring keeps every CPU busy: each CPU runs that many.
"""

from __future__ import annotations

import os
from contextlib import closing

from cfepy.extra.exploration.fork_server import ForkServer, LateSchedule
from cfepy.mission import Mission, read_mission
from cfepy.schedules import Schedule
from cfepy.writing.console import Console

COUNT = 100
SHORT_S = 0.2  # of virtual time
BOOTED = Schedule.parse("at:from=600ms")  # when the mission is OPERATIONAL, and its nodes have begun


def from_power_on(context: str, seconds: float) -> float:
    """Return schedules per CPU second, each from power-on to its end and the end of its nodes."""
    spec = read_mission("capture")
    begin = _cpu_s()
    for seed in range(COUNT):
        with Mission(spec, console=_quiet(), tasks=context, policy=Schedule("random", seed).policy()) as flight:
            flight.run_for(seconds)
    return COUNT / (_cpu_s() - begin)


def forked() -> float:
    """Return schedules per CPU second, of the first 0.2 s after the boot, which is the same for all and done once."""
    spec = read_mission("capture")

    def fly(schedule: LateSchedule) -> str:
        with Mission(spec, console=_quiet(), tasks="greenlet", policy=schedule.policy()) as flight:
            flight.run_for(BOOTED.from_ns / 1e9 + SHORT_S)
            return flight.trace.digest()

    begin = _cpu_s()
    with closing(ForkServer(fly, BOOTED)) as server:  # the CPU time of its processes is known after it is closed
        digests = {server.run(Schedule("random", seed, from_ns=BOOTED.from_ns)) for seed in range(COUNT)}
    seconds = _cpu_s() - begin
    if len(digests) != COUNT:
        raise RuntimeError(f"{COUNT} schedules gave {len(digests)} different runs")
    return COUNT / seconds


def schedules(contexts: tuple[str, ...]) -> dict[str, float]:
    """Return figures by name, in schedules per CPU second."""
    figures: dict[str, float] = {}
    for context in contexts:
        figures[f"power_on_to_0.2_s.{context}"] = from_power_on(context, SHORT_S)
        figures[f"power_on_to_0.8_s.{context}"] = from_power_on(context, BOOTED.from_ns / 1e9 + SHORT_S)
    if "greenlet" in contexts:
        figures["forked_at_0.6_s_to_0.8_s"] = forked()
    return figures


def _cpu_s() -> float:
    """Return the CPU time of this process and of its children that have ended."""
    return sum(os.times()[:4])


def _quiet() -> Console:
    return Console(quiet=True)
