"""`python3 -m dev.record.wrong_calls FILE`: records ROS's answers to wrong calls of its API.

The program makes calls with a seed: wrong kinds of arguments, zero, negative, None, too long, twice, in a wrong mode or
order. `tests/data/calls_in_node.py` executes them in new nodes, each with a master of its own: before `init_node`,
after it, in a thread, in a callback, in a hook of the shutdown, and after the shutdown. It needs ROS's Python packages.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import lzma
import os
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any
from xmlrpc.client import ServerProxy

SITUATIONS = ("before", "node", "thread", "callback", "hook", "after")
"""When a node makes its calls: before `init_node`, after it, in a thread of its own, in a callback, in a hook of the
shutdown, and after the shutdown."""
PORT = 11793
COUNT = 100  # calls of a situation
PROGRAM = Path(__file__).parents[2] / "tests" / "data" / "calls_in_node.py"

_WRONG = (
    *(
        "None",
        "0",
        "-1",
        "1.5",
        "True",
        "''",
        "'a b'",
        "'/'",
        "'~y'",
        "'a//b'",
        "'1a'",
        "'/a/'",
        "b'x'",
        "[]",
        "{}",
        "()",
    ),
    *(
        "object",
        "len",
        "Text",
        "Text('a')",
        "T(1)",
        "D(-1)",
        "float('nan')",
        "float('inf')",
        "2**31",
        "-2**31",
        "2**64",
    ),
    *(
        "'x' * 300",
        "'\\u00e9'",
        "'a\\0b'",
        "[None]",
        "{'a': 1}",
        "(1, 2)",
        "'-a'",
        "'a.b'",
        "'$(x)'",
        "1e300",
        "{1, 2}",
    ),
)
_NAMES = ("'a'", "'a'", "'/a/b'", "'~a'", *_WRONG)
_CLASSES = (
    "Text",
    "Text",
    "UInt8",
    "rospy.AnyMsg",
    "None",
    "Text('a')",
    "int",
    "'std_msgs/String'",
    "Empty",
    "rospy.Message",
)
_NUMBERS = (
    "1",
    "0",
    "-1",
    "0.5",
    "None",
    "'1'",
    "2**31",
    "2**64",
    "float('nan')",
    "float('inf')",
    "True",
    "D(1)",
    "[]",
)
_TIMES = ("T(1)", "T(0)", "D(1)", "D(-1, 5)", "GT(2)", "GD(3)", "1", "1.5", "None", "'a'", "True")
_STAMPS = ("T(1)", "T(2)", "T(9)", "T(0)", "GT(2)", "1", "None", "'a'", "True", "[]")  # C++ ends the process below zero
_FIELDS = (
    *("Bool", "Byte", "Char", "Float32", "Float64", "Int8", "Int16", "Int32", "Int64", "UInt8", "UInt16", "UInt32"),
    *("UInt64", "Text", "SpanMessage", "TimeMessage"),
)
_VALUES = (
    *("0", "-1", "127", "128", "255", "256", "65536", "2**31", "2**32", "2**63", "2**64", "1.5", "None", "'a'", "b'a'"),
    *("'\\u00e9'", "True", "[]", "T(1)", "D(1)", "T(-1)", "float('nan')", "1e300", "'\\ud800'", "{}", "object"),
)
TEMPLATES: tuple[tuple[str, tuple[tuple[str, ...], ...]], ...] = (
    ("rospy.Publisher({}, Text, queue_size=1)", (_NAMES,)),
    ("rospy.Publisher('p', {}, queue_size=1)", (_CLASSES,)),
    ("rospy.Publisher('p', Text, queue_size={})", (_NUMBERS,)),
    ("rospy.Publisher('p', Text, {}, queue_size=1)", (_WRONG,)),
    ("rospy.Publisher('p', Text, queue_size=1, headers={})", (_WRONG,)),
    ("rospy.Publisher('p', Text, queue_size=1, latch={})", (_WRONG,)),
    ("rospy.Subscriber({}, Text, len)", (_NAMES,)),
    ("rospy.Subscriber('s', {}, len)", (_CLASSES,)),
    ("rospy.Subscriber('s', Text, {})", (_WRONG,)),
    ("rospy.Subscriber('s', Text, len, queue_size={})", (_NUMBERS,)),
    ("rospy.Subscriber('s', Text, len, buff_size={})", (_NUMBERS,)),
    ("rospy.Subscriber('s', Text, len, tcp_nodelay={})", (_WRONG,)),
    ("publisher().publish({})", (_WRONG,)),
    ("publisher(kind={}).publish({})", (("UInt8", "Header", "ColorRGBA", "NoData", "rospy.AnyMsg"), _WRONG)),
    ("publisher(kind=ColorRGBA).publish({}, {})", (_WRONG, _WRONG)),
    ("publisher().publish(**{})", (("{'data': 1}", "{'x': 1}", "{}", "{'data': 'a', 'x': 1}", "{1: 2}"),)),
    ("gone(publisher()).{}", (("publish('a')", "unregister()", "get_num_connections()", "name", "impl", "type"),)),
    ("gone(rospy.Subscriber('s', Text)).{}", (("unregister()", "get_num_connections()", "callback", "publish('a')"),)),
    ("rospy.Service({}, Empty, len)", (_NAMES,)),
    ("rospy.Service('srv', {}, len)", (_CLASSES,)),
    ("rospy.Service('srv2', Empty, {})", (_WRONG,)),
    ("rospy.Service('srv3', Empty, len, error_handler={})", (_WRONG,)),
    ("rospy.Service('srv4', Empty, len, buff_size={})", (_NUMBERS,)),
    ("rospy.ServiceProxy({}, Empty)", (_NAMES,)),
    ("rospy.ServiceProxy('nobody', {})", (_CLASSES,)),
    ("rospy.ServiceProxy('nobody', Empty, {}, {})", (_WRONG, _WRONG)),
    ("rospy.ServiceProxy('nobody', SetLoggerLevel)({})", (_WRONG,)),
    ("rospy.ServiceProxy('nobody', SetLoggerLevel).call({}, {})", (_WRONG, _WRONG)),
    ("twice(lambda: rospy.Service('double', Empty, len))", ()),
    ("twice(rospy.ServiceProxy('nobody', Empty).close)", ()),
    ("twice(rospy.Timer(D(100), len).shutdown)", ()),
    ("twice(publisher().unregister)", ()),
    ("rospy.Timer({}, len)", (("0", "-1", "None", "'1'", "1.5", "[]", "T(1)", "rospy"),)),
    ("rospy.Timer(D(100), {})", (_WRONG,)),
    ("rospy.Timer(D(100), len, oneshot={})", (_WRONG,)),
    ("rospy.Rate({})", (_NUMBERS,)),
    ("rospy.Rate({}).sleep_dur", (("1", "3", "-1", "1e9", "1e10", "0.1", "True"),)),
    ("rospy.Rate({}).sleep()", (("1000", "-1", "1e9", "1e10"),)),
    (
        "rospy.sleep({})",
        (("0", "-1", "D(0)", "D(-1)", "None", "'a'", "[]", "0.001", "GD(0)", "T(0)", "float('nan')", "True"),),
    ),
    ("T({})", (_WRONG,)),
    ("D({})", (_WRONG,)),
    ("T({}, {})", (_NUMBERS, _NUMBERS)),
    ("D({}, {})", (_NUMBERS, _NUMBERS)),
    ("GT({}, {})", (_NUMBERS, _NUMBERS)),
    ("GD({}, {})", (_NUMBERS, _NUMBERS)),
    ("T.from_sec({})", (_WRONG,)),
    ("D.from_sec({})", (_WRONG,)),
    ("{} + {}", (_TIMES, _TIMES)),
    ("{} - {}", (_TIMES, _TIMES)),
    ("{} * {}", (_TIMES, _TIMES)),
    ("{} / {}", (_TIMES, _TIMES)),
    ("{} // {}", (_TIMES, _TIMES)),
    ("{} % {}", (_TIMES, _TIMES)),
    ("divmod({}, {})", (_TIMES, _TIMES)),
    ("{} < {}", (_TIMES, _TIMES)),
    ("{} == {}", (_TIMES, _TIMES)),
    ("{} >= {}", (_TIMES, _TIMES)),
    ("(-{}, abs({}))", (_TIMES, _TIMES)),
    (
        "({0}.to_sec(), {0}.to_nsec(), {0}.is_zero(), str({0}), hash({0}))",
        (("T(1, 5)", "D(-1, 5)", "GT(0)", "GD(-1.5)"),),
    ),
    (
        "{}.{}",
        (("T(1)", "D(1)", "GT(1)"), ("to_time()", "to_seconds()", "set(1, -1)", "canon()", "secs", "sec", "nsec")),
    ),
    ("round({}), int({}), float({})", (("T(1)",), ("D(1)",), ("GD(1)",))),
    ("rospy.get_param({})", (_NAMES,)),
    ("rospy.get_param({}, 7)", (_NAMES,)),
    ("rospy.get_param_cached({}, 7)", (_NAMES,)),
    ("rospy.has_param({})", (_NAMES,)),
    ("rospy.delete_param({})", (_NAMES,)),
    ("rospy.search_param({})", (_NAMES,)),
    ("rospy.set_param({}, 1)", (_NAMES,)),
    ("(rospy.set_param('q', {0}), rospy.get_param('q'))", (_WRONG,)),
    ("(rospy.set_param('~q', {{'k': {0}}}), rospy.get_param('~q/k'))", (_WRONG,)),
    (
        "rospy.wait_for_message('quiet', Text, {})",
        (("0", "-1", "0.01", "'a'", "[]", "D(0.01)", "float('nan')", "True"),),
    ),
    ("rospy.wait_for_message({}, Text, 0.01)", (_NAMES,)),
    ("rospy.wait_for_message('quiet', {}, 0.01)", (_CLASSES,)),
    ("rospy.wait_for_service('nobody', {})", (("0", "-1", "0.01", "'a'", "[]", "D(0.01)", "D(-1)", "float('nan')"),)),
    ("rospy.wait_for_service({}, 0.01)", (_NAMES,)),
    ("rospy.resolve_name({})", (_NAMES,)),
    ("rospy.resolve_name({}, {})", (_NAMES, _NAMES)),
    ("rospy.remap_name({})", (_NAMES,)),
    ("rospy.names.canonicalize_name({})", (_NAMES,)),
    (
        "rosgraph.names.{}({})",
        (("is_legal_name", "is_legal_base_name", "is_global", "is_private", "namespace"), _NAMES),
    ),
    ("rosgraph.names.ns_join({}, {})", (_NAMES, _NAMES)),
    ("rosgraph.names.resolve_name({}, {})", (_NAMES, _NAMES)),
    ("rosgraph.names.make_global_ns({})", (_NAMES,)),
    ("sorted(rospy.get_published_topics({}))", (("'/nowhere'", "None", "1", "[]", "b'a'", "{}"),)),
    ("rospy.on_shutdown({})", (_WRONG,)),
    ("rospy.core.add_preshutdown_hook({})", (_WRONG,)),
    ("rospy.loginfo({})", (("'%s'", "None", "1", "[]", "b'a'"),)),
    ("rospy.loginfo('%d', {})", (("'a'", "None", "1"),)),
    ("rospy.loginfo_throttle({}, 'a')", (("1", "'a'", "None", "-1", "[]"),)),
    ("rospy.logwarn_once({})", (("'a'", "None", "[]"),)),
    ("rospy.init_node({})", (("'other'", "'probe'", "''", "None", "1", "'a b'", "'/a'", "'a/b'", "'~a'", "b'a'"),)),
    ("rospy.init_node('probe', {})", (("None", "['x']", "'a'", "1", "[1]", "['a:=b:=c']"),)),
    ("rospy.init_node('probe', log_level={})", (("None", "'a'", "99", "rospy.DEBUG", "3"),)),
    ("rospy.myargv({})", (("[]", "['a', 'b:=c']", "1", "['a:=b:=c']", "[1]"),)),
    ("rospy.get_name(){}", (("", ".x", "+1"),)),
    ("(rospy.is_shutdown(), rospy.core.is_initialized(), rospy.core.is_shutdown_requested())", ()),
    ("rospy.spin({})", (("1", "None"),)),
    ("written({}({}))", (_FIELDS, _VALUES)),
    ("written(UInt8MultiArray(MultiArrayLayout(), {}))", (_VALUES,)),
    ("written(Float64MultiArray(MultiArrayLayout(), [{}]))", (_VALUES,)),
    ("written(Header({}, {}, {}))", (_VALUES, _VALUES, _VALUES)),
    ("written(Pose({}, None))", (("None", "Point()", "Text()", "1", "'a'", "[1, 2, 3]"),)),
    ("{}({}, {})", (("Text", "UInt8", "ColorRGBA", "Header", "NoData"), _VALUES, _VALUES)),
    ("{}(**{})", (("Text", "UInt8", "ColorRGBA", "NoData"), ("{'data': 1}", "{'r': 1}", "{'x': 1}", "{}", "{1: 2}"))),
    (
        "read({}, {})",
        (_FIELDS, ("b''", "b'a'", "b'\\1\\0\\0\\0'", "b'\\1\\0\\0\\0\\xff'", "None", "'a'", "b'aaaaaaaaaaaa'")),
    ),
    ("{}() == {}", (("Text", "UInt8"), ("Text()", "Text", "None", "''", "UInt8()", "0"))),
    ("Text('a').{}", (("x", "data.y", "_md5sum", "_slot_types", "_check_types()", "_get_types()", "deserialize(1)"),)),
    ("setattr(Text(), {}, 1)", (("'data'", "'x'", "'_connection_header'", "1"),)),
    ("bag({})", (("'r'", "'x'", "None", "1", "'rb'", "'w'", "'a'", "''"),)),
    ("rosbag.Bag({})", (_WRONG,)),
    ("bag(compression={})", (("'none'", "'bz2'", "'x'", "None", "1", "'BZ2'"),)),
    ("bag(chunk_threshold={})", (_NUMBERS,)),
    ("bag(options={})", (("{}", "{'compression': 'x'}", "[]", "1", "{'x': 1}", "'a'"),)),
    ("bag().write({}, Text('a'), T(1))", (_NAMES,)),
    ("bag().write('/a', {}, T(1))", (_WRONG,)),
    ("bag().write('/a', Text('a'), {})", (("None", "1", "'a'", "D(1)", "GT(1)", "T(0)", "T(-1)", "[]", "True"),)),
    ("bag().write('/a', Text({}), T(1))", (_VALUES,)),
    (
        "bag().write('/a', {}, T(1), raw=True)",
        (("Text('a')", "('a',)", "None", "('std_msgs/String', b'', 'x', Text)", "1"),),
    ),
    (
        "closed().{}",
        (
            *(
                (
                    "write('/a', Text('a'), T(1))",
                    "read_messages()",
                    "close()",
                    "flush()",
                    "size",
                    "mode",
                    "filename",
                    "version",
                ),
            ),
        ),
    ),
    (
        "(closed(), bag('r').{})",
        (
            (
                *(
                    "write('/a', Text('b'), T(2))",
                    "get_message_count({})",
                    "get_message_count('/a')",
                    "get_message_count(1)",
                ),
                *(
                    "flush()",
                    "reindex()",
                    "get_start_time()",
                    "compression",
                    "chunk_threshold",
                    "mode",
                    "get_end_time()",
                ),
                *("get_compression_info()", "set_encryptor(1)", "set_encryptor(None)"),
            ),
        ),
    ),
    (
        "(closed(), len(list(bag('r').read_messages({}))))",
        (("None", "[]", "'/a'", "'a'", "['/a', '/b']", "1", "b'/a'"),),
    ),
    ("(closed(), len(list(bag('r').read_messages(None, {}, {}))))", (_TIMES, _TIMES)),
    ("(bag().close(), bag('r').{})", (("get_start_time()", "get_end_time()", "get_message_count()", "size > 0"),)),
    ("buffer().lookup_transform({}, {}, {})", (("'a'", "'b'", "'c'", "''", "'/a'", "None", "1"),) * 2 + (_STAMPS,)),
    ("buffer().lookup_transform('a', 'b', T(2), {})", (("D(0)", "None", "1", "'a'", "D(-1)"),)),
    ("buffer().can_transform('a', {}, {})", (("'b'", "'c'", "''", "'/b'", "None", "1"), _STAMPS)),
    ("buffer().can_transform('a', 'c', T(1), return_debug_tuple={})", (("True", "False", "1"),)),
    ("buffer().lookup_transform_full('a', {}, 'b', {}, {})", (_STAMPS, _STAMPS, ("'a'", "'c'", "''", "None"))),
    (
        "buffer().set_transform({}, 'me')",
        (
            (
                *(
                    "transform()",
                    "transform(child='a')",
                    "transform(parent='')",
                    "transform(child='/b')",
                    "transform(w=0.0)",
                ),
                *("transform(x=float('nan'))", "TransformStamped()", "transform(w=1e3)"),
            ),
        ),
    ),
    ("buffer().set_transform(transform(), {})", (_WRONG,)),
    ("buffer().transform({}, 'a')", (("PointStamped()", "None", "Point()", "Text()", "transform()"),)),
    ("buffer().get_latest_common_time({}, {})", (("'a'", "'b'", "'c'", "''", "None"),) * 2),
    ("tf2_ros.Buffer({}, debug=False)", (_STAMPS,)),
    ("buffer().{}", (("all_frames_as_string()", "clear()", "registration.x", "lookup()"),)),
    (
        "tf2_ros.TransformBroadcaster().sendTransform({})",
        (("transform()", "[transform()]", "None", "1", "'a'", "[]", "Text()"),),
    ),
    ("actionlib.SimpleActionClient('act', {})", (("TestAction", "TestGoal", "Text", "None", "TestAction()", "'a'"),)),
    ("actionlib.SimpleActionClient({}, TestAction)", (_NAMES,)),
    (
        "actionlib.SimpleActionClient('act', TestAction).{}",
        (
            (
                *(
                    "cancel_goal()",
                    "get_result()",
                    "get_state()",
                    "wait_for_result(D(0.01))",
                    "wait_for_server(D(0.01))",
                ),
                *(
                    "get_goal_status_text()",
                    "stop_tracking_goal()",
                    "cancel_all_goals()",
                    "cancel_goals_at_and_before_time(None)",
                ),
                *(
                    "send_goal(None)",
                    "send_goal(Text())",
                    "send_goal(TestGoal(), 1, 2, 3)",
                    "wait_for_server(0.01)",
                    "gh",
                    "done_cb",
                ),
            ),
        ),
    ),
    (
        "actionlib.ActionClient('act', TestAction).{}",
        (("send_goal(1)", "wait_for_server(1)", "cancel_all_goals()", "x"),),
    ),
    ("actionlib.ClientGoalHandle({}).{}", (("None",), ("get_comm_state()", "cancel()", "resend()", "get_result()"))),
    ("actionlib.SimpleActionServer('act', TestAction, {}, {})", (("None", "len", "1"), ("False", "None", "0"))),
    (
        "actionlib.SimpleActionServer('act', TestAction, None, False).{}",
        (
            (
                *(
                    "accept_new_goal()",
                    "set_succeeded()",
                    "publish_feedback(None)",
                    "is_active()",
                    "is_preempt_requested()",
                ),
                *(
                    "register_goal_callback(1)",
                    "set_preempted()",
                    "register_preempt_callback(None)",
                    "is_new_goal_available()",
                ),
            ),
        ),
    ),
    ("actionlib.GoalIDGenerator({}).generate_ID().{}", (("None", "'a'", "1"), ("id == ''", "stamp == 0"))),
    ("message_filters.Subscriber({}, Text)", (_NAMES,)),
    ("message_filters.Subscriber('f', {})", (_CLASSES,)),
    ("message_filters.Cache({}, {})", (("message_filters.SimpleFilter()", "None", "1"), _NUMBERS)),
    (
        "message_filters.Cache(message_filters.SimpleFilter(), 1).{}",
        (
            (
                *(
                    "getInterval(T(1), T(2))",
                    "getInterval(1, 2)",
                    "add(Text())",
                    "add(PointStamped())",
                    "getLastestTime()",
                ),
                *("getOldestTime()", "getLast()", "getElemAfterTime(T(1))", "getElemBeforeTime(None)", "add(None)"),
            ),
        ),
    ),
    ("message_filters.TimeSynchronizer({}, {})", (("[]", "None", "[message_filters.SimpleFilter()]", "[1]"), _NUMBERS)),
    (
        "message_filters.ApproximateTimeSynchronizer({}, {}, {})",
        (
            ("[message_filters.SimpleFilter()]", "None", "[1]"),
            _NUMBERS,
            ("0.1", "0", "-1", "None", "'a'", "D(1)"),
        ),
    ),
    ("message_filters.SimpleFilter().{}", (("registerCallback(1)", "registerCallback()", "signalMessage(1)", "x"),)),
    ("rospy.AnyMsg({})", (("1", "None", "'a'"),)),
    ("genpy.message.{}({})", (("get_message_class", "get_service_class"), ("'a'", "''", "None", "'a/b/c'"))),
    (
        "genpy.message.fill_message_args({}, {})",
        (
            ("Text()", "Header()", "Pose()", "None"),
            (
                "[]",
                "['a']",
                "[1]",
                "[1, 2]",
                "{'data': 'a'}",
                "[{}]",
                "[{'x': 1}]",
                "1",
                "None",
                "[[1, 2]]",
                "[1, 'now', 'a']",
            ),
        ),
    ),
    (
        "genpy.message.check_type('f', {}, {})",
        (
            ("'int8'", "'string'", "'bool'", "'time'", "'uint8[]'", "'int32[2]'", "'std_msgs/String'", "'x'"),
            _VALUES,
        ),
    ),
    ("genpy.message.strify_message({})", (("Text('a')", "None", "1", "[Text('a')]", "T(1)", "Header()"),)),
)
"""Calls with "{}" for arguments, and the texts for each argument."""


_BAGS = """
closed(), bag("r").write("/a", "x", T(2))
closed(), bag("r").write("/a", Text(1), T(2))
closed(), bag("r").write("/a", Text("b"), 5)
closed(), bag("r").write("/a", ("std_msgs/String", b"", "x", Text), T(1), raw=True)
closed(), bag("r").write("", Text("b"), T(2))
steps(bag("w"), put("b", 2), READ, put("c", 3), READ, COUNT, START, TOPICS, CLOSE, AGAIN)
steps(bag("w"), put("b", 2), READ, put("c", 3), CLOSE, AGAIN)
steps(bag("w"), put("b", 2), FLUSH, READ, put("c", 3), FLUSH, READ, READ, COUNT, CLOSE, AGAIN)
steps(bag("w"), put("b", 2), put("c", 3, "/b"), READ, put("d", 1), READ, CLOSE, AGAIN)
steps(bag("w", chunk_threshold=0), put("b", 2), put("c", 3), READ, put("d", 4), READ, COUNT, CLOSE, AGAIN)
steps(bag("w", compression="bz2"), put("b", 2), READ, CLOSE, AGAIN)
steps(bag("w"), REINDEX, put("b", 2), REINDEX, CLOSE, CLOSE, REINDEX)
closed(), steps(bag("a"), put("b", 2), READ, COUNT, CLOSE, AGAIN)
closed(), steps(bag("a"), READ, CLOSE, AGAIN)
closed(), steps(bag("a"), REINDEX, READ, COUNT, CLOSE, AGAIN)
closed(), steps(bag("r"), REINDEX, REINDEX, READ, COUNT, TOPICS, CLOSE)
steps(bag("w"), put("b", 2), FLUSH, put("c", 3), FLUSH, lambda each: steps(UNINDEXED(), REINDEX, READ, COUNT))
rosbag.Bag(io.BytesIO(), "w")
rosbag.Bag(open("made.bag", "w+b"), "w")
closed(), rosbag.Bag(open("made.bag", "rb"), "w")
closed(), rosbag.Bag(open("made.bag", "rb"))
closed(), rosbag.Bag(open("made.bag", "rb"), "a")
closed(), rosbag.Bag(io.BytesIO(open("made.bag", "rb").read()))
closed(), rosbag.Bag(open("made.bag", "r"))
"""
"""Lives of bags in several modes."""


def made(seed: int, count: int) -> dict[str, list[str]]:
    """Return calls for each situation.

    Args:
        seed: of their choice.
        count: how many for a situation.
    """
    chance = random.Random(seed)
    found: dict[str, list[str]] = {}
    for situation in SITUATIONS:
        templates = [chance.choice(TEMPLATES) for _ in range(4 * count)]
        calls = dict.fromkeys(
            template.format(*(chance.choice(each) for each in slots)) for template, slots in templates
        )
        found[situation] = [call for call in calls if not _is_barred(call, situation)][:count]
    found["node"] += _BAGS.split("\n")[1:-1]
    return found


def _is_barred(call: str, situation: str) -> bool:
    """Return whether a call would end or block the node itself in a situation."""
    if call in ("rosbag.Bag(0)", "rosbag.Bag(True)"):
        return True  # descriptors of the process
    if ("preshutdown" in call or "on_shutdown" in call) and situation == "hook":
        return True  # another thread cannot add one meanwhile
    return ("spin" in call and situation != "after") or ("init_node" in call and situation == "before")


def main() -> None:
    """Record."""
    parser = argparse.ArgumentParser(prog="python -m dev.record.wrong_calls", description=__doc__.partition("\n")[0])
    parser.add_argument("file", metavar="FILE", help="the file to write, tests/data/wrong_calls.json.xz")
    parser.add_argument("--seed", type=int, default=1, help="of the choice of calls, 1 by default")
    parser.add_argument("--count", type=int, default=COUNT, help=f"calls of a situation, {COUNT} by default")
    asked = parser.parse_args()
    calls = made(asked.seed, asked.count)
    record = {situation: [each, recorded(situation, each)] for situation, each in calls.items()}
    with lzma.open(asked.file, "wt", encoding="utf-8") as out:
        json.dump(record, out, indent=0)


def recorded(situation: str, calls: list[str]) -> Any:
    """Return the outcomes of calls in a new process with a master of its own."""
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "ROS_MASTER_URI": f"http://localhost:{PORT}", "ROS_LOG_DIR": folder}
        master = subprocess.Popen(["rosmaster", "--core", "-p", str(PORT)], env=environment, stdout=subprocess.DEVNULL)
        try:
            _wait_for(environment["ROS_MASTER_URI"])
            Path(folder, "calls.json").write_text(json.dumps([situation, calls]), encoding="utf-8")
            command = [sys.executable, str(PROGRAM)]
            subprocess.run(command, check=True, cwd=folder, env=environment, timeout=60, stderr=subprocess.DEVNULL)
            return json.loads(Path(folder, "outcomes.json").read_text(encoding="utf-8"))
        finally:
            master.terminate()
            master.wait()


def _wait_for(uri: str) -> None:
    """Wait until a master answers."""
    for _ in range(100):
        with contextlib.suppress(OSError):
            ServerProxy(uri).getPid("/record")
            return
        time.sleep(0.05)


if __name__ == "__main__":
    main()
