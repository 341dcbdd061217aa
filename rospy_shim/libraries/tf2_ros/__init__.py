"""tf2_ros: transforms between frames over time, heard on /tf and /tf_static and told there.

`BufferClient` and `BufferServer` are loaded when they are first asked for, because they bring actionlib with them.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from tf2_py import (
    BufferCore,
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)

from tf2_ros.buffer import Buffer
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
    "Buffer",
    "BufferClient",
    "BufferCore",
    "BufferInterface",
    "BufferServer",
    "ConnectivityException",
    "ConvertRegistration",
    "ExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "NotImplementedException",
    "Stamped",
    "StaticTransformBroadcaster",
    "TimeoutException",
    "TransformBroadcaster",
    "TransformException",
    "TransformListener",
    "TransformRegistration",
    "TypeException",
    "convert",
]

_WITH_ACTIONLIB = {"BufferClient": "tf2_ros.buffer_client", "BufferServer": "tf2_ros.buffer_server"}


def __getattr__(name: str) -> Any:
    if name not in _WITH_ACTIONLIB:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(_WITH_ACTIONLIB[name]), name)
