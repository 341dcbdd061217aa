"""The part of ROS 1's genpy that nodes see: times, the message base class and its errors.

Code belongs here if a node imports it as `genpy` (`rospy_shim.types.msgs.make_module("genpy")`). The generation of
message classes belongs to `rospy_shim.types.msgs`. The central file is `rospy_shim/types/genpy/message.py`.
"""

from __future__ import annotations

import struct

from rospy_shim.types.genpy.errors import DeserializationError, MessageException, SerializationError
from rospy_shim.types.genpy.message import Message
from rospy_shim.types.genpy.rostime import Duration, Time, TVal

struct_I = struct.Struct("<I")  # genpy's name

__all__ = [
    "DeserializationError",
    "Duration",
    "Message",
    "MessageException",
    "SerializationError",
    "TVal",
    "Time",
    "struct_I",
]
