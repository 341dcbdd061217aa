"""tf_conversions and tf2_kdl: poses of ROS and tf as PyKDL's, and PyKDL's values in a tf2 buffer."""

from __future__ import annotations

import math
from typing import Any

import pytest

from tests.ros_libraries.world import universe


@pytest.fixture
def world() -> Any:
    return universe().importer


def test_poses(world: Any) -> None:
    pm, kdl = world.load("tf_conversions.posemath"), world.load("PyKDL")
    frame = kdl.Frame(kdl.Rotation.RPY(0.1, 0.2, 0.3), kdl.Vector(1, 2, 3))
    assert pm.fromMsg(pm.toMsg(frame)) == frame
    assert pm.fromTf(pm.toTf(frame)) == frame
    matrix = pm.toMatrix(frame)
    assert (matrix.shape, matrix[:3, 3].tolist(), matrix[3].tolist()) == ((4, 4), [1, 2, 3], [0, 0, 0, 1])
    assert pm.fromMatrix(matrix) == frame


def test_package_has_the_names_of_kdl_and_tf(world: Any) -> None:
    package = world.load("tf_conversions")
    assert package.Frame() == world.load("PyKDL").Frame()
    quaternion = package.transformations.quaternion_from_euler(0.1, 0.2, 0.3)
    assert package.Rotation.Quaternion(*quaternion) == package.Rotation.RPY(0.1, 0.2, 0.3)


def test_camera_parameters(world: Any) -> None:
    import numpy as np

    class Camera:
        @staticmethod
        def Rodrigues(rvec: Any) -> tuple[Any, None]:
            return np.eye(3) * rvec[0, 0], None

    frame = world.load("tf_conversions").fromCameraParams(Camera, np.array([[1.0]]), np.array([[1.0], [2.0], [3.0]]))
    assert (frame.M.m, frame.p.v) == ([1, 0, 0, 0, 1, 0, 0, 0, 1], [1, 2, 3])


def test_values_of_kdl_in_a_buffer(world: Any) -> None:
    tf2, kdl, rospy = world.load("tf2_ros"), world.load("PyKDL"), world.load("rospy")
    library = world.load("tf2_kdl")
    transform = world.load("geometry_msgs.msg").TransformStamped()
    transform.header.frame_id, transform.child_frame_id = "map", "base"
    transform.transform.translation.x, transform.transform.rotation.x = 10.0, 1.0
    core = tf2.BufferCore()
    core.set_transform(transform, "test")
    values = [kdl.Vector(1, 2, 3), kdl.Frame(), kdl.Twist(kdl.Vector(1, 2, 3), kdl.Vector()), kdl.Wrench()]
    found = core.lookup_transform_core("map", "base", rospy.Time(0))
    for value in values:
        stamped = tf2.Stamped(value, rospy.Time(0), "base")
        moved = tf2.TransformRegistration().get(type(value))(stamped, found)
        assert moved == library.transform_to_kdl(found) * value
        assert moved.header.frame_id == "map"
    point = library.to_msg_vector(tf2.Stamped(kdl.Vector(1, 2, 3), rospy.Time(4), "base"))
    assert (point.point.y, point.header.stamp.secs) == (2, 4)
    geometry = world.load("tf2_geometry_msgs")
    assert geometry.transform_to_kdl(found) == geometry.PyKDL.Frame(kdl.Rotation.RotX(math.pi), kdl.Vector(10, 0, 0))
    assert geometry.PointStamped is type(point)
    back = tf2.convert(point, kdl.Vector)
    assert (back, back.header.frame_id) == (kdl.Vector(1, 2, 3), "base")
    twin = tf2.convert(back, kdl.Vector)
    assert twin == back
