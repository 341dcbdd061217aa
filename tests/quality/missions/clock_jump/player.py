"""Plays a recording twice: the clock jumps back, and a message says that everything begins anew."""

import time

import rospy
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Empty

rospy.init_node("player")
clock = rospy.Publisher("/clock", Clock, queue_size=10)
restart = rospy.Publisher("restart", Empty, queue_size=10)
time.sleep(0.1)
for _ in range(2):
    restart.publish()
    for tick in range(1, 6):
        clock.publish(rospy.Time.from_sec(tick / 10))
        time.sleep(0.01)
