"""rosgraph.rosenv: environment variables of the ROS graph (wiki.ros.org/ROS/EnvironmentVariables)."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping, Sequence

ROS_MASTER_URI = "ROS_MASTER_URI"
ROS_IP = "ROS_IP"
ROS_IPV6 = "ROS_IPV6"
ROS_HOSTNAME = "ROS_HOSTNAME"
ROS_NAMESPACE = "ROS_NAMESPACE"

DEFAULT_MASTER_PORT = 11311
DEFAULT_MASTER_URI = f"http://localhost:{DEFAULT_MASTER_PORT}/"

_ON_COMMAND_LINE = "__master:="


def get_master_uri(env: Mapping[str, str] | None = None, argv: Sequence[str] | None = None) -> str:
    """Return where the master answers: `__master:=` on the command line, or ROS_MASTER_URI, or the default.

    Args:
        env: os.environ by default.
        argv: sys.argv by default.

    Raises:
        ValueError: `__master:=` without a URI.
    """
    for argument in sys.argv if argv is None else argv:
        if argument.startswith(_ON_COMMAND_LINE):
            given = argument.removeprefix(_ON_COMMAND_LINE)
            if not given or ":=" in given:
                raise ValueError(f"__master remapping argument '{argument}' improperly specified")
            return given
    return (os.environ if env is None else env).get(ROS_MASTER_URI, DEFAULT_MASTER_URI)
