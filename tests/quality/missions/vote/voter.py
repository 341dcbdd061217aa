"""Gives its vote to the first who asks, and remembers that over restarts; but it answers before it remembers."""

import rospy
from std_msgs.msg import String


def on_request(message: String) -> None:
    if not rospy.get_param("/voted_for", ""):
        vote.publish(message.data)
        rospy.set_param("/voted_for", message.data)


rospy.init_node("voter")
vote = rospy.Publisher("vote", String, queue_size=10)
rospy.Subscriber("request", String, on_request)
rospy.spin()
