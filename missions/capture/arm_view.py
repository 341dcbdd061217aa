#!/usr/bin/env python3
"""What a person sees of the capture in a 3D view: the arm as it moves, and the debris that it catches.

The robot's description (URDF) is made from `arm_description.py`, a link for each joint, with the joint's name and
`_link`. The debris floats where the fingers will close, and goes with the hand from the phase `retract` on.

Subscribes: `joint_states_throttle` (sensor_msgs/JointState), `phase` (std_msgs/String)
Publishes:  `/tf` (from `arm_base` to each link), `/tf_static` (`world` to `arm_base`),
            `debris` (visualization_msgs/Marker, latched),
            `robot_description` (std_msgs/String, latched: recordings have no parameters)
Parameters: sets `/robot_description`; ~contact (7 rad): the pose of the arm that touches the debris
"""

from __future__ import annotations

import contextlib
from collections.abc import Sequence

import rospy
import tf2_ros
from arm_description import CHAIN, JOINT_NAMES, ROLL, hand_pose, joint_values, rotation
from geometry_msgs.msg import Point, Quaternion, TransformStamped
from main_control import CONTACT
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from visualization_msgs.msg import Marker

WORLD, BASE, HAND = "world", "arm_base", "hand_link"
THICKNESS = (0.10, 0.09, 0.08, 0.07, 0.06, 0.05, 0.05)  # m, radius of each link
LINKS = [f"{name}_link" for name in JOINT_NAMES]


def description() -> str:
    """The arm as a URDF: a cylinder for each link, blue where it rolls and grey where it pitches."""
    colours = '<material name="roll"><color rgba="0.2 0.4 0.8 1"/></material>'
    colours += '<material name="pitch"><color rgba="0.7 0.7 0.7 1"/></material>'
    parts = [f'<robot name="arm">{colours}{_link(BASE, "pitch", 0.15, 0.06, -0.06)}']
    parent, reach = BASE, 0.0
    for link, joint, (axis, length), radius in zip(LINKS, JOINT_NAMES, CHAIN, THICKNESS):
        parts.append(_link(link, "roll" if axis == ROLL else "pitch", radius, length))
        parts.append(_joint(joint, "continuous", parent, link, reach, f'<axis xyz="{axis.x} {axis.y} {axis.z}"/>'))
        parent, reach = link, length
    parts.append(f'<link name="{HAND}"/>{_joint("hand", "fixed", parent, HAND, reach)}</robot>')
    return "".join(parts)


def _link(name: str, colour: str, radius: float, length: float, below: float = 0.0) -> str:
    shape = f'<cylinder radius="{radius}" length="{length}"/>'
    origin = f'<origin xyz="0 0 {below + length / 2}"/>'
    visual = f'{origin}<geometry>{shape}</geometry><material name="{colour}"/>'
    return f'<link name="{name}"><visual>{visual}</visual></link>'


def _joint(name: str, kind: str, parent: str, child: str, reach: float, axis: str = "") -> str:
    ends = f'<parent link="{parent}"/><child link="{child}"/>'
    return f'<joint name="{name}" type="{kind}">{ends}<origin xyz="0 0 {reach}"/>{axis}</joint>'


def transform(
    parent: str, child: str, stamp: rospy.Time, reach: float, turn: Sequence[float] = (0.0, 0.0, 0.0, 1.0)
) -> TransformStamped:
    """From a link to the next, which begins `reach` metres along it."""
    found = TransformStamped()
    found.header.stamp, found.header.frame_id, found.child_frame_id = stamp, parent, child
    found.transform.translation.z = reach
    found.transform.rotation = Quaternion(*turn)
    return found


class ArmView:
    """The node: a transform for each link with each joint state, and the debris when it is caught."""

    def __init__(self) -> None:
        urdf = description()
        rospy.set_param("/robot_description", urdf)
        self._description = rospy.Publisher("robot_description", String, queue_size=1, latch=True)
        self._description.publish(urdf)
        self._moving = tf2_ros.TransformBroadcaster()
        self._fixed = tf2_ros.StaticTransformBroadcaster()
        now = rospy.Time.now()
        self._fixed.sendTransform([transform(WORLD, BASE, now, 0.5), transform(LINKS[-1], HAND, now, CHAIN[-1][1])])
        self._debris = rospy.Publisher("debris", Marker, queue_size=1, latch=True)
        place, turn = hand_pose(joint_values("~contact", CONTACT))
        self._show_debris(BASE, Point(*place), Quaternion(*turn))
        rospy.Subscriber("joint_states_throttle", JointState, self._on_state, queue_size=1)
        rospy.Subscriber("phase", String, self._on_phase, queue_size=4)

    def _on_state(self, message: JointState) -> None:
        parent, reach, found = BASE, 0.0, []
        for link, (axis, length), angle in zip(LINKS, CHAIN, message.position):
            found.append(transform(parent, link, message.header.stamp, reach, rotation(axis, angle)))
            parent, reach = link, length
        self._moving.sendTransform(found)

    def _on_phase(self, message: String) -> None:
        if message.data == "retract":
            self._show_debris(HAND, Point(), Quaternion(w=1.0))

    def _show_debris(self, frame: str, place: Point, turn: Quaternion) -> None:
        marker = Marker(ns="debris", type=Marker.CUBE, action=Marker.ADD, frame_locked=True)
        marker.header.frame_id = frame
        marker.pose.position, marker.pose.orientation = place, turn
        marker.scale.x, marker.scale.y, marker.scale.z = 0.25, 0.25, 0.25
        marker.color.r, marker.color.g, marker.color.b, marker.color.a = 0.9, 0.6, 0.1, 1.0
        self._debris.publish(marker)


def main() -> None:
    rospy.init_node("arm_view")
    ArmView()
    rospy.spin()


if __name__ == "__main__":
    with contextlib.suppress(rospy.ROSInterruptException):
        main()
