"""Values that end a process of ROS inside tf2's C++ core, recorded from tf2_py 0.7.6: they end the node here, too."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest

from cfepy.rtos import TaskExit
from tests.ros_libraries.world import universe
from tests.rospy_shim.missions import run_nodes

HEAD = """
import math, rospy, tf2_py
from geometry_msgs.msg import PoseStamped, TransformStamped
rospy.init_node("a")
buffer = tf2_py.BufferCore(rospy.Duration(10))
def stamped():
    made = TransformStamped(child_frame_id="c")
    made.header.frame_id, made.header.stamp, made.transform.rotation.w = "p", rospy.Time(1), 1
    return made
def tried(**parts):
    made = stamped()
    for path, value in parts.items():
        *way, last = path.split("_of_")[::-1]
        at = made
        for part in way:
            at = getattr(at, part)
        setattr(at, last, value)
    buffer.set_transform(made, "me")
class At:
    def __init__(self, seconds):
        self.to_sec = lambda: seconds
before = At(-1)
"""
TIME, DURATION, NULL = (
    f"terminate called after throwing an instance of 'std::{kind}'|  what():  {what}"
    for kind, what in (
        ("runtime_error", "Time is out of dual 32-bit range"),
        ("runtime_error", "Duration is out of dual 32-bit range"),
        ("logic_error", "basic_string: construction from null is not valid"),
    )
)
NO_MESSAGE = "cfepy: tf2 got a {} without `{}`. On ROS, a segmentation fault ends the node."
ENDS = {
    "tried(stamp_of_header=before)": TIME,
    "buffer.lookup_transform_core('p', 'c', before)": TIME,
    "buffer.can_transform_core('p', 'c', before)": TIME,
    "buffer.can_transform_full_core('p', At(1), 'c', before, 'p')": TIME,
    "buffer._allFramesAsDot(before)": TIME,
    "buffer._chain('p', before, 'c', before, 'p')": TIME,
    "buffer.can_transform_core('p', 'c', At(2**32))": TIME,
    "buffer.can_transform_core('p', 'c', At(math.nan))": TIME,
    "buffer.can_transform_core('p', 'c', At('x'))": TIME,
    "tf2_py.BufferCore(At(2**31))": DURATION,
    "tried(frame_id_of_header=None)": NULL,
    "tried(child_frame_id=b'c')": NULL,
    "buffer.set_transform(None, 'me')": NO_MESSAGE.format("NoneType", "header"),
    "buffer.set_transform_static(3, 'me')": NO_MESSAGE.format("int", "header"),
    "buffer.set_transform(PoseStamped(), 'me')": NO_MESSAGE.format("PoseStamped", "child_frame_id"),
    "tried(header=None)": NO_MESSAGE.format("NoneType", "frame_id"),
    "tried(transform=None)": NO_MESSAGE.format("NoneType", "translation"),
}

GOES_ON = {
    "print(buffer.can_transform_core('p', 'c', At(2**32 - 1)))": "(0, 'canTransform: target_frame p does not exist.",
    "tf2_py.BufferCore(At(-2**31)); print('made')": "made",
    "tried(x_of_translation_of_transform='1'); print(buffer.lookup_transform_core('p', 'c', At(0)).transform)": (
        "translation: |  x: -1.0"
    ),
}
FAILS = {
    "tried(stamp_of_header=None)": "TypeError: time must have a to_sec method, e.g. rospy.Time or rospy.Duration",
    "tried(translation_of_transform=None)": "TypeError: transform.translation must have members x, y, z",
    "tried(w_of_rotation_of_transform=None)": (
        "SystemError: <method 'set_transform' of '_tf2.BufferCore' objects> returned a result with an exception set"
    ),
    "buffer.set_transform(None, None)": "TypeError: argument 2 must be str, not None",
}


def outputs(tmp_path: Path, calls: dict[str, str]) -> list[str]:
    """Return the output of a node for each call."""
    scripts = {f"N{at}": f"{HEAD}{call}\nprint('after')\n" for at, call in enumerate(calls)}
    for at, app in enumerate(scripts):
        scripts[app] = scripts[app].replace('"a"', f'"n{at}"')
    printed = run_nodes(tmp_path, scripts, seconds=1.0).printed
    return ["|".join(printed[f"n{at}"]) for at in range(len(calls))]


def test_values_that_end_the_process(tmp_path: Path) -> None:
    assert outputs(tmp_path, ENDS) == list(ENDS.values())


def test_exit_statuses_are_of_the_signals() -> None:
    for value, status in (("a", 139), (SimpleNamespace(header=SimpleNamespace(frame_id=3), child_frame_id=""), 134)):
        node = universe()
        with pytest.raises(TaskExit):
            node.importer.load("tf2_py").BufferCore().set_transform(value, "me")
        assert node.exit_status == status


def test_values_at_the_limits_do_not(tmp_path: Path) -> None:
    printed = outputs(tmp_path, GOES_ON)
    for text, expected in zip(printed, GOES_ON.values(), strict=True):
        assert text.startswith(expected)
        assert text.endswith("after")


def test_values_that_raise(tmp_path: Path) -> None:
    printed = outputs(tmp_path, FAILS)
    assert [text.rpartition("|")[2] for text in printed] == list(FAILS.values())
