"""tf2_ros and tf2_geometry_msgs in one universe: the content of a buffer, and data that is transformed with it."""

from __future__ import annotations

import math
from typing import Any

import pytest

from cfepy.nodes import Universe
from tests.ros_libraries.world import universe

HALF = math.sqrt(0.5)


@pytest.fixture
def node() -> Universe:
    return universe()


def stamped(load: Any, parent: str, child: str, seconds: float, *numbers: float) -> Any:
    msg = load("geometry_msgs.msg")
    message = msg.TransformStamped(child_frame_id=child)
    message.header.frame_id, message.header.stamp = parent, load("rospy").Time.from_sec(seconds)
    message.transform = msg.Transform(msg.Vector3(*numbers[:3]), msg.Quaternion(*(numbers[3:] or (0, 0, 0, 1))))
    return message


def buffer_of(load: Any) -> Any:
    """Return a buffer with `base` a quarter turn left of `map`, 1 m ahead."""
    buffer = load("tf2_ros").Buffer(debug=False)
    buffer.set_transform(stamped(load, "map", "base", 5, 1, 0, 0, 0, 0, HALF, HALF), "me")
    return buffer


BAD = [
    (("base", "base", 1), 'Error:   TF_SELF_TRANSFORM: Ignoring transform from authority "me" with frame_id and '),
    (("map", "", 1), 'Error:   TF_NO_CHILD_FRAME_ID: Ignoring transform from authority "me" because child_frame_id '),
    (("", "base", 1), 'Error:   TF_NO_FRAME_ID: Ignoring transform with child_frame_id "base"  from authority "me" '),
    (("map", "base", 1, math.nan, 0, 0), 'Error:   TF_NAN_INPUT: Ignoring transform for child_frame_id "base" from '),
    (("map", "base", 1, 0, 0, 0, 0, 0, 0, 2), "Error:   TF_DENORMALIZED_QUATERNION: Ignoring transform for child_fr"),
]


@pytest.mark.parametrize(("transform", "text"), BAD, ids=lambda value: value[9:30] if isinstance(value, str) else "")
def test_invalid_transform_is_reported(node: Universe, transform: Any, text: str) -> None:
    load = node.importer.load
    buffer = load("tf2_py").BufferCore()
    buffer.set_transform(stamped(load, *transform[:3], *(transform[3:] or (0, 0, 0))), "me")
    assert node.output[0].removeprefix("[node] ").startswith(text)
    assert buffer._getFrameStrings() == []


def test_old_and_repeated_data_are_reported(node: Universe) -> None:
    load = node.importer.load
    buffer = load("tf2_py").BufferCore()
    for seconds in (100, 100, 80):
        buffer.set_transform(stamped(load, "map", "base", seconds, 0, 0, 0), "me")
    where = "for frame base (parent map) at time"
    assert node.output == [
        f"[node] Warning: TF_REPEATED_DATA ignoring data with redundant timestamp {where} 100.000000 according to "
        "authority me",
        "[node] Warning: TF_OLD_DATA ignoring data from the past (Possible reasons are listed at "
        f"http://wiki.ros.org/tf/Errors%20explained) {where} 80.000000 according to authority me",
    ]


def test_arguments_of_the_wrong_kind(node: Universe) -> None:
    load = node.importer.load
    buffer = buffer_of(load)
    with pytest.raises(TypeError, match="time must have a to_sec method"):
        buffer.lookup_transform("map", "base", 5)
    with pytest.raises(TypeError, match="must be str, not int"):
        buffer.lookup_transform("map", 5, load("rospy").Time(0))
    incomplete = stamped(load, "map", "base", 6, 0, 0, 0)
    incomplete.transform.rotation = object()
    with pytest.raises(TypeError, match=r"transform\.rotation must have members w, x, y, z"):
        buffer.set_transform(incomplete, "me")


def test_texts_with_a_nul_are_refused(node: Universe) -> None:
    load = node.importer.load
    buffer, time = buffer_of(load), load("rospy").Time(0)
    calls = (
        lambda: buffer.set_transform(stamped(load, "map", "base", 6, 0, 0, 0), "m\0e"),
        lambda: buffer.lookup_transform("map", "ba\0se", time),
        lambda: buffer.can_transform_full("map", time, "base", time, "\0"),
        lambda: buffer._frameExists("ma\0p"),
    )
    for call in calls:
        with pytest.raises(ValueError, match="embedded null character"):
            call()
    with pytest.raises(TypeError, match="argument 1 must be str, not int"):
        buffer._frameExists(5)


