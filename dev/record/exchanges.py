"""Requests of a rosbridge client in the tests that compare with rosbridge_suite, and the comparison of answers.

`python -m dev.record.rosbridge` sends them to the real server.
"""

from __future__ import annotations

import json
from base64 import b64decode
from io import BytesIO
from math import isqrt
from typing import Any

from PIL import Image

Op = dict[str, Any]

POSE = {"position": {"x": 1, "y": 2.5, "z": -3}, "orientation": {"x": 0, "y": 0, "z": 0, "w": 1}}
MESSAGES: list[tuple[str, Any]] = [
    ("std_msgs/String", {"data": "hello"}),
    ("std_msgs/String", {"data": '\u00fc\u4e2d\U0001f600 "quoted" \\ \n'}),
    ("std_msgs/String", {}),
    ("std_msgs/String", {"data": 3}),
    ("std_msgs/String", {"data": None}),
    ("std_msgs/String", {"other": "x"}),
    ("std_msgs/String", "text"),
    ("std_msgs/String", []),
    ("std_msgs/Bool", {"data": True}),
    ("std_msgs/Bool", {"data": 1}),
    ("std_msgs/Bool", {"data": "true"}),
    ("std_msgs/Int8", {"data": -128}),
    ("std_msgs/Int8", {"data": 128}),
    ("std_msgs/Int8", {"data": 1.0}),
    ("std_msgs/Int8", {"data": True}),
    ("std_msgs/UInt8", {"data": 255}),
    ("std_msgs/UInt8", {"data": -1}),
    ("std_msgs/Char", {"data": 65}),
    ("std_msgs/Int64", {"data": -9223372036854775808}),
    ("std_msgs/UInt64", {"data": 18446744073709551615}),
    ("std_msgs/UInt64", {"data": 18446744073709551616}),
    ("std_msgs/Float32", {"data": 0.1}),
    ("std_msgs/Float64", {"data": 0.1}),
    ("std_msgs/Float64", {"data": 1e308}),
    ("std_msgs/Float64", {"data": 7}),
    ("std_msgs/Float64", {"data": float("nan")}),
    ("std_msgs/Float64", {"data": float("inf")}),
    ("std_msgs/Float64", {"data": None}),
    ("std_msgs/Float64", {"data": "1.5"}),
    ("std_msgs/Time", {"data": {"secs": 12, "nsecs": 500000000}}),
    ("std_msgs/Time", {"data": {"secs": 12}}),
    ("std_msgs/Time", {"data": 12}),
    ("std_msgs/Duration", {"data": {"secs": -1, "nsecs": 5}}),
    ("std_msgs/Header", {"seq": 7, "stamp": {"secs": 3, "nsecs": 4}, "frame_id": "map"}),
    ("std_msgs/ColorRGBA", {"r": 0.5, "g": 1, "b": 0, "a": 1.0}),
    ("std_msgs/UInt8MultiArray", {"data": [1, 2, 255]}),
    ("std_msgs/UInt8MultiArray", {"data": "AQL/"}),
    ("std_msgs/UInt8MultiArray", {"data": ""}),
    ("std_msgs/UInt8MultiArray", {"layout": {"dim": [{"label": "x", "size": 3, "stride": 1}], "data_offset": 0}}),
    ("std_msgs/UInt8MultiArray", {"layout": {"dim": [{"label": "x", "wrong": 3}]}}),
    ("std_msgs/ByteMultiArray", {"data": [-1, 0, 127]}),
    ("std_msgs/Float64MultiArray", {"data": [1, 2.5, -0.0]}),
    ("std_msgs/Float64MultiArray", {"data": [float("nan"), 1.0, float("-inf")]}),
    ("std_msgs/Float64MultiArray", {"data": ["x"]}),
    ("std_msgs/Float64MultiArray", {"data": {"0": 1}}),
    ("geometry_msgs/PoseArray", {"header": {"stamp": {"secs": 1, "nsecs": 2}, "frame_id": "a"}, "poses": [POSE, {}]}),
    ("geometry_msgs/PoseStamped", {"header": {"stamp": {"secs": 1, "nsecs": 2}}, "pose": POSE}),
    ("geometry_msgs/PoseStamped", {"pose": {"position": {"x": "far"}}}),
    ("geometry_msgs/PoseStamped", {"pose": {"position": 4}}),
]
COMPRESSED = ("png", "cbor")


