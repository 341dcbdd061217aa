"""`BufferInterface`, and the registries of functions that transform and convert messages (tf2_ros.buffer_interface)."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from typing import Any, ClassVar

from rclpy.duration import Duration
from std_msgs.msg import Header


class TypeException(Exception):
    """There is no function for a type."""

    def __init__(self, errstr: str) -> None:
        self.errstr = errstr


class NotImplementedException(Exception):
    """A subclass lacks a method."""

    def __init__(self) -> None:
        self.errstr = "CanTransform or LookupTransform not implemented"


class BufferInterface:
    """Base of the buffers."""

    def __init__(self) -> None:
        self.registration = TransformRegistration()

    def transform(
        self, object_stamped: Any, target_frame: str, timeout: Duration | None = None, new_type: Any = None
    ) -> Any:
        """Transform a message.

        Args:
            object_stamped: a message with a header, of a type that a loaded package transforms.
            target_frame: the frame of the result.
            timeout: longest time to wait; None does not wait.
            new_type: type of the result; None keeps the message's.

        Raises:
            TypeException: no loaded package transforms the type.
            tf2_py.TransformException: the transform is not available.
        """
        function = self.registration.get(type(object_stamped))
        header = object_stamped.header
        found = self.lookup_transform(target_frame, header.frame_id, header.stamp, timeout or Duration())
        result = function(object_stamped, found)
        return result if new_type is None else convert(result, new_type)

    def transform_full(
        self,
        object_stamped: Any,
        target_frame: str,
        target_time: Any,
        fixed_frame: str,
        timeout: Duration | None = None,
        new_type: Any = None,
    ) -> Any:
        """Transform a message to another time; see `transform`.

        Args:
            object_stamped: the message.
            target_frame: the frame of the result.
            target_time: the time of the result.
            fixed_frame: the frame that does not move in between.
            timeout: longest time to wait; None does not wait.
            new_type: type of the result; None keeps the message's.
        """
        function = self.registration.get(type(object_stamped))
        header = object_stamped.header
        found = self.lookup_transform_full(
            target_frame, target_time, header.frame_id, header.stamp, fixed_frame, timeout or Duration()
        )
        result = function(object_stamped, found)
        return result if new_type is None else convert(result, new_type)

    def lookup_transform(self, *args: Any, **options: Any) -> Any:
        """Refuse: a subclass implements it."""
        raise NotImplementedException

    lookup_transform_full = can_transform = can_transform_full = lookup_transform


def Stamped(obj: Any, stamp: Any, frame_id: str) -> Any:
    """Return an object with a header."""
    obj.header = Header(frame_id=frame_id, stamp=stamp)
    return obj


def _of(table: dict[Any, Callable[..., Any]], key: Any) -> Callable[..., Any]:
    if key not in table:
        raise TypeException(f"Type {key} is not loaded or supported")
    return table[key]


class TransformRegistration:
    """The functions that transform messages, by type."""

    _functions: ClassVar[dict[Any, Callable[..., Any]]] = {}

    def add(self, key: Any, callback: Callable[[Any, Any], Any]) -> None:
        """Add the function for a type."""
        self._functions[key] = callback

    def get(self, key: Any) -> Callable[[Any, Any], Any]:
        """Return the function for a type. Raises TypeException if there is none."""
        return _of(self._functions, key)


class ConvertRegistration:
    """The functions that convert objects to messages, from messages, and to each other."""

    _to_msg: ClassVar[dict[Any, Callable[..., Any]]] = {}
    _from_msg: ClassVar[dict[Any, Callable[..., Any]]] = {}
    _convert: ClassVar[dict[Any, Callable[..., Any]]] = {}

    def add_from_msg(self, key: Any, callback: Callable[[Any], Any]) -> None:
        """Add a function that makes an object of a type from a message."""
        self._from_msg[key] = callback

    def add_to_msg(self, key: Any, callback: Callable[[Any], Any]) -> None:
        """Add a function that makes a message from an object of a type."""
        self._to_msg[key] = callback

    def add_convert(self, key: Any, callback: Callable[[Any], Any]) -> None:
        """Add a function that converts between two types."""
        self._convert[key] = callback

    def get_from_msg(self, key: Any) -> Callable[[Any], Any]:
        """Return the function from a message. Raises TypeException if there is none."""
        return _of(self._from_msg, key)

    def get_to_msg(self, key: Any) -> Callable[[Any], Any]:
        """Return the function to a message. Raises TypeException if there is none."""
        return _of(self._to_msg, key)

    def get_convert(self, key: Any) -> Callable[[Any], Any]:
        """Return the function between two types. Raises TypeException if there is none."""
        return _of(self._convert, key)


def convert(a: Any, b_type: Any) -> Any:
    """Return an object converted to a type.

    Raises:
        TypeException: no loaded package converts it.
    """
    known = ConvertRegistration()
    try:
        return known.get_convert((type(a), b_type))(a)
    except TypeException:
        if type(a) is b_type:
            return deepcopy(a)
        return known.get_from_msg(b_type)(known.get_to_msg(type(a))(a))
