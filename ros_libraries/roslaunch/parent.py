"""`ROSLaunchParent`: launch files from a program (roslaunch.parent)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import rospy

from roslaunch import _processes  # type: ignore[attr-defined]  # made for the node, by the mission
from roslaunch.core import RLException
from roslaunch.pmon import Process

LOOK_S = 0.1


class ROSLaunchParent:
    """Starts the nodes of launch files, and ends them together.

    Args:
        run_id: accepted.
        roslaunch_files: paths, or pairs of a path and its arguments as `name:=value`.
        more, options: roslaunch's further arguments; accepted.
    """

    def __init__(self, run_id: str | None, roslaunch_files: Sequence[Any], *more: Any, **options: Any) -> None:
        self.run_id = run_id
        self.roslaunch_files = list(roslaunch_files)
        self.processes: list[Process] = []

    def start(self, auto_terminate: bool = True) -> None:
        """Start all nodes.

        Raises:
            RLException: a launch file is wrong.
        """
        for each in self.roslaunch_files:
            file, args = (each, ()) if isinstance(each, str) else each
            try:
                apps = _processes.start_file(file, list(args))
            except ValueError as error:
                raise RLException(str(error)) from error
            self.processes += [Process(app, app) for app in apps]

    def shutdown(self) -> None:
        """End all nodes that were started."""
        for process in self.processes:
            if process.is_alive():
                process.stop()
        self.processes = []

    def spin(self) -> None:
        """Wait until all nodes have ended, or this one is to end."""
        while self.processes and not rospy.is_shutdown() and any(each.is_alive() for each in self.processes):
            rospy.sleep(LOOK_S)

    def spin_once(self) -> None:
        """Let some time go by."""
        rospy.sleep(LOOK_S)
