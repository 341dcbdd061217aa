"""Foxglove's WebSocket protocol: messages to and from viewers, as bytes (foxglove/ws-protocol, spec.md).

It has two names, without a difference in the parts used here: Foxglove itself asks for `foxglove.sdk.v1`, its older
client library and Lichtblick for `foxglove.websocket.v1`. A text is a JSON object with an `op`. The first byte of a
binary message is its opcode. Numbers are little-endian.
"""

from __future__ import annotations

import base64
import binascii
import json
import math
import struct
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from cfepy.extra.viewers.bounded_json import loads
from cfepy.reading.input_limits import ROS_NAME, VIEWER_ROWS

SUBPROTOCOLS = ("foxglove.sdk.v1", "foxglove.websocket.v1")
CAPABILITIES = ("clientPublish", "connectionGraph", "parameters", "parametersSubscribe", "services", "time")
JSON, ROS1 = "json", "ros1"
ROS1_SCHEMA, JSON_SCHEMA = "ros1msg", "jsonschema"
WARNING, ERROR = 1, 2  # levels of a status
MOST_ROWS = {"channels": 100, "parameters": 1_000}
"""Maximum entries of lists whose entries are expensive; others have `VIEWER_ROWS`."""
HALF_A_CHARACTER = "\\ud"  # in JSON: a surrogate; without its other half it is not a valid text

_MESSAGE_DATA, _TIME, _SERVICE_RESPONSE = 1, 2, 3  # from the server
_SERVICE_REQUEST = 2  # from a viewer; its messages are 1, too
_message_head, _time = struct.Struct("<BIQ").pack, struct.Struct("<BQ").pack
_response_head = struct.Struct("<BIII").pack
_message_number, _request_head = struct.Struct("<I").unpack_from, struct.Struct("<III").unpack_from
_MOST_NUMBER = 2**32 - 1
_FLOAT, _FLOATS, _BYTES = "float64", "float64_array", "byte_array"

Graph = tuple[Mapping[str, Sequence[str]], Mapping[str, Sequence[str]], Mapping[str, Sequence[str]]]
"""Publishers and subscribers of each topic, and the nodes that offer each service."""


class FrameError(ValueError):
    """A viewer has sent a message that the protocol does not define."""


# -- to viewers --------------------------------------------------------------------------------------------------------


def text(op: str, **fields: Any) -> str:
    """Return a message in JSON."""
    return json.dumps({"op": op, **fields})


def server_info(name: str, session: str) -> str:
    """Return the first message to each viewer."""
    return text(
        "serverInfo",
        name=name,
        capabilities=CAPABILITIES,
        supportedEncodings=(ROS1, JSON),
        metadata={},
        sessionId=session,
    )


def status(level: int, message: str, key: str | None = None) -> str:
    """Return a message for the user of a viewer; one with the same key replaces it."""
    return text("status", level=level, message=message, **({} if key is None else {"id": key}))


def service(number: int, name: str, kind: str, request: str, response: str) -> dict[str, Any]:
    """Return a ROS service as it is advertised, with the definitions of both of its parts."""

    def part(ending: str, definition: str) -> dict[str, str]:
        name = f"{kind}{ending}"
        return {"encoding": ROS1, "schemaName": name, "schemaEncoding": ROS1_SCHEMA, "schema": definition}

    return {
        "id": number,
        "name": name,
        "type": kind,
        "request": part("Request", request),
        "response": part("Response", response),
        "requestSchema": request,  # for viewers that do not know the two above
        "responseSchema": response,
    }


def message_head(subscription: int, time_ns: int) -> bytes:
    """Return the header of a message."""
    return _message_head(_MESSAGE_DATA, subscription, time_ns)


def time_message(time_ns: int) -> bytes:
    """Return a message with the time."""
    return _time(_TIME, time_ns)


def service_response(service: int, call: int, answer: bytes) -> bytes:
    """Return the answer to a call."""
    encoding = ROS1.encode()
    return _response_head(_SERVICE_RESPONSE, service, call, len(encoding)) + encoding + answer


def service_failure(service: int, call: int, why: str) -> str:
    """Return the message for a failed call."""
    return text("serviceCallFailure", serviceId=service, callId=call, message=why)


def parameters(values: Iterable[tuple[str, Any]], request: str | None = None) -> str:
    """Return a message with the values of parameters.

    Args:
        values: names and values; bytes, numbers, texts, and lists and dicts of them. None means that there is no such
            parameter.
        request: id of the request that it answers.
    """
    told = [{"name": name, **_told(value)} for name, value in values]
    return text("parameterValues", parameters=told, **({} if request is None else {"id": request}))


