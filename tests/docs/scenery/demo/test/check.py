#!/usr/bin/env python3
"""Whether the talker is heard."""

import unittest

import rospy
import rostest
from std_msgs.msg import String


class TestTalker(unittest.TestCase):
    def test_hears(self):
        rospy.init_node("check")
        heard = rospy.wait_for_message("chatter", String, timeout=2).data
        if not heard.startswith("hello"):
            self.fail("heard " + heard)


rostest.rosrun("demo", "check", TestTalker)
