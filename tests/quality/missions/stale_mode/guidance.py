"""Sets the mode, and then commands a burn."""

import rospy
from std_msgs.msg import Float32, String

rospy.init_node("guidance")
rospy.Subscriber("fired", String, lambda message: None)
mode = rospy.Publisher("mode", String, queue_size=1, latch=True)
fire = rospy.Publisher("fire", Float32, queue_size=1)
rospy.sleep(0.1)
mode.publish("main")
fire.publish(2.5)
rospy.spin()
