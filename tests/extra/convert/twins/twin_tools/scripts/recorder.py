#!/usr/bin/env python3
"""Prints the messages of some topics: the time in nanoseconds, the topic, its type and the message's bytes."""

import rospy


def record(message, topic):
    """Print a message."""
    kind = message._connection_header["type"]
    print("RECORD", rospy.Time.now().to_nsec(), topic, kind, message._buff.hex(), flush=True)


if __name__ == "__main__":
    rospy.init_node("recorder")
    for name in rospy.myargv()[1:]:
        rospy.Subscriber(name, rospy.AnyMsg, record, callback_args=name)
    rospy.spin()
