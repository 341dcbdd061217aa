"""Applications of a run that kept others from running: they used the CPU without waiting, at a higher priority.

This is no problem of the run, because NASA's cFE does the same with real-time priorities. But a report would otherwise
show only that the others did nothing.
"""

from __future__ import annotations

from cfepy.mission import Mission
from cfepy.reading.suggestions import listed
from cfepy.rtos import KeptBack, Task
from cfepy.units import NS_PER_S

LONG_NS = NS_PER_S
MOST_NAMED = 4


def starved_tasks(mission: Mission) -> list[str]:
    """Return a line for each application that kept tasks ready for a second or more without running."""
    kernel = mission.kernel
    kernel.look_at_ready()
    by_app: dict[str, list[KeptBack]] = {}
    for each in kernel.kept_back():
        if each.length_ns >= LONG_NS and each.task.owner is not each.by.owner:
            by_app.setdefault(_app_of(each.by), []).append(each)
    return [_line(mission, app, found) for app, found in by_app.items()]


def _line(mission: Mission, app: str, found: list[KeptBack]) -> str:
    found.sort(key=lambda each: -each.length_ns)
    names = [f"{each.task.name} ({each.length_ns / NS_PER_S:.1f} s)" for each in found[:MOST_NAMED]]
    if len(found) > MOST_NAMED:
        names.append(f"{len(found) - MOST_NAMED} more")
    now = max(1, mission.kernel.now)
    used = sum(task.cpu_ns for task in mission.kernel.tasks if _app_of(task) == app)
    return (
        f"{app} used {used / now:.0%} of the CPU, and kept tasks of less urgent priority ready without running: "
        f"{listed(names, 'and')}; let it wait, lower its priority, or set `scheduling: fair` in the mission file"
    )


def _app_of(task: Task) -> str:
    return task.name if task.owner is None else str(task.owner.name)
