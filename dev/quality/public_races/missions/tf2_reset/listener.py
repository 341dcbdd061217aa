"""Listens to tf. The clock never jumps back, so the buffer must not be cleared."""

import os

import rospy
import tf2_ros
import transform_listener


class Buffer(tf2_ros.Buffer):
    def clear(self):
        os._exit(1)


rospy.init_node("listener")
listener = transform_listener.TransformListener(Buffer())
rospy.spin()
