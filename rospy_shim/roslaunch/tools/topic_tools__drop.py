"""topic_tools/drop: drop X of every Y messages (wiki.ros.org/topic_tools/drop)."""

from __future__ import annotations

import sys

import rospy
from any_topic import QUEUE_SIZE, Output


class Drop:
    """Sends on the last Y - X messages of every Y.

    Args:
        output: the output topic.
        x: number of messages to drop in each group.
        y: number of messages in a group.
    """

    def __init__(self, output: Output, x: int, y: int) -> None:
        self._output = output
        self._x = x
        self._y = y
        self._count = 0

    def take(self, message: rospy.AnyMsg) -> None:
        """Take a message."""
        if self._count >= self._x:
            self._output.send(message)
        self._count = (self._count + 1) % self._y


def main() -> int:
    """Run until the end."""
    rospy.init_node("drop", anonymous=True)
    words = rospy.myargv()[1:]
    if not 3 <= len(words) <= 4 or not words[1].isdecimal() or not words[2].isdecimal() or words[2] == "0":
        rospy.logerr("usage: drop IN_TOPIC X Y [OUT_TOPIC]")
        return 1
    output = Output(words[3] if len(words) == 4 else f"{words[0]}_drop")
    rospy.Subscriber(words[0], rospy.AnyMsg, Drop(output, int(words[1]), int(words[2])).take, queue_size=QUEUE_SIZE)
    rospy.spin()
    return 0


if __name__ == "__main__":
    sys.exit(main())
