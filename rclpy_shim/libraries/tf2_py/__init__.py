"""tf2_py for ROS 2: the buffer of transforms and its exceptions.

The tree of frames and its arithmetic come from ROS 1's tf2_py, whose folder is a second place of this package's
modules. Times, messages and error texts are ROS 2's.
"""

from __future__ import annotations

from rclpy._seam import SHARED_LIBRARIES

__path__.append(f"{SHARED_LIBRARIES}/tf2_py")

from tf2_py._buffer_core import BufferCore  # noqa: E402
from tf2_py._exceptions import (  # noqa: E402
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)

__all__ = [
    "BufferCore",
    "ConnectivityException",
    "ExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "TimeoutException",
    "TransformException",
]