def test_static_transforms_hold_at_all_times(node: Universe) -> None:
    load = node.importer.load
    buffer, time = buffer_of(load), load("rospy").Time
    buffer.set_transform_static(stamped(load, "base", "laser", 99, 0, 0, 0.5), "me")
    assert buffer.lookup_transform("base", "laser", time(1234)).header.stamp == time(1234)
    assert buffer.lookup_transform("map", "laser", time(0)).header.stamp == time(5)
    buffer.clear()
    assert buffer.can_transform("base", "laser", time(0)) == 1
    assert buffer.can_transform("map", "laser", time(0)) == 0


def test_points_are_turned_and_moved_vectors_only_turned(node: Universe) -> None:
    load = node.importer.load
    msg, buffer = load("geometry_msgs.msg"), buffer_of(load)
    load("tf2_geometry_msgs")
    point = msg.PointStamped(point=msg.Point(2, 0, 0))
    vector = msg.Vector3Stamped(vector=msg.Vector3(2, 0, 0))
    wrench = msg.WrenchStamped(wrench=msg.Wrench(msg.Vector3(2, 0, 0), msg.Vector3(0, 2, 0)))
    for each in (point, vector, wrench):
        each.header.frame_id = "base"
    moved, turned, pushed = (buffer.transform(each, "map") for each in (point, vector, wrench))
    assert numbers(moved.point) == pytest.approx([1, 2, 0])
    assert (moved.header.frame_id, moved.header.stamp.secs) == ("map", 5)
    assert numbers(turned.vector) == pytest.approx([0, 2, 0])
    assert numbers(pushed.wrench.force) == pytest.approx([0, 2, 0])
    assert numbers(pushed.wrench.torque) == pytest.approx([-2, 0, 0])


@pytest.mark.parametrize("turn", [(0, 0, 0, 1), (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, HALF, HALF)])
def test_poses_are_turned_and_moved(node: Universe, turn: tuple[float, ...]) -> None:
    load = node.importer.load
    msg, buffer = load("geometry_msgs.msg"), buffer_of(load)
    load("tf2_geometry_msgs")
    pose = msg.PoseStamped(pose=msg.Pose(msg.Point(2, 0, 1), msg.Quaternion(*turn)))
    pose.header.frame_id = "base"
    found = buffer.transform(pose, "map").pose
    product = load("tf.transformations").quaternion_multiply((0, 0, HALF, HALF), turn)
    assert numbers(found.position) == pytest.approx([1, 2, 1])
    o = found.orientation
    assert abs(sum(a * b for a, b in zip((o.x, o.y, o.z, o.w), product, strict=True))) == pytest.approx(1.0)


def numbers(value: Any) -> list[float]:
    return [value.x, value.y, value.z]


def test_unregistered_types_are_refused(node: Universe) -> None:
    load = node.importer.load
    tf2_ros, msg = load("tf2_ros"), load("geometry_msgs.msg")
    with pytest.raises(tf2_ros.TypeException) as caught:
        buffer_of(load).transform(msg.PolygonStamped(), "map")
    assert "PolygonStamped" in caught.value.errstr
    with pytest.raises(tf2_ros.NotImplementedException):
        tf2_ros.BufferInterface().lookup_transform("map", "base", load("rospy").Time(0))


def test_converting(node: Universe) -> None:
    load = node.importer.load
    tf2_ros, msg = load("tf2_ros"), load("geometry_msgs.msg")
    registration = tf2_ros.ConvertRegistration()
    registration.add_to_msg(complex, lambda value: msg.Point(value.real, value.imag, 0))
    registration.add_from_msg(list, lambda message: [message.x, message.y])
    registration.add_convert((complex, str), str)
    assert tf2_ros.convert(1 + 2j, list) == [1, 2]
    assert tf2_ros.convert(1 + 2j, str) == "(1+2j)"
    point = msg.Point(1, 2, 3)
    copy = tf2_ros.convert(point, msg.Point)
    assert (copy == point, copy is point) == (True, False)
    buffer = buffer_of(load)
    tf2_ros.TransformRegistration().add(msg.PointStamped, lambda data, transform: 3 + 4j)
    data = tf2_ros.Stamped(msg.PointStamped(), load("rospy").Time(5), "base")
    assert buffer.transform(data, "map", new_type=list) == [3, 4]
    assert buffer.transform_full(data, "map", load("rospy").Time(5), "map", new_type=str) == "(3+4j)"


def test_unknown_names_of_tf2_ros_are_an_error(node: Universe) -> None:
    with pytest.raises(AttributeError, match="BufferKlient"):
        _ = node.importer.load("tf2_ros").BufferKlient


def test_unregistered_type_has_the_error_text_of_tf2_ros(node: Universe) -> None:
    """The texts are those of tf2_ros 0.7.6."""
    load = node.importer.load
    error = load("tf2_ros").TypeException
    with pytest.raises(error, match=r"^Type <class 'int'> if not loaded or supported$"):
        buffer_of(load).transform(5, "map")
    with pytest.raises(error, match=r"^Type <class 'int'> if not loaded or supported$"):
        load("tf2_ros").convert(5, str)
