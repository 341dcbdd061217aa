#!/usr/bin/env python3
"""Messages of random contents and lengths, from one seed."""

import random

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import Point, Pose, PoseArray, Quaternion
from sensor_msgs.msg import Image, PointCloud2, PointField
from std_msgs.msg import Header
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

dice = random.Random(7)


def header():
    return Header(stamp=rospy.Time(dice.randrange(2**32), dice.randrange(10**9)), frame_id="f" * dice.randrange(20))


def pose():
    return Pose(Point(*(dice.uniform(-9, 9) for _ in range(3))), Quaternion(*(dice.random() for _ in range(4))))


def point():
    lists = [[dice.gauss(0, 1) for _ in range(dice.randrange(8))] for _ in range(4)]
    return JointTrajectoryPoint(*lists, rospy.Duration(dice.randrange(-50, 50), dice.randrange(10**9)))


def status():
    values = [KeyValue(f"key {n}", "v" * dice.randrange(40)) for n in range(dice.randrange(5))]
    return DiagnosticStatus(dice.randrange(3), "name", "message ü", "", values)


def some(make, most):
    return [make() for _ in range(dice.randrange(most))]


def cloud(size):
    fields = [PointField(name, 4 * n, PointField.FLOAT32, 1) for n, name in enumerate("xyz")]
    return PointCloud2(header(), 1, size // 12, fields, False, 12, size, dice.randbytes(size), bool(size % 24))


if __name__ == "__main__":
    rospy.init_node("stimulus")
    kinds = {"poses": PoseArray, "trajectory": JointTrajectory, "diagnostics": DiagnosticArray}
    kinds |= {"cloud": PointCloud2, "image": Image}
    into = {name: rospy.Publisher(name, kind, queue_size=5) for name, kind in kinds.items()}
    rospy.sleep(2)
    for cycle in range(15):
        into["poses"].publish(PoseArray(header(), some(pose, 30)))
        into["trajectory"].publish(JointTrajectory(header(), ["joint"] * cycle, some(point, 9)))
        into["diagnostics"].publish(DiagnosticArray(header(), some(status, 9)))
        into["cloud"].publish(cloud(12 * dice.randrange(900)))
        if cycle % 5 == 2:
            size = (100, 32768, 90001)[cycle // 5]
            into["image"].publish(Image(header(), 1, size, "mono8", 1, size, dice.randbytes(size)))
        rospy.sleep(0.5)
