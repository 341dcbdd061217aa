"""genpy for nodes: the base of message classes, and the generator of their source text.

`genpy.message` and `genpy.rostime` are made for each node. The other modules here write Python source from definitions
as ROS's genpy 0.6 does. cfepy itself does not need them: it makes its classes in memory.
"""

from __future__ import annotations

from . import base, message, rostime
from .message import DeserializationError, Message, MessageException, SerializationError, struct_I
from .rostime import Duration, Time, TVal

__all__ = [
    "DeserializationError",
    "Duration",
    "Message",
    "MessageException",
    "SerializationError",
    "TVal",
    "Time",
    "base",
    "message",
    "rostime",
    "struct_I",
]
