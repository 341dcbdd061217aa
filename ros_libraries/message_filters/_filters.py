"""The base of all filters, and the first filter of a chain: a subscription."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import rospy

_NO_STAMP = (
    "Cannot use message filters with non-stamped messages. Use the 'allow_headerless' constructor option to "
    "auto-assign ROS time to headerless messages."
)


class SimpleFilter:
    """A source of messages."""

    def __init__(self) -> None:
        self.callbacks: dict[int, tuple[Callable[..., object], tuple[Any, ...]]] = {}

    def registerCallback(self, cb: Callable[..., object], *args: Any) -> int:
        """Register `cb`, which is called with each message followed by `args`.

        Returns:
            number of the connection.
        """
        number = len(self.callbacks)
        self.callbacks[number] = (cb, args)
        return number

    def signalMessage(self, *msg: Any) -> None:
        """Pass a message on to the callbacks."""
        for callback, args in self.callbacks.values():
            callback(*msg, *args)


class Subscriber(SimpleFilter):
    """Passes on the messages of a topic. It has the arguments and the attributes of rospy.Subscriber."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__()
        self.topic = args[0]
        kwargs["callback"] = self.callback
        self.sub = rospy.Subscriber(*args, **kwargs)

    def callback(self, msg: Any) -> None:
        """A message came."""
        self.signalMessage(msg)

    def getTopic(self) -> Any:
        """Return the topic as it was given."""
        return self.topic

    def __getattr__(self, key: str) -> Any:
        return getattr(self.__dict__["sub"], key)


def stamp_of(msg: Any, allow_headerless: bool) -> Any:
    """Return the stamp of a message.

    Without a header, return the current time, or None with a warning if that is not allowed.
    """
    if hasattr(msg, "header") and hasattr(msg.header, "stamp"):
        return msg.header.stamp
    if allow_headerless:
        return rospy.Time.now()
    rospy.logwarn(_NO_STAMP)
    return None
