"""`Parameter`: one parameter of a node (rclpy.parameter)."""

from __future__ import annotations

from array import array
from enum import IntEnum
from typing import Any

PARAMETER_SEPARATOR_STRING = "."
_LOW, _HIGH = -(1 << 63), 1 << 63


class _Type(IntEnum):
    NOT_SET = 0
    BOOL = 1
    INTEGER = 2
    DOUBLE = 3
    STRING = 4
    BYTE_ARRAY = 5
    BOOL_ARRAY = 6
    INTEGER_ARRAY = 7
    DOUBLE_ARRAY = 8
    STRING_ARRAY = 9

    @classmethod
    def from_parameter_value(cls, parameter_value: Any) -> _Type:
        """Return the type of a Python value.

        Raises:
            TypeError: no type has such values.
        """
        if parameter_value is None:
            return cls.NOT_SET
        single = _SINGLE.get(type(parameter_value))
        if single is not None:
            return cls[single]
        if isinstance(parameter_value, array):
            return cls.DOUBLE_ARRAY if parameter_value.typecode in "fd" else cls.INTEGER_ARRAY
        if isinstance(parameter_value, (list, tuple)):
            kinds = {type(each) for each in parameter_value}
            if not kinds or kinds == {bytes}:
                return cls.BYTE_ARRAY
            if len(kinds) == 1 and (kind := _SINGLE.get(kinds.pop())) is not None:
                return cls[f"{kind}_ARRAY"]
        raise TypeError(f"The given value is not one of the allowed types '{parameter_value!r}'.")

    def check(self, parameter_value: Any) -> bool:
        """Return True if a Python value is of this type."""
        if self is _Type.NOT_SET:
            return parameter_value is None
        if self.name.endswith("_ARRAY") and isinstance(parameter_value, (list, tuple)) and not parameter_value:
            return True
        try:
            found = _Type.from_parameter_value(parameter_value)
        except TypeError:
            return False
        if found is _Type.INTEGER and not _LOW <= parameter_value < _HIGH:
            return False
        return found is self


_Type.__name__, _Type.__qualname__ = "Type", "Parameter.Type"  # as it is shown
_SINGLE = {bool: "BOOL", int: "INTEGER", float: "DOUBLE", str: "STRING"}
_FIELDS = {
    _Type.BOOL: "bool_value",
    _Type.INTEGER: "integer_value",
    _Type.DOUBLE: "double_value",
    _Type.STRING: "string_value",
    _Type.BYTE_ARRAY: "byte_array_value",
    _Type.BOOL_ARRAY: "bool_array_value",
    _Type.INTEGER_ARRAY: "integer_array_value",
    _Type.DOUBLE_ARRAY: "double_array_value",
    _Type.STRING_ARRAY: "string_array_value",
}


class Parameter:
    """A parameter.

    Args:
        name: its name.
        type_: its type; None takes the type of the value.
        value: its value.

    Raises:
        TypeError: `type_` is not a type.
        ValueError: the value is not of the type.
    """

    Type = _Type

    def __init__(self, name: str, type_: _Type | None = None, value: Any = None) -> None:
        if type_ is None:
            type_ = _Type.from_parameter_value(value)
        if not isinstance(type_, _Type):
            raise TypeError("type must be an instance of `Parameter.Type`")
        if not type_.check(value):
            raise ValueError(f"Type '{type_}' and value '{value}' do not agree")
        self._type = type_
        self._name = name
        self._value = value

    @property
    def name(self) -> str:
        """Its name."""
        return self._name

    @property
    def type_(self) -> _Type:
        """Its type."""
        return self._type

    @property
    def value(self) -> Any:
        """Its value."""
        return self._value

    def get_parameter_value(self) -> Any:
        """Return its value as rcl_interfaces/ParameterValue."""
        from rcl_interfaces.msg import ParameterValue

        message = ParameterValue(type=self._type.value)
        if self._type is not _Type.NOT_SET:
            setattr(message, _FIELDS[self._type], self._value)
        return message

    def to_parameter_msg(self) -> Any:
        """Return it as rcl_interfaces/Parameter."""
        from rcl_interfaces.msg import Parameter as Message

        return Message(name=self._name, value=self.get_parameter_value())

    @classmethod
    def from_parameter_msg(cls, param_msg: Any) -> Parameter:
        """Make it from rcl_interfaces/Parameter."""
        return cls(param_msg.name, _Type(param_msg.value.type), parameter_value_to_python(param_msg.value))


def parameter_value_to_python(parameter_value: Any) -> Any:
    """Return the Python value of rcl_interfaces/ParameterValue.

    Raises:
        RuntimeError: it has an unknown type.
    """
    try:
        kind = _Type(parameter_value.type)
    except ValueError:
        raise RuntimeError(f"unexpected parameter type {parameter_value.type}") from None
    if kind is _Type.NOT_SET:
        return None
    value = getattr(parameter_value, _FIELDS[kind])
    return list(value) if kind.name.endswith("_ARRAY") else value


def get_parameter_value(string_value: str) -> Any:
    """Return rcl_interfaces/ParameterValue from a text in YAML."""
    return Parameter("", value=python_value(string_value)).get_parameter_value()


def python_value(text: str) -> Any:
    """Return the Python value of a text in YAML; a text without another meaning is a string."""
    import yaml

    try:
        value = yaml.safe_load(text)
    except yaml.YAMLError:
        return text
    return text if isinstance(value, dict) or value is None else value
