"""Passes on the fixes of two antennas, in one message that is made once, since making messages is slow."""

import rospy
from geometry_msgs.msg import Point
from std_msgs.msg import Float64

out = Point()


def on_fix(message: Float64) -> None:
    out.x = message.data
    rospy.logdebug("fix at %f", out.x)
    out.y = -message.data
    fix.publish(out)


rospy.init_node("gps")
fix = rospy.Publisher("fix", Point, queue_size=10)
rospy.Subscriber("front", Float64, on_fix)
rospy.Subscriber("rear", Float64, on_fix)
rospy.spin()
