"""roslaunch for nodes: starts other nodes and launch files while the mission runs.

Source: wiki.ros.org/roslaunch/API%20Usage. A started node becomes an application of the same mission. The tool itself
is `cfepy launch`. Remote machines, servers and process monitors are not supported: everything is on one computer.
"""

from __future__ import annotations

from roslaunch import core, parent, rlutil, scriptapi, substitution_args
from roslaunch.core import Node, RLException
from roslaunch.scriptapi import ROSLaunch

__all__ = [
    "Node",
    "RLException",
    "ROSLaunch",
    "configure_logging",
    "core",
    "parent",
    "rlutil",
    "scriptapi",
    "substitution_args",
]


def configure_logging(uuid: str) -> None:
    """Do nothing: logging goes to the mission's console, so there is no file to open."""
