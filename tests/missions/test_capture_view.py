"""A 3D view of the capture: the arm has its joint positions, and the debris is in the hand after the capture."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any
from xml.etree import ElementTree

import numpy
import pytest

import cfepy

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def run() -> cfepy.Run:
    return cfepy.run("capture/view.scr", seconds=13)


def matrix(transform: Any) -> Any:
    """Return a geometry_msgs/Transform as a matrix."""
    turn, place = transform.rotation, transform.translation
    x, y, z, w = turn.x, turn.y, turn.z, turn.w
    made = numpy.identity(4)
    made[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    made[:3, 3] = place.x, place.y, place.z
    return made


def hands(run: cfepy.Run) -> Iterator[tuple[int, Any]]:
    """Yield the time of each message on /tf, in ns, and the hand's position from it and /tf_static, in the arm's
    base."""
    (fixed,) = run.messages("/tf_static")
    last = next(each for each in fixed.transforms if each.child_frame_id == "hand_link")
    for message in run.messages("/tf"):
        frames = ["arm_base", *(each.child_frame_id for each in message.transforms)]
        assert [each.header.frame_id for each in message.transforms] == frames[:-1]
        assert last.header.frame_id == frames[-1]
        place = numpy.identity(4)
        for each in (*message.transforms, last):
            place = place @ matrix(each.transform)
        yield message.transforms[0].header.stamp.to_nsec(), place[:3, 3]


def test_position_of_the_hand_equals_the_report_of_main_control(run: cfepy.Run) -> None:
    told = {each.header.stamp.to_nsec(): each.pose.position for each in run.messages("/hand_pose")}
    found = [(place, told[at]) for at, place in hands(run) if at in told]
    assert len(found) > 20
    for place, position in found:
        assert numpy.allclose(place, (position.x, position.y, position.z), atol=1e-6)


def test_the_links_of_the_description_are_the_frames(run: cfepy.Run) -> None:
    mission = run.mission
    assert mission.ros is not None
    (description,) = run.messages("/robot_description")
    assert mission.ros.graph.params.find("/robot_description") == description.data
    robot = ElementTree.fromstring(description.data)
    joints = {tag.get("name"): tag for tag in robot.findall("joint")}
    assert {tag.get("name") for tag in robot.findall("link")} == {
        "arm_base",
        "hand_link",
        *(each.child_frame_id for each in run.messages("/tf")[0].transforms),
    }
    for each in run.messages("/tf")[0].transforms:
        found = {tag.tag: tag for tag in joints[each.child_frame_id.removesuffix("_link")]}
        assert found["parent"].get("link") == each.header.frame_id
        assert found["child"].get("link") == each.child_frame_id
        assert found["origin"].get("xyz") == f"0 0 {each.transform.translation.z}"


def test_the_debris_is_caught(run: cfepy.Run) -> None:
    floating, caught = run.messages("/debris")
    assert (floating.header.frame_id, caught.header.frame_id) == ("arm_base", "hand_link")
    grasped = next(
        at for at, phase in ((each.t, each.msg.data) for each in run.history("/phase")) if phase == "retract"
    )
    place = [where for at, where in hands(run) if at / 1e9 <= 316_533_800 + grasped][-1]
    at = floating.pose.position
    assert numpy.allclose(place, (at.x, at.y, at.z), atol=0.001)
