#!/usr/bin/env python3
"""The twin of src/twin.cpp."""

import diagnostic_updater
import rospy
from diagnostic_msgs.msg import DiagnosticStatus


class Twin:
    """The node's tasks."""

    calls = 0

    def function(self, status):
        self.calls += 1
        status.summary(DiagnosticStatus.OK, f"call {self.calls}")
        status.add("calls", str(self.calls))
        status.add("text", "some text")
        return status

    def check(self, status):
        third = self.calls % 3 == 0
        status.summary(DiagnosticStatus.ERROR if third else DiagnosticStatus.WARN, "third" if third else "not third")
        status.add("rest", f"{self.calls % 3} of 3")
        return status


if __name__ == "__main__":
    rospy.init_node("twin")
    updater = diagnostic_updater.Updater()
    updater.setHardwareID("a device")
    twin = Twin()
    updater.add("function", twin.function)
    updater.add("method", twin.check)
    rospy.sleep(1)
    for _ in range(6):
        updater.force_update()
        rospy.sleep(1)
    rospy.spin()
