# ruff: noqa: PT009  # a test node of ROS is a unittest
"""rostest/paramtest: a test that a parameter exists (wiki.ros.org/rostest/Nodes).

Private parameters: param_name_target; param_value_expected, if its value counts too; wait_time in s (20).
"""

from __future__ import annotations

import sys
import unittest

import rospy
import rostest

LOOK_S = 0.1


class ParamTest(unittest.TestCase):
    """One parameter."""

    def test_param(self) -> None:
        """Check that it exists in time, and has the expected value."""
        rospy.init_node("paramtest")
        name, expected = rospy.get_param("~param_name_target"), rospy.get_param("~param_value_expected", None)
        end = rospy.get_time() + float(rospy.get_param("~wait_time", 20))
        while not rospy.has_param(name) and rospy.get_time() < end:
            rospy.sleep(LOOK_S)
        value = rospy.get_param(name, None)
        if expected:
            self.assertEqual(expected, value)
        else:
            self.assertIsNotNone(value, f"unknown parameter {name}")


if __name__ == "__main__":
    rostest.run("rostest", "paramtest", ParamTest, sys.argv)
