# ruff: noqa: PT009  # a test node of ROS is a unittest
"""rostest/publishtest: a test that messages come on topics, or do not (wiki.ros.org/rostest/Nodes).

Private parameter: topics, a list of mappings with name; timeout in s (10); negative, whether no message may come.
"""

from __future__ import annotations

import sys
import unittest

import rospy
import rostest

LOOK_S = 0.01


class PublishTest(unittest.TestCase):
    """Topics with and without messages."""

    def test_publish(self) -> None:
        """Check that each topic has a message within its time, or none if that is expected."""
        rospy.init_node("publishtest")
        topics = rospy.get_param("~topics", [])
        self.assertTrue(topics, "no topic in the parameter ~topics")
        self.assertTrue(all("name" in topic for topic in topics), "each of ~topics needs a name")
        heard: set[str] = set()
        for topic in topics:
            rospy.Subscriber(topic["name"], rospy.AnyMsg, lambda message, name: heard.add(name), topic["name"])
        begin, waiting = rospy.get_time(), list(topics)
        while waiting and not rospy.is_shutdown():
            for topic in waiting[:]:
                name, negative = topic["name"], topic.get("negative", False)
                if name in heard:
                    self.assertFalse(negative, f"Topic [{name}] is published")
                    waiting.remove(topic)
                elif rospy.get_time() > begin + topic.get("timeout", 10):
                    self.assertTrue(negative, f"Topic [{name}] is not published")
                    waiting.remove(topic)
            rospy.sleep(LOOK_S)


if __name__ == "__main__":
    rostest.run("rostest", "publishtest", PublishTest, sys.argv)
