"""Has the hand opened or closed, as its argument says, when the signal comes."""

import sys

import rospy
from std_msgs.msg import Empty
from std_srvs.srv import SetBool

rospy.init_node("hand", anonymous=True)
wanted = sys.argv[1]
rospy.wait_for_service("grip")
grip = rospy.ServiceProxy("grip", SetBool)
rospy.wait_for_message("go", Empty)
for _ in range(2):
    answer = grip(wanted == "closed").message
    if answer != wanted:
        sys.exit(f"asked for {wanted}, the answer is {answer}")
