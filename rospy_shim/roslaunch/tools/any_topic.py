"""Messages of any type from one topic to another: the common part of topic_tools' relay, throttle and drop."""

from __future__ import annotations

from typing import Any

import roslib.message
import rospy

QUEUE_SIZE = 10


class Output:
    """The output topic; it is advertised when the first message shows the type.

    Args:
        name: name of the topic.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._class: Any = None
        self._publisher: Any = None

    def send(self, message: rospy.AnyMsg) -> None:
        """Send a message on; a latched one stays latched."""
        if self._publisher is None:
            header = message._connection_header
            self._class = roslib.message.get_message_class(header["type"])
            if self._class is None:
                rospy.logerr_once("no package has the message type %s of %s", header["type"], header.get("topic"))
                return
            latch = header.get("latching") == "1"
            self._publisher = rospy.Publisher(self._name, self._class, latch=latch, queue_size=QUEUE_SIZE)
        self._publisher.publish(self._class().deserialize(message._buff))
