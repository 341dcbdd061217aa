"""A node to talk with over rosbridge: it sends back what it hears, keeps a latched message, and offers services."""

import rospy
from geometry_msgs.msg import PoseArray, PoseStamped
from std_msgs.msg import (
    Bool,
    ByteMultiArray,
    Char,
    ColorRGBA,
    Duration,
    Float32,
    Float64,
    Float64MultiArray,
    Header,
    Int8,
    Int64,
    String,
    Time,
    UInt8,
    UInt8MultiArray,
    UInt64,
)
from std_srvs.srv import Empty, SetBool, Trigger

KINDS = [
    *(Bool, ByteMultiArray, Char, ColorRGBA, Duration, Float32, Float64, Float64MultiArray, Header, Int8, Int64),
    *(PoseArray, PoseStamped, String, Time, UInt8, UInt8MultiArray, UInt64),
]

rospy.init_node("peer")
for kind in KINDS:
    name = kind._type.split("/")[1].lower()
    publisher = rospy.Publisher("/t/out/" + name, kind, queue_size=100)
    rospy.Subscriber("/t/in/" + name, kind, publisher.publish)


def switch(request):
    """Refuse to be switched off."""
    if not request.data:
        raise ValueError("off is not possible")
    return True, "on"


latched = rospy.Publisher("/t/latched", String, queue_size=1, latch=True)
latched.publish("kept")
rospy.Service("/t/switch", SetBool, switch)
rospy.Service("/t/nothing", Empty, lambda request: [])


def ask(message):
    """Call a service of a client's, and tell what it says."""
    try:
        rospy.wait_for_service("/t/client_service", 5)
        answer = rospy.ServiceProxy("/t/client_service", SetBool)(message.data == "on")
        told.publish(f"{answer.success} {answer.message}")
    except rospy.ServiceException:
        told.publish("ServiceException")


told = rospy.Publisher("/t/told", String, queue_size=10)
rospy.Subscriber("/t/ask", String, ask)
rospy.set_param("/t/number", 3)
rospy.set_param("/t/deep/list", [1, 2.5, "three"])
rospy.Service("/t/ready", Trigger, lambda request: (True, "ready"))
rospy.spin()
