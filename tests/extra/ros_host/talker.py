"""A node for both worlds: real rospy runs it on a ROS master, cfepy in a mission."""

import rospy
from roscpp.srv import GetLoggers, GetLoggersResponse
from std_msgs.msg import Int32, String

rospy.init_node("talker")
chatter = rospy.Publisher("/chatter", String, queue_size=10)
latched = rospy.Publisher("/latched", Int32, queue_size=1, latch=True)
latched.publish(7)


def heard(message):
    latched.publish(len(message.data))


rospy.Subscriber("/orders", String, heard)
rospy.Service("/things", GetLoggers, lambda request: GetLoggersResponse([]))
rospy.set_param("/talker/speed", 3)
rate = rospy.Rate(10)
while not rospy.is_shutdown():
    chatter.publish("hello")
    rate.sleep()
