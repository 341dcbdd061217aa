"""The ROS side of a running mission for a test, a script or the console: publish, set a parameter, call a service.

`RosSide` finds the user's mistakes in names, messages and fields. `cfepy.mission.host_actions` then carries out the
action.
"""

from __future__ import annotations

import io
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from cfepy.ground.topics import Topic, library_of, topics_of
from cfepy.mission import CALL, PARAM, PUBLISH, HostCall, Mission
from cfepy.reading.suggestions import did_you_mean, expected, listed
from cfepy.status import UsageError, together
from cfepy.units import NS_PER_S

if TYPE_CHECKING:
    from rospy_shim.runtime import RosRuntime
    from rospy_shim.types.msgs import Library

LIKE_IT = 3  # number of similar names to suggest
_TIMES = ("time", "duration")
_OF_TIMES = ("secs", "nsecs")
_BYTES = ("uint8", "char")  # an array of them may be given as text


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
    misfits = list(_misfits(library, message, fields, ""))
    if misfits:
        raise together(misfits)
    try:
        ArgumentFiller(library.message_class).fill_message_args(message, [dict(fields)])
    except Exception as error:  # any error of genpy for values that do not fit
        raise UsageError(f"invalid {kind}: {error}") from None
    return message


def _misfits(library: Library, message: Any, values: Mapping[str, Any], prefix: str) -> Iterator[UsageError]:
    """Yield an error for each field that does not exist, and for each value that cannot be a time, message or array."""
    for name, value in values.items():
        if name not in message.__slots__:
            yield _no_field(message._type, message.__slots__, name, prefix)
            continue
        old = getattr(message, name)
        base, bracket, _ = message._slot_types[message.__slots__.index(name)].partition("[")
        if not bracket:
            yield from _misfits_of_value(library, old, value, f"{prefix}{name}")
        elif base in _BYTES:
            continue
        elif not isinstance(value, (list, tuple)):
            yield UsageError(f"must be a list, not {value!r}", field=f"{prefix}{name}")
        elif "/" in base or base in _TIMES:
            for number, each in enumerate(value):
                yield from _misfits_of_value(library, _item(library, base), each, f"{prefix}{name}[{number}]")


def _no_field(kind: str, fields: Sequence[str], name: str, prefix: str) -> UsageError:
    hint = f"unknown field of {kind}; {expected(name, fields)}" if fields else f"{kind} has no fields"
    return UsageError(hint, field=f"{prefix}{name}")


def _item(library: Library, kind: str) -> Any:
    """Return an item of an array, with the default value."""
    from rospy_shim.types.genpy.rostime import Duration, Time

    return library.message_class(kind)() if "/" in kind else {"time": Time, "duration": Duration}[kind]()


def _misfits_of_value(library: Library, old: Any, value: Any, path: str) -> Iterator[UsageError]:
    from rospy_shim.types.genpy.rostime import TVal

    if isinstance(old, TVal):
        if isinstance(value, Mapping):
            yield from (_no_field("a time", _OF_TIMES, each, f"{path}.") for each in value if each not in _OF_TIMES)
        elif isinstance(value, bool) or not isinstance(value, (int, list)):
            yield UsageError(f"must be a time such as {_time_text(value)}, not {value!r}", field=path)
    elif hasattr(old, "_slot_types"):
        if isinstance(value, Mapping):
            yield from _misfits(library, old, value, f"{path}.")
        elif not isinstance(value, list):
            fields = ", ".join(f"{name}: ..." for name in old.__slots__)
            yield UsageError(f"must be a {old._type} such as {{{fields}}}, not {value!r}", field=path)


def _time_text(value: Any) -> str:
    """Return a time as a script has it; the value in seconds if it is a number."""
    nanoseconds = round(value * NS_PER_S) if isinstance(value, float) and math.isfinite(value) else NS_PER_S
    seconds, rest = divmod(nanoseconds, NS_PER_S)
    return f"{{secs: {seconds}, nsecs: {rest}}}" if rest else f"{{secs: {seconds}}}"


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
    try:
        message.serialize(buffer)
    except Exception as error:  # any error of genpy for values that do not fit
        raise UsageError(f"invalid {getattr(message, '_type', 'message')}: {error}") from None
    return buffer.getvalue()
