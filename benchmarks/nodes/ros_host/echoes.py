"""Echoes messages, as a node of both worlds. Its argument is the name of its topics; `mission` without one."""

import sys

import rospy
from sensor_msgs.msg import JointState

arguments = rospy.myargv(sys.argv)
name = arguments[1] if len(arguments) > 1 else "mission"
rospy.init_node("echoes_" + name)
answers = rospy.Publisher("/answer_" + name, JointState, queue_size=100, tcp_nodelay=True)
rospy.Subscriber("/ask_" + name, JointState, answers.publish, queue_size=100, tcp_nodelay=True)
rospy.spin()
