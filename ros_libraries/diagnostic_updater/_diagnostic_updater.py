"""Diagnostic tasks, and `Updater`, which runs a node's tasks and publishes their results."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import rospy
from diagnostic_msgs.msg import DiagnosticArray

from ._diagnostic_status_wrapper import ERROR, OK, DiagnosticStatusWrapper

Run = Callable[[Any], Any]
"""Fills in a DiagnosticStatusWrapper and returns it."""

_PERIOD_CHECK_S = 0.25
_NO_HARDWARE_ID = (
    "diagnostic_updater: No HW_ID was set. This is probably a bug. Please report it. For devices that do not have a"
    " HW_ID, set this value to 'none'. This warning only occurs once all diagnostics are OK so it is okay to wait until"
    " the device is open before calling setHardwareID."
)


class DiagnosticTask:
    """Base of all tasks."""

    def __init__(self, name: str) -> None:
        self.name = name

    def getName(self) -> str:
        """Return the task's name."""
        return self.name

    def run(self, stat: Any) -> Any:
        """Fill in a status and return it. Override this method."""
        return stat


class FunctionDiagnosticTask(DiagnosticTask):
    """A task that is a function."""

    def __init__(self, name: str, fn: Run) -> None:
        super().__init__(name)
        self.fn = fn

    def run(self, stat: Any) -> Any:
        """Call the function."""
        return self.fn(stat)


class CompositeDiagnosticTask(DiagnosticTask):
    """Several tasks that make one status: all values, the worst level, the messages as `mergeSummary` joins them."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.tasks: list[DiagnosticTask] = []

    def addTask(self, t: DiagnosticTask) -> None:
        """Add a task."""
        self.tasks.append(t)

    def run(self, stat: Any) -> Any:
        """Run the tasks in order. Each begins with the summary that was passed in."""
        combined, original = DiagnosticStatusWrapper(), DiagnosticStatusWrapper()
        original.summary(stat)
        for task in self.tasks:
            stat.summary(original)
            stat = task.run(stat)
            combined.mergeSummary(stat)
        stat.summary(combined)
        return stat


class DiagnosticTaskVector:
    """A list of tasks to which others may be added while it is in use."""

    class DiagnosticTaskInternal:
        """A task as it stands in the list."""

        def __init__(self, name: str, fn: Run) -> None:
            self.name, self.fn = name, fn

        def run(self, stat: Any) -> Any:
            """Run the task on a status that has its name."""
            stat.name = self.name
            return self.fn(stat)

    def __init__(self) -> None:
        self.tasks: list[DiagnosticTaskVector.DiagnosticTaskInternal] = []
        self.lock = threading.Lock()

    def addedTaskCallback(self, task: DiagnosticTaskInternal) -> None:
        """Handle a new task. Override this method."""

    def add(self, *args: Any) -> None:
        """Add a task: `add(task)` or `add(name, function)`."""
        name, run = args if len(args) == 2 else (args[0].getName(), args[0].run)
        task = self.DiagnosticTaskInternal(name, run)
        with self.lock:
            self.tasks.append(task)
            self.addedTaskCallback(task)

    def removeByName(self, name: str) -> bool:
        """Remove the first task with a name. Returns whether there was one."""
        with self.lock:
            for index, task in enumerate(self.tasks):
                if task.name == name:
                    del self.tasks[index]
                    return True
        return False


class Updater(DiagnosticTaskVector):
    """Runs tasks every `~diagnostic_period` seconds (1 by default) and publishes on /diagnostics."""

    def __init__(self) -> None:
        super().__init__()
        self.publisher = rospy.Publisher("/diagnostics", DiagnosticArray, queue_size=10)
        self.last_time = rospy.Time.now()
        self.last_time_period_checked = self.last_time
        self.period: float = 1
        self.verbose = False
        self.hwid = ""
        self.warn_nohwid_done = False

    def update(self) -> None:
        """Run the tasks if it is time to. Call this often."""
        self._check_diagnostic_period()
        if rospy.Time.now() >= self.last_time + rospy.Duration(self.period):
            self.force_update()

    def force_update(self) -> None:
        """Run the tasks now."""
        self.last_time = rospy.Time.now()
        with self.lock:
            found = [self._status_of(task) for task in self.tasks]
        if not self.hwid and not self.warn_nohwid_done and not any(status.level for status in found):
            rospy.logwarn(_NO_HARDWARE_ID)
            self.warn_nohwid_done = True
        self.publish(found)

    def _status_of(self, task: DiagnosticTaskVector.DiagnosticTaskInternal) -> Any:
        status = DiagnosticStatusWrapper(name=task.name, hardware_id=self.hwid)
        status.summary(ERROR, "No message was set")
        task.run(status)
        if self.verbose and status.level:
            rospy.logwarn(
                f"Non-zero diagnostic status. Name: '{status.name}', status {status.level}: '{status.message}'"
            )
        return status

    def broadcast(self, lvl: int, msg: str) -> None:
        """Publish one level and message for all tasks, e.g. before the node ends."""
        found = []
        for task in self.tasks:
            status = DiagnosticStatusWrapper(name=task.name)
            status.summary(lvl, msg)
            found.append(status)
        self.publish(found)

    def setHardwareID(self, hwid: str) -> None:
        """Set the name of the device; "none" if there is none."""
        self.hwid = hwid

    def _check_diagnostic_period(self) -> None:
        now = rospy.Time.now()
        if now >= self.last_time_period_checked + rospy.Duration(_PERIOD_CHECK_S):
            self.period = rospy.get_param_cached("~diagnostic_period", 1)
            self.last_time_period_checked = now

    def publish(self, msg: Any) -> None:
        """Publish a status or a list of statuses. The node's name is put before each status's name."""
        found = msg if type(msg) is list else [msg]
        for status in found:
            status.name = f"{rospy.get_name()[1:]}: {status.name}"
        array = DiagnosticArray(status=found)
        array.header.stamp = rospy.Time.now()
        self.publisher.publish(array)

    def addedTaskCallback(self, task: DiagnosticTaskVector.DiagnosticTaskInternal) -> None:
        """Publish that a task has begun."""
        status = DiagnosticStatusWrapper(name=task.name)
        status.summary(OK, "Node starting up")
        self.publish(status)
