#!/usr/bin/env python3
"""Messages that a node in C++ hears whatever they are, and those that it passes on."""

import rospy
from geometry_msgs.msg import Point
from std_msgs.msg import Bool, String

rospy.init_node("partner")
points = rospy.Publisher("/probes/from_py", Point, queue_size=5)
latched = rospy.Publisher("/probes/latched_py", Bool, queue_size=5, latch=True)
ear = rospy.Subscriber("/probes/to_py", String, lambda message: print("P| py heard", ascii(message.data), flush=True))
latched.publish(True)
rospy.set_param("/ready_py", 1)
while not rospy.is_shutdown() and not rospy.has_param("/go_py"):
    rospy.sleep(0.05)
points.publish(1.0, 2.0, -0.5)
while not rospy.is_shutdown() and not rospy.has_param("/end"):
    rospy.sleep(0.05)
