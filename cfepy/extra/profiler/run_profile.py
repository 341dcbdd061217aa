"""`RunProfile`: the times of tasks and the samples of stacks as one profile, whose stacks add up to the wall time.

The time of a task is exact. It is divided among the stacks that were seen in the task, by how often each was seen.
"""

from __future__ import annotations

import functools
import os
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import CodeType
from typing import NamedTuple

from cfepy.extra.profiler.task_times import HOST, Stack, TaskLabel, TaskTimes
from cfepy.interpreter.own_code import PACKAGE, is_library, is_own_code, is_shown, is_standard, source_file

MAIN = "(main code)"
"""The name of the code of a file outside of its functions."""

_OF_TASKS = ("cfepy/rtos/context.py", "cfepy/rtos/kernel.py", "cfepy/extra/profiler/task_times.py", "/threading.py")
"""Files of the functions around every task, which are left out of the stacks."""

SERVICES = {
    "sb": "SB, Software Bus",
    "es": "ES, Executive Services",
    "evs": "EVS, Event Services",
    "tbl": "TBL, Table Services",
    "time": "TIME, Time Services",
    "fs": "FS, File Services",
    "msg": "MSG, headers of packets",
    "osal": "OSAL",
    "psp": "PSP",
    "rtos": "kernel",
    "schedules": "kernel",
    "nodes": "modules of nodes",
    "mission": "mission",
}
"""Packages of cfepy as users know them."""

ROSPY = {"client": "rospy", "types": "messages of ROS", "graph": "graph of ROS"}
GENERATED = "generated code of messages"
STANDARD = "Python's standard library"
_ROOT = os.path.dirname(PACKAGE)


class ProfiledFunction(NamedTuple):
    """A function in a stack: its name, its file and its first line."""

    name: str
    file: str
    line: int

    @classmethod
    def of(cls, code: CodeType) -> ProfiledFunction:
        """Return the function of a code object."""
        name = MAIN if code.co_qualname == "<module>" else code.co_qualname
        return cls(name, source_file(code.co_filename), code.co_firstlineno)


class CallbackTime(NamedTuple):
    """The wall time of a function of the mission that cfepy called: a callback, a handler, a main function."""

    app: str
    function: str
    place: str
    wall_ns: float


@dataclass(slots=True)
class RunProfile:
    """The profile of a run; times are wall times in ns.

    Attributes:
        stacks: the time of each stack, by task.
        times: the exact times of the tasks.
        samples: number of samples of stacks, or of traced turns.
    """

    stacks: dict[TaskLabel, dict[Stack, float]]
    times: TaskTimes
    samples: int = 0
    _functions: dict[int, ProfiledFunction] = field(default_factory=dict)

    @classmethod
    def of(cls, times: TaskTimes, seen: Mapping[TaskLabel, Counter[Stack]], samples: int) -> RunProfile:
        """Return the profile of a run that has ended.

        Args:
            times: the times of its tasks.
            seen: the weight of each stack, by task.
            samples: number of samples.
        """
        stacks: dict[TaskLabel, dict[Stack, float]] = {}
        for label, wall_ns in times.times.items():
            if label == HOST:
                continue
            counts: Counter[Stack] = Counter()
            for stack, count in seen.get(label, {}).items():
                counts[_inside(stack)] += count
            if not counts.total():
                counts[()] = 1
            each = wall_ns / counts.total()
            stacks[label] = {stack: each * count for stack, count in counts.items()}
        return cls(stacks, times, samples)

    def function(self, code: CodeType) -> ProfiledFunction:
        """Return the function of a code object in a stack."""
        found = self._functions.get(id(code))
        if found is None:
            found = self._functions[id(code)] = ProfiledFunction.of(code)
        return found

    def apps(self) -> dict[str, int]:
        """Return the time of each application, the longest first."""
        found: Counter[str] = Counter()
        for label, wall_ns in self.times.times.items():
            if label != HOST:
                found[label.app] += wall_ns
        return dict(found.most_common())

    def owners(self) -> dict[str, float]:
        """Return the time in the code of each owner, without its calls of others, the longest first."""
        found: dict[str, float] = {}
        for stacks in self.stacks.values():
            for stack, wall_ns in stacks.items():
                if stack:
                    owner = code_owner(stack[-1].co_filename)
                    found[owner] = found.get(owner, 0.0) + wall_ns
        return dict(sorted(found.items(), key=lambda item: -item[1]))

    def callbacks(self) -> list[CallbackTime]:
        """Return the time of each function of the mission that cfepy called, with all it calls, the longest first."""
        found: dict[tuple[str, ProfiledFunction], float] = {}
        for label, stacks in self.stacks.items():
            for stack, wall_ns in stacks.items():
                first = next((code for code in stack if is_own_code(code.co_filename)), None)
                if first is not None:
                    key = label.app, self.function(first)
                    found[key] = found.get(key, 0.0) + wall_ns
        rows = [
            CallbackTime(app, function.name, f"{function.file.rpartition('/')[2]}:{function.line}", wall_ns)
            for (app, function), wall_ns in found.items()
        ]
        return sorted(rows, key=lambda row: (-row.wall_ns, row))


def _inside(stack: Stack) -> Stack:
    """Return a stack without the functions of the kernel and the profiler around it."""
    first, last = 0, len(stack)
    while first < last and _is_around(stack[first]):
        first += 1
    while last > first and "/extra/profiler/" in stack[last - 1].co_filename:
        last -= 1
    return stack[first:last]


def _is_around(code: CodeType) -> bool:
    return code.co_filename.replace("\\", "/").endswith(_OF_TASKS)


# -- owners of code ----------------------------------------------------------------------------------------------------


@functools.lru_cache(maxsize=4096)
def code_owner(file: str) -> str:
    """Return the owner of a source file, as the rows of the table name it.

    Args:
        file: as a code object names it.
    """
    if file.startswith("<"):
        return STANDARD if file.startswith("<frozen") else GENERATED
    file = source_file(file)
    parts = Path(os.path.relpath(file, _ROOT)).parts if file.startswith(_ROOT + os.sep) else ()
    if not is_shown(file):
        package = parts[1] if len(parts) > 2 else ""
        if parts[0] == "cfepy":
            return SERVICES.get(package, f"cfepy, {package}" if package else "cfepy")
        return "ROS 2 in cfepy" if parts[0] == "rclpy_shim" else ROSPY.get(package, "ROS in cfepy")
    if parts and parts[0] in ("apps", "ros_libraries") and len(parts) > 2:
        return f"{parts[0]}/{parts[1]}"
    if parts[:2] == ("rclpy_shim", "libraries") and len(parts) > 3:
        return f"{parts[0]}/{parts[2]}"
    if is_standard(file):
        return STANDARD
    return _installed(file) if is_library(file) else os.path.basename(file)


def _installed(file: str) -> str:
    """Return the package of an installed library."""
    parts = Path(file).parts
    at = max(index for index, name in enumerate(parts) if name in ("site-packages", "dist-packages"))
    return parts[at + 1].removesuffix(".py")
