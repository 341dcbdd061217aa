"""Foxglove's protocol as bytes: sent messages, and the parsing of received ones."""

from __future__ import annotations

import json
import struct
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cfepy.extra.viewers.foxglove.protocol import (
    Advertised,
    Called,
    FrameError,
    GraphWatched,
    ParametersAsked,
    ParametersSet,
    ParametersWatched,
    Published,
    Subscribed,
    Unadvertised,
    Unsubscribed,
    graph_update,
    message_head,
    ops_of,
    parameters,
    service_response,
    time_message,
)

CHANNEL = {"id": 7, "topic": "/orders", "encoding": "ros1", "schemaName": "std_msgs/String"}
NUMBER = st.integers(0, 2**32 - 1)


def ask(op: str, **fields: Any) -> str:
    """Return a message of a viewer."""
    return json.dumps({"op": op, **fields})


@pytest.mark.parametrize(
    ("frame", "op"),
    [
        (ask("subscribe", subscriptions=[{"id": 1, "channelId": 2}]), Subscribed([(1, 2)])),
        (ask("unsubscribe", subscriptionIds=[1, 2]), Unsubscribed([1, 2])),
        (ask("unadvertise", channelIds=[7]), Unadvertised([7])),
        (ask("getParameters", parameterNames=[], id="all"), ParametersAsked([], "all")),
        (ask("getParameters", parameterNames=["/a"]), ParametersAsked(["/a"], None)),
        (ask("subscribeParameterUpdates", parameterNames=["/a"]), ParametersWatched(["/a"], True)),
        (ask("unsubscribeParameterUpdates", parameterNames=[]), ParametersWatched([], False)),
        (ask("subscribeConnectionGraph"), GraphWatched(True)),
        (ask("unsubscribeConnectionGraph"), GraphWatched(False)),
        (ask("advertise", channels=[CHANNEL]), Advertised(7, "/orders", "ros1", "std_msgs/String", "")),
        (
            ask("advertise", channels=[{**CHANNEL, "schema": "string data", "schemaEncoding": "ros1msg"}]),
            Advertised(7, "/orders", "ros1", "std_msgs/String", "string data"),
        ),
        (
            ask("advertise", channels=[{**CHANNEL, "schema": "{}", "schemaEncoding": "jsonschema"}]),
            Advertised(7, "/orders", "ros1", "std_msgs/String", ""),
        ),
        (b"\x01\x07\x00\x00\x00data", Published(7, b"data")),
        (b"\x02" + struct.pack("<III", 1, 2, 4) + b"ros1\x01", Called(1, 2, "ros1", b"\x01")),
    ],
)
def test_requests_of_a_viewer_are_parsed(frame: str | bytes, op: object) -> None:
    assert ops_of(frame) == [op]


@pytest.mark.parametrize(
    ("given", "value"),
    [
        ({"value": 3}, 3),
        ({"value": 3, "type": "float64"}, 3.0),
        ({"value": [1, 2], "type": "float64_array"}, [1.0, 2.0]),
        ({"value": [1, 2.5]}, [1.0, 2.5]),  # JavaScript writes 1.0 as 1
        ({"value": [1, 2]}, [1, 2]),
        ({"value": [True, 1]}, [True, 1]),
        ({"value": "AAE=", "type": "byte_array"}, b"\x00\x01"),
        ({"value": {"p": [1, "a"]}}, {"p": [1, "a"]}),
        ({"value": None}, None),
        ({}, None),
    ],
)
def test_set_parameters_are_parsed(given: dict[str, Any], value: Any) -> None:
    (op,) = ops_of(ask("setParameters", parameters=[{"name": "/p", **given}], id="1"))
    assert op == ParametersSet({"/p": value}, "1")
    assert isinstance(op, ParametersSet)
    assert repr(op.values["/p"]) == repr(value)  # 3 is not 3.0


