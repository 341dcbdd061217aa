"""A ROS node that switches the relay twice, and waits for its acknowledgement."""

import sys
import threading

import rospy
from std_msgs.msg import UInt8MultiArray

PACKET = b"\x08\x91\xc0\x00\x00\x09" + bytes(10)

rospy.init_node("panel")
switched = threading.Event()
switch = rospy.Publisher("switch", UInt8MultiArray, queue_size=10)
rospy.Subscriber("switched", UInt8MultiArray, lambda packet: switched.set())
rospy.sleep(0.2)
for number in range(2):
    switch.publish(data=PACKET)
    switched.clear()
    if not switched.wait(0.1):
        sys.exit(f"switching {number} was not acknowledged")
