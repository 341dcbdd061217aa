"""robot_state_publisher/robot_state_publisher: transforms of a robot's links from its joints' positions.

Reads the URDF in the parameter robot_description, listens to joint_states, and sends the transforms of moving joints on
/tf and of fixed ones on /tf_static. Private parameters: publish_frequency in Hz (50), the most that one joint's
transform is sent; use_tf_static; ignore_timestamp. Source: wiki.ros.org/robot_state_publisher.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import Any
from xml.etree import ElementTree

import numpy
import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import JointState
from tf import transformations

FIXED, TURNING, SLIDING = "fixed", ("revolute", "continuous"), "prismatic"


class Joint:
    """One joint of a URDF.

    Args:
        tag: its <joint>.

    Raises:
        ValueError: an attribute does not consist of three numbers.
    """

    def __init__(self, tag: ElementTree.Element) -> None:
        origin, axis, mimic = tag.find("origin"), tag.find("axis"), tag.find("mimic")
        self.name, self.kind = tag.get("name", ""), tag.get("type", "")
        self.parent, self.child = _link(tag, "parent"), _link(tag, "child")
        self.place = _numbers(origin, "xyz", "0 0 0")
        self.turn = transformations.quaternion_from_euler(*_numbers(origin, "rpy", "0 0 0"))
        self.axis = transformations.unit_vector(_numbers(axis, "xyz", "1 0 0"))
        self.leader = "" if mimic is None else mimic.get("joint", "")
        self.factor = 1.0 if mimic is None else float(mimic.get("multiplier", 1))
        self.offset = 0.0 if mimic is None else float(mimic.get("offset", 0))

    def transform(self, position: float, stamp: Any) -> TransformStamped:
        """Return the transform from the parent's to the child's frame, for a position in rad or m."""
        place, turn = self.place, self.turn
        if self.kind in TURNING:
            turn = transformations.quaternion_multiply(turn, transformations.quaternion_about_axis(position, self.axis))
        elif self.kind == SLIDING:
            place = place + transformations.quaternion_matrix(turn)[:3, :3] @ (self.axis * position)
        message = TransformStamped()
        message.header.stamp, message.header.frame_id, message.child_frame_id = stamp, self.parent, self.child
        to, by = message.transform.translation, message.transform.rotation
        to.x, to.y, to.z = map(float, place)
        by.x, by.y, by.z, by.w = map(float, turn)
        return message


def _link(tag: ElementTree.Element, side: str) -> str:
    found = tag.find(side)
    return "" if found is None else found.get("link", "").lstrip("/")


def _numbers(tag: ElementTree.Element | None, name: str, default: str) -> Any:
    text = default if tag is None else tag.get(name, default)
    try:
        numbers = numpy.array([float(word) for word in text.split()])
    except ValueError:
        numbers = numpy.zeros(0)
    if len(numbers) != 3:
        raise ValueError(f"{name} must be three numbers, not {text!r}")
    return numbers


def joints_of(text: str) -> list[Joint]:
    """Return the joints of a URDF.

    Raises:
        ValueError: it is not a URDF, or a joint has an error.
    """
    try:
        tags = ElementTree.fromstring(text).findall("joint")
    except ElementTree.ParseError as error:
        raise ValueError(str(error)) from None
    found = []
    for tag in tags:
        try:
            found.append(Joint(tag))
        except ValueError as error:
            raise ValueError(f"joint {tag.get('name')}: {error}") from None
    return found


class RobotStatePublisher:
    """Sends the transforms of one robot.

    Args:
        joints: all of its joints.
    """

    def __init__(self, joints: list[Joint]) -> None:
        self._fixed = [joint for joint in joints if joint.kind == FIXED]
        self._moving = {joint.name: joint for joint in joints if joint.kind in (*TURNING, SLIDING)}
        self._interval = rospy.Duration(1 / float(rospy.get_param("~publish_frequency", 50.0)))
        self._any_stamp = rospy.get_param("~ignore_timestamp", False)
        self._sent: dict[str, Any] = {}
        self._broadcaster = tf2_ros.TransformBroadcaster()
        self._static = tf2_ros.StaticTransformBroadcaster()
        if rospy.get_param("~use_tf_static", True):
            self._static.sendTransform(self._fixed_transforms())
        else:
            self._timer = rospy.Timer(self._interval, lambda event: self._send(self._fixed_transforms()))
        rospy.Subscriber("joint_states", JointState, self.take, queue_size=1)

    def _send(self, transforms: list[TransformStamped]) -> None:
        if transforms:
            self._broadcaster.sendTransform(transforms)

    def _fixed_transforms(self) -> list[TransformStamped]:
        return [joint.transform(0.0, rospy.Time.now()) for joint in self._fixed]

    def take(self, state: JointState) -> None:
        """Send the transforms for new positions, unless the same joints were sent a moment ago."""
        stamp = state.header.stamp
        positions = dict(zip(state.name, state.position, strict=False))
        last = min((self._sent.get(name, rospy.Time(0)) for name in positions), default=rospy.Time(0))
        if not self._any_stamp and stamp < last + self._interval:
            return
        positions.update(self._followers(positions))
        moving = [(self._moving[name], position) for name, position in positions.items() if name in self._moving]
        self._send([joint.transform(position, stamp) for joint, position in moving])
        self._sent.update((name, stamp) for name in positions)

    def _followers(self, positions: dict[str, float]) -> Iterator[tuple[str, float]]:
        """Yield joints that follow others, and are not in the message themselves."""
        for joint in self._moving.values():
            if joint.leader in positions and joint.name not in positions:
                yield joint.name, positions[joint.leader] * joint.factor + joint.offset


def main() -> int:
    """Run until the end."""
    rospy.init_node("robot_state_publisher")
    key = rospy.search_param("robot_description")
    try:
        joints = joints_of(rospy.get_param(key or "robot_description"))
    except (KeyError, ValueError) as error:
        rospy.logerr("robot_description is not a URDF: %s", error)
        return 1
    RobotStatePublisher(joints)
    rospy.spin()
    return 0


if __name__ == "__main__":
    sys.exit(main())
