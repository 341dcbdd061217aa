#!/usr/bin/env python3
"""A latched goal that is there before the node listens, and subscribers that come late and go."""

import rospy
from std_msgs.msg import Int32, String


def tell(message, what):
    out.publish(f"{what} {message.data}")


if __name__ == "__main__":
    rospy.init_node("stimulus")
    out = rospy.Publisher("out", String, queue_size=100)
    goal = rospy.Publisher("goal", Int32, queue_size=1, latch=True)
    goal.publish(11)
    other = rospy.Publisher("other", Int32, queue_size=1, latch=True)
    other.publish(5)
    rospy.sleep(3.03)
    rospy.Subscriber("state", Int32, tell, "state")
    rospy.Subscriber("greeting", Int32, tell, "greeting")
    watching = rospy.Subscriber("watched", Int32, tell, "watched")
    rospy.sleep(0.5)
    goal.publish(12)
    rospy.sleep(0.5)
    watching.unregister()
    rospy.spin()