def topic_of(kind: str) -> str:
    """Return the part of a topic's name that is made of a type."""
    return kind.partition("/")[2].lower()


def _subscriptions() -> list[list[Op]]:
    kinds = list(dict.fromkeys(kind for kind, _ in MESSAGES))
    return [
        [{"op": "subscribe", "topic": f"/t/out/{topic_of(kind)}", "type": kind} for kind in kinds],
        [{"op": "advertise", "topic": f"/t/in/{topic_of(kind)}", "type": kind} for kind in kinds],
    ]


def _rosapi() -> list[Op]:
    def call(name: str, /, *arguments: Any, **fields: Any) -> Op:
        return {"op": "call_service", "service": f"/rosapi/{name}", "args": fields or list(arguments)}

    types = ("std_msgs/String", "std_msgs/Header", "geometry_msgs/PoseStamped", "std_msgs/UInt8MultiArray")
    more = ("rosgraph_msgs/Log", "actionlib_msgs/GoalStatus", "string", "time", "no_package/Nothing", "wrong")
    return [
        *(call("topics"), call("nodes"), call("services")),
        call("topics_for_type", "std_msgs/String"),
        call("services_for_type", type="std_srvs/SetBool"),
        *(call("topic_type", topic) for topic in ("/t/latched", "/t/in/time", "/t/no_such_topic")),
        *(call("service_type", service) for service in ("/t/switch", "/rosapi/topics", "/t/no_such_service")),
        *(call("publishers", topic) for topic in ("/t/latched", "/t/in/string", "/t/no_such_topic")),
        *(call("subscribers", topic) for topic in ("/t/out/string", "/t/in/string", "/t/no_such_topic")),
        *(call("service_node", service) for service in ("/t/switch", "/rosapi/topics", "/t/no_such_service")),
        *(call("service_host", service) for service in ("/rosapi/topics", "/t/no_such_service")),
        call("service_providers", "std_srvs/SetBool"),
        call("node_details", "/peer"),
        call("node_details", "/no_such_node"),
        call("action_servers"),
        *(call("message_details", kind) for kind in (*types, *more)),
        *(call("service_request_details", type=kind) for kind in ("std_srvs/SetBool", "std_srvs/Empty", "no/Such")),
        *(call("service_response_details", type=kind) for kind in ("std_srvs/SetBool", "rosapi/MessageDetails")),
        *(call("get_param", name=name) for name in ("/t/number", "t/number", "/t/deep", "/t/none")),
        *(call("get_param", name="/t/none", default=default) for default in ('"text"', "3", "plain")),
        call("set_param", name="/t/made", value='{"a": [1, true, "x"]}'),
        call("get_param", name="/t/made/a"),
        call("set_param", name="/t/made", value="{wrong"),
        call("set_param", name="/t/made", value="null"),
        *(call("has_param", name=name) for name in ("/t/made", "/t/none")),
        call("get_param_names"),
        *(call("search_param", name=name) for name in ("t/number", "/t/number")),
        *(call("delete_param", name=name) for name in ("/t/made", "/t/none")),
        call("has_param", name="/t/made"),
        call("get_time"),
        call("get_ros_version"),
        call("topic_type"),
        call("topic_type", no_field="x"),
        call("topic_type", topic=3),
    ]


