"""What a test does to a mission that ROS and cFE nodes take part in: messages on topics, parameters, service calls.

Mistakes are found here; `cfepy.mission.host_acts` then does it, at the instant at which the run stands. rospy_shim is
loaded by name.
"""

from __future__ import annotations

import importlib
import io
from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from typing import Any

from cfepy.mission.host_acts import CALL, PARAM, PUBLISH, Call
from cfepy.mission.mission import Mission
from cfepy.mission.script_conditions import seconds
from cfepy.mission.topics import Topic, library_of, topics_of
from cfepy.status import UsageError
from cfepy.testing.errors import ExpectationError

__tracebackhide__ = True  # pytest shows the line of the test

MISSING = object()
LIKE_IT = 3  # names that are told in place of one that there is not


class RosSide:
    """The ROS side of a mission, for its test.

    Args:
        mission: the mission, also after it was reset.
    """

    def __init__(self, mission: Mission) -> None:
        self._mission = mission

    @property
    def _ros(self) -> Any:
        ros = self._mission.ros
        if ros is None:
            raise ExpectationError(
                "no ROS node has started yet: run the mission first, as with run_until_operational()"
            )
        return ros

    # -- topics --------------------------------------------------------------------------------------------------------

    def publish(self, name: str, message: Any, fields: Mapping[str, Any]) -> None:
        """Put a message on a topic; see `Flight.publish`."""
        topic = self._topic(name)
        route = self._mission.cfe.sb.routes.get(topic.msg_id)
        if route is None or not route.active:
            raise ExpectationError(f"nobody subscribes to {topic.name} at {seconds(self._mission.kernel.now)} s")
        self._mission.outside.act(PUBLISH, topic.name, self._payload(topic, message, fields))

    def _topic(self, name: str) -> Topic:
        known = {} if self._ros is None else {topic.name: topic for topic in topics_of(self._mission)}
        full = name if name.startswith("/") else f"/{name}"
        if full not in known:
            raise ExpectationError(f"there is no topic {full} yet; {near(full, known)}")
        return known[full]

    def _payload(self, topic: Topic, message: Any, fields: Mapping[str, Any]) -> bytes:
        """The message as ROS serialises it.

        Raises:
            UsageError: it is of another type, or has no such field or value.
        """
        if message is None:
            if not topic.type:
                raise UsageError(f"the type of {topic.name} is not known; give a message")
            message = filled(library_of(topic), topic.type, fields)
        elif topic.type and getattr(message, "_type", None) != topic.type:
            kind = getattr(message, "_type", type(message).__name__)
            raise UsageError(f"{topic.name} carries {topic.type}, and this is a {kind}")
        return serialized(message)

    # -- parameters ----------------------------------------------------------------------------------------------------

    def param(self, name: str, default: Any) -> Any:
        """A parameter's value now; see `Flight.param`."""
        tree = self._ros.graph.params
        found = tree.find(name)
        if found is not tree.MISSING:
            return found
        if default is not MISSING:
            return default
        raise ExpectationError(f"there is no parameter {name}; {near(name, tree.names())}")

    def set_param(self, name: str, value: Any) -> None:
        """Set a parameter; see `Flight.set_param`."""
        if self._ros is not None:
            self._mission.outside.act(PARAM, name, value)

    # -- services ------------------------------------------------------------------------------------------------------

    def call(self, name: str, request: Any, fields: Mapping[str, Any]) -> Call:
        """Begin to call a service; the mission has to run for the answer to come."""
        services = self._ros.graph.services
        full = name if name.startswith("/") else f"/{name}"
        if full not in services:
            raise ExpectationError(f"nobody offers the service {full}; {near(full, sorted(services))}")
        service = services[full].service
        if request is None:
            request = filled(service.node.library, service.request_class._type, fields)
        call: Call = self._mission.outside.act(CALL, full, serialized(request))
        return call


def near(name: str, known: Iterable[str]) -> str:
    """What there is instead of a name: those that are like it, or all."""
    names = list(known)
    found = get_close_matches(name, names, LIKE_IT)
    return f"is {' or '.join(found)} meant?" if found else f"there are {', '.join(names) or 'none'}"


def filled(library: Any, kind: str, fields: Mapping[str, Any]) -> Any:
    """A message with fields from plain values; dictionaries stand for nested messages.

    Args:
        library: knows the type.
        kind: the type.
        fields: values by name.

    Raises:
        UsageError: there is no such field, or a value does not fit.
    """
    message = library.message_class(kind)()
    filler = importlib.import_module("rospy_shim.genpy.arguments").ArgumentFiller(library.message_class)
    try:
        filler.fill_message_args(message, [dict(fields)])
    except Exception as error:  # whatever genpy raises for values that do not fit
        raise UsageError(f"no {kind}: {error}") from None
    return message


def serialized(message: Any) -> bytes:
    """The bytes of a message of whatever make.

    Raises:
        UsageError: it is no message.
    """
    if not hasattr(message, "serialize"):
        raise UsageError(f"{message!r} is no ROS message; give one, or its fields by name")
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()
