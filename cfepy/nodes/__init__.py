"""Unmodified Python programs on the simulated computer: one module universe per node.

A ROS node expects a process of its own. Here it gets its own module table, clock, threads, environment and random
numbers instead, all on the kernel; nothing of the host interpreter is patched. It may import `cfepy.rtos` and what is
left of it, and knows nothing of ROS: rospy and the message packages come in as factories of synthetic modules.
"""

from cfepy.nodes.refused import RefusedError
from cfepy.nodes.universe import Factory, StartThread, Universe

__all__ = ["Factory", "RefusedError", "StartThread", "Universe"]
