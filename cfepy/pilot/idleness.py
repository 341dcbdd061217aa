"""Nodes of a run that do nothing, as its results name them: shut down by another node with the same name.

This is no problem of the run, because ROS does the same. But the report of a run, or a failed test, shows only that
messages are missing.
"""

from __future__ import annotations

from cfepy.mission import Mission


def idle_nodes(mission: Mission) -> list[str]:
    """Return a line for each idle node of a mission that still flies; empty without ROS nodes."""
    if mission.ros is None:
        return []
    return [
        f"{name}: the node of {former} was shut down when the node of {new} took its name; "
        "give one of them another name"
        for name, former, new in mission.ros.graph.displaced
        if former != new  # an application that starts its node again
    ]
