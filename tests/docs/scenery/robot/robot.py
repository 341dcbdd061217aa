"""A robot that drives at its rate."""

import rospy

rospy.init_node("robot")
rate = rospy.Rate(rospy.get_param("/robot/rate"))
while not rospy.is_shutdown():
    rate.sleep()
