"""Executes calls of ROS's API in one situation of a node: `calls.json` has the situation and the calls.

`dev.record.wrong_calls` runs this file with ROS, and a test runs it in a node of cfepy. It writes the outcome of each
call to `outcomes.json`: the result, or the type and text of the exception. It imports only the standard library and
ROS.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import re
import sys
import threading
import warnings
from pathlib import Path
from typing import Any

PATIENCE_S = 0.5  # after which a call blocks

_IMPORTS = """
import io, math, struct, threading, time
import actionlib, genpy, message_filters, rosbag, rosgraph, rospy, tf2_ros
from actionlib_msgs.msg import GoalID
from geometry_msgs.msg import Point, PointStamped, Pose, TransformStamped
from actionlib.msg import TestAction, TestGoal
from std_msgs.msg import *
from std_msgs.msg import Empty as NoData, String as Text, Duration as SpanMessage, Time as TimeMessage
from roscpp.srv import Empty, GetLoggers, SetLoggerLevel, SetLoggerLevelRequest
T, D, GT, GD = rospy.Time, rospy.Duration, genpy.Time, genpy.Duration

def written(message):
    out = io.BytesIO()
    message.serialize(out)
    return out.getvalue().hex()

def read(kind, data):
    return kind().deserialize(data)

def bag(mode="w", **options):
    return rosbag.Bag("made.bag", mode, **options)

def transform(parent="a", child="b", stamp=1, w=1.0, x=0.0):
    found = TransformStamped()
    found.header.frame_id, found.child_frame_id, found.header.stamp = parent, child, T(stamp)
    found.transform.rotation.w, found.transform.translation.x = w, x
    return found

def buffer():
    made = tf2_ros.Buffer(debug=False)
    made.set_transform(transform(stamp=1), "me")
    made.set_transform(transform(stamp=3), "me")
    return made

def twice(function):
    function()
    return function()

def closed():
    made = bag()
    made.write("/a", Text("a"), T(1))
    made.close()
    return made

def outcome_of(function, *arguments):
    try:
        return function(*arguments)
    except Exception as error:
        return f"{type(error).__name__}: {error}"

def steps(made, *functions):
    return [outcome_of(function, made) for function in functions]

def put(text, stamp, topic="/a"):
    return lambda made: made.write(topic, Text(text), T(stamp))

def texts(made):
    return [each.message.data for each in made.read_messages()]

READ, AGAIN = texts, lambda made: texts(bag("r"))
FLUSH, CLOSE, COUNT, START = (
    rosbag.Bag.flush, rosbag.Bag.close, rosbag.Bag.get_message_count, rosbag.Bag.get_start_time
)
TOPICS = lambda made: made.get_type_and_topic_info().topics["/a"].message_count
REINDEX = lambda made: list(made.reindex())
UNINDEXED = lambda: bag("r", allow_unindexed=True)

def publisher(name="/out", kind=Text, **options):
    return rospy.Publisher(name, kind, queue_size=1, **options)

def gone(handle):
    handle.unregister()
    return handle
"""


def plain(value: Any) -> Any:
    """Return a result as a text that is the same in each run."""
    if isinstance(value, (tuple, list)):
        return [plain(each) for each in value]
    if isinstance(value, (bool, int, float, str, bytes, dict, type(None))) or type(value).__name__ in (
        "Time",
        "Duration",
    ):
        return re.sub("0x[0-9a-f]+", "0x..", repr(value))[:200]
    if hasattr(value, "_slot_types"):
        return re.sub("0x[0-9a-f]+", "0x..", str(value))[:200]
    return f"<{type(value).__name__}>"


def outcome(call: str, place: dict[str, Any]) -> Any:
    """Return the result of a call, or its exception."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return plain(eval(call, place))
        except BaseException as error:
            text = str(error).partition(" and no __dict__")[0].partition(". Did you mean")[0]
            return {type(error).__name__: re.sub("0x[0-9a-f]+", "0x..", text)[:200]}


def patient(call: str, place: dict[str, Any]) -> Any:
    """Return the outcome of a call in a thread of its own, or "blocks"."""
    found: list[Any] = []
    thread = threading.Thread(target=lambda: found.append(outcome(call, place)), daemon=True)
    thread.start()
    thread.join(PATIENCE_S)
    return found[0] if found else "blocks"


def executed(situation: str, calls: list[str]) -> list[Any]:
    """Execute calls in a situation of this program. Returns their outcomes."""
    place: dict[str, Any] = {}
    exec(_IMPORTS, place)
    rospy = place["rospy"]
    found: list[Any] = []

    def execute(*_: Any) -> None:
        found.extend(patient(call, place) for call in calls)
        done.set()

    done = threading.Event()
    if situation == "before":
        execute()
        return found
    sys.argv = ["probe.py"]
    rospy.init_node("probe", disable_signals=True, log_level=rospy.FATAL)
    if situation == "thread":
        threading.Thread(target=execute, daemon=True).start()
    elif situation == "callback":
        rospy.Subscriber("/begin", place["Text"], execute)
        place["publisher"]("/begin", latch=True).publish("a")
    elif situation == "hook":
        rospy.on_shutdown(execute)
        threading.Thread(target=rospy.signal_shutdown, args=("end",), daemon=True).start()  # it waits for threads
    else:
        if situation == "after":
            rospy.signal_shutdown("end")
        execute()
    done.wait(60)
    return found


def main() -> None:
    """Execute the calls."""
    situation, calls = json.loads(Path("calls.json").read_text(encoding="utf-8"))
    with contextlib.redirect_stdout(io.StringIO()):
        outcomes = executed(situation, calls)
    Path("outcomes.json").write_text(json.dumps(outcomes), encoding="utf-8")
    os._exit(0)  # some calls have left threads behind that do not end


main()
