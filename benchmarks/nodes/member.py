"""One of many small nodes: publishes on its own topic and listens to the next one's."""

import rospy
from std_msgs.msg import UInt32

rospy.init_node("member")
number, count, talks = (int(word) for word in rospy.myargv()[1:4])
publisher = rospy.Publisher(f"/ring{number}", UInt32, queue_size=1)
rospy.Subscriber(f"/ring{(number + 1) % count}", UInt32, lambda message: None)
if talks:
    rospy.loginfo("node %d is here", number)
rate = rospy.Rate(1)
while not rospy.is_shutdown():
    publisher.publish(number)
    rate.sleep()
