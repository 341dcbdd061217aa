"""Publishes the positions of a joint on two topics, which later subscribers get, too."""

import rospy
from sensor_msgs.msg import JointState

rospy.init_node("source")
topics = [rospy.Publisher(topic, JointState, queue_size=1, latch=True) for topic in ("/left", "/right")]
for each in topics:
    each.publish(JointState(name=["wheel"], position=[1.0]))
rospy.spin()
