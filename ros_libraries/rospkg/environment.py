"""rospkg.environment: folders that environment variables name (wiki.ros.org/ROS/EnvironmentVariables)."""

from __future__ import annotations

import os
from collections.abc import Mapping

ROS_ROOT = "ROS_ROOT"
ROS_PACKAGE_PATH = "ROS_PACKAGE_PATH"
ROS_HOME = "ROS_HOME"
ROS_ETC_DIR = "ROS_ETC_DIR"
ROS_LOG_DIR = "ROS_LOG_DIR"
ROS_TEST_RESULTS_DIR = "ROS_TEST_RESULTS_DIR"

Env = Mapping[str, str] | None
"""An environment; os.environ for None."""


def _environment(env: Env) -> Mapping[str, str]:
    return os.environ if env is None else env


def get_ros_root(env: Env = None) -> str | None:
    """ROS_ROOT, or None."""
    root = _environment(env).get(ROS_ROOT)
    return os.path.normpath(root) if root else root


def get_ros_package_path(env: Env = None) -> str | None:
    """ROS_PACKAGE_PATH, or None."""
    return _environment(env).get(ROS_PACKAGE_PATH)


def get_ros_paths(env: Env = None) -> list[str]:
    """Return the folders to search for packages; the first match counts."""
    path = get_ros_package_path(env) or ""
    return [each for each in (get_ros_root(env), *path.split(os.pathsep)) if each and each.strip()]


def on_ros_path(p: str, env: Env = None) -> bool:
    """Return whether a folder is one of the searched folders, or below one."""
    place = os.path.realpath(os.path.expanduser(p))
    roots = (os.path.realpath(os.path.expanduser(path)) for path in get_ros_paths(env))
    return any(place == root or place.startswith(root + os.sep) for root in roots)


def get_ros_home(env: Env = None) -> str:
    """Return the folder of a user's ROS data."""
    return _environment(env).get(ROS_HOME) or os.path.join(os.path.expanduser("~"), ".ros")


def get_log_dir(env: Env = None) -> str:
    """Return the folder of log files."""
    return _environment(env).get(ROS_LOG_DIR) or os.path.join(get_ros_home(env), "log")


def get_test_results_dir(env: Env = None) -> str:
    """Return the folder of test results."""
    return _environment(env).get(ROS_TEST_RESULTS_DIR) or os.path.join(get_ros_home(env), "test_results")


def get_etc_ros_dir(env: Env = None) -> str:
    """Return the folder of ROS's settings."""
    return _environment(env).get(ROS_ETC_DIR, "/etc/ros")
