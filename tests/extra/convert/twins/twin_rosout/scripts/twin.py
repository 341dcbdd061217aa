#!/usr/bin/env python3
"""The twin of src/twin.cpp."""

import logging

import rospy


class Delayed:
    """ROS_INFO_DELAYED_THROTTLE, which rospy does not have: a period begins with the first call, which prints
    nothing."""

    def __init__(self, period):
        self.period = rospy.Duration(period)
        self.last = None

    def info(self, text):
        now = rospy.Time.now()
        if self.last is None:
            self.last = now
        elif now - self.last >= self.period:
            self.last = now
            rospy.loginfo(text)


if __name__ == "__main__":
    rospy.init_node("twin")
    rospy.sleep(1)
    delayed = Delayed(1.6)
    rate = rospy.Rate(4)
    cycle = 0
    while not rospy.is_shutdown():
        rospy.logdebug("debug %d", cycle)
        rospy.loginfo("info %d of %s, %.3f", cycle, "twin", cycle / 8.0)
        rospy.logwarn(f"warn {cycle} of a stream")
        if cycle % 3 == 0:
            rospy.logerr("error %d", cycle)
        if cycle == 7:
            rospy.logfatal(f"fatal {cycle}")
        rospy.loginfo_once("once, in cycle %d", cycle)
        rospy.logwarn_throttle(1.1, f"throttled, in cycle {cycle}")
        rospy.loginfo_throttle(2.6, f"a throttled stream, in cycle {cycle}")
        delayed.info(f"delayed, in cycle {cycle}")
        if cycle == 9:
            rospy.loginfo("x" * 300)
        if cycle == 20:
            logging.getLogger("rosout").setLevel(logging.DEBUG)
        cycle += 1
        rate.sleep()
