"""Somebody prints a letter and thinks better of it."""

import rospy
from std_msgs.msg import Empty, String

rospy.init_node("desk")
job = rospy.Publisher("job", String, queue_size=10)
cancel = rospy.Publisher("cancel", Empty, queue_size=10)
rospy.sleep(0.1)
for number in range(2):
    job.publish(f"letter {number}")
    cancel.publish()
    rospy.sleep(0.01)
