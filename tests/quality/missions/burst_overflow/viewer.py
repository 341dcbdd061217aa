"""Looks at the images; one may wait, since the relay needs longer for each than this."""

import sys

import rospy
from std_msgs.msg import Int32

IMAGES = 6

rospy.init_node("viewer")
seen = []
rospy.Subscriber("stamped", Int32, lambda message: seen.append(message.data), queue_size=1)
image = rospy.Publisher("image", Int32, queue_size=10)
rospy.sleep(0.5)  # relay looks for its service every 0.3 s
for number in range(IMAGES):
    image.publish(number)
rospy.sleep(0.05)
if len(seen) != IMAGES:
    sys.exit(f"of {IMAGES} images {seen} came")