def _told(value: Any) -> dict[str, Any]:
    if value is None:
        return {}
    if isinstance(value, float):
        return {"value": _plain(value), "type": _FLOAT}
    if isinstance(value, bytes):
        return {"value": _plain(value), "type": _BYTES}
    if isinstance(value, list) and value and all(isinstance(each, float) for each in value):
        return {"value": _plain(value), "type": _FLOATS}
    return {"value": _plain(value)}


def _plain(value: Any) -> Any:
    """Convert a value to JSON, which has no NaN or infinity, and no bytes."""
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if isinstance(value, bytes):
        return base64.b64encode(value).decode()
    if isinstance(value, dict):
        return {str(name): _plain(each) for name, each in value.items()}
    return [_plain(each) for each in value] if isinstance(value, list) else value


def graph_update(before: Graph, now: Graph) -> str:
    """Return the difference of two graphs."""
    publishers, subscribers, providers = (
        [{"name": name, key: list(ids)} for name, ids in new.items() if ids != old.get(name, ())]
        for old, new, key in zip(before, now, ("publisherIds", "subscriberIds", "providerIds"), strict=True)
    )
    topics_before, topics = before[0].keys() | before[1].keys(), now[0].keys() | now[1].keys()
    return text(
        "connectionGraphUpdate",
        publishedTopics=publishers,
        subscribedTopics=subscribers,
        advertisedServices=providers,
        removedTopics=sorted(topics_before - topics),
        removedServices=sorted(before[2].keys() - now[2].keys()),
    )


# -- from viewers ------------------------------------------------------------------------------------------------------


class Subscribed(NamedTuple):
    """A viewer subscribes: pairs of a subscription number of its own and a channel number."""

    pairs: list[tuple[int, int]]


class Unsubscribed(NamedTuple):
    """A viewer unsubscribes; the numbers are its own."""

    numbers: list[int]


class Advertised(NamedTuple):
    """A viewer announces a publication; `definition` is the definition of the type, if it gave one."""

    number: int
    topic: str
    encoding: str
    kind: str
    definition: str


class Unadvertised(NamedTuple):
    """A viewer ends publications."""

    numbers: list[int]


class Published(NamedTuple):
    """A viewer publishes a message."""

    number: int
    data: bytes


class ParametersAsked(NamedTuple):
    """A viewer asks for parameters; all of them if it names none."""

    names: list[str]
    request: str | None


class ParametersSet(NamedTuple):
    """A viewer sets parameters; None deletes one."""

    values: dict[str, Any]
    request: str | None


class ParametersWatched(NamedTuple):
    """A viewer subscribes to changes of parameters, or unsubscribes; all existing ones if it names none."""

    names: list[str]
    is_on: bool


class GraphWatched(NamedTuple):
    """A viewer subscribes to changes of the graph, or unsubscribes."""

    is_on: bool


class Called(NamedTuple):
    """A viewer calls a service."""

    service: int
    call: int
    encoding: str
    request: bytes


Op = (
    Subscribed
    | Unsubscribed
    | Advertised
    | Unadvertised
    | Published
    | ParametersAsked
    | ParametersSet
    | ParametersWatched
    | GraphWatched
    | Called
)


def ops_of(frame: str | bytes) -> list[Op]:
    """Parse a message of a viewer.

    Returns:
        Its operations.

    Raises:
        FrameError: it is not a message of the protocol.
    """
    if isinstance(frame, bytes):
        return [_binary(frame)] if frame else []
    try:
        message = loads(frame)
        if HALF_A_CHARACTER in frame.lower():
            json.dumps(message, ensure_ascii=False).encode()
    except (ValueError, RecursionError) as error:
        raise FrameError(f"not JSON: {error}") from None
    if not isinstance(message, dict):
        raise FrameError(f"a message must be a JSON object, not {frame[:40]}")
    op = message.get("op")
    if op == "advertise":
        return [_advertised(each) for each in _objects(message, "channels")]
    if op in ("subscribeConnectionGraph", "unsubscribeConnectionGraph"):
        return [GraphWatched(op.startswith("s"))]
    if op in ("subscribeParameterUpdates", "unsubscribeParameterUpdates"):
        return [ParametersWatched(_texts(message, "parameterNames"), op.startswith("s"))]
    match op:
        case "subscribe":
            pairs = [(_number(each, "id"), _number(each, "channelId")) for each in _objects(message, "subscriptions")]
            return [Subscribed(pairs)]
        case "unsubscribe":
            return [Unsubscribed(_numbers(message, "subscriptionIds"))]
        case "unadvertise":
            return [Unadvertised(_numbers(message, "channelIds"))]
        case "getParameters":
            return [ParametersAsked(_texts(message, "parameterNames"), _request(message))]
        case "setParameters":
            values = {_text(each, "name"): _value(each) for each in _objects(message, "parameters")}
            return [ParametersSet(values, _request(message))]
    raise FrameError(f"unknown operation {str(op)[:40]!r}")