@pytest.mark.parametrize(
    ("frame", "why"),
    [
        ("", "not JSON"),
        ("[1]", "a message must be a JSON object"),
        ("{}", "unknown operation 'None'"),
        (ask("fetchAsset", uri="package://x", requestId=1), "unknown operation 'fetchAsset'"),
        (ask("subscribe"), "subscriptions must be a list of objects"),
        (ask("subscribe", subscriptions=[1]), "subscriptions must be a list of objects"),
        (ask("subscribe", subscriptions=[{"id": -1, "channelId": 1}]), "id must be a number of 32 bits"),
        (ask("subscribe", subscriptions=[{"id": True, "channelId": 1}]), "id must be a number"),
        (ask("unsubscribe", subscriptionIds=["1"]), "subscriptionIds must be a list of numbers"),
        (ask("getParameters", parameterNames=[], id=5), "id must be a text"),
        (ask("advertise", channels=[{**CHANNEL, "topic": 5}]), "topic must be a text"),
        (
            ask("setParameters", parameters=[{"name": "/p", "value": "x", "type": "byte_array"}]),
            "/p is not of type byte_array",
        ),
        (
            ask("setParameters", parameters=[{"name": "/p", "value": True, "type": "float64"}]),
            "/p is not of type float64",
        ),
        (
            ask("setParameters", parameters=[{"name": "/p", "value": 5, "type": "float64_array"}]),
            "/p is not of type float64_arr",
        ),
        (ask("setParameters", parameters=[{"name": "/p", "value": [10**400, 0.5]}]), "/p is not of type float64_array"),
        (ask("setParameters", parameters=[{"name": "/p", "value": 5, "type": "int"}]), "unknown parameter type 'int'"),
        ('{"op": "unadvertise", "x": "\\ud800"}', "not JSON: .*surrogates"),
        ("[" * 100_000, "not JSON"),
        (b"\x00", "unknown binary operation 0"),
        (b"\x01\x00", "too short"),
        (b"\x02" + struct.pack("<III", 1, 2, 5) + b"ros1", "longer than the request"),
    ],
)
def test_malformed_message_of_the_protocol_is_refused(frame: str | bytes, why: str) -> None:
    with pytest.raises(FrameError, match=why):
        ops_of(frame)


@given(
    frame=st.one_of(
        st.binary(max_size=40), st.text(max_size=40), st.builds(bytes.__add__, st.just(b"\x02"), st.binary())
    )
)
def test_any_frame_is_parsed_or_refused(frame: str | bytes) -> None:
    try:
        ops_of(frame)
    except FrameError as error:
        str(error).encode()


JSON_VALUES = st.recursive(
    st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=5)),
    lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(st.text(max_size=5), inner, max_size=3)),
    max_leaves=8,
)


@given(op=st.sampled_from(["subscribe", "advertise", "setParameters"]), value=JSON_VALUES, type_=JSON_VALUES)
def test_values_of_wrong_types_are_parsed_or_refused(op: str, value: Any, type_: Any) -> None:
    lists = {"subscriptions": [{"id": value}], "channels": [{**CHANNEL, "id": value}]}
    frame = ask(op, **lists, parameters=[{"name": "/p", "value": value, "type": type_}])
    try:
        ops_of(frame)
    except FrameError:
        pass


@pytest.mark.parametrize(
    ("value", "told"),
    [
        (3, {"value": 3}),
        (2.5, {"value": 2.5, "type": "float64"}),
        (float("nan"), {"value": None, "type": "float64"}),
        ([1.0, 2.0], {"value": [1.0, 2.0], "type": "float64_array"}),
        ([1, 2], {"value": [1, 2]}),
        ([], {"value": []}),
        (b"\x00\x01", {"value": "AAE=", "type": "byte_array"}),
        ({"d": [b"\x00", float("inf")]}, {"value": {"d": ["AA==", None]}}),
        (None, {}),
    ],
)
def test_parameters_are_serialized_with_their_types(value: Any, told: dict[str, Any]) -> None:
    message = json.loads(parameters([("/p", value)], "7"))
    assert message == {"op": "parameterValues", "parameters": [{"name": "/p", **told}], "id": "7"}
    assert "id" not in json.loads(parameters([("/p", value)]))


def test_graph_update_has_only_differences() -> None:
    before = ({"/a": ["/n"], "/b": []}, {"/a": [], "/b": []}, {"/s": ["/n"], "/t": ["/n"]})
    now = ({"/a": [], "/c": ["/m"]}, {"/a": ["/m"], "/c": []}, {"/t": ["/n"]})
    assert json.loads(graph_update(before, now)) == {
        "op": "connectionGraphUpdate",
        "publishedTopics": [{"name": "/a", "publisherIds": []}, {"name": "/c", "publisherIds": ["/m"]}],
        "subscribedTopics": [{"name": "/a", "subscriberIds": ["/m"]}, {"name": "/c", "subscriberIds": []}],
        "advertisedServices": [],
        "removedTopics": ["/b"],
        "removedServices": ["/s"],
    }


@given(number=NUMBER, call=NUMBER, time_ns=st.integers(0, 2**64 - 1), data=st.binary(max_size=20))
def test_binary_messages(number: int, call: int, time_ns: int, data: bytes) -> None:
    assert struct.unpack("<BIQ", message_head(number, time_ns)) == (1, number, time_ns)
    assert struct.unpack("<BQ", time_message(time_ns)) == (2, time_ns)
    answer = service_response(number, call, data)
    assert struct.unpack_from("<BIII4s", answer) == (3, number, call, 4, b"ros1")
    assert answer[17:] == data
