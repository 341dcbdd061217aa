"""tf2_ros: transforms between frames over time, received and published on /tf and /tf_static.

`BufferClient` and `BufferServer` are loaded when they are first used, because they need actionlib. As in ROS, the
messages that the package uses are also names of it.
"""

from __future__ import annotations

import importlib
import threading
from typing import TYPE_CHECKING, Any

import rospy
from geometry_msgs.msg import TransformStamped
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage
from tf2_py import (
    BufferCore,
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)

from tf2_ros.buffer import DEFAULT_CAN_TRANSFORM_POLLING_SCALE, Buffer
from tf2_ros.buffer_interface import (
    BufferInterface,
    ConvertRegistration,
    NotImplementedException,
    Stamped,
    TransformRegistration,
    TypeException,
    convert,
)
from tf2_ros.static_transform_broadcaster import StaticTransformBroadcaster
from tf2_ros.transform_broadcaster import TransformBroadcaster
from tf2_ros.transform_listener import TransformListener

if TYPE_CHECKING:
    from tf2_ros.buffer_client import BufferClient
    from tf2_ros.buffer_server import BufferServer

__all__ = [
    "DEFAULT_CAN_TRANSFORM_POLLING_SCALE",
    "Buffer",
    "BufferClient",
    "BufferCore",
    "BufferInterface",
    "BufferServer",
    "ConnectivityException",
    "ConvertRegistration",
    "ExtrapolationException",
    "Header",
    "InvalidArgumentException",
    "LookupException",
    "NotImplementedException",
    "Stamped",
    "StaticTransformBroadcaster",
    "TFMessage",
    "TimeoutException",
    "TransformBroadcaster",
    "TransformException",
    "TransformListener",
    "TransformRegistration",
    "TransformStamped",
    "TypeException",
    "convert",
    "rospy",
    "threading",
]

_LATER = {
    "BufferClient": "tf2_ros.buffer_client",
    "BufferServer": "tf2_ros.buffer_server",
    "FrameGraph": "tf2_msgs.srv",
    "FrameGraphResponse": "tf2_msgs.srv",
    "GoalStatus": "actionlib_msgs.msg",
    "LookupTransformAction": "tf2_msgs.msg",
    "LookupTransformGoal": "tf2_msgs.msg",
}


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(_LATER[name]), name)
