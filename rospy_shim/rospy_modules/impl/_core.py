"""The parts of rospy.core beside a node's life and log: addresses, the environment, rospy's own loggers."""

from __future__ import annotations

import functools
import logging
import os
import warnings
import xmlrpc.client
from collections.abc import Callable, Mapping
from typing import Any
from urllib.parse import urlparse

import rospy
from rospy.impl.validators import ParameterInvalid

ROSRPC = "rosrpc://"
NullHandler = logging.NullHandler

_proxies: dict[str, Any] = {}
_logger = logging.getLogger("rospy.internal")


def rospydebug(msg: Any, *args: Any, **kwargs: Any) -> None:
    """Log for developers of rospy itself, to the logger rospy.internal."""
    _logger.debug(msg, *args, **kwargs)


def rospyinfo(msg: Any, *args: Any, **kwargs: Any) -> None:
    """Log as `rospydebug` does, as information."""
    _logger.info(msg, *args, **kwargs)


def rospywarn(msg: Any, *args: Any, **kwargs: Any) -> None:
    """Log as `rospydebug` does, as a warning."""
    _logger.warning(msg, *args, **kwargs)


def rospyerr(msg: Any, *args: Any, **kwargs: Any) -> None:
    """Log as `rospydebug` does, as an error."""
    _logger.error(msg, *args, **kwargs)


def deprecated(func: Callable[..., Any]) -> Callable[..., Any]:
    """Decorate a function so that it warns when it is called."""

    @functools.wraps(func)
    def wrapper(*args: Any, **kwargs: Any) -> Any:
        warnings.warn(f"Call to deprecated function {func.__name__}.", DeprecationWarning, stacklevel=2)
        return func(*args, **kwargs)

    return wrapper


@deprecated
def get_ros_root(required: bool = False, env: Mapping[str, str] | None = None) -> str | None:
    """Return the value of ROS_ROOT.

    Args:
        required: True if the variable must be set.
        env: the environment; None is os.environ.

    Raises:
        ROSException: it is required and not set.
    """
    root = (os.environ if env is None else env).get("ROS_ROOT")
    if required and not root:
        raise rospy.ROSException("ROS_ROOT is not set")
    return root


def parse_rosrpc_uri(uri: str) -> tuple[str, int]:
    """Return the host and port in a service's URI.

    Raises:
        ParameterInvalid: it is not such a URI.
    """
    if not uri.startswith(ROSRPC):
        raise ParameterInvalid(f"Invalid protocol for ROS service URL: {uri}")
    host, colon, port = uri[len(ROSRPC) :].partition("/")[0].partition(":")
    if not colon or not port.isdecimal():
        raise ParameterInvalid(f"ROS service URL is invalid: {uri}")
    return host, int(port)


def xmlrpcapi(uri: str | None, cache: bool = True) -> Any:
    """Return a proxy for the XML-RPC server at a URI; None if the URI is None or invalid.

    Args:
        uri: the server's URI.
        cache: True returns the same proxy in later calls.
    """
    if uri is None or not all(urlparse(uri)[:2]):
        return None
    if not cache:
        return xmlrpc.client.ServerProxy(uri)
    return _proxies.get(uri) or _proxies.setdefault(uri, xmlrpc.client.ServerProxy(uri))