def steps() -> list[list[Op]]:
    """Return the steps. The answers of each step are awaited before the next one is sent."""
    last = {"op": "subscribe", "topic": "/t/out/string", "type": "std_msgs/String"}
    text = {"op": "publish", "topic": "/t/in/string", "msg": {"data": "again"}}
    leave = {"op": "unsubscribe", "topic": last["topic"]}
    return [
        *_subscriptions(),
        *([{"op": "publish", "topic": f"/t/in/{topic_of(kind)}", "msg": value}] for kind, value in MESSAGES),
        *([op] for op in _rosapi()),
        [{"op": "call_service", "service": "/t/switch", "args": [True]}],
        [{"op": "call_service", "service": "/t/switch", "args": {"data": True}, "id": "named"}],
        [{"op": "call_service", "service": "/t/switch#old", "args": {"data": True}}],
        [{"op": "call_service", "service": "t/switch", "args": {"data": True}}],
        [{"op": "call_service", "service": "/t/switch", "args": {"data": False}}],
        [{"op": "call_service", "service": "/t/switch", "args": {"data": "x"}}],
        [{"op": "call_service", "service": "/t/switch", "args": {"wrong": True}}],
        [{"op": "call_service", "service": "/t/nothing"}],
        [{"op": "call_service", "service": "/t/nothing", "args": None}],
        [{"op": "call_service", "service": "/t/no_such_service", "id": "none"}],
        [{"op": "call_service", "id": "nameless"}],
        [{"op": "subscribe", "topic": "/t/latched"}],
        [{"op": "subscribe", "topic": "/t/latched", "id": "again"}],
        [{"op": "unsubscribe", "topic": "/t/latched"}],
        [{"op": "subscribe", "topic": "/t/latched", "type": "std_msgs/Int8"}],
        [{"op": "subscribe", "topic": "/t/unknown"}],
        [{"op": "subscribe", "topic": "/t/unknown", "type": "no_package/Nothing"}],
        [{"op": "publish", "topic": "/t/unknown", "msg": {}}],
        [{"op": "advertise", "topic": "/t/in/string", "type": "std_msgs/Int8"}],
        [{"op": "advertise", "topic": "/t/own", "type": "std_msgs/String"}],
        [{"op": "subscribe", "topic": "/t/own"}],
        [{"op": "publish", "topic": "/t/own", "msg": {"data": "to myself"}}],
        [{"op": "unadvertise", "topic": "/t/own"}],
        [{"op": "subscribe", "topic": "t/out/string", "type": "std_msgs/String"}],
        [text],
        [{"op": "unsubscribe", "topic": "t/out/string"}],
        [{"op": "unsubscribe", "topic": "/t/out/string"}],
        [text],
        *(step for each in COMPRESSED for step in ([{**last, "compression": each}], [text], [leave])),
        [{"op": "subscribe", "topic": "/t/told", "type": "std_msgs/String"}],
        [{"op": "advertise_service", "service": "/t/client_service", "type": "std_srvs/SetBool"}],
        [{"op": "advertise", "topic": "/t/ask", "type": "std_msgs/String"}],
        [{"op": "publish", "topic": "/t/ask", "msg": {"data": "on"}}],
        [RESPONSE],
        [{"op": "unadvertise_service", "service": "/t/client_service"}],
        [{"op": "unadvertise_service", "service": "/t/client_service"}],
        [{"op": "unknown"}],
        [{"topic": "/t/own"}],
        *([{"op": "fragment", "id": "f", "num": at, "total": 2, "data": each}] for at, each in enumerate(PIECES)),
    ]


PIECES = ('{"op": "call_service", "service": "/t/swi', 'tch", "args": [true]}')
RESPONSE: Op = {
    "op": "service_response",
    "service": "/t/client_service",
    "id": "ID",  # of the request that came
    "values": {"success": True, "message": "from the client"},
    "result": True,
}

KNOWN_NODES = ("/peer", "/rosapi", "/rosbridge_websocket")
LOGGERS = ("get_loggers", "set_logger_level")  # services that every node has


def comparable(answer: Op) -> Op:
    """Return an answer without the parts of a single run: other nodes' names, times, arbitrary orders, filters."""
    if answer.get("op") == "service_response":
        return {**answer, "values": _values(answer["service"].partition("#")[0], answer["values"])}
    if answer.get("op") == "png":
        image = Image.open(BytesIO(b64decode(answer["data"])))
        assert (image.mode, image.width) == ("RGB", isqrt(len(image.tobytes().rstrip(b"\n")) // 3))
        return {**answer, "data": json.loads(image.tobytes())}
    return answer


def _values(service: str, values: Any) -> Any:
    if not isinstance(values, dict):
        return values.partition("Unable to")[0]  # the rest are paths
    if service == "/rosapi/get_time":
        return {"time": sorted(values["time"])}
    if service == "/rosapi/topics":
        pairs = zip(values["topics"], values["types"], strict=True)
        return {"topics": sorted([topic, kind] for topic, kind in pairs if topic.startswith("/t/"))}
    return {name: _listed(name, each) for name, each in values.items()}


def _listed(name: str, value: Any) -> Any:
    if name in ("nodes", "publishers", "subscribers", "providers"):
        return sorted(each for each in value if each in KNOWN_NODES)
    if name in ("services", "topics", "publishing", "subscribing", "names"):
        named = sorted(each for each in value if each.startswith(("/t/", "/rosapi/")))
        return [each for each in named if not each.endswith(LOGGERS)]
    return value
