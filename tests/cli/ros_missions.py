"""A small robot for the tests of `cfepy rostopic` and `cfepy rosservice`."""

from __future__ import annotations

import textwrap
from pathlib import Path

ROBOT = """
    import rospy
    from nav_msgs.msg import Odometry
    from std_msgs.msg import String
    from std_srvs.srv import SetBool

    rospy.init_node("robot")
    said = rospy.Publisher("said", String, queue_size=10)
    odom = rospy.Publisher("odom", Odometry, queue_size=10)
    rospy.Service("switch", SetBool, lambda request: (request.data, "is %s" % request.data))
    rospy.Subscriber("orders", String, lambda message: print("got", message.data))
    rate = rospy.Rate(10)
    i = 0
    while not rospy.is_shutdown():
        said.publish("m%d" % i)
        message = Odometry()
        message.header.stamp = rospy.Time.now() - rospy.Duration(0.25)
        message.pose.pose.position.x = i / 2
        odom.publish(message)
        i += 1
        rate.sleep()
"""


def robot(folder: Path) -> Path:
    """Return its mission's folder."""
    (folder / "robot.py").write_text(textwrap.dedent(ROBOT), encoding="utf-8")
    (folder / "startup.scr").write_text(
        "CFE_APP, robot.py, __main__, ROBOT, 100, 16384, 0x0, 0;\n!\n", encoding="utf-8"
    )
    return folder
