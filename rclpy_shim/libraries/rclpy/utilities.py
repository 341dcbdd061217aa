"""Small functions of rclpy (rclpy.utilities)."""

from __future__ import annotations

import sys

from rclpy.context import Context
from rclpy.context import get_default_context as _get_default_context

S_TO_NS = 1_000_000_000


def get_default_context(*, shutting_down: bool = False) -> Context:
    """Return the default context."""
    return _get_default_context()


def ok(*, context: Context | None = None) -> bool:
    """Return True if a context is initialized and not shut down; None is the default one."""
    return (context or get_default_context()).ok()


def shutdown(*, context: Context | None = None) -> None:
    """Shut a context down; None is the default one.

    Raises:
        RuntimeError: it is not initialized, or is shut down.
    """
    (context or get_default_context()).shutdown()


def try_shutdown(*, context: Context | None = None) -> None:
    """Shut a context down if it is not yet; None is the default one."""
    (context or get_default_context()).try_shutdown()


def remove_ros_args(args: list[str] | None = None) -> list[str]:
    """Return a command line without the arguments of ROS.

    Args:
        args: the command line; None takes sys.argv.
    """
    found: list[str] = []
    is_ros = False
    for word in sys.argv if args is None else args:
        if word == "--ros-args":
            is_ros = True
        elif word == "--" and is_ros:
            is_ros = False
        elif not is_ros:
            found.append(word)
    return found


def get_rmw_implementation_identifier() -> str:
    """Return the name of the middleware; messages pass over cFE's Software Bus."""
    return "rmw_cfe_sb"


def timeout_sec_to_nsec(timeout_sec: float | None) -> int:
    """Return a time in ns; -1 for None and negative times, which stand for no limit."""
    return -1 if timeout_sec is None or timeout_sec < 0 else int(float(timeout_sec) * S_TO_NS)
