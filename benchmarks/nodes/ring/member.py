"""One node of a ring: publishes on its own topic at a rate, and listens to the next one's."""

import rospy
from std_msgs.msg import UInt32

rospy.init_node("member")
number, count, hz = (int(word) for word in rospy.myargv()[1:4])
publisher = rospy.Publisher(f"/ring{number}", UInt32, queue_size=1)
rospy.Subscriber(f"/ring{(number + 1) % count}", UInt32, lambda message: None)
rate = rospy.Rate(hz)
while not rospy.is_shutdown():
    publisher.publish(number)
    rate.sleep()
