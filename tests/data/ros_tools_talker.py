"""A node for `ros_tools_questions.py` to ask about: two topics, a service, a parameter."""

import rospy
from roscpp.srv import SetLoggerLevel, SetLoggerLevelResponse
from std_msgs.msg import Float64MultiArray, String

rospy.init_node("talker")
words = rospy.Publisher("chatter", String, queue_size=1)
numbers = rospy.Publisher("/ns/numbers", Float64MultiArray, queue_size=1)
service = rospy.Service("flip", SetLoggerLevel, lambda request: SetLoggerLevelResponse())
rospy.set_param("~rate", 10)
rate = rospy.Rate(10)
count = 0
while not rospy.is_shutdown():
    words.publish(f"hello {count}")
    numbers.publish(Float64MultiArray(data=[1, 2.5]))
    count += 1
    rate.sleep()
