"""The contents of a launch file as plain records: nodes, tests, parameters, and remarks for its user."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from cfepy.reading.mistakes import FirstMistake, Mistakes

DEFAULT_TIME_LIMIT_S = 60.0


class LaunchRemark(NamedTuple):
    """A remark about a launch file that does not keep it from running.

    Attributes:
        text: the remark.
        file: the file.
        line: line in the file, from 1; 0 is the file as a whole.
        is_error: True if a part of the file is left out, because it needs something that is missing.
        before_runs: True to show it before each run, and not only in `cfepy check`.
    """

    text: str
    file: Path
    line: int
    is_error: bool = False
    before_runs: bool = True

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: {self.text}" if self.line else f"{self.file}: {self.text}"


@dataclass(slots=True)
class LaunchFindings:
    """Findings of reading launch files.

    Attributes:
        mistakes: receives errors: it raises the first one, or keeps all.
        remarks: further messages for the user.
        unset: arguments without a value that were reported: file, the <include> that reads it, name.
        work: size of the launch so far (`LAUNCH_WORK` of `cfepy.reading.input_limits`).
    """

    mistakes: Mistakes = field(default_factory=FirstMistake)
    remarks: list[LaunchRemark] = field(default_factory=list)
    unset: set[tuple[Path, str, str]] = field(default_factory=set)
    work: int = 0


@dataclass(frozen=True, slots=True)
class LaunchNode:
    """One <node> (roslaunch.core.Node), with everything resolved.

    Attributes:
        package: package, as in the file.
        type: type, as in the file.
        name: name without a namespace.
        namespace: namespace with a slash at both ends.
        args: arguments of its command line, as in the file: one text.
        remaps: (from, to) in roslaunch's order.
        env: environment variables, in the file's order.
        output: "screen", "log" or None.
        cwd: "node", "cwd", "ROS_HOME" or None.
        respawn: True if it is started again after its end.
        respawn_delay: delay of that in s.
        required: True if the end of the node ends the launch.
        file: file that it is in.
        line: its line in the file.
    """

    package: str
    type: str
    name: str
    namespace: str
    args: str
    remaps: tuple[tuple[str, str], ...]
    env: Mapping[str, str]
    output: str | None
    cwd: str | None
    respawn: bool
    respawn_delay: float
    required: bool
    file: Path
    line: int

    @property
    def full_name(self) -> str:
        """The resolved name, "/arm/driver"."""
        return self.namespace + self.name


@dataclass(frozen=True, slots=True)
class LaunchTest:
    """One <test>: a node that checks something (roslaunch.core.Test).

    `time_limit` is in s; `retry` is the number of repetitions after a failure.
    """

    test_name: str
    node: LaunchNode
    time_limit: float = DEFAULT_TIME_LIMIT_S
    retry: int = 0


@dataclass(slots=True)
class Launch:
    """A launch file, read (roslaunch.config.ROSLaunchConfig).

    Attributes:
        files: every file that was read, the launch file first.
        nodes: nodes in the order of the file.
        tests: tests in the order of the file.
        params: parameters by resolved name, in the order in which they were first set.
        places: file and line of each parameter's value.
        remarks: messages for the user.
    """

    files: list[Path] = field(default_factory=list)
    nodes: list[LaunchNode] = field(default_factory=list)
    tests: list[LaunchTest] = field(default_factory=list)
    params: dict[str, Any] = field(default_factory=dict)
    places: dict[str, tuple[Path, int]] = field(default_factory=dict)
    remarks: list[LaunchRemark] = field(default_factory=list)
