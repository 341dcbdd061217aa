# ruff: noqa: PT009  # a test node of ROS is a unittest
"""rostest/hztest: a test that messages come at a rate (wiki.ros.org/rostest/Nodes).

Private parameters: topic; hz and hzerror, the rate in Hz and its tolerance; test_duration in s; wait_time, the longest
wait for the first message, in s (20); check_intervals, whether each interval must keep the rate.
"""

from __future__ import annotations

import sys
import unittest
from typing import Any

import rospy
import rostest

LOOK_S = 0.1


class HzTest(unittest.TestCase):
    """One topic's rate."""

    def setUp(self) -> None:
        rospy.init_node("hztest")
        self.times: list[float] = []

    def needed(self, name: str) -> Any:
        """Return a required private parameter."""
        if not rospy.has_param(f"~{name}"):
            self.fail(f"hztest requires the parameter {rospy.resolve_name('~' + name)}")
        return rospy.get_param(f"~{name}")

    def test_hz(self) -> None:
        """Check that messages come at the rate, or none at all if it is 0."""
        topic, hz, duration = self.needed("topic"), float(self.needed("hz")), float(self.needed("test_duration"))
        error = float(self.needed("hzerror")) if hz else 0.0
        self.assertTrue(hz >= 0 and error >= 0 and duration > 0 and topic, "bad parameters")
        subscriber = rospy.Subscriber(topic, rospy.AnyMsg, lambda message: self.times.append(rospy.get_time()))
        self.wait_for_first(float(rospy.get_param("~wait_time", 20.0)))
        if not hz:
            self.assertFalse(self.times, f"a message came on {topic}")
        else:
            self.assertTrue(self.times, f"no message came on {topic}")
        rospy.sleep(duration)
        subscriber.unregister()
        if not hz:
            self.assertFalse(self.times, f"a message came on {topic}")
            return
        self.check_rate(hz - error, hz + error)
        if rospy.get_param("~check_intervals", False):
            self.check_intervals(hz - error, hz + error)

    def wait_for_first(self, seconds: float) -> None:
        """Wait for the first message, or until time is over."""
        end = rospy.get_time() + seconds
        while not self.times and rospy.get_time() < end:
            rospy.sleep(LOOK_S)

    def check_rate(self, least: float, most: float) -> None:
        """Check that the average rate in Hz is between two limits."""
        taken = self.times[-1] - self.times[0]
        self.assertGreater(taken, 0, "only one message came")
        rate = (len(self.times) - 1) / taken
        self.assertGreaterEqual(rate, least, f"average rate ({rate:.3f}Hz) is below the minimum ({least:.3f}Hz)")
        self.assertLessEqual(rate, most, f"average rate ({rate:.3f}Hz) is above the maximum ({most:.3f}Hz)")

    def check_intervals(self, least: float, most: float) -> None:
        """Check that all intervals keep the rate; a minimum rate of 0 or less permits any length."""
        for before, after in zip(self.times, self.times[1:], strict=False):
            interval = after - before
            self.assertGreaterEqual(interval, 1 / most, f"interval {interval:f} s is too short")
            if least > 0:
                self.assertLessEqual(interval, 1 / least, f"interval {interval:f} s is too long")


if __name__ == "__main__":
    rostest.run("rostest", "hztest", HzTest, sys.argv)
