"""tf's own interface to a buffer: `Transformer` and `TransformerROS`."""

from __future__ import annotations

import math
from typing import Any

import pytest

from tests.ros_libraries.test_tf2_buffer import HALF, numbers, stamped
from tests.ros_libraries.world import universe

load: Any = universe().importer.load
rospy, msg, tf = load("rospy"), load("geometry_msgs.msg"), load("tf")


@pytest.fixture
def transformer() -> Any:
    found = tf.TransformerROS()
    for seconds in (5, 6):
        found.setTransform(stamped(load, "map", "base", seconds, seconds - 4, 0, 0, 0, 0, HALF, HALF))
    return found


def at_base(message: Any) -> Any:
    message.header.frame_id, message.header.stamp = "base", rospy.Time(5)
    return message


def test_frames_may_begin_with_a_slash(transformer: Any) -> None:
    translation, rotation = transformer.lookupTransform("/map", "/base", rospy.Time(0))
    assert translation == pytest.approx([2, 0, 0])
    assert rotation == pytest.approx([0, 0, HALF, HALF])
    assert transformer.canTransform("/map", "/base", rospy.Time(5))
    assert transformer.getLatestCommonTime("/map", "/base") == rospy.Time(6)


def test_messages_are_transformed(transformer: Any) -> None:
    point = transformer.transformPoint("map", at_base(msg.PointStamped(point=msg.Point(2, 0, 0))))
    assert numbers(point.point) == pytest.approx([1, 2, 0])
    assert (point.header.frame_id, point.header.stamp) == ("map", rospy.Time(5))
    vector = transformer.transformVector3("map", at_base(msg.Vector3Stamped(vector=msg.Vector3(2, 0, 0))))
    assert numbers(vector.vector) == pytest.approx([0, 2, 0])
    turn = msg.Quaternion(0, 0, HALF, HALF)
    turned = transformer.transformQuaternion("map", at_base(msg.QuaternionStamped(quaternion=turn))).quaternion
    assert (turned.z, turned.w) == pytest.approx((1, 0))
    pose = transformer.transformPose("map", at_base(msg.PoseStamped(pose=msg.Pose(msg.Point(2, 0, 0), turn)))).pose
    assert numbers(pose.position) == pytest.approx([1, 2, 0])
    assert (pose.orientation.z, pose.orientation.w) == pytest.approx((1, 0))


def test_a_cloud_is_transformed(transformer: Any) -> None:
    cloud = at_base(load("sensor_msgs.msg").PointCloud(points=[msg.Point32(2, 0, 0), msg.Point32(0, 2, 1)]))
    found = transformer.transformPointCloud("map", cloud)
    assert [numbers(point) for point in found.points] == [pytest.approx([1, 2, 0]), pytest.approx([-1, 0, 1])]


def test_between_two_times(transformer: Any) -> None:
    times = {"target_time": rospy.Time(6), "source_time": rospy.Time(5)}
    args = {"target_frame": "base", "source_frame": "base", "fixed_frame": "map", **times}
    assert transformer.canTransformFull(**args)
    translation, _ = transformer.lookupTransformFull(**args)
    assert translation == pytest.approx([0, 1, 0])
    assert transformer.chain("base", rospy.Time(6), "base", rospy.Time(5), "map") == ["base", "map", "base"]


def test_wait_for_transform_requires_a_dedicated_thread(transformer: Any) -> None:
    with pytest.raises(tf.Exception, match="without a dedicated thread"):
        transformer.waitForTransform("map", "base", rospy.Time(5), rospy.Duration(0))
    transformer.setUsingDedicatedThread(True)
    transformer.waitForTransform("map", "base", rospy.Time(5), rospy.Duration(0))
    transformer.waitForTransformFull("map", rospy.Time(5), "base", rospy.Time(5), "map", rospy.Duration(0))
    with pytest.raises(tf.Exception, match="source_frame elsewhere does not exist"):
        transformer.waitForTransform("map", "elsewhere", rospy.Time(5), rospy.Duration(0))


def moving(speed: float, turning: float) -> Any:
    """Return a frame that moves along x and turns about z, with a sample each 0.1 s."""
    found = tf.Transformer()
    for tenth in range(50):
        half = turning * tenth / 20
        pose = (speed * tenth / 10, 0, 0, 0, 0, math.sin(half), math.cos(half))
        found.setTransform(stamped(load, "map", "base", 1 + tenth / 10, *pose))
    return found


def test_velocity_of_a_frame_that_moves() -> None:
    linear, angular = moving(3.0, 0.0).lookupTwist("base", "map", rospy.Time(3), rospy.Duration(0.5))
    assert linear == pytest.approx((3, 0, 0))
    assert angular == pytest.approx((0, 0, 0))


def test_velocity_of_a_frame_that_turns() -> None:
    found = moving(0.0, 0.2).lookupTwist("base", "map", rospy.Time(0), rospy.Duration(0.5))
    assert [*found[0], *found[1]] == pytest.approx([0, 0, 0, 0, 0, 0.2], abs=1e-9)


def test_frames_are_listed(transformer: Any) -> None:
    assert transformer.getFrameStrings() == ["base"]
    assert (transformer.frameExists("base"), transformer.frameExists("map")) == (True, False)
    assert transformer.allFramesAsString() == "Frame base exists with parent map.\n"
    assert "( 1.000 sec old)" in transformer.allFramesAsDot(rospy.Time(7))
    assert transformer.getTFPrefix() == ""
    transformer.clear()
    assert transformer.getFrameStrings() == []
