"""A mission with one ROS node: it copies /cmd_vel to /moved, and offers the service /enable."""

from __future__ import annotations

from pathlib import Path

from tests.mission.flights import write_mission

STARTUP = "CFE_APP, rover.py, __main__, ROVER, 60, 16384, 0x0, 0;\n!\n"
ROVER = """
    import rospy_shim as rospy
    from geometry_msgs.msg import Twist
    from std_srvs.srv import SetBool, SetBoolResponse

    def enable(request):
        rospy.sleep(0.2)
        if not request.data:
            raise ValueError("cannot be disabled")
        return SetBoolResponse(True, "enabled at " + str(rospy.get_param("/speed")))

    rospy.init_node("rover")
    out = rospy.Publisher("/moved", Twist, queue_size=5)
    rospy.Subscriber("/cmd_vel", Twist, out.publish)
    rospy.Service("/enable", SetBool, enable)
    rospy.set_param("/speed", 3)
    rospy.spin()
"""


def write_rover(folder: Path) -> str:
    """Write the mission; returns the argument for `cfepy run`."""
    return write_mission(folder, STARTUP, rover=ROVER)
