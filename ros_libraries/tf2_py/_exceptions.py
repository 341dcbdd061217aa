"""The exceptions of transforms (tf2/exceptions.h). Imports nothing."""

from __future__ import annotations


class TransformException(Exception):
    """Base of all errors of tf2."""

    __module__ = "tf2"


class ConnectivityException(TransformException):
    """Two frames are in different trees."""

    __module__ = "tf2"


class LookupException(TransformException):
    """A frame is unknown, or the tree has a loop."""

    __module__ = "tf2"


class ExtrapolationException(TransformException):
    """The requested time is outside of the samples in the buffer."""

    __module__ = "tf2"


class InvalidArgumentException(TransformException):
    """A frame's name is empty or begins with a slash."""

    __module__ = "tf2"


class TimeoutException(TransformException):
    """A server of transforms did not answer in time."""

    __module__ = "tf2"
