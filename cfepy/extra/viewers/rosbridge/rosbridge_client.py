"""`RosbridgeClient`: the ops of one client, and the messages to it (ROSBRIDGE_PROTOCOL.md).

An error in an op is reported with a `status` of level `error`, and the op has no effect. Texts are those of
rosbridge_library, where it has one.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from typing import Any, Concatenate, ParamSpec

from cfepy.extra.viewers.bounded_json import loads
from cfepy.extra.viewers.rosbridge.bridge_node import BridgeNode
from cfepy.extra.viewers.rosbridge.fragments import Assembly, fragments
from cfepy.extra.viewers.rosbridge.known_types import NotPossible
from cfepy.extra.viewers.rosbridge.outgoing import Outgoing
from cfepy.extra.viewers.rosbridge.rosapi import Rosapi
from cfepy.extra.viewers.rosbridge.rosauth import MacCheck
from cfepy.extra.viewers.rosbridge.sending import CBOR_RAW, LONGEST_QUEUE, NONE, Pacing, Wish
from cfepy.extra.viewers.websocket import LONGEST_MESSAGE, WebSocket
from cfepy.extra.viewers.websocket_listener import CONNECTIONS, INTERNAL, LONGEST_REASON
from cfepy.io import INTO, OUT_OF, PeerCounts
from cfepy.status import UsageError
from rospy_shim.types.genpy import DeserializationError

LEVELS = ("none", "error", "warning", "info")
"""Levels of `status`, from the least verbose."""
MOST_CALLS = 1000  # pending calls of a client
MOST_TOPICS = 1000  # that a client publishes, and that it subscribes to
MOST_PATIENCE_S = 1.0  # wall time for which the mission may be full, before a message is dropped
SHORTEST_FRAGMENT = 16  # characters
LONGEST_ID = 1000  # characters
MOST_IDS = 100  # of one topic
MOST_SERVICES = 100  # that a client offers
POLICY = 1008  # RFC 6455, 7.4.1

Op = dict[str, Any]
_TEXT, _NUMBER, _OBJECT, _FLAG = (str,), (int,), (dict,), (bool,)
_IDS = (str, int, float, bool, type(None))
_NAMES: dict[type, str] = {str: "str", int: "int", dict: "dict", bool: "bool", type(None): "NoneType"}


P = ParamSpec("P")


def _alone(step: Callable[Concatenate[RosbridgeClient, P], None]) -> Callable[Concatenate[RosbridgeClient, P], None]:
    """Decorate a step of a client that the mission calls, so that an error in it only ends the client's connection."""

    def guarded(client: RosbridgeClient, /, *values: P.args, **named: P.kwargs) -> None:
        try:
            step(client, *values, **named)
        except Exception as error:
            client.socket.close(INTERNAL, f"{type(error).__name__}: {error}"[:LONGEST_REASON])

    return guarded


