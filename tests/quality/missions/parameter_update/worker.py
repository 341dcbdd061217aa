"""Takes the next free number from the parameter server, when it is told to."""

import rospy
from std_msgs.msg import Empty, Int32


def on_go(_message: Empty) -> None:
    number = rospy.get_param("/next_number")
    rospy.set_param("/next_number", number + 1)
    taken.publish(number)


rospy.init_node("worker", anonymous=True)
taken = rospy.Publisher("taken", Int32, queue_size=10)
rospy.Subscriber("go", Empty, on_go)
rospy.spin()
