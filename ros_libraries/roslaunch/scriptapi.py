"""`ROSLaunch`: launches nodes one by one from a program (roslaunch.scriptapi)."""

from __future__ import annotations

from typing import Any

import rospy

from roslaunch import _processes  # type: ignore[attr-defined]  # made for the node, by the mission
from roslaunch.core import Node, RLException
from roslaunch.parent import ROSLaunchParent
from roslaunch.pmon import Process


class ROSLaunch:
    """Starts nodes, and ends them together."""

    def __init__(self) -> None:
        self.parent = ROSLaunchParent(None, [])
        self.started = False

    def load(self, f: str) -> None:
        """Have a launch file started with `start`."""
        self.parent.roslaunch_files.append(f)

    def start(self) -> None:
        """Start the loaded nodes. From now on, nodes can be launched."""
        self.parent.start()
        self.started = True

    def launch(self, node: Node) -> Process:
        """Start a node.

        Raises:
            RLException: `start` was not called, or the node cannot run here.
        """
        if not self.started:
            raise RLException("please start ROSLaunch first")
        if not isinstance(node, Node):
            raise ValueError("arg must be of type Node")
        try:
            app = _processes.start_node(node._fields())
        except ValueError as error:
            raise RLException(str(error)) from error
        process = Process(node.name or node.type, app)
        self.parent.processes.append(process)
        return process

    def stop(self) -> None:
        """End all nodes that were started."""
        self.parent.shutdown()

    def spin(self) -> None:
        """Wait until all nodes have ended."""
        self.parent.spin()

    def spin_once(self) -> Any:
        """Return whether a node still runs."""
        rospy.sleep(0.1)
        return any(process.is_alive() for process in self.parent.processes)
