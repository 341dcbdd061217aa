"""A ROS engineer's view of a run: the output of the nodes, and a report of topics and nodes.

`cfepy.cli.run.run.View` shows the flight computer below them, its console and its own messages.
"""

from __future__ import annotations

import re
import sys
from typing import Any

from cfepy.cli.display import Display
from cfepy.cli.run.report import faults, show_speed
from cfepy.cli.run.run import View
from cfepy.cli.text_table import Table, show_tables
from cfepy.mission import Mission
from cfepy.pilot import BOOT_S, ENDED, NOT_STARTED, Flown, Results

LOG_TOPIC = "/rosout"
_OF_NODES = re.compile(r"\[[\w/]+\] |launch: |cfepy fault ")  # prefixes of lines from nodes and about nodes
_STATES = {NOT_STARTED: "not started", ENDED: "ended"}


class NodesDisplay:
    """Shows the output of nodes, and nothing of the flight computer's console.

    Args:
        display: shows the remaining lines.
    """

    def __init__(self, display: Display) -> None:
        self._display = display
        self.tell = display.tell
        self.update = display.update
        self.close = display.close

    def line(self, text: str) -> None:
        """Show a line of the console if it is from a node."""
        if _OF_NODES.match(text):
            self._display.line(text)


class NodesView(View):
    """The view of the nodes; see `View`."""

    def display(self, seconds: float) -> Display:
        """Make the display of the nodes' output."""
        return NodesDisplay(super().display(seconds))

    def report(self, flown: Flown) -> None:
        """Print topics, nodes, and the line about speed."""
        results, mission = flown.results, flown.mission
        show_tables([_topics(results, mission), _nodes(results, mission), *faults(results)], sys.stdout)
        show_speed(results, sys.stdout)


def _topics(results: Results, mission: Mission) -> Table:
    table = Table("Topics", ("name", "messages", "Hz", "lost", "why"), right=(1, 2, 3))
    found = {topic.msg_id: topic for topic in results.topics}
    seconds = results.virtual_s - BOOT_S
    rows = {row.name: row for row in (*mission.record.topics.values(), *mission.processor.topics())}
    for _, row in sorted(rows.items()):
        topic = found.get(row.msg_id)
        if row.name == LOG_TOPIC and not row.subscribers:
            continue  # every node has it
        if topic is None or not topic.sent:
            table.add(row.name, 0, "0.0", 0, _missing(row))
        else:
            table.add(row.name, topic.sent, f"{topic.sent / seconds:.1f}", topic.dropped, topic.why)
    return table


def _missing(row: Any) -> str:
    """Explain why messages of a topic did not reach all nodes (`rospy_shim.graph.graph.TopicRow`)."""
    if not row.publishers:
        return "no publisher"
    if not row.subscribers:
        return "no subscriber"
    return f"{row.latched} latched" if row.latched else ""


def _nodes(results: Results, mission: Mission) -> Table:
    table = Table("Nodes", ("name", "state", "restarts"), right=(2,))
    states = {app.name: app.state for app in results.apps}
    restarts = {app.name: app.restarts for app in results.apps}
    monitor = None if mission.ros is None else mission.ros.monitor
    for app, node in mission.spec.ros.nodes.items():
        if monitor is not None and app in monitor.statuses and not node.respawn:
            state = f"ended, exit status {monitor.statuses[app]}"
        else:
            state = "not started" if states.get(app) == NOT_STARTED else "running"
        table.add(f"/{node.name}", state, 0 if monitor is None else monitor.restarts.get(app, 0))
    for app, program in mission.spec.built.items():
        state = _STATES.get(states.get(app, NOT_STARTED), "running")
        if monitor is not None and app in monitor.statuses and not program.node.respawn:
            state = f"ended, exit status {monitor.statuses[app]}"
        table.add(program.name, state, restarts.get(app, 0))
    return table
