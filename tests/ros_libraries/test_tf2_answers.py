"""tf2_py gives the same answers as the real one: random trees, times, interpolation, errors and reports, as recorded.

To record again, feed the recorded `sets` to ROS's tf2_py and ask it the same `asks`.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest

from tests.ros_libraries.world import universe

WORLDS: list[dict[str, Any]] = json.loads(
    (Path(__file__).parents[1] / "data/tf/tf2_answers.json").read_text(encoding="utf-8")
)
PRECISION = 1e-12
load: Any = universe().importer.load
rospy, msg, tf2 = load("rospy"), load("geometry_msgs.msg"), load("tf2_py")


def moment(ns: int) -> Any:
    return rospy.Time(*divmod(ns, 1_000_000_000))


def stamped(parent: str, child: str, stamp: int, numbers: list[float | None]) -> Any:
    message = msg.TransformStamped(child_frame_id=child)
    message.header.frame_id, message.header.stamp = parent, moment(stamp)
    values = [math.nan if number is None else number for number in numbers]
    message.transform = msg.Transform(msg.Vector3(*values[:3]), msg.Quaternion(*values[3:]))
    return message


def filled(world: dict[str, Any]) -> Any:
    buffer = tf2.BufferCore(rospy.Duration(world["cache_time"]))
    for parent, child, stamp, numbers, static, authority in world["sets"]:
        put = buffer.set_transform_static if static else buffer.set_transform
        put(stamped(parent, child, stamp, numbers), authority)
    return buffer


def plain(answer: Any) -> Any:
    """Return an answer as it stands in the file."""
    if isinstance(answer, msg.TransformStamped):
        t, r = answer.transform.translation, answer.transform.rotation
        frames = [answer.header.frame_id, answer.child_frame_id]
        numbers = pytest.approx([t.x, t.y, t.z, r.x, r.y, r.z, r.w], rel=PRECISION, abs=PRECISION)
        return {"stamp": answer.header.stamp.to_nsec(), "frames": frames, "numbers": numbers}
    if isinstance(answer, rospy.Time):
        return {"stamp": answer.to_nsec()}
    return list(answer) if isinstance(answer, tuple) else answer


def ask(buffer: Any, name: str, args: list[Any]) -> Any:
    try:
        return plain(getattr(buffer, name)(*(moment(each) if isinstance(each, int) else each for each in args)))
    except tf2.TransformException as error:
        return {"error": type(error).__name__, "text": str(error)}


@pytest.mark.parametrize("world", WORLDS, ids=lambda world: f"{len(world['sets'])} transforms")
def test_answers_equal_the_recorded_ones(world: dict[str, Any]) -> None:
    buffer = filled(world)
    for name, args, wanted in world["asks"]:
        assert ask(buffer, name, args) == wanted, f"{name}{args}"


def test_recording_covers_all_errors_and_many_transforms() -> None:
    answers = [answer for world in WORLDS for _, _, answer in world["asks"] if isinstance(answer, dict)]
    errors = {answer["error"] for answer in answers if "error" in answer}
    assert errors >= {"LookupException", "ConnectivityException", "ExtrapolationException", "InvalidArgumentException"}
    assert sum("numbers" in answer for answer in answers) > 50


@pytest.mark.parametrize(
    ("rotation", "back"),
    [
        ((0.0, 0.0, 0.0, 1.0), "0.0 0.0 0.0 1.0"),
        ((0.0, 0.0, 0.0, -1.0), "0.0 0.0 0.0 -1.0"),
        ((1.0, 0.0, 0.0, 0.0), "-1.0 0.0 0.0 0.0"),
        ((-0.0, 0.0, 0.0, 1.0), "0.0 0.0 0.0 1.0"),
        ((0.0, 0.0, math.sqrt(0.5), -math.sqrt(0.5)), "0.0 0.0 -0.7071067811865476 -0.7071067811865476"),
    ],
)
def test_signs_of_zeros_in_a_transform_back(rotation: tuple[float, ...], back: str) -> None:
    """Asked of tf2 0.7.6."""
    buffer = tf2.BufferCore(rospy.Duration(10))
    buffer.set_transform(stamped("a", "b", 1, [1.0, 0.0, 0.0, *rotation]), "")
    found = buffer.lookup_transform_core("b", "a", moment(1)).transform.rotation
    assert " ".join(map(repr, (found.x, found.y, found.z, found.w))) == back
