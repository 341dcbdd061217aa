"""rospy_shim: rospy for nodes that run on cfepy's simulated flight computer.

Inside a mission `import rospy_shim as rospy` and `import rospy` both give a node its own rospy. Outside, in a plain
Python process, this module has rospy's exceptions, times and constants, and every function says how to run the node.

Code belongs here if a node or a ROS tool sees it, in subpackages: `types` needs no graph, `client` is rospy itself,
`graph` and `parameters` are shared by all nodes of a mission, `master` is their XML-RPC side, `roslaunch` reads launch
files, `rospy_modules` and `stand_ins` are code that runs as part of nodes, and `runtime` is started by a mission.
Python as a program sees it belongs to `cfepy.nodes`; the use of nodes by a mission belongs to `cfepy.mission`, which
this package does not know. The central file is `rospy_shim/runtime.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from rospy_shim.client.rostime import Duration, Time
    from rospy_shim.types.exceptions import (
        ROSException,
        ROSInitException,
        ROSInternalException,
        ROSInterruptException,
        ROSSerializationException,
        ROSTimeMovedBackwardsException,
        ServiceException,
    )

__all__ = [
    "Duration",
    "ROSException",
    "ROSInitException",
    "ROSInternalException",
    "ROSInterruptException",
    "ROSSerializationException",
    "ROSTimeMovedBackwardsException",
    "ServiceException",
    "Time",
]

DEBUG, INFO, WARN, ERROR, FATAL = 1, 2, 4, 8, 16

# fmt: off
_NEEDS_A_NODE = frozenset({
    "AnyMsg", "Header", "Message", "Publisher", "Rate", "SubscribeListener", "Subscriber", "Timer", "delete_param",
    "get_caller_id", "get_name", "get_namespace", "get_node_uri", "get_param", "get_param_cached", "get_param_names",
    "get_published_topics", "get_rostime", "get_time", "has_param", "init_node", "is_shutdown", "logdebug", "logerr",
    "logfatal", "loginfo", "logwarn", "myargv", "on_shutdown", "remap_name", "resolve_name", "search_param",
    "set_param", "signal_shutdown", "sleep", "spin", "wait_for_message",
})
# fmt: on


_load, __dir__ = face(
    __name__,
    {
        ".client.rostime": ("Duration", "Time"),
        ".types.exceptions": (
            "ROSException",
            "ROSInitException",
            "ROSInternalException",
            "ROSInterruptException",
            "ROSSerializationException",
            "ROSTimeMovedBackwardsException",
            "ServiceException",
        ),
    },
)


def __getattr__(name: str) -> Any:
    """Return a name of `__all__`, or a placeholder for a function of nodes; calling it explains how to run a node."""
    if name not in _NEEDS_A_NODE:
        return _load(name)

    def refuse(*args: Any, **options: Any) -> None:
        from rospy_shim.types.exceptions import ROSInitException

        raise ROSInitException(
            f"rospy_shim.{name}() works in a node of a cfepy mission only. Run this program with `cfepy run <mission>`"
            " (see docs/how_to/run_a_ros_node.md), or import rospy instead of rospy_shim on a computer with ROS"
        )

    return refuse