class RosbridgeClient:
    """A client.

    Args:
        node: knows the mission.
        rosapi: answers the services of rosapi.
        counts: counts for the run's report.
        peer: name of the client in the report.
        mac: checks `auth`, with which the client must begin unless it is admitted otherwise.

    Attributes:
        socket: its connection.
    """

    def __init__(self, node: BridgeNode, rosapi: Rosapi, counts: PeerCounts, peer: str, mac: MacCheck) -> None:
        self.socket: WebSocket
        self._node = node
        self._rosapi = rosapi
        self._counts = counts
        self._peer = peer
        self._mac: MacCheck | None = mac
        self._level = LEVELS.index("error")
        self._fragment_size: int | None = None
        self._fragment_number = 0
        self._assembly = Assembly(LONGEST_MESSAGE)
        self._stalled: tuple[str, bytes, float] | None = None  # topic, message, since when
        self._advertised: dict[str, set[object]] = {}  # by topic: ids
        self._published: set[str] = set()  # topics that it publishes or has published
        self._hears: dict[str, dict[str, Pacing[Outgoing]]] = {}  # by full name and the name that it has given
        self._calls: set[int] = set()
        self._ops: dict[str, Callable[[Op], object]] = {
            "call_service": self._call_service,
            "advertise": self._advertise,
            "unadvertise": self._unadvertise,
            "publish": self._publish,
            "subscribe": self._subscribe,
            "unsubscribe": self._unsubscribe,
            "fragment": self._fragment,
            "advertise_service": self._advertise_service,
            "service_response": self._service_response,
            "unadvertise_service": self._unadvertise_service,
            "set_level": self._set_level,
            "auth": self._auth,
        }

    def is_admitted(self) -> None:
        """Admit the client without `auth`."""
        self._mac = None

    # -- input ---------------------------------------------------------------------------------------------------------

    @property
    def is_ready(self) -> bool:
        """True if the mission has room for the client's messages."""
        return self._stalled is None

    @property
    def unfinished(self) -> int:
        return self._assembly.size

    @property
    def takes_part(self) -> bool:
        offers = self._node.offered_by(self)
        return bool(self._published or self._hears or self._calls or self._stalled is not None or offers)

    @property
    def has_more(self) -> bool:
        """Always False: the connection itself keeps messages that wait for room."""
        return False

    def begin(self, connection: WebSocket) -> None:
        """Keep the new connection."""
        self.socket = connection
        self._counts.of(CONNECTIONS, self._peer, INTO).connections += 1

    def go_on(self, now_s: float) -> None:
        """Go on after a step of the run: enter a message that waited for room, and send messages that are due."""
        if self._stalled is not None:
            self._enter(*self._stalled, now_s)
        for by_name in list(self._hears.values()):
            for name, pacing in by_name.items():
                while (message := pacing.due(now_s)) is not None:
                    self._tell(name, pacing, message)

    def take(self, message: str | bytes) -> None:
        """Take a message of the client."""
        count = self._counts.of(CONNECTIONS, self._peer, INTO)
        count.messages += 1
        count.size += len(message)
        try:
            op = self._parsed(message)
        except UsageError as error:
            self._wrong(str(error), None)
            return
        self._do(op)

    def _parsed(self, message: str | bytes) -> Op:
        if isinstance(message, bytes):
            raise NotPossible("binary messages (BSON) are not supported; send JSON as text")
        try:
            op = loads(message)
        except ValueError as error:
            raise NotPossible(f"Unable to deserialize message from client: {message[:200]}: {error}") from None
        if not isinstance(op, dict):
            raise NotPossible(f"a message must be a JSON object, not {type(op).__name__}: {message[:200]}")
        return op

    def _do(self, op: Op) -> None:
        name = op.get("op")
        if self._mac is not None and name != "auth":
            self._turn_away("did not authenticate")
            return
        if type(op.get("id")) not in _IDS or len(str(op.get("id"))) > LONGEST_ID:
            self._wrong(f"Expected field id to be a text or a number of at most {LONGEST_ID} characters.", None)
            return
        known = self._ops.get(name) if isinstance(name, str) else None
        if known is None:
            self._wrong(self._unknown(op), op.get("id"))
            return
        size = op.get("fragment_size")
        if type(size) is int and size > 0:
            self._fragment_size = max(size, SHORTEST_FRAGMENT)
        try:
            known(op)
        except (UsageError, DeserializationError) as error:
            self._wrong(f"{name}: {error}", op.get("id"))

    def _unknown(self, op: Op) -> str:
        names = list(self._ops)
        if "op" in op:
            return f"Unknown operation: {str(op['op'])[:200]}.  Allowed operations: {names}"
        text = "Received a message without an op.  All messages require 'op' field with value one of:"
        return f"{text} {names}.  Original message was: {str(op)[:200]}"

    def _wrong(self, text: str, name: object) -> None:
        count = self._counts.of(CONNECTIONS, self._peer, INTO)
        count.dropped += 1
        count.why = text
        self._status("error", text, name)

    def _status(self, level: str, text: str, name: object = None) -> None:
        if LEVELS.index(level) <= self._level:
            self._send({"op": "status", "level": level, "msg": text, **({} if name is None else {"id": name})})

    # -- output --------------------------------------------------------------------------------------------------------

    def _send(self, op: Op) -> None:
        self._out(json.dumps(op), op.get("id"))

    def _out(self, message: str | bytes, name: object = None) -> None:
        size = self._fragment_size
        if size is None or isinstance(message, bytes) or len(message) <= size:
            self.socket.send(message)
            return
        if name is None:
            name, self._fragment_number = str(self._fragment_number), self._fragment_number + 1
        for each in fragments(message, size, name):
            self.socket.send(json.dumps(each))

    # -- published topics ----------------------------------------------------------------------------------------------

    def _advertise(self, op: Op) -> None:
        _check(op, ("topic", True, _TEXT), ("type", True, _TEXT))
        topic = self._node.resolved(op["topic"])
        self._publishes(topic, op["type"], op.get("latch") is True)
        names = self._advertised.setdefault(topic, set())
        if len(names) >= MOST_IDS:
            raise NotPossible(f"a client can advertise a topic under at most {MOST_IDS} ids")
        names.add(_hashable(op.get("id")))

    def _publishes(self, topic: str, kind: str | None, latching: bool) -> None:
        if len(self._published) >= MOST_TOPICS and topic not in self._published:
            raise NotPossible(f"a client can publish at most {MOST_TOPICS} topics")
        self._node.advertise(self, topic, kind, latching)
        self._published.add(topic)

    def _unadvertise(self, op: Op) -> None:
        _check(op, ("topic", True, _TEXT))
        topic = self._node.resolved(op["topic"])
        names = self._advertised.get(topic)
        if names is None:
            return
        if op.get("id") is None:
            names.clear()
        names.discard(_hashable(op.get("id")))
        if not names:
            del self._advertised[topic]
            self._published.discard(topic)
            self._node.unadvertise(self, topic, time.monotonic())

    def _publish(self, op: Op) -> None:
        _check(op, ("topic", True, _TEXT))
        topic = self._node.resolved(op["topic"])
        self._publishes(topic, None, op.get("latch") is True)
        payload = self._node.packed(topic, op.get("msg", {}))
        now_s = time.monotonic()
        self._stalled = (topic, payload, now_s)
        self._enter(topic, payload, now_s, now_s)

    def _enter(self, topic: str, payload: bytes, since_s: float, now_s: float) -> None:
        """Enter a message, if the mission has room for it or has been full for too long."""
        if not self._node.has_room(topic, payload) and now_s - since_s < MOST_PATIENCE_S:
            return
        self._stalled = None
        count = self._counts.of(topic, self._peer, INTO)
        count.messages += 1
        count.size += len(payload)
        if not self._node.publish(topic, payload):
            count.dropped += 1
            count.why = f"the Software Bus did not take a message of {topic}"
            self._status("error", f"publish: {count.why}")

    # -- subscribed topics ---------------------------------------------------------------------------------------------

    def _subscribe(self, op: Op) -> None:
        _check(
            op,
            *(("topic", True, _TEXT), ("type", False, _TEXT), ("throttle_rate", False, _NUMBER)),
            *(("fragment_size", False, _NUMBER), ("queue_length", False, _NUMBER), ("compression", False, _TEXT)),
        )
        name = op["topic"]
        topic = self._node.resolved(name)
        compression = op.get("compression", NONE)
        length = min(max(op.get("queue_length", 0), 0), LONGEST_QUEUE)
        if topic not in self._hears and len(self._hears) >= MOST_TOPICS:
            raise NotPossible(f"a client can subscribe to at most {MOST_TOPICS} topics")
        by_name = self._hears.setdefault(topic, {})
        if len(by_name) >= MOST_IDS and name not in by_name:
            raise NotPossible(f"a client can write the name of a topic in at most {MOST_IDS} ways")
        pacing = by_name.get(name)
        if pacing is not None and pacing.wishes >= MOST_IDS:
            raise NotPossible(f"a client can subscribe to a topic under at most {MOST_IDS} ids")
        is_new = pacing is None
        if pacing is None:
            pacing = by_name[name] = Pacing(lambda message: len(message.payload))
        pacing.want(_hashable(op.get("id")), Wish(max(op.get("throttle_rate", 0), 0), length, compression))
        try:
            self._node.subscribe(self, topic, op.get("type"), compression == CBOR_RAW)
        except UsageError:
            if is_new:
                self._forget(topic, name)
            raise
        if is_new:
            self._counts.of(topic, self._peer, OUT_OF).connections += 1
        self._status("info", f"Subscribed to {name}")

    def _unsubscribe(self, op: Op) -> None:
        _check(op, ("topic", True, _TEXT))
        name = op["topic"]
        topic = self._node.resolved(name)
        pacing = self._hears.get(topic, {}).get(name)
        if pacing is None:
            return
        if pacing.want_no_more(_hashable(op.get("id"))):
            self._forget(topic, name)
        self._status("info", f"Unsubscribed from {name}")

    def _forget(self, topic: str, name: str) -> None:
        by_name = self._hears[topic]
        self._counts.of(topic, self._peer, OUT_OF).dropped += by_name.pop(name).dropped
        if not by_name:
            del self._hears[topic]
            self._node.unsubscribe(self, topic)

    @_alone
    def heard(self, topic: str, message: Outgoing) -> None:
        now_s = time.monotonic()
        for name, pacing in self._hears.get(topic, {}).items():
            found = pacing.add(message, now_s)
            if found is not None:
                self._tell(name, pacing, found)

    def _tell(self, name: str, pacing: Pacing[Outgoing], message: Outgoing) -> None:
        count = self._counts.of(self._node.resolved(name), self._peer, OUT_OF)
        try:
            self._out(message.op(name, pacing.compression))
        except DeserializationError as error:
            count.dropped += 1
            count.why = str(error)
            return
        count.messages += 1
        count.size += len(message.payload)

    # -- services ------------------------------------------------------------------------------------------------------

    def _call_service(self, op: Op) -> None:
        _check(
            op,
            *(("service", True, _TEXT), ("fragment_size", False, (int, type(None))), ("compression", False, _TEXT)),
        )
        given = op["service"]
        name, mark, old_id = given.partition("#")
        cid = op.get("id", old_id if mark else None)

        def answer(good: bool, values: Any) -> None:
            self._answer_call(given, cid, good, values)

        try:
            service = self._node.resolved(name)
            if service in self._rosapi.services:
                answer(True, self._rosapi.call(service, op.get("args", [])))
                return
            if len(self._calls) >= MOST_CALLS:
                raise NotPossible(f"the limit of {MOST_CALLS} pending calls is reached")
            self._begin_call(service, op.get("args", []), answer)
        except UsageError as error:
            answer(False, str(error))

    @_alone
    def _answer_call(self, given: str, cid: object, good: bool, values: Any) -> None:
        named = {} if cid is None else {"id": cid}
        self._send({"op": "service_response", "service": given, "values": values, "result": good, **named})

    def _begin_call(self, service: str, arguments: Any, answer: Callable[[bool, Any], None]) -> None:
        def over(good: bool, values: Any) -> None:
            self._calls.discard(number)
            if not good:
                count.dropped += 1
                count.why = str(values)
            answer(good, values)

        number = self._node.call(service, arguments, over)
        count = self._counts.of(service, self._peer, INTO)
        count.messages += 1
        self._calls.add(number)

    def _advertise_service(self, op: Op) -> None:
        _check(op, ("service", True, _TEXT), ("type", True, _TEXT))
        name = op["service"]
        if self._node.offered_by(self) >= MOST_SERVICES:
            raise NotPossible(f"a client can offer at most {MOST_SERVICES} services")
        if self._node.offer(self, self._node.resolved(name), op["type"]):
            self._status("warning", f"Duplicate service advertised. Overwriting {name}.")
        self._status("info", f"Advertised service {name}.")

    def _unadvertise_service(self, op: Op) -> None:
        _check(op, ("service", True, _TEXT))
        name = op["service"]
        service = self._node.resolved(name)
        if self._node.offers(service) is None:
            raise NotPossible(f"Service {name} has not been advertised via rosbridge, can't unadvertise.")
        self._node.withdraw(service)
        self._status("info", f"Unadvertised service {name}.")

    @_alone
    def requested(self, service: str, number: str, values: Op) -> None:
        self._counts.of(service, self._peer, OUT_OF).messages += 1
        self._send({"op": "call_service", "id": number, "service": service, "args": values})

    def _service_response(self, op: Op) -> None:
        _check(op, ("service", True, _TEXT), ("id", False, _TEXT), ("values", False, _OBJECT), ("result", True, _FLAG))
        name = op["service"]
        service = self._node.resolved(name)
        if self._node.offers(service) is not self:
            raise NotPossible(f"Service {name} has not been advertised via rosbridge.")
        self._node.respond(service, op.get("id", ""), op.get("values", {}))

    # -- the rest ------------------------------------------------------------------------------------------------------

    def _fragment(self, op: Op) -> None:
        whole = self._assembly.add(op, time.monotonic())
        if whole is not None:
            self.take(whole)

    def _set_level(self, op: Op) -> None:
        level = op.get("level")
        if level not in LEVELS:
            raise NotPossible(f"Expected field level to be one of {LEVELS}. Invalid value: {str(level)[:200]}")
        self._level = LEVELS.index(level)

    def _auth(self, op: Op) -> None:
        if self._mac is None:
            return  # not required, or done already
        if self._mac.admits(op, time.time()):
            self._mac = None
        else:
            self._turn_away("did not authenticate")

    def _turn_away(self, why: str) -> None:
        count = self._counts.of(CONNECTIONS, self._peer, INTO)
        count.refused += 1
        count.why = why
        self.socket.close(POLICY, why)

    def gone(self, why: str) -> None:
        """Remove all entries of the client at the end of its connection; publishers stay for a while."""
        now_s = time.monotonic()
        for number in list(self._calls):
            self._node.forget_call(number)
        self._calls.clear()
        self._node.withdraw_all(self)
        for topic, by_name in list(self._hears.items()):
            for name in list(by_name):
                self._forget(topic, name)
        for topic in self._published:
            self._node.unadvertise(self, topic, now_s)
        self._published.clear()
        self._advertised.clear()
        self._stalled = None
        count = self._counts.of(CONNECTIONS, self._peer, INTO)
        count.ended += 1
        count.why = why or count.why
        self._counts.of(CONNECTIONS, self._peer, OUT_OF).dropped += self.socket.dropped


def _check(op: Op, *fields: tuple[str, bool, tuple[type, ...]]) -> None:
    """Check fields of an op: name, True if it is required, and the permitted types.

    Raises:
        NotPossible: one of them is missing, or has another type.
    """
    for name, is_needed, kinds in fields:
        if name not in op:
            if is_needed:
                raise NotPossible(f"Expected a {name} field but none was found.")
        elif type(op[name]) not in kinds:
            expected = tuple(_NAMES[each] for each in kinds)
            raise NotPossible(f"Expected field {name} to be one of {expected}. Invalid value: {str(op[name])[:200]}")


def _hashable(name: object) -> object:
    return name if isinstance(name, (str, int, type(None))) else repr(name)
