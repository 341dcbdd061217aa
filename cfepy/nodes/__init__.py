"""Unmodified Python programs on the simulated computer: one module universe per node.

A ROS node expects a process of its own. Here it gets its own module table, clock, threads, environment and random
numbers instead, all on the kernel; nothing of the host interpreter is patched. It may import `cfepy.rtos` and what is
left of it, and knows nothing of ROS: rospy and the message packages come in as factories of synthetic modules.

The names below are loaded when they are first used: a mission without nodes pays nothing for them.
"""

from __future__ import annotations

import importlib
import threading  # noqa: F401  # first imported by a task, the host's would take that task for its main thread
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cfepy.nodes.refused import RefusedError
    from cfepy.nodes.universe import Factory, StartThread, Universe

__all__ = ["Factory", "RefusedError", "StartThread", "Universe"]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    home = "cfepy.nodes.refused" if name == "RefusedError" else "cfepy.nodes.universe"
    return getattr(importlib.import_module(home), name)
