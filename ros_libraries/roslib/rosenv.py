"""roslib.rosenv: older names of rospkg.environment and rosgraph.rosenv."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping, Sequence

import rosgraph.rosenv
import rospkg.environment
from rosgraph.rosenv import ROS_HOSTNAME, ROS_IP, ROS_MASTER_URI, ROS_NAMESPACE
from rosgraph.roslogging import makedirs_with_parent_perms
from rospkg.environment import (
    ROS_HOME,
    ROS_LOG_DIR,
    ROS_PACKAGE_PATH,
    ROS_ROOT,
    get_log_dir,
    get_ros_home,
    get_test_results_dir,
)

__all__ = [
    "ROS_BINDEPS_PATH",
    "ROS_BOOST_ROOT",
    "ROS_HOME",
    "ROS_HOSTNAME",
    "ROS_IP",
    "ROS_LOG_DIR",
    "ROS_MASTER_URI",
    "ROS_NAMESPACE",
    "ROS_PACKAGE_PATH",
    "ROS_ROOT",
    "ROSEnvException",
    "get_log_dir",
    "get_master_uri",
    "get_ros_home",
    "get_ros_package_path",
    "get_ros_root",
    "get_test_results_dir",
    "makedirs_with_parent_perms",
]

ROS_BINDEPS_PATH, ROS_BOOST_ROOT = "ROS_BINDEPS_PATH", "ROS_BOOST_ROOT"


class ROSEnvException(Exception):
    """An environment variable is missing or wrong."""


def get_ros_root(required: bool = True, env: Mapping[str, str] | None = None) -> str | None:
    """ROS_ROOT.

    Raises:
        ROSEnvException: it is required and not set.
    """
    return _required(rospkg.environment.get_ros_root(env), ROS_ROOT, required)


def get_ros_package_path(required: bool = False, env: Mapping[str, str] | None = None) -> str | None:
    """ROS_PACKAGE_PATH.

    Raises:
        ROSEnvException: it is required and not set.
    """
    return _required(rospkg.environment.get_ros_package_path(env), ROS_PACKAGE_PATH, required)


def get_master_uri(
    required: bool = True, env: Mapping[str, str] | None = None, argv: Sequence[str] | None = None
) -> str | None:
    """Return the master's URI from the environment or an argument `__master:=`.

    Raises:
        ROSEnvException: it is required but missing, or the argument is wrong.
    """
    words = sys.argv if argv is None else argv
    said = ROS_MASTER_URI in (os.environ if env is None else env) or any(
        word.startswith("__master:=") for word in words
    )
    try:
        uri = rosgraph.rosenv.get_master_uri(env, argv) if said else None
    except ValueError as error:
        raise ROSEnvException(str(error)) from None
    return _required(uri, ROS_MASTER_URI, required)


def _required(value: str | None, name: str, required: bool) -> str | None:
    if required and not value:
        raise ROSEnvException(f"The {name} environment variable has not been set.\nPlease set it to use ROS.")
    return value
