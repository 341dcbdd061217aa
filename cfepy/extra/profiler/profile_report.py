"""The tables of a profile at the end of a report, with the time of task switches.

The switches of greenlets are quicker than of threads, so the report names the gain.
"""

from __future__ import annotations

from time import perf_counter_ns

from cfepy.cli.text_table import Table
from cfepy.extra.profiler.flame_files import NO_APP, OUTSIDE, SWITCHES
from cfepy.extra.profiler.run_profile import RunProfile
from cfepy.extra.profiler.task_times import HOST, TaskTimes
from cfepy.mission import Mission
from cfepy.pilot import Flown
from cfepy.units import NS_PER_S

MOST_ROWS = 12
TURNS = 2000
FAST = "pip install 'cfepy[fast]'"


def profile_tables(profile: RunProfile, flown: Flown) -> list[Table]:
    """Return the tables: applications and nodes, callbacks, and services and libraries."""
    results = flown.results
    wall_ns = max(profile.times.wall_ns, 1)
    apps = Table("Wall time of applications", ("application", "node", "wall, s", "share"), right=(2, 3), least=(1,))
    names = _node_names(flown.mission)
    rows = [(app or NO_APP, names.get(app, ""), spent_ns) for app, spent_ns in profile.apps().items()]
    rows += [(SWITCHES, "", profile.times.switch_ns), (OUTSIDE, "", profile.times.times.get(HOST, 0))]
    for app, node, spent_ns in rows:
        apps.add(app, node, *_spent(spent_ns, wall_ns))
    callbacks = Table(
        "Wall time of callbacks and main functions",
        ("application", "function", "place", "wall, s", "share"),
        right=(3, 4),
        least=(2,),
    )
    for row in profile.callbacks()[:MOST_ROWS]:
        callbacks.add(row.app or NO_APP, row.function, row.place, *_spent(row.wall_ns, wall_ns))
    owners = Table("Wall time of services and libraries", ("code", "wall, s", "share"), right=(1, 2))
    for owner, spent in list(profile.owners().items())[:MOST_ROWS]:
        owners.add(owner, *_spent(spent, wall_ns))
    virtual_ns = round(results.virtual_s * NS_PER_S)
    greenlet_ns = greenlet_switch_ns() if results.tasks == "thread" else None
    owners.note = " ".join(
        (
            _samples(profile, results.tasks),
            f"With the profiler, the mission flew {virtual_ns / wall_ns:.1f} x real time.",
            advice(profile.times, results.tasks, virtual_ns, greenlet_ns),
        )
    )
    return [apps, callbacks, owners] if callbacks.rows else [apps, owners]


def _samples(profile: RunProfile, tasks: str) -> str:
    """Return the sentence about the samples of the last two tables."""
    if tasks != "thread":
        return f"The last two tables come from {profile.samples:,} samples of stacks."
    turns = f"{profile.samples:,} of {sum(profile.times.turns.values()):,} turns of tasks"
    return f"The last two tables come from the calls in {turns}, where short calls look longer than they are."


def _spent(spent_ns: float, wall_ns: int) -> tuple[str, str]:
    return f"{spent_ns / NS_PER_S:.3f}", f"{spent_ns / wall_ns:.1%}"


def _node_names(mission: Mission) -> dict[str, str]:
    """Return the full names of the nodes by application."""
    ros = mission.ros
    if ros is None:
        return {}
    ended = {app: f"/{end.name.lstrip('/')}" for app, end in ros.ended.items()}
    return ended | {node.config.app: name for name, node in ros.graph.nodes.items()}


# -- task switches -----------------------------------------------------------------------------------------------------


def greenlet_switch_ns() -> float | None:
    """Return the measured time of a switch between two greenlets; None if greenlet is not installed."""
    try:
        from greenlet import greenlet
    except ImportError:
        return None

    def answer() -> None:
        while True:
            first.switch()

    def ask() -> float:
        second.switch()
        begun = perf_counter_ns()
        for _ in range(TURNS):
            second.switch()
        return (perf_counter_ns() - begun) / (2 * TURNS)

    first, second = greenlet(ask), greenlet(answer)
    measured: float = first.switch()
    return measured


def advice(times: TaskTimes, tasks: str, virtual_ns: int, greenlet_ns: float | None) -> str:
    """Return the sentences about the switches of a run.

    Args:
        times: the measured times.
        tasks: "thread" or "greenlet".
        virtual_ns: virtual time of the run.
        greenlet_ns: time of a switch between greenlets; None if greenlet is not installed.
    """
    wall_ns, count = times.wall_ns or 1, max(times.switches, 1)
    each_us = times.switch_ns / count / 1000
    text = f"{times.switches:,} task switches took {times.switch_ns / wall_ns:.0%} of the time, {each_us:.1f} us each."
    if tasks != "thread":
        return f"{text} Tasks were greenlets."
    text += " Tasks were threads."
    if greenlet_ns is None:
        most = virtual_ns / max(wall_ns - times.switch_ns, 1)
        return f"{text} Greenlets ({FAST}) would save most of that: at most {most:.1f} x real time."
    saved_ns = max(times.switch_ns - round(count * greenlet_ns), 0)
    speed = virtual_ns / max(wall_ns - saved_ns, 1)
    each = f"a switch of greenlets takes {greenlet_ns / 1000:.1f} us here"
    return f"{text} With --tasks greenlet it would fly about {speed:.1f} x real time: {each}."
