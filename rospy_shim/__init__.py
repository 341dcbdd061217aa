"""rospy_shim: rospy for nodes that run on cfepy's simulated flight computer.

Inside a mission `import rospy_shim as rospy` and `import rospy` both give a node its own rospy. Outside, in a plain
Python process, this module has rospy's exceptions, times and constants, and every function says how to run the node.

What a node or a tool sees of ROS belongs here, in rooms: `types` is what needs no graph, `client` rospy itself, `graph`
and `parameters` what all nodes of a mission share, `master` their XML-RPC side, `roslaunch` launch files,
`rospy_modules` and `stand_ins` code of nodes, and `runtime` what a mission starts. What a program sees of Python is in
`cfepy.nodes`; how a mission uses nodes is in `cfepy.mission`, of which nothing here knows. The central file is
`rospy_shim/runtime.py`.
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
    """A name of `__all__`, or what only a node has: calling that tells how to become one."""
    if name not in _NEEDS_A_NODE:
        return _load(name)

    def refuse(*args: Any, **options: Any) -> None:
        from rospy_shim.types.exceptions import ROSInitException

        raise ROSInitException(
            f"rospy_shim.{name}() works in a node of a cfepy mission only. Run this program with `cfepy run <mission>`"
            " (see docs/how_to/run_a_ros_node.md), or import rospy instead of rospy_shim on a computer with ROS"
        )

    return refuse
