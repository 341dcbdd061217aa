"""Checks of arguments of ROS's XML-RPC APIs (rospy.impl.validators, and those of rospy.names and rospy.core).

A validator takes a value and the caller's name, and gives the value to go on with. Imports nothing of cfepy.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rospy_shim.names import SEP

Resolve = Callable[[str, str], str]


class ParameterInvalid(Exception):  # rospy's name
    """An argument that an API does not take.

    Args:
        message: what is wrong.
    """

    __module__ = "rospy.impl.validators"

    def __init__(self, message: str) -> None:
        super().__init__(message)


def non_empty(param_name: str) -> Callable[[Any, str], Any]:
    """A validator that refuses what is false."""

    def validator(value: Any, caller_id: str) -> Any:
        if not value:
            raise ParameterInvalid(f"ERROR: parameter [{param_name}] must be specified and non-empty")
        return value

    return validator


def isstring(s: Any) -> bool:
    """Whether a value is text."""
    return isinstance(s, str)


def valid_name_validator_unresolved(param_name: str, param_value: Any, caller_id: str) -> str:
    """Check a name, and give it as it is.

    Raises:
        ParameterInvalid: it is no text, is empty, or looks like a URI.
    """
    _check_text(param_name, param_value)
    if ":" in param_value or " " in param_value:
        raise ParameterInvalid(f"ERROR: parameter [{param_name}] contains illegal chars")
    return str(param_value)


def global_name(param_name: str) -> Callable[[Any, str], str]:
    """A validator that wants a global name."""

    def validator(value: Any, caller_id: str) -> str:
        _check_text(param_name, value)
        if not value.startswith(SEP):
            raise ParameterInvalid(f"ERROR: parameter [{param_name}] must be a globally referenced name")
        return str(value)

    return validator


def _check_text(param_name: str, value: Any) -> None:
    if not value or not isstring(value):
        raise ParameterInvalid(f"ERROR: parameter [{param_name}] must be a non-empty string")


class NameValidators:
    """Those validators that resolve names for a node.

    Args:
        resolve: resolves a name for a caller.
    """

    def __init__(self, resolve: Resolve) -> None:
        self._resolve = resolve

    def valid_name_validator_resolved(self, param_name: str, param_value: Any, caller_id: str) -> str:
        """Check a name, and resolve it for the caller.

        Raises:
            ParameterInvalid: see `valid_name_validator_unresolved`.
        """
        return self._resolve(valid_name_validator_unresolved(param_name, param_value, caller_id), caller_id)

    def valid_name(self, param_name: str, resolve: bool = True) -> Callable[[Any, str], str]:
        """A validator for names; `resolve` says whether it resolves them."""
        check = self.valid_name_validator_resolved if resolve else valid_name_validator_unresolved
        return lambda value, caller_id: check(param_name, value, caller_id)

    def is_topic(self, param_name: str) -> Callable[[Any, str], str]:
        """A validator for names of topics, which it resolves."""

        def validator(value: Any, caller_id: str) -> str:
            found = self.valid_name_validator_resolved(param_name, value, caller_id)
            if value == SEP:
                raise ParameterInvalid(f"ERROR: parameter [{param_name}] cannot be the global namespace")
            return found

        return validator
