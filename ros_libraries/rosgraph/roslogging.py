"""rosgraph.roslogging: Python's logging as ROS programs set it up; rospy itself writes log files, if any."""

from __future__ import annotations

import logging
import os
from collections.abc import Mapping

from rospy.impl.init import RosStreamHandler

__all__ = [
    "ROS_LOG_DIR",
    "LoggingException",
    "RosStreamHandler",
    "RospyLogger",
    "configure_logging",
    "makedirs_with_parent_perms",
]

ROS_LOG_DIR = "ROS_LOG_DIR"


class LoggingException(Exception):
    """Logging cannot be set up as asked for."""


class RospyLogger(logging.Logger):
    """The class of ROS's loggers."""


def configure_logging(
    logname: str, level: int = logging.INFO, filename: str | None = None, env: Mapping[str, str] | None = None
) -> str:
    """Set the level of the root logger, and print records of the logger "rosout" on the console.

    Args:
        logname: name of the program.
        level: minimum level of records.
        filename: name of the log file.
        env: environment with the folder of log files; os.environ by default.

    Returns:
        the path that the log file has on ROS; nothing is written to it.
    """
    from rospkg import get_log_dir

    logging.getLogger().setLevel(level)
    rosout = logging.getLogger("rosout")
    if not rosout.handlers:
        rosout.addHandler(RosStreamHandler())
        rosout.setLevel(level)
    return os.path.join(get_log_dir(env), filename or f"{logname or 'unknown'}-{os.getpid()}.log")


def makedirs_with_parent_perms(p: str) -> None:
    """Make a folder and those above it, with the permissions of the one that is there already."""
    p = os.path.abspath(p)
    parent = os.path.dirname(p)
    if os.path.exists(p) or parent == p:
        return
    makedirs_with_parent_perms(parent)
    os.mkdir(p)
    os.chmod(p, os.stat(parent).st_mode)
