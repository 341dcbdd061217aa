"""Nodes and tasks of a run that do nothing.

A node may be shut down by another node with the same name, or have a synchronizer that never calls back. A task may be
ready without running, because an application of higher priority uses the CPU without waiting.

This is no problem of the run, because ROS and NASA's cFE do the same. But the report of a run, or a failed test, shows
only that messages are missing.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from cfepy.mission import Mission
from cfepy.reading.suggestions import listed
from cfepy.rtos import KeptBack, Task
from cfepy.units import NS_PER_MS, NS_PER_S

MATCHES = "message_filters._match_record"
"""The module that records synchronizers; an original message_filters beside the node has none."""
LONG_NS = NS_PER_S
MOST_NAMED = 4
"""How long a task must be ready without running, in virtual ns, and how many tasks a line names."""


def idle_nodes(mission: Mission) -> list[str]:
    """Return a line for each idle node of a mission that still flies; empty without ROS nodes."""
    if mission.ros is None:
        return []
    graph = mission.ros.graph
    return [*_displaced(graph.displaced), *_unmatched(graph.nodes)]


def _displaced(found: list[tuple[str, str, str]]) -> Iterator[str]:
    for name, former, new in found:
        if former != new:  # an application may start its node again
            yield (
                f"{name}: the node of {former} was shut down when the node of {new} took its name; "
                "give one of them another name"
            )


def _unmatched(nodes: dict[str, Any]) -> Iterator[str]:
    """Yield a line for each synchronizer that got messages and never called back."""
    for name, node in nodes.items():
        module = node.universe.importer.modules.get(MATCHES)
        for record in () if module is None else module.records:
            why = _why_unmatched(record)
            if why:
                topics = listed(record.inputs, "and")
                yield f"{name}: the {record.kind} of {topics} never called back: {why}"


def _why_unmatched(record: Any) -> str:
    """Return why a synchronizer never called back; empty if it did, or got no messages."""
    if not any((*record.counts, *record.unstamped)):
        return ""  # the lines of topics say why
    if record.matches:
        return "" if record.has_callback else "it has no callback; call registerCallback"
    counts = list(zip(record.inputs, record.counts, record.unstamped, strict=True))
    unstamped = [topic for topic, count, without in counts if without and not count]
    if unstamped:
        return f"messages of {listed(unstamped, 'and')} have no header; set allow_headerless=True"
    silent = [topic for topic, count, _ in counts if not count]
    if silent:
        return f"no message came on {listed(silent, 'and')}"
    return _why_apart(record)


def _why_apart(record: Any) -> str:
    """Return why the messages of all inputs never matched."""
    apart, slop = record.late_ns, record.slop_ns
    if apart is None:
        return "the inputs never had messages at the same time"
    if apart < slop if slop is not None else apart == 0:
        size = record.queue_size
        return f"queue_size={size} is too small, so a message is dropped before its match comes; raise queue_size"
    differ = f"the stamps differ by {apart / NS_PER_MS:g} ms or more"
    if slop is None:
        return f"{differ}, but must be equal; copy the stamp, or use an ApproximateTimeSynchronizer"
    return f"{differ}, but must differ by less than slop={slop / NS_PER_S:g} s; raise slop"


def starved_tasks(mission: Mission) -> list[str]:
    """Return a line for each application that kept tasks ready for a second or more without running."""
    kernel = mission.kernel
    kernel.look_at_ready()
    by_app: dict[str, list[KeptBack]] = {}
    for each in kernel.kept_back():
        if each.length_ns >= LONG_NS and each.task.owner is not each.by.owner:
            by_app.setdefault(_app_of(each.by), []).append(each)
    return [_starving(mission, app, found) for app, found in by_app.items()]


def _starving(mission: Mission, app: str, found: list[KeptBack]) -> str:
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
