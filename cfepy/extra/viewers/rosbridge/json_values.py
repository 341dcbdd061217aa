"""Messages as rosbridge writes them in JSON, and back (RobotWebTools/rosbridge_suite, ROSBRIDGE_PROTOCOL.md 2 and 3.4).

A message is an object of its fields. Times are {"secs", "nsecs"}, uint8[] and char[] are base64. Numbers that JSON
lacks, NaN and the infinities, are null. Input is checked against the type of each field, and errors have rosbridge's
texts.
"""

from __future__ import annotations

import math
from base64 import b64decode, b64encode
from binascii import Error as NoBase64
from collections.abc import Callable
from functools import lru_cache
from typing import Any

from cfepy.status import UsageError
from rospy_shim.types.genpy import Duration, Message, Time
from rospy_shim.types.msgs import MessageClass

Convert = Callable[[Any], Any]
ClassOf = Callable[[str], MessageClass]
OCTETS = ("uint8", "char")
FLOATS = ("float32", "float64")
TIMES = ("time", "duration")
INTEGERS = ("int8", "byte", "uint8", "char", "int16", "uint16", "int32", "uint32", "int64", "uint64")
PRIMITIVES = frozenset({"bool", "string", *INTEGERS, *FLOATS})
HEADERS = ("Header", "std_msgs/Header", "roslib/Header")
NOW = "now"
_FITTING: dict[type, frozenset[str]] = {
    bool: frozenset({"bool"}),
    int: frozenset({*INTEGERS, *FLOATS}),
    float: frozenset(FLOATS),
    str: frozenset({"string"}),
}
"""Types of fields for a type of a Python value."""


class WrongMessage(UsageError):
    """A client has sent values that are not a message of the type."""


# -- out ---------------------------------------------------------------------------------------------------------------


def json_values(message: Message) -> dict[str, Any]:
    """Convert a message to an object of JSON."""
    return {
        name: getattr(message, name) if convert is None else convert(getattr(message, name))
        for name, convert in _fields(message)
    }


def _fields(message: Message) -> list[tuple[str, Convert | None]]:
    """Return the names of a message's fields, and converters of their values; None for values that stay unchanged."""
    return [(name, _converter(field)) for name, field in zip(message.__slots__, message._slot_types, strict=True)]


@lru_cache(maxsize=1000)
def _converter(field: str) -> Convert | None:
    base, bracket, _ = field.partition("[")
    if not bracket:
        return _single(base)
    if base in OCTETS:
        return _base64
    if base in PRIMITIVES and base not in FLOATS:
        return list
    each = _single(base)
    assert each is not None
    return lambda values: [each(value) for value in values]


def _single(base: str) -> Convert | None:
    if base in FLOATS:
        return _float
    if base in TIMES:
        return _time
    return None if base in PRIMITIVES else json_values


def _float(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _time(value: Any) -> dict[str, int]:
    return {"secs": value.secs, "nsecs": value.nsecs}


def _base64(value: Any) -> str:
    return b64encode(bytes(value)).decode("ascii")


# -- in ----------------------------------------------------------------------------------------------------------------


class Reading:
    """Makes messages from the values of a client.

    Args:
        class_of: returns the class of a nested type.
        now: returns the mission's ROS time, (s, ns).
    """

    def __init__(self, class_of: ClassOf, now: Callable[[], tuple[int, int]]) -> None:
        self._class_of = class_of
        self._now = now

    def message(self, values: Any, kind: MessageClass) -> Message:
        """Make a message from values.

        Args:
            values: an object; missing fields have their defaults.
            kind: class of the message.

        Raises:
            WrongMessage: a field is unknown, or has a value that its type cannot carry.
        """
        message = kind()
        self._fill(values, message, kind._type, [])
        return message

    def serialized(self, values: Any, kind: MessageClass, seq: int | None = None) -> bytes:
        """Serialize a message as ROS does.

        Args:
            values: as for `message`.
            kind: its class.
            seq: number of the message, which publishers put into a header; None for a message that is not published.

        Raises:
            WrongMessage: as for `message`.
        """
        message: Any = self.message(values, kind)
        if seq is not None and kind._has_header:
            message.header.seq = seq
        try:
            packed: bytes = message.__pack__()
        except Exception as error:  # generated code raises various errors for values that do not fit, OverflowError too
            raise WrongMessage(str(error)) from None
        return packed

    def _fill(self, values: Any, message: Any, root: str, stack: list[str]) -> None:
        kind = type(message)
        if type(values) is not dict:
            raise _mismatch(root, stack, kind._type, values)
        if kind._type in HEADERS:
            message.stamp.secs, message.stamp.nsecs = self._now()
        types = dict(zip(kind.__slots__, kind._slot_types, strict=True))
        for name, value in values.items():
            inner = [*stack, name]
            if name not in types:
                raise WrongMessage(f"Message type {root} does not have a field {'.'.join(inner)}")
            setattr(message, name, self._value(value, types[name], root, inner, getattr(message, name)))

    def _value(self, value: Any, field: str, root: str, stack: list[str], former: Any) -> Any:
        base, bracket, _ = field.partition("[")
        if bracket:
            return self._array(value, base, field, root, stack)
        if base in TIMES:
            return self._time(value, base, former)
        if base in PRIMITIVES:
            if base not in _FITTING.get(type(value), ()):
                raise _mismatch(root, stack, base, value)
            return value
        self._fill(value, former, root, stack)
        return former

    def _array(self, value: Any, base: str, field: str, root: str, stack: list[str]) -> Any:
        if base in OCTETS and type(value) is str:
            try:
                return b64decode(value)
            except (NoBase64, ValueError):
                raise WrongMessage(f"{root} message requires base64 for field {'.'.join(stack)}") from None
        if type(value) is not list:
            raise _mismatch(root, stack, field, value)
        if base in OCTETS:
            try:
                return bytes(value)
            except (TypeError, ValueError):
                raise WrongMessage(f"{root} message requires octets for field {'.'.join(stack)}") from None
        return [self._value(each, base, root, stack, self._empty(base)) for each in value]

    def _empty(self, base: str) -> Any:
        if base in PRIMITIVES:
            return None
        return _time_class(base)() if base in TIMES else self._class_of(base)()

    def _time(self, value: Any, base: str, former: Any) -> Any:
        if base == "time" and value == NOW:
            secs, nsecs = self._now()
            return _time_class(base)(secs, nsecs)
        if isinstance(value, dict):
            for name in ("secs", "nsecs"):
                if name in value:
                    setattr(former, name, value[name])
        return former


def _time_class(base: str) -> Any:
    return Time if base == "time" else Duration


def _mismatch(root: str, stack: list[str], expected: str, value: Any) -> WrongMessage:
    if root == expected:
        return WrongMessage(f"Expected a JSON object for type {root} but received a {type(value)}")
    where = ".".join(stack)
    return WrongMessage(f"{root} message requires a {expected} for field {where}, but got a {type(value)}")
