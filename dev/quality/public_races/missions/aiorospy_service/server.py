"""Adds two numbers."""

import rospy
from rospy_tutorials.srv import AddTwoInts, AddTwoIntsResponse

rospy.init_node("server")
rospy.Service("/add", AddTwoInts, lambda request: AddTwoIntsResponse(request.a + request.b))
rospy.spin()
