"""Publishes a message at the next full second."""

import rospy
from std_msgs.msg import Int32

rospy.init_node("source")
numbers = rospy.Publisher("/numbers", Int32, queue_size=10)
rospy.sleep(0.05)
now = rospy.Time.now()
rospy.sleep(rospy.Time(now.secs + 1) - now)
numbers.publish(1)
rospy.spin()
