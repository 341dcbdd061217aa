"""The exceptions that nodes import from rclpy's C++ part."""

from __future__ import annotations


class RCLError(RuntimeError):
    """An error of rcl."""


class InvalidHandle(RuntimeError):
    """An entity was used after its end."""


class NodeNameNonExistentError(RCLError):
    """There is no node with a name."""


class UnknownROSArgsError(RuntimeError):
    """A command line has unknown arguments of ROS."""


class UnsupportedEventTypeError(RCLError):
    """The middleware does not support an event."""
