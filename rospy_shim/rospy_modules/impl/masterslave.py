"""rospy.impl.masterslave: the checks of arguments in methods of the master and slave APIs, and a node's handler."""

from __future__ import annotations

import functools
import logging
import os
import traceback
import urllib.parse as urlparse
from collections.abc import Callable, Sequence
from hashlib import md5
from typing import Any
from xmlrpc.client import ServerProxy

from rospy.core import MASTER_NAME, ROSRPC, get_node_uri
from rospy.impl._node import adopt_handler
from rospy.impl.paramserver import get_param_server_cache
from rospy.impl.validators import ParameterInvalid
from rospy.names import ANYTYPE, GLOBALNS, REMAP, SEP, SERVICE_ANYTYPE, TOPIC_ANYTYPE, get_name, global_name

__all__ = [
    "ANYTYPE",
    "GLOBALNS",
    "LOG_API",
    "MASTER_NAME",
    "MSG",
    "REMAP",
    "ROSRPC",
    "SEP",
    "SERVICE_ANYTYPE",
    "STATUS",
    "TOPIC_ANYTYPE",
    "VAL",
    "ROSHandler",
    "apivalidate",
    "is_publishers_list",
    "md5",
]

STATUS, MSG, VAL = 0, 1, 2  # indices in an answer
LOG_API = True

_logger = logging.getLogger("rospy.impl.masterslave")

Answer = tuple[int, str, Any]


def is_publishers_list(paramName: str) -> Callable[[Any, str], Any]:
    """Make a validator for lists of URIs."""

    def validator(value: Any, caller_id: str) -> Any:
        if type(value) is not list:
            raise ParameterInvalid(f"ERROR: param [{paramName}] must be a list")
        for each in value:
            if not isinstance(each, str):
                raise ParameterInvalid(f"ERROR: param [{paramName}] must be a list of strings")
            if not all(urlparse.urlparse(each)[:2]):
                raise ParameterInvalid(f"ERROR: param [{paramName}] does not contain valid URLs [{each}]")
        return value

    return validator


def apivalidate(error_return_value: Any, validators: Sequence[Any] = ()) -> Callable[[Any], Callable[..., Answer]]:
    """Make a decorator for a method of an API: its arguments are checked, and errors become answers.

    Args:
        error_return_value: the value in an answer that reports an error.
        validators: one for each argument after the caller's name; None checks nothing.
    """

    def declare(method: Any) -> Callable[..., Answer]:
        arity = method.__code__.co_argcount

        @functools.wraps(method)
        def checked(*args: Any) -> Answer:
            if len(args) == 1:
                return -1, "missing required caller_id parameter", error_return_value
            if len(args) != arity:
                return -1, "Error: bad call arity", error_return_value
            own, caller_id, *rest = args
            if not isinstance(caller_id, str):
                return -1, "caller_id must be a string", error_return_value
            try:
                pairs = zip(validators, rest, strict=False)
                values = [check(each, caller_id) if check else each for check, each in pairs]
                code, text, value = method(own, caller_id, *values)
            except ParameterInvalid as error:
                return -1, str(error) or "error", error_return_value
            except TypeError as error:
                _logger.error(traceback.format_exc())
                return -1, f"Error: invalid arguments: {error}", error_return_value
            except Exception as error:
                _logger.error(traceback.format_exc())
                return 0, f"Internal failure: {error}", error_return_value
            return code, text, value

        return checked

    return declare


class ROSHandler:
    """Answers calls at the node's URI. Programs replace `paramUpdate` in its only object to learn of changes.

    The object exists from the import of this module on. `init_node` gives it the URI.
    """

    def __init__(self, name: str, master_uri: str) -> None:
        self.masterUri = master_uri
        self.name = name
        self.protocol_handlers: list[Any] = []
        self.done = False

    @property
    def uri(self) -> str | None:
        """The URI of the node; None before `init_node`."""
        found: str | None = get_node_uri()
        return found

    def __call(self, method: str, *arguments: Any) -> Answer:
        """Call a method of the node as another program would."""
        code, text, value = getattr(ServerProxy(self.uri or ""), method)(*arguments)
        return code, text, value

    def getUri(self, caller_id: str) -> Answer:
        """Return the node's URI."""
        return self.__call("getUri", caller_id)

    def getName(self, caller_id: str) -> Answer:
        """Return the node's name."""
        return self.__call("getName", caller_id)

    def getBusStats(self, caller_id: str) -> Answer:
        """Return bytes and messages of the node's connections."""
        return self.__call("getBusStats", caller_id)

    def getBusInfo(self, caller_id: str) -> Answer:
        """Return the node's connections."""
        return self.__call("getBusInfo", caller_id)

    def getMasterUri(self, caller_id: str) -> Answer:
        """Return the URI of the master."""
        return self.__call("getMasterUri", caller_id)

    def shutdown(self, caller_id: str, msg: str = "") -> Answer:
        """Shut the node down."""
        return self.__call("shutdown", caller_id, msg)

    def getPid(self, caller_id: str) -> Answer:
        """Return the node's process number."""
        return self.__call("getPid", caller_id)

    def getSubscriptions(self, caller_id: str) -> Answer:
        """Return the subscribed topics."""
        return self.__call("getSubscriptions", caller_id)

    def getPublications(self, caller_id: str) -> Answer:
        """Return the published topics."""
        return self.__call("getPublications", caller_id)

    @apivalidate(-1, (global_name("parameter_key"), None))
    def paramUpdate(self, caller_id: str, parameter_key: str, parameter_value: Any) -> Answer:
        """Take a changed parameter into the cache of subscribed ones."""
        try:
            get_param_server_cache().update(parameter_key, parameter_value)
        except KeyError:
            return -1, "not subscribed", 0
        return 1, "", 0

    def publisherUpdate(self, caller_id: str, topic: str, publishers: list[str]) -> Answer:
        """Do nothing: the Software Bus knows the publishers."""
        return self.__call("publisherUpdate", caller_id, topic, publishers)

    def requestTopic(self, caller_id: str, topic: str, protocols: list[Any]) -> Answer:
        """Refuse: messages pass over the Software Bus."""
        return self.__call("requestTopic", caller_id, topic, protocols)


_handler = ROSHandler(get_name(), os.environ.get("ROS_MASTER_URI", ""))
adopt_handler(_handler)
