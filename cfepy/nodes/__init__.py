"""Unmodified Python programs on the simulated computer, each with its own module table ("universe").

A ROS node expects a process of its own. Here it gets its own module table, clock, threads, environment and random
numbers instead, all on the kernel; the host interpreter is not patched. Everything that makes a program a process
belongs here: the universe, finding and executing modules, refused modules, and tracebacks. Replacements for the
standard library are in `cfepy.nodes.stdlib`. This package does not know ROS: rospy and the message packages come in as
factories of modules.

The names below are loaded on first use, so a mission without nodes does not load them. The central file is
`cfepy/nodes/universe.py`.
"""

from __future__ import annotations

import threading  # noqa: F401  # first imported by a task, the host's would take that task for its main thread
from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face
from rospy_shim.types.config import (
    ROSCORE_PARAMS,
    BridgedPacket,
    CppNode,
    NodeConfig,
    RosBridge,
    RosConfig,
    TopicConfig,
)

if TYPE_CHECKING:
    from cfepy.nodes.accesses import WHOLE, Accesses, Observer, Touch
    from cfepy.nodes.app_modules import AppModules, make_app_universe
    from cfepy.nodes.busy_waits import turn_hook
    from cfepy.nodes.files import ASKED, LISTED, MADE, NEEDED, PREFIX, WRITES_FILE, FilePoints, Overlay, below_root
    from cfepy.nodes.importer import imported, show_only
    from cfepy.nodes.reachable_objects import can_call, held_by, is_private, reaches
    from cfepy.nodes.refused_modules import RefusedError
    from cfepy.nodes.universe import Factory, ProcessNumbers, StartThread, Universe, process_number

__all__ = [
    "ASKED",
    "LISTED",
    "MADE",
    "NEEDED",
    "PREFIX",
    "ROSCORE_PARAMS",
    "WHOLE",
    "WRITES_FILE",
    "Accesses",
    "AppModules",
    "BridgedPacket",
    "CppNode",
    "Factory",
    "FilePoints",
    "NodeConfig",
    "Observer",
    "Overlay",
    "ProcessNumbers",
    "RefusedError",
    "RosBridge",
    "RosConfig",
    "StartThread",
    "TopicConfig",
    "Touch",
    "Universe",
    "below_root",
    "can_call",
    "held_by",
    "imported",
    "is_private",
    "make_app_universe",
    "process_number",
    "reaches",
    "show_only",
    "turn_hook",
]

if not TYPE_CHECKING:  # type checkers see only the names above
    __getattr__, __dir__ = face(
        __name__,
        {
            ".accesses": ("WHOLE", "Touch", "Accesses", "Observer"),
            ".app_modules": ("AppModules", "make_app_universe"),
            ".busy_waits": ("turn_hook",),
            ".files": (
                "ASKED",
                "LISTED",
                "MADE",
                "NEEDED",
                "PREFIX",
                "WRITES_FILE",
                "FilePoints",
                "Overlay",
                "below_root",
            ),
            ".importer": ("imported", "show_only"),
            ".reachable_objects": ("can_call", "held_by", "is_private", "reaches"),
            ".refused_modules": ("RefusedError",),
            ".universe": (
                "Factory",
                "StartThread",
                "Universe",
                "ProcessNumbers",
                "process_number",
            ),
        },
    )
