"""The common part of rosnode, rosservice and rostopic; a separate package, which no ROS source replaces."""

from __future__ import annotations

import importlib
import sys
from typing import Any


def command_of(tool: str, name: str) -> Any:
    """Return one command of a tool, under the name that ROS's tests and other tools use.

    Args:
        tool: the tool's package.
        name: `_rosnode_cmd_list` and similar names, which take the command line, or `_fullusage`.

    Raises:
        AttributeError: the tool has no such command.
    """
    module = importlib.import_module(f"{tool}._command")
    prefix = f"_{tool}_cmd_"
    command = module.COMMANDS.get(name.removeprefix(prefix)) if name.startswith(prefix) else None
    if command is not None:
        return lambda argv=sys.argv: command(argv[2:])
    if name == "_fullusage":
        return module.print_usage
    raise AttributeError(f"module {tool!r} has no attribute {name!r}")
