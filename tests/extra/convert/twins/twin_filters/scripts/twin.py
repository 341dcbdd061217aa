#!/usr/bin/env python3
"""The twin of src/twin.cpp."""

import message_filters
import rospy
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import Imu
from std_msgs.msg import String


def both(imu, pose):
    out.publish(f"{imu.header.stamp.to_nsec()} {imu.header.frame_id} {pose.header.frame_id}")


if __name__ == "__main__":
    rospy.init_node("twin")
    out = rospy.Publisher("out", String, queue_size=100)
    filters = [message_filters.Subscriber("imu", Imu), message_filters.Subscriber("pose", PoseStamped)]
    message_filters.TimeSynchronizer(filters, 5).registerCallback(both)
    rospy.spin()
