"""roslib.stacks: older names of rospkg.RosStack."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import rospkg
from rospkg import STACK_FILE
from rospkg.common import ROS_STACK
from rospkg.environment import ROS_PACKAGE_PATH, ROS_ROOT

__all__ = [
    "ROS_PACKAGE_PATH",
    "ROS_ROOT",
    "ROS_STACK",
    "STACK_FILE",
    "InvalidROSStackException",
    "ROSStackException",
    "expand_to_packages",
    "get_stack_dir",
    "get_stack_version",
    "get_stack_version_by_dir",
    "list_stacks",
    "list_stacks_by_path",
    "stack_of",
]

Env = Mapping[str, str] | None
"""An environment; os.environ for None."""

get_stack_version_by_dir = rospkg.get_stack_version_by_dir


class ROSStackException(Exception):
    """Base of the errors of stacks."""


class InvalidROSStackException(ROSStackException):
    """There is no such stack."""


def _stacks(env: Env) -> rospkg.RosStack:
    return rospkg.RosStack(rospkg.get_ros_paths(env))


def stack_of(pkg: str, env: Env = None) -> str | None:
    """Return the name of the stack that contains a package, or None.

    Raises:
        rospkg.ResourceNotFound: there is no such package.
    """
    return rospkg.RosPack().stack_of(pkg)


def get_stack_dir(stack: str, env: Env = None) -> str:
    """Return the folder of a stack.

    Raises:
        InvalidROSStackException: there is no such stack.
    """
    try:
        return _stacks(env).get_path(stack)
    except rospkg.ResourceNotFound:
        raise InvalidROSStackException(stack) from None


def list_stacks(env: Env = None) -> list[str]:
    """Return the names of all stacks."""
    return _stacks(env).list()


def list_stacks_by_path(path: str, stacks: list[str] | None = None, cache: dict[str, str] | None = None) -> list[str]:
    """Return the names of the stacks in a folder at any depth.

    Args:
        path: the folder.
        stacks: takes the names as well.
        cache: takes the folders.
    """
    found = [] if stacks is None else stacks
    found.extend(each for each in rospkg.list_by_path(STACK_FILE, path, cache) if each not in found)
    return found


def get_stack_version(stack: str, env: Env = None) -> str | None:
    """Return the version of a stack, or None.

    Raises:
        rospkg.ResourceNotFound: there is no such stack.
    """
    return _stacks(env).get_stack_version(stack)


def expand_to_packages(names: Sequence[str], env: Env = None) -> tuple[list[str], list[str]]:
    """Return packages of a list of packages and stacks, and the names that are neither."""
    return rospkg.expand_to_packages(names, rospkg.RosPack(), _stacks(env))
