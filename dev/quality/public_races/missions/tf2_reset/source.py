"""Publishes transforms on both topics of tf at once."""

import rospy
from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

rospy.init_node("source")
topics = [rospy.Publisher(topic, TFMessage, queue_size=10) for topic in ("/tf", "/tf_static")]
transform = TransformStamped(child_frame_id="arm")
transform.header.frame_id = "base"
transform.transform.rotation.w = 1
rospy.sleep(0.2)
for _ in range(5):
    for topic in topics:
        topic.publish([transform])
    rospy.sleep(0.01)
