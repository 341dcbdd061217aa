"""Robots that come up while a report is asked for."""

import rospy
from std_msgs.msg import Empty, String

rospy.init_node("fleet")
report = rospy.Publisher("report", Empty, queue_size=10)
robot = rospy.Publisher("robot", String, queue_size=10)
rospy.Subscriber("status", String, lambda message: None)
rospy.sleep(0.1)
for number in range(3):
    report.publish()
    robot.publish(f"robot {number}")
    rospy.sleep(0.01)
