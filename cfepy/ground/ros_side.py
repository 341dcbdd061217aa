"""The ROS side of a running mission for a test, a script or the console: publish, set a parameter, call a service.

`RosSide` finds the user's mistakes in names, messages and fields. `cfepy.mission.host_actions` then carries out the
action.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

from cfepy.ground.topics import Topic, library_of, topics_of
from cfepy.ground.values import unknown_field
from cfepy.mission import CALL, PARAM, PUBLISH, HostCall, Mission
from cfepy.reading.suggestions import did_you_mean, listed
from cfepy.status import UsageError, together
from cfepy.units import NS_PER_S

if TYPE_CHECKING:
    from rospy_shim.runtime import RosRuntime
    from rospy_shim.types.msgs import Library

LIKE_IT = 3  # number of similar names to suggest


class AbsentError(LookupError):
    """Exception for a topic, subscriber, service, parameter or node that the mission does not have at this time."""


class RosSide:
    """The ROS side of a mission.

    Args:
        mission: the mission; it may be reset.
        act: carries out a host action; see `cfepy.mission.host_actions.HostActs.do`.
    """

    MISSING = object()
    """Default of a parameter that must exist."""

    def __init__(self, mission: Mission, act: Callable[..., Any]) -> None:
        self._mission = mission
        self._act = act

    def publish(self, name: str, message: Any, fields: Mapping[str, Any]) -> None:
        """Publish a message on a topic.

        Args:
            name: name of the topic; a leading `/` may be missing.
            message: a message of the topic's type; None for a message made of `fields`.
            fields: values by name; dictionaries are nested messages.

        Raises:
            AbsentError: if the topic does not exist, or has no subscriber.
            UsageError: if the message has another type, or there is no such field or value.
        """
        topic = self._topic(name)
        route = self._mission.cfe.sb.routes.get(topic.msg_id)
        if route is None or not route.active:
            raise AbsentError(f"{topic.name} has no subscriber at {self._mission.kernel.now / NS_PER_S:.3f} s")
        self._act(PUBLISH, topic.name, _payload(topic, message, fields))

    def param(self, name: str, default: Any = MISSING) -> Any:
        """Return the present value of a parameter.

        Raises:
            AbsentError: if it does not exist and there is no default.
        """
        tree = self._started().graph.params
        found = tree.find(name)
        if found is not tree.MISSING:
            return found
        if default is not self.MISSING:
            return default
        raise AbsentError(f"unknown parameter {name}; {near(name, tree.names())}")

    def set_param(self, name: str, value: Any) -> None:
        """Set a parameter.

        Raises:
            AbsentError: if no node has started.
        """
        self._started()
        self._act(PARAM, name, value)

    def call(self, name: str, request: Any, fields: Mapping[str, Any]) -> HostCall:
        """Start a service call; the mission must run for the response to arrive.

        Args:
            name: name of the service; a leading `/` may be missing.
            request: a message of the request's type; None for a message made of `fields`.
            fields: values by name.

        Raises:
            AbsentError: if no node offers it.
            UsageError: if the request is not a message, or there is no such field or value.
        """
        graph = self._started().graph
        full = _full(name)
        if full not in graph.services:
            raise AbsentError(f"unknown service {full}; {near(full, sorted(graph.services))}")
        if request is None:
            node, service_class = graph.caller(full)
            request = filled(node.library, service_class._request_class._type, fields)
        call: HostCall = self._act(CALL, full, _serialized(request))
        return call

    def _started(self) -> RosRuntime:
        ros: RosRuntime | None = self._mission.ros
        if ros is None:
            raise AbsentError("no ROS node has started yet; let the mission run first")
        return ros

    def _topic(self, name: str) -> Topic:
        self._started()
        known = {topic.name: topic for topic in topics_of(self._mission)}
        full = _full(name)
        if full not in known:
            raise AbsentError(f"unknown topic {full} (so far); {near(full, known)}")
        return known[full]


def near(name: str, known: Iterable[str]) -> str:
    """Return a hint for an unknown name: similar names, or all."""
    names = list(known)
    return did_you_mean(name, names, f"there are {listed(names, 'and')}", most=LIKE_IT)


def filled(library: Library, kind: str, fields: Mapping[str, Any]) -> Any:
    """Return a message with fields from plain values; dictionaries are nested messages.

    Args:
        library: has the type.
        kind: the type.
        fields: values by name.

    Raises:
        UsageError: if there is no such field, or a value does not fit.
    """
    from rospy_shim.types.genpy.arguments import ArgumentFiller

    message = library.message_class(kind)()
    unknown = [unknown_field(kind, message.__slots__, name) for name in fields if name not in message.__slots__]
    if unknown:
        raise together(unknown)
    try:
        ArgumentFiller(library.message_class).fill_message_args(message, [dict(fields)])
    except Exception as error:  # any error of genpy for values that do not fit
        raise UsageError(f"invalid {kind}: {error}") from None
    return message


def _full(name: str) -> str:
    return name if name.startswith("/") else f"/{name}"


def _payload(topic: Topic, message: Any, fields: Mapping[str, Any]) -> bytes:
    """Return a message for a topic in ROS serialization; see `RosSide.publish` for the errors."""
    if message is None:
        if not topic.type:
            raise UsageError(f"the type of {topic.name} is unknown; give a message object")
        message = filled(library_of(topic), topic.type, fields)
    elif topic.type and getattr(message, "_type", None) != topic.type:
        kind = getattr(message, "_type", type(message).__name__)
        raise UsageError(f"{topic.name} has type {topic.type}, not {kind}")
    return _serialized(message)


def _serialized(message: Any) -> bytes:
    """Return the bytes of a message of any implementation; raises UsageError if it is not a message."""
    if not hasattr(message, "serialize"):
        raise UsageError(f"not a ROS message: {message!r}; give a message, or its fields by name")
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()
