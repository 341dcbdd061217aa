"""The launch pad's crew."""

import rospy
from std_msgs.msg import Empty

rospy.init_node("pad")
vent = rospy.Publisher("vent", Empty, queue_size=10)
fill = rospy.Publisher("fill", Empty, queue_size=10)
rospy.sleep(0.1)
for _ in range(3):
    vent.publish()
    fill.publish()
    rospy.sleep(0.01)
