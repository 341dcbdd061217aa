"""What rosnode, rosservice and rostopic have in common; a package of its own, which no source of ROS replaces."""

from __future__ import annotations

import importlib
import sys
from typing import Any


def command_of(tool: str, name: str) -> Any:
    """One command of a tool, under the name by which ROS's tests and other tools call it.

    Args:
        tool: the tool's package.
        name: `_rosnode_cmd_list` and the like, which take the command line, or `_fullusage`.

    Raises:
        AttributeError: the tool has nothing of that name.
    """
    module = importlib.import_module(f"{tool}.command")
    prefix = f"_{tool}_cmd_"
    command = module.COMMANDS.get(name.removeprefix(prefix)) if name.startswith(prefix) else None
    if command is not None:
        return lambda argv=sys.argv: command(argv[2:])
    if name == "_fullusage":
        return module.print_usage
    raise AttributeError(f"module {tool!r} has no attribute {name!r}")
