#!/usr/bin/env python3
"""The twin of src/twin.cpp."""

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import Pose, PoseArray
from sensor_msgs.msg import Image, PointCloud2
from trajectory_msgs.msg import JointTrajectory


def on_poses(message):
    message.header.frame_id += "_out"
    for each in message.poses:
        each.position.x *= 2
        each.orientation.w = each.position.y + each.position.z
    message.poses.append(Pose())
    return message


def on_trajectory(message):
    message.joint_names.insert(0, "first")
    for point in message.points:
        point.positions = (*point.positions, 0.5)
        point.time_from_start += rospy.Duration(0.25)
    return message


def on_diagnostics(message):
    for status in message.status:
        status.level = DiagnosticStatus.WARN
        status.values.append(KeyValue("values", str(len(status.values))))
    return message


def on_cloud(message):
    message.data = bytes(byte ^ 0xFF for byte in message.data)
    message.is_dense = not message.is_dense
    return message


def on_image(message):
    message.data += message.data[::-1]
    message.height *= 2
    return message


def echo(name, kind, act):
    """Publish a function's result for each message."""
    publisher = rospy.Publisher(f"{name}_out", kind, queue_size=5)
    rospy.Subscriber(name, kind, lambda message: publisher.publish(act(message)), queue_size=5)


if __name__ == "__main__":
    rospy.init_node("twin")
    echo("poses", PoseArray, on_poses)
    echo("trajectory", JointTrajectory, on_trajectory)
    echo("diagnostics", DiagnosticArray, on_diagnostics)
    echo("cloud", PointCloud2, on_cloud)
    echo("image", Image, on_image)
    rospy.spin()
