"""Turns both wheels, and compares the odometer with what they did."""

import sys

import rospy
from std_msgs.msg import Int32

ROUNDS = 3

rospy.init_node("wheels")
seen = []
rospy.Subscriber("distance", Int32, lambda message: seen.append(message.data))
wheels = [rospy.Publisher(topic, Int32, queue_size=10) for topic in ("left_ticks", "right_ticks")]
rospy.sleep(0.1)
for _ in range(ROUNDS):
    for wheel in wheels:
        wheel.publish(1)
    rospy.sleep(0.01)
if max(seen) != 2 * ROUNDS:
    sys.exit(f"the wheels made {2 * ROUNDS} ticks, the odometer says {max(seen)}")
