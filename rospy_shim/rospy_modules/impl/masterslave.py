"""rospy.impl.masterslave: the checks of arguments in methods of the master and slave APIs."""

from __future__ import annotations

import functools
import logging
import traceback
from collections.abc import Callable, Sequence
from hashlib import md5
from typing import Any
from urllib.parse import urlparse

from rospy.core import MASTER_NAME, ROSRPC
from rospy.impl.validators import ParameterInvalid
from rospy.names import ANYTYPE, GLOBALNS, REMAP, SEP, SERVICE_ANYTYPE, TOPIC_ANYTYPE

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
            if not all(urlparse(each)[:2]):
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
