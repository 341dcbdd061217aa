"""The contents of a launch file as plain records: nodes, tests, parameters, and remarks for its user."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from cfepy.reading.marked_yaml import Mistakes

DEFAULT_TIME_LIMIT_S = 60.0


class LaunchRemark(NamedTuple):
    """Something about a launch file that does not keep it from running.

    Attributes:
        text: what it is.
        file: where it is.
        line: in the file, from 1; 0 is the file as a whole.
        is_error: something that the file asks for is not there, so it is left out.
        before_runs: it is told before each run, and not by `cfepy check` alone.
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
    """What is found while launch files are read.

    Attributes:
        mistakes: takes what is wrong: it raises the first mistake, or keeps all.
        remarks: all else that a user should know.
        unset: arguments without a value that have been told of: file, the <include> that reads it, name.
        work: how large the launch is so far (`LAUNCH_WORK` of `cfepy.reading.input_limits`).
    """

    mistakes: Mistakes = field(default_factory=Mistakes)
    remarks: list[LaunchRemark] = field(default_factory=list)
    unset: set[tuple[Path, str, str]] = field(default_factory=set)
    work: int = 0


@dataclass(frozen=True, slots=True)
class LaunchNode:
    """One <node> (roslaunch.core.Node), with everything resolved.

    Attributes:
        package, type: as the file has them.
        name: without a namespace.
        namespace: with a slash at both ends.
        args: of its command line, as the file has them: one text.
        remaps: (from, to) in roslaunch's order.
        env: environment variables, in the file's order.
        output: "screen", "log" or None.
        cwd: "node", "cwd", "ROS_HOME" or None.
        respawn, respawn_delay: whether it is started again when it ended, and after how many s.
        required: whether the end of the node is the end of the launch.
        file, line: where it stands.
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

    `time_limit` is in s; `retry` says how often it is run again when it fails.
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
        nodes, tests: in the order of the file.
        params: by resolved name, in the order in which they were first set.
        places: file and line that each parameter has its value from.
        remarks: what a user should know.
    """

    files: list[Path] = field(default_factory=list)
    nodes: list[LaunchNode] = field(default_factory=list)
    tests: list[LaunchTest] = field(default_factory=list)
    params: dict[str, Any] = field(default_factory=dict)
    places: dict[str, tuple[Path, int]] = field(default_factory=dict)
    remarks: list[LaunchRemark] = field(default_factory=list)
