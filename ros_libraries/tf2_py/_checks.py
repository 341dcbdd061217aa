"""Checks of a buffer of transforms, and their error texts. Imports tf2_py._rotation only."""

from __future__ import annotations

from tf2_py._rotation import Rigid

_SELF_TRANSFORM = 'with frame_id and child_frame_id  "{}" because they are the same'
_TOLERANCE = 0.01  # of a quaternion's squared length


def problems_of(child: str, parent: str, rigid: Rigid, authority: str, same: str = _SELF_TRANSFORM) -> list[str]:
    """Return the reasons why a transform cannot be used.

    Args:
        child, parent: names of its frames.
        rigid: translation and rotation.
        authority: name of the sender.
        same: text for a frame that is its own parent, which is not the same in ROS 1 and ROS 2.
    """
    found = []
    by = f'from authority "{authority}"'
    if child == parent:
        found.append(f"TF_SELF_TRANSFORM: Ignoring transform {by} {same.format(child)}")
    if not child:
        found.append(f"TF_NO_CHILD_FRAME_ID: Ignoring transform {by} because child_frame_id not set ")
    if not parent:
        why = "because frame_id not set"
        found.append(f'TF_NO_FRAME_ID: Ignoring transform with child_frame_id "{child}"  {by} {why}')
    x, y, z, w = rigid[3:]
    length2 = w * w + x * x + y * y + z * z
    if abs(length2 - 1.0) < _TOLERANCE and sum(rigid) == sum(rigid):
        return found
    rotation = f"({x:f} {y:f} {z:f} {w:f})"
    of = f'Ignoring transform for child_frame_id "{child}" {by} because of'
    if any(number != number for number in rigid):
        translation = f"({rigid[0]:f} {rigid[1]:f} {rigid[2]:f})"
        found.append(f"TF_NAN_INPUT: {of} a nan value in the transform {translation} {rotation}")
    if not abs(length2 - 1.0) < _TOLERANCE:
        found.append(f"TF_DENORMALIZED_QUATERNION: {of} an invalid quaternion in the transform {rotation}")
    return found


def name_problem(role: str, name: str) -> str:
    """Return the error in the form of a frame's name, or ""."""
    if not name:
        return f"Invalid argument passed to {role} in tf2 frame_ids cannot be empty"
    if name.startswith("/"):
        return f"Invalid argument \"{name}\" passed to {role} in tf2 frame_ids cannot start with a '/' like: "
    return ""


def does_not_exist(role: str, name: str) -> str:
    if role == "fixed_frame":
        return f"fixed_frame: {name}does not exist."  # tf2 leaves out the space
    return f"canTransform: {role} {name} does not exist."
