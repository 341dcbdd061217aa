"""What a launch file comes to: nodes, tests, parameters, and what to tell its user. Imports nothing of cfepy."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

DEFAULT_TIME_LIMIT_S = 60.0


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
        notes: what a user should know, a line each.
    """

    files: list[Path] = field(default_factory=list)
    nodes: list[LaunchNode] = field(default_factory=list)
    tests: list[LaunchTest] = field(default_factory=list)
    params: dict[str, Any] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
