#!/usr/bin/env python3
"""The level stays within its bounds, and falls below them while the pump is stopped."""

import unittest

import rospy
import rostest
from std_msgs.msg import Float64
from std_srvs.srv import SetBool

LOW, HIGH = 3.8, 6.2


def level():
    """The next level that is published."""
    return rospy.wait_for_message("level", Float64, 5).data


def enable(on):
    """Let the pump run, or stop it; what it answers."""
    rospy.wait_for_service("pump/enable", 5)
    return rospy.ServiceProxy("pump/enable", SetBool)(on).message


class TestLevel(unittest.TestCase):
    """The tank, looked at from outside."""

    def test_it_stays_within_its_bounds(self):
        """For 20 s."""
        levels = [level() for _ in range(200)]
        assert min(levels) > LOW
        assert max(levels) < HIGH

    def test_it_falls_while_the_pump_is_stopped(self):
        """A service that answers and does nothing would not do."""
        assert enable(False) == "stopped"
        rospy.sleep(10)
        assert level() < LOW
        assert enable(True) == "enabled"
        rospy.sleep(5)
        assert level() > LOW


rospy.init_node("check_level")
rostest.rosrun("tank", "level", TestLevel)
