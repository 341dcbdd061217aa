"""topic_tools/relay: send all messages of one topic on another, of any type (wiki.ros.org/topic_tools/relay)."""

from __future__ import annotations

import sys

import rospy
from any_topic import QUEUE_SIZE, Output


def main() -> int:
    """Relay until the end."""
    rospy.init_node("relay", anonymous=True)
    words = rospy.myargv()[1:]
    if not 1 <= len(words) <= 2:
        rospy.logerr("usage: relay IN_TOPIC [OUT_TOPIC]")
        return 1
    output = Output(words[1] if len(words) == 2 else f"{words[0]}_relay")
    rospy.Subscriber(words[0], rospy.AnyMsg, output.send, queue_size=QUEUE_SIZE)
    rospy.spin()
    return 0


if __name__ == "__main__":
    sys.exit(main())
