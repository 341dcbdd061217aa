"""Calls of ROS's XML-RPC APIs: checks of the arguments, and the answer as a triple of code, text and value.

An API is a class whose methods are declared with `answers`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from rospy_shim.types.names import ANYTYPE, PRIV_NAME, SEP, canonicalize_name

Answer = tuple[int, str, Any]
"""Code (1 success, 0 failure, -1 error of the caller), text, value (wiki.ros.org/ROS/Master_API)."""
Check = Callable[[Any, str], Any]
"""Takes an argument and the caller's name; returns the argument for the method, or raises `InvalidArgument`."""


class InvalidArgument(Exception):
    """An argument that the API does not accept; the text is the answer's."""


class UnknownMethod(Exception):
    """There is no method of that name."""


def answers(value_of_errors: Any, *checks: Check | None) -> Callable[[Callable[..., Answer]], Callable[..., Answer]]:
    """Declare a method of an API.

    Args:
        value_of_errors: the value in answers that report an error.
        checks: one for each argument after the caller's name.
    """

    def declare(method: Callable[..., Answer]) -> Callable[..., Answer]:
        vars(method)["api"] = (value_of_errors, checks)
        return method

    return declare


def call(api: object, name: str, arguments: Sequence[Any]) -> Answer:
    """Call a method of an API as rosmaster and rospy do. Returns an answer also for a wrong argument or a failure.

    Raises:
        UnknownMethod: there is no such method.
    """
    method = getattr(type(api), name, None)
    if not hasattr(method, "api"):
        raise UnknownMethod(f'method "{name}" is not supported')
    value, checks = vars(method)["api"]
    if not arguments:
        return -1, "missing required caller_id parameter", value
    if len(arguments) != len(checks) + 1:
        return -1, "Error: bad call arity", value
    caller, *rest = arguments
    if not isinstance(caller, str):
        return -1, "caller_id must be a string", value
    try:
        checked = [check(each, caller) if check else each for check, each in zip(checks, rest, strict=True)]
        answer: Answer = getattr(api, name)(caller, *checked)
    except InvalidArgument as error:
        return -1, str(error), value
    except TypeError as error:
        return -1, f"Error: invalid arguments: {error}", value
    except Exception as error:
        return 0, f"Internal failure: {error}", value
    return answer if answer[2] is not None else (-1, "Internal error (None value returned)", value)


def resolve(name: str, caller: str) -> str:
    """Return the global name for a name of a caller (rosgraph.names.resolve_name)."""
    above = caller.rstrip(SEP).rpartition(SEP)[0] + SEP
    if not name:
        return above
    name = canonicalize_name(name)
    if name.startswith(SEP):
        return name
    if name.startswith(PRIV_NAME):
        return canonicalize_name(f"{caller}{SEP}{name[1:]}")
    return above + name


# -- checks ----------------------------------------------------------------------------------------------------------


def text(parameter: str) -> Check:
    """Make a check that an argument is a text that is not empty."""

    def check(value: Any, caller: str) -> Any:
        if not value:
            raise InvalidArgument(f"ERROR: parameter [{parameter}] must be specified and non-empty")
        if not isinstance(value, str):
            raise InvalidArgument(f"ERROR: parameter [{parameter}] must be a string")
        return value

    return check


def something(parameter: str) -> Check:
    """Make a check that an argument is neither None nor empty."""

    def check(value: Any, caller: str) -> Any:
        if not value:
            raise InvalidArgument(f"ERROR: parameter [{parameter}] must be specified and non-empty")
        return value

    return check


def address(parameter: str) -> Check:
    """Make a check that an argument is a URI of a node or of a service."""

    def check(value: Any, caller: str) -> Any:
        if not value or not isinstance(value, str):
            raise InvalidArgument(f"ERROR: parameter [{parameter}] is not an XMLRPC URI")
        if not value.startswith(("http://", "rosrpc://")):
            raise InvalidArgument(f"ERROR: parameter [{parameter}] is not an RPC URI")
        return value

    return check


def name(parameter: str) -> Check:
    """Make a check of a graph resource name that also resolves it for the caller."""

    def check(value: Any, caller: str) -> Any:
        if not value or not isinstance(value, str):
            raise InvalidArgument(f"ERROR: parameter [{parameter}] must be a non-empty string")
        if ":" in value or " " in value:
            raise InvalidArgument(f"ERROR: parameter [{parameter}] contains illegal chars")
        return resolve(value, caller)

    return check


def name_of_thing(parameter: str) -> Check:
    """Make a check as `name` does, for topics and services, which cannot be the root."""
    plain = name(parameter)

    def check(value: Any, caller: str) -> Any:
        found = plain(value, caller)
        if value == SEP:
            raise InvalidArgument(f"ERROR: parameter [{parameter}] cannot be the global namespace")
        return found

    return check


def name_or_nothing(parameter: str) -> Check:
    """Make a check as `name` does, which accepts an empty text unchanged."""

    def check(value: Any, caller: str) -> Any:
        if not isinstance(value, str):
            raise InvalidArgument(f"ERROR: parameter [{parameter}] must be a string")
        return resolve(value, caller) if value else ""

    return check


def type_name(parameter: str) -> Check:
    """Make a check of the name of a message type, or `*`."""

    def check(value: Any, caller: str) -> Any:
        if value == ANYTYPE:
            return value
        if not value or not isinstance(value, str):
            raise InvalidArgument(f"ERROR: parameter [{parameter}] must be a non-empty string")
        if value.count(SEP) != 1:
            raise InvalidArgument(f"ERROR: parameter [{parameter}] is not a valid package resource name")
        return value

    return check
