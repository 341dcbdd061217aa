"""Two candidates ask for a vote, one after the other."""

import rospy
from std_msgs.msg import String

rospy.init_node("candidates")
request = rospy.Publisher("request", String, queue_size=10)
for name in ("anna", "bert"):
    rospy.sleep(0.3)
    request.publish(name)
