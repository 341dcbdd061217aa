#!/usr/bin/env python3
"""Prints the parts of /rosout that are the same in both languages: not the source line, nor the message number."""

import rospy
from rosgraph_msgs.msg import Log
from std_msgs.msg import String


def tell(log):
    if log.name == "/twin":
        out.publish(f"{log.level} {log.header.stamp.to_nsec()} {log.header.frame_id} {log.msg}")


if __name__ == "__main__":
    rospy.init_node("stimulus")
    out = rospy.Publisher("out", String, queue_size=100)
    rospy.Subscriber("/rosout", Log, tell)
    rospy.spin()