def _binary(frame: bytes) -> Op:
    try:
        if frame[0] == _MESSAGE_DATA:
            return Published(_message_number(frame, 1)[0], frame[5:])
        if frame[0] == _SERVICE_REQUEST:
            service, call, length = _request_head(frame, 1)
            if len(frame) < 13 + length:
                raise FrameError("the encoding of a request is longer than the request")
            return Called(service, call, frame[13 : 13 + length].decode(errors="replace"), frame[13 + length :])
    except struct.error:
        raise FrameError("a binary message is too short") from None
    raise FrameError(f"unknown binary operation {frame[0]}")


def _advertised(channel: Mapping[str, Any]) -> Advertised:
    encoding, schema = channel.get("schemaEncoding"), channel.get("schema")
    definition = schema if isinstance(schema, str) and encoding in (None, "", ROS1_SCHEMA) else ""
    topic, kind = _text(channel, "topic"), _text(channel, "schemaName")
    return Advertised(_number(channel, "id"), topic, _text(channel, "encoding"), kind, definition)


def _value(parameter: Mapping[str, Any]) -> Any:
    """Return the value of a parameter. Numbers in a list get one type, since JavaScript writes 1.0 as 1."""
    value, kind = parameter.get("value"), parameter.get("type")
    if value is None:
        return None
    try:
        if kind == _BYTES:
            return base64.b64decode(value, validate=True)
        if kind == _FLOAT:
            return _float(value)
        kinds = {type(each) for each in value} if isinstance(value, list) else set()
        if kind == _FLOATS or kinds == {int, float}:
            return [_float(each) for each in value]
    except (TypeError, ValueError, OverflowError, binascii.Error):
        raise FrameError(f"parameter {str(parameter.get('name'))[:100]} is not of type {kind or _FLOATS}") from None
    if kind is not None:
        raise FrameError(f"unknown parameter type {str(kind)[:40]!r}")
    return value


def _float(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise TypeError
    return float(value)


def _field(of: Mapping[str, Any], name: str, kind: type, what: str) -> Any:
    value = of.get(name)
    if not isinstance(value, kind) or isinstance(value, bool):
        raise FrameError(f"{name} must be {what}")
    return value


def _text(of: Mapping[str, Any], name: str) -> str:
    text = str(_field(of, name, str, "a text"))
    if len(text) > ROS_NAME:
        raise FrameError(f"{name} has more than {ROS_NAME:,} characters")
    return text


def _request(of: Mapping[str, Any]) -> str | None:
    return None if of.get("id") is None else _text(of, "id")


def _number(of: Mapping[str, Any], name: str) -> int:
    value: int = _field(of, name, int, "a number")
    if not 0 <= value <= _MOST_NUMBER:
        raise FrameError(f"{name} must be a number of 32 bits")
    return value


def _list(of: Mapping[str, Any], name: str, kind: type, what: str) -> list[Any]:
    values: list[Any] = _field(of, name, list, f"a list of {what}")
    most = MOST_ROWS.get(name, VIEWER_ROWS)
    if len(values) > most:
        raise FrameError(f"{name} has {len(values):,} entries; the limit is {most:,}")
    if not all(isinstance(each, kind) and not isinstance(each, bool) for each in values):
        raise FrameError(f"{name} must be a list of {what}")
    return values


def _texts(of: Mapping[str, Any], name: str) -> list[str]:
    texts: list[str] = _list(of, name, str, "texts")
    if any(len(each) > ROS_NAME for each in texts):
        raise FrameError(f"{name} has a text of more than {ROS_NAME:,} characters")
    return texts


def _numbers(of: Mapping[str, Any], name: str) -> list[int]:
    return _list(of, name, int, "numbers")


def _objects(of: Mapping[str, Any], name: str) -> list[dict[str, Any]]:
    return _list(of, name, dict, "objects")
