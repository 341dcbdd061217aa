"""Launchable nodes, and the errors of launching (roslaunch.core)."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any


class RLException(Exception):
    """Something cannot be launched."""


def printlog(msg: str) -> None:
    """Tell something on standard output."""
    print(msg)


printlog_bold = printlog


def printerrlog(msg: str) -> None:
    """Tell something on standard error."""
    print(msg, file=sys.stderr)


def generate_run_id() -> str:
    """Return an identifier for a launch."""
    import uuid

    return str(uuid.uuid1())


class Param:
    """A parameter.

    Args:
        key: its name.
        value: its value.
    """

    def __init__(self, key: str, value: Any) -> None:
        self.key = key
        self.value = value


class Node:
    """A node to launch.

    Args:
        package: its package.
        node_type: the file's name.
        name: without a namespace; the file's name if None.
        namespace: namespace of its names.
        machine_name: accepted.
        args: arguments of its command line, as one text.
        respawn: start it again when it ends.
        respawn_delay: in s.
        remap_args: (from, to) each.
        env_args: (name, value) each.
        output: "screen", "log" or None.
        cwd: "node", "cwd", "ROS_HOME" or None.
        launch_prefix: accepted.
        required: its end is the end of the run.
        filename: the file that defines it.

    Raises:
        ValueError: an invalid field.
    """

    def __init__(
        self,
        package: str,
        node_type: str,
        name: str | None = None,
        namespace: str = "/",
        machine_name: str | None = None,
        args: str = "",
        respawn: bool = False,
        respawn_delay: float = 0.0,
        remap_args: Sequence[Sequence[str]] | None = None,
        env_args: Sequence[Sequence[str]] | None = None,
        output: str | None = None,
        cwd: str | None = None,
        launch_prefix: str | None = None,
        required: bool = False,
        filename: str = "<unknown>",
    ) -> None:
        if not package.strip() or not node_type.strip():
            raise ValueError("'package' and 'type' must be non-empty")
        if name is not None and (not name.strip() or "/" in name):
            raise ValueError(f"node name {name!r} must be non-empty and have no namespace")
        if output not in (None, "", "screen", "log"):
            raise ValueError(f"'output' must be one of 'log', 'screen', not {output!r}")
        if respawn and required:
            raise ValueError("respawn and required cannot both be set to true")
        self.package = package
        self.type = node_type
        self.name = name
        self.namespace = f"/{namespace.strip('/')}/" if namespace and namespace.strip("/") else "/"
        self.machine_name = machine_name
        self.args = args
        self.respawn = respawn
        self.respawn_delay = respawn_delay
        self.remap_args = [(pair[0], pair[1]) for pair in remap_args or []]
        self.env_args = [(pair[0], pair[1]) for pair in env_args or []]
        self.output = output
        self.cwd = cwd
        self.launch_prefix = launch_prefix
        self.required = required
        self.filename = filename

    def _fields(self) -> dict[str, Any]:
        """Return its description for the mission."""
        return {
            "package": self.package,
            "type": self.type,
            "name": self.name or self.type.rpartition("/")[2].partition(".")[0],
            "namespace": self.namespace,
            "args": self.args or "",
            "remaps": tuple(self.remap_args),
            "env": dict(self.env_args),
            "output": self.output or None,
            "cwd": self.cwd,
            "respawn": self.respawn,
            "respawn_delay": self.respawn_delay,
            "required": self.required,
        }
