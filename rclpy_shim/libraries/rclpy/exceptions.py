"""rclpy's exceptions (rclpy.exceptions)."""

from __future__ import annotations

from typing import Any


class NotInitializedException(Exception):
    """`rclpy.init` was not called."""

    def __init__(self, *args: object) -> None:
        super().__init__("rclpy.init() has not been called" + "".join(f". msg:{each}" for each in args))


class NoTypeSupportImportedException(Exception):
    """A class is not a message class."""


class NameValidationException(Exception):
    """A name breaks ROS's rules.

    Args:
        name_type: kind of name.
        name: the name.
        error_msg: the rule.
        invalid_index: index of the first wrong character.
    """

    def __init__(self, name_type: str, name: str, error_msg: str, invalid_index: int, *args: object) -> None:
        text = f"Invalid {name_type}: {error_msg}:\n  '{name}'\n   {' ' * invalid_index}^"
        super().__init__(text, *args)


class InvalidNamespaceException(NameValidationException):
    """A namespace breaks ROS's rules."""

    def __init__(self, name: str, error_msg: str, invalid_index: int, *args: object) -> None:
        super().__init__("namespace", name, error_msg, invalid_index, *args)


class InvalidNodeNameException(NameValidationException):
    """A node name breaks ROS's rules."""

    def __init__(self, name: str, error_msg: str, invalid_index: int, *args: object) -> None:
        super().__init__("node name", name, error_msg, invalid_index, *args)


class InvalidTopicNameException(NameValidationException):
    """A topic name breaks ROS's rules."""

    def __init__(self, name: str, error_msg: str, invalid_index: int, *args: object) -> None:
        super().__init__("topic name", name, error_msg, invalid_index, *args)


class InvalidServiceNameException(NameValidationException):
    """A service name breaks ROS's rules."""

    def __init__(self, name: str, error_msg: str, invalid_index: int, *args: object) -> None:
        super().__init__("service name", name, error_msg, invalid_index, *args)


class ParameterException(Exception):
    """Base of exceptions about parameters.

    Args:
        error_msg: the error.
        parameters: name of the parameter, or names.
    """

    def __init__(self, error_msg: str, parameters: Any, *args: object) -> None:
        super().__init__(f"{error_msg}: {parameters}", *args)


class ParameterNotDeclaredException(ParameterException):
    """A parameter was not declared."""

    def __init__(self, parameters: Any, *args: object) -> None:
        super().__init__("Invalid access to undeclared parameter(s)", parameters, *args)


class ParameterAlreadyDeclaredException(ParameterException):
    """A parameter is declared already."""

    def __init__(self, parameters: Any, *args: object) -> None:
        super().__init__("Parameter(s) already declared", parameters, *args)


class InvalidParameterException(ParameterException):
    """A parameter has an invalid name."""

    def __init__(self, parameter: Any, *args: object) -> None:
        super().__init__("Invalid parameter name", parameter, *args)


class InvalidParameterTypeException(ParameterException):
    """A parameter has another type than it was declared with."""

    def __init__(self, parameter: Any, expected_type: str, *args: object) -> None:
        text = f"Trying to set parameter '{parameter.name}' to '{parameter.value}' of type '{parameter.type_.name}'"
        Exception.__init__(self, f"{text}, expecting type '{expected_type}'", *args)


class ParameterUninitializedException(ParameterException):
    """A parameter was declared without a value."""

    def __init__(self, parameter_name: str, *args: object) -> None:
        super().__init__(f"The parameter '{parameter_name}' is not initialized", parameter_name, *args)


class InvalidParameterValueException(ParameterException):
    """A value was refused.

    Args:
        parameter: name of the parameter.
        value: the value.
        reason: reason of the refusal.
    """

    def __init__(self, parameter: str, value: Any, reason: str, *args: object) -> None:
        text = f"Invalid parameter value ({value!s}) for parameter. Reason: {reason}"
        super().__init__(text, parameter, *args)


class ParameterImmutableException(ParameterException):
    """A parameter cannot be removed."""

    def __init__(self, parameter: Any, *args: object) -> None:
        super().__init__("Attempted to modify read-only parameter", parameter, *args)


class ROSInterruptException(Exception):
    """The context was shut down during a sleep."""

    def __init__(self, *args: object) -> None:
        super().__init__("rclpy.shutdown() has been called", *args)
