"""Transforms stamped data of any type that is registered here (tf2_ros.buffer_interface).

Imports rospy and std_msgs.
"""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from typing import Any, ClassVar

import rospy
from std_msgs.msg import Header

_NO_WAIT = rospy.Duration(0.0)


class TypeException(Exception):
    """No function is registered to transform or convert a type."""

    def __init__(self, errstr: str) -> None:
        self.errstr = errstr


class NotImplementedException(Exception):
    """A subclass of `BufferInterface` lacks a method."""

    def __init__(self) -> None:
        self.errstr = "CanTransform or LookupTransform is not implemented"


class TransformRegistration:
    """Transform functions of (data, geometry_msgs/TransformStamped), one for each type; one table for all."""

    _transforms: ClassVar[dict[type, Callable[[Any, Any], Any]]] = {}

    def print_me(self) -> None:
        """Print the table."""
        print(self._transforms)

    def add(self, key: type, callback: Callable[[Any, Any], Any]) -> None:
        """Register a type."""
        self._transforms[key] = callback

    def get(self, key: type) -> Callable[[Any, Any], Any]:
        """Return the function for a type.

        Raises:
            TypeException: no function is registered.
        """
        return _registered(self._transforms, key)


class ConvertRegistration:
    """Conversion functions: to a message, from a message, or from one type directly to another; tables for all."""

    _to_msg: ClassVar[dict[Any, Callable[[Any], Any]]] = {}
    _from_msg: ClassVar[dict[Any, Callable[[Any], Any]]] = {}
    _convert: ClassVar[dict[Any, Callable[[Any], Any]]] = {}

    def add_from_msg(self, key: type, callback: Callable[[Any], Any]) -> None:
        """Register how a type is made of a message."""
        self._from_msg[key] = callback

    def add_to_msg(self, key: type, callback: Callable[[Any], Any]) -> None:
        """Register how a message is made of a type."""
        self._to_msg[key] = callback

    def add_convert(self, key: tuple[type, type], callback: Callable[[Any], Any]) -> None:
        """Register a straight way from the first type to the second."""
        self._convert[key] = callback

    def get_from_msg(self, key: type) -> Callable[[Any], Any]:
        """Return the function that makes a type from a message. Raises TypeException if there is none."""
        return _registered(self._from_msg, key)

    def get_to_msg(self, key: type) -> Callable[[Any], Any]:
        """Return the function that makes a message from a type. Raises TypeException if there is none."""
        return _registered(self._to_msg, key)

    def get_convert(self, key: tuple[type, type]) -> Callable[[Any], Any]:
        """Return the direct conversion from one type to another. Raises TypeException if there is none."""
        return _registered(self._convert, key)


def _registered(table: dict[Any, Callable[..., Any]], key: Any) -> Callable[..., Any]:
    if key not in table:
        raise TypeException(f"Type {key} if not loaded or supported")  # the wording is tf2's
    return table[key]


def convert(a: Any, b_type: type) -> Any:
    """Convert data to another type: directly if possible, as a copy if it is that type, or through a message.

    Args:
        a: the data.
        b_type: the target type.

    Raises:
        TypeException: there is no conversion.
    """
    registration = ConvertRegistration()
    try:
        straight = registration.get_convert((type(a), b_type))
    except TypeException:
        if type(a) is b_type:
            return deepcopy(a)
        to_msg = registration.get_to_msg(type(a))
        return registration.get_from_msg(b_type)(to_msg(a))
    return straight(a)


def Stamped(obj: Any, stamp: Any, frame_id: str) -> Any:
    """Give an object a header, so that it can be transformed.

    Args:
        obj: any object that takes attributes.
        stamp: a rospy.Time.
        frame_id: the frame that its coordinates are in.
    """
    obj.header = Header(frame_id=frame_id, stamp=stamp)
    return obj


class BufferInterface:
    """Base class of all sources of transforms. A subclass looks them up."""

    def __init__(self) -> None:
        self.registration = TransformRegistration()

    def transform(self, object_stamped: Any, target_frame: str, timeout: Any = _NO_WAIT, new_type: Any = None) -> Any:
        """Return stamped data as seen from another frame.

        Args:
            object_stamped: has a header, and its type is registered.
            target_frame: name of a frame.
            timeout: how long to wait for the transform, a rospy.Duration.
            new_type: type to convert the result to; None leaves it.

        Raises:
            TypeException: the type is not registered.
            TransformException: the transform is not available.
        """
        apply = self.registration.get(type(object_stamped))
        header = object_stamped.header
        found = apply(object_stamped, self.lookup_transform(target_frame, header.frame_id, header.stamp, timeout))
        return convert(found, new_type) if new_type else found

    def transform_full(
        self,
        object_stamped: Any,
        target_frame: str,
        target_time: Any,
        fixed_frame: str,
        timeout: Any = _NO_WAIT,
        new_type: Any = None,
    ) -> Any:
        """Return stamped data as seen from another frame at another time.

        Args:
            object_stamped: has a header, and its type is registered.
            target_frame: name of a frame.
            target_time: a rospy.Time.
            fixed_frame: the frame that does not move in between.
            timeout: how long to wait for the transform, a rospy.Duration.
            new_type: type to convert the result to; None leaves it.

        Raises:
            TypeException: the type is not registered.
            TransformException: the transform is not available.
        """
        apply = self.registration.get(type(object_stamped))
        source = object_stamped.header
        between = self.lookup_transform_full(
            target_frame, target_time, source.frame_id, source.stamp, fixed_frame, timeout
        )
        found = apply(object_stamped, between)
        return convert(found, new_type) if new_type else found

    def lookup_transform(self, target_frame: str, source_frame: str, time: Any, timeout: Any = _NO_WAIT) -> Any:
        """Return the transform between two frames. A subclass implements it."""
        raise NotImplementedException

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Any = _NO_WAIT,
    ) -> Any:
        """Return the transform between two frames at different times. A subclass implements it."""
        raise NotImplementedException

    def can_transform(self, target_frame: str, source_frame: str, time: Any, timeout: Any = _NO_WAIT) -> Any:
        """Return whether `lookup_transform` would succeed. A subclass implements it."""
        raise NotImplementedException

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Any = _NO_WAIT,
    ) -> Any:
        """Return whether `lookup_transform_full` would succeed. A subclass implements it."""
        raise NotImplementedException
