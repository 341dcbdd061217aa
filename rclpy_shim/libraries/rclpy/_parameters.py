"""`ParameterStore`: the parameters of a node: declaring, reading, setting, and the callbacks (rclpy.node)."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable
from typing import Any

from rclpy.exceptions import (
    InvalidParameterException,
    InvalidParameterTypeException,
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from rclpy.parameter import PARAMETER_SEPARATOR_STRING, Parameter

SIM_TIME = "use_sim_time"
_ONLY_A_NAME = (
    "when declaring parameter named '{}', declaring a parameter only providing its name is deprecated. "
    'You have to either:\n\t- Pass a name and a default value different to "PARAMETER NOT SET" '
    "(and optionally a descriptor).\n\t- Pass a name and a parameter type.\n\t- Pass a name and a descriptor "
    "with `dynamic_typing=True"
)
_NOT_SET: Any = object()
_NEAR = 1e-9  # share of a step


class ParameterStore:
    """Base of `Node` with its parameters.

    Args:
        overrides: values by name that replace the defaults of declared parameters.
        allows_undeclared: parameters need not be declared.
    """

    def __init__(self, overrides: dict[str, Any], allows_undeclared: bool) -> None:
        self._parameters: dict[str, Parameter] = {}
        self._descriptors: dict[str, Any] = {}
        self._parameter_overrides = {name: Parameter(name, value=value) for name, value in overrides.items()}
        self._allow_undeclared_parameters = allows_undeclared
        self._pre_set_callbacks: list[Callable[[list[Parameter]], list[Parameter]]] = []
        self._on_set_callbacks: list[Callable[[list[Parameter]], Any]] = []
        self._post_set_callbacks: list[Callable[[list[Parameter]], object]] = []

    # -- declaring ---------------------------------------------------------------------------------------------------

    def declare_parameter(
        self, name: str, value: Any = None, descriptor: Any = None, ignore_override: bool = False
    ) -> Parameter:
        """Declare a parameter.

        Args:
            name: its name.
            value: its default value, or a `Parameter.Type`, which leaves it without a value.
            descriptor: rcl_interfaces/ParameterDescriptor; None for the default.
            ignore_override: do not take the value of the command line.

        Returns:
            The parameter with its value.

        Raises:
            ParameterAlreadyDeclaredException: it is declared already.
            InvalidParameterException: the name is empty.
            InvalidParameterTypeException: the value of the command line has another type.
            InvalidParameterValueException: a callback or the range refuses the value.
        """
        return self.declare_parameters("", [(name, value, descriptor)], ignore_override)[0]

    def declare_parameters(
        self, namespace: str, parameters: Iterable[tuple[Any, ...]], ignore_override: bool = False
    ) -> list[Parameter]:
        """Declare parameters below a namespace.

        Args:
            namespace: put before each name with a dot; may be empty.
            parameters: (name), (name, value) or (name, value, descriptor).
            ignore_override: do not take the values of the command line.

        Returns:
            The parameters.

        Raises:
            ParameterAlreadyDeclaredException, InvalidParameterException, InvalidParameterTypeException,
            InvalidParameterValueException: as for `declare_parameter`.
        """
        wanted = [self._wanted(namespace, *each) for each in parameters]
        already = [name for name, _, _ in wanted if name in self._parameters]
        if already:
            raise ParameterAlreadyDeclaredException(already)
        return [self._declare(name, value, descriptor, ignore_override) for name, value, descriptor in wanted]

    def _wanted(self, namespace: str, name: str, value: Any = _NOT_SET, descriptor: Any = None) -> tuple[str, Any, Any]:
        from rcl_interfaces.msg import ParameterDescriptor

        full = f"{namespace}{PARAMETER_SEPARATOR_STRING}{name}" if namespace else name
        if not isinstance(name, str) or not full:
            raise InvalidParameterException(full)
        chosen = ParameterDescriptor() if descriptor is None else descriptor
        if value is _NOT_SET or (value is None and descriptor is None):
            warnings.warn(_ONLY_A_NAME.format(full), stacklevel=5)
            chosen.dynamic_typing, value = True, None
        return full, value, chosen

    def _declare(self, name: str, value: Any, descriptor: Any, ignore_override: bool) -> Parameter:
        kind = value if isinstance(value, Parameter.Type) else Parameter.Type.from_parameter_value(value)
        chosen = Parameter(name) if isinstance(value, Parameter.Type) else Parameter(name, value=value)
        if not ignore_override and name in self._parameter_overrides:
            chosen = self._parameter_overrides[name]
        if not descriptor.dynamic_typing:
            if kind is Parameter.Type.NOT_SET:
                kind = Parameter.Type(descriptor.type)
            descriptor.type = kind.value
            if chosen.type_ not in (kind, Parameter.Type.NOT_SET) and not kind.check(chosen.value):
                raise InvalidParameterTypeException(chosen, kind.name)
            if chosen.type_ is not Parameter.Type.NOT_SET:
                chosen = Parameter(name, kind, chosen.value)
        descriptor.name = name
        result = self._judge([chosen], {name: descriptor})
        if not result.successful:
            raise InvalidParameterValueException(name, chosen.value, result.reason)
        self._descriptors[name] = descriptor
        self._parameters[name] = chosen
        self._tell([chosen], [], [])
        for heard in self._post_set_callbacks:
            heard([chosen])
        return chosen

    def undeclare_parameter(self, name: str) -> None:
        """Remove a parameter.

        Raises:
            ParameterNotDeclaredException: it is not declared.
            ParameterImmutableException: it is read-only.
        """
        if name not in self._parameters:
            raise ParameterNotDeclaredException(name)
        if self._descriptors[name].read_only:
            raise ParameterImmutableException(name)
        del self._parameters[name], self._descriptors[name]

    def _tell(self, new: list[Parameter], changed: list[Parameter], deleted: list[Parameter]) -> None:
        """Publish changes on /parameter_events."""

    # -- reading -----------------------------------------------------------------------------------------------------

    def has_parameter(self, name: str) -> bool:
        """Return True if a parameter is declared."""
        return name in self._parameters

    def get_parameter(self, name: str) -> Parameter:
        """Return a parameter.

        Raises:
            ParameterNotDeclaredException: it is not declared.
            ParameterUninitializedException: it was declared with a type and has no value.
        """
        found = self._parameters.get(name)
        if found is None:
            if self._allow_undeclared_parameters:
                return Parameter(name)
            raise ParameterNotDeclaredException(name)
        if found.type_ is Parameter.Type.NOT_SET and not self._descriptors[name].dynamic_typing:
            raise ParameterUninitializedException(name)
        return found

    def get_parameters(self, names: Iterable[str]) -> list[Parameter]:
        """Return parameters by their names; see `get_parameter`."""
        return [self.get_parameter(name) for name in names]

    def get_parameter_or(self, name: str, alternative_value: Any = None) -> Any:
        """Return a parameter, or the alternative if it is not declared or has no value."""
        found = self._parameters.get(name)
        if found is None or found.type_ is Parameter.Type.NOT_SET:
            return Parameter(name) if alternative_value is None else alternative_value
        return found

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter]:
        """Return the parameters below a prefix, by the rest of their names."""
        head = f"{prefix}{PARAMETER_SEPARATOR_STRING}" if prefix else ""
        return {name.removeprefix(head): each for name, each in self._parameters.items() if name.startswith(head)}

    def get_parameter_types(self, names: Iterable[str]) -> list[Any]:
        """Return the types of parameters, as numbers."""
        return [self.get_parameter_type(name).value for name in names]

    def get_parameter_type(self, name: str) -> Any:
        """Return the type of a parameter.

        Raises:
            ParameterNotDeclaredException: it is not declared.
        """
        if name in self._parameters:
            return self._parameters[name].type_
        if self._allow_undeclared_parameters:
            return Parameter.Type.NOT_SET
        raise ParameterNotDeclaredException(name)

    def describe_parameter(self, name: str) -> Any:
        """Return the descriptor of a parameter.

        Raises:
            ParameterNotDeclaredException: it is not declared.
        """
        from rcl_interfaces.msg import ParameterDescriptor

        if name in self._descriptors:
            return self._descriptors[name]
        if self._allow_undeclared_parameters:
            return ParameterDescriptor()
        raise ParameterNotDeclaredException(name)

    def describe_parameters(self, names: Iterable[str]) -> list[Any]:
        """Return the descriptors of parameters; see `describe_parameter`."""
        return [self.describe_parameter(name) for name in names]

    def set_descriptor(self, name: str, descriptor: Any, alternative_value: Any = None) -> Any:
        """Replace the descriptor of a parameter.

        Returns:
            The value of the parameter as rcl_interfaces/ParameterValue.

        Raises:
            ParameterNotDeclaredException: it is not declared.
            ParameterImmutableException: it is read-only.
        """
        if name not in self._parameters:
            raise ParameterNotDeclaredException(name)
        if self._descriptors[name].read_only:
            raise ParameterImmutableException(name)
        descriptor.name, descriptor.type = name, self._parameters[name].type_.value
        self._descriptors[name] = descriptor
        return self._parameters[name].get_parameter_value()

    # -- setting -----------------------------------------------------------------------------------------------------

    def set_parameters(self, parameter_list: list[Parameter]) -> list[Any]:
        """Set parameters one by one.

        Returns:
            For each one rcl_interfaces/SetParametersResult.

        Raises:
            ParameterNotDeclaredException: one is not declared; those before it are set.
        """
        return [self.set_parameters_atomically([each]) for each in parameter_list]

    def set_parameters_atomically(self, parameter_list: list[Parameter]) -> Any:
        """Set all parameters or none of them.

        Returns:
            rcl_interfaces/SetParametersResult.

        Raises:
            ParameterNotDeclaredException: one is not declared.
        """
        chosen = list(parameter_list)
        for change in self._pre_set_callbacks:
            chosen = change(chosen)
        self._require_declared(chosen)
        result = self._judge(chosen, self._descriptors)
        if not result.successful:
            return result
        new: list[Parameter] = []
        changed: list[Parameter] = []
        deleted: list[Parameter] = []
        for each in chosen:
            if each.type_ is Parameter.Type.NOT_SET and not self._is_dynamic(each.name):
                if each.name in self._parameters:
                    deleted.append(each)
                self._parameters.pop(each.name, None)
                self._descriptors.pop(each.name, None)
                continue
            (changed if each.name in self._parameters else new).append(each)
            self._parameters[each.name] = each
            self._descriptors.setdefault(each.name, self._free_descriptor(each))
        self._tell(new, changed, deleted)
        for heard in self._post_set_callbacks:
            heard(chosen)
        return result

    def _free_descriptor(self, parameter: Parameter) -> Any:
        from rcl_interfaces.msg import ParameterDescriptor

        return ParameterDescriptor(name=parameter.name, type=parameter.type_.value, dynamic_typing=True)

    def _is_dynamic(self, name: str) -> bool:
        return name in self._descriptors and bool(self._descriptors[name].dynamic_typing)

    def _require_declared(self, parameters: list[Parameter]) -> None:
        missing = [each.name for each in parameters if each.name not in self._parameters]
        if missing and not self._allow_undeclared_parameters:
            raise ParameterNotDeclaredException(missing[1:])  # as rclpy, whose test has used up the first name

    def _judge(self, parameters: list[Parameter], descriptors: dict[str, Any]) -> Any:
        """Return SetParametersResult: the first refusal by a descriptor or a callback."""
        from rcl_interfaces.msg import SetParametersResult

        for each in parameters:
            reason = _refusal(each, descriptors.get(each.name), is_new=each.name not in self._parameters)
            if reason:
                return SetParametersResult(successful=False, reason=reason)
        for judge in self._on_set_callbacks:
            result = judge(parameters)
            if not isinstance(result, SetParametersResult):
                warnings.warn("Callback returned an invalid type, it should return SetParameterResult.", stacklevel=4)
                return SetParametersResult(successful=False, reason="Callback returned an invalid type")
            if not result.successful:
                return result
        return SetParametersResult(successful=True)

    # -- callbacks ---------------------------------------------------------------------------------------------------

    def add_pre_set_parameters_callback(self, callback: Callable[[list[Parameter]], list[Parameter]]) -> None:
        """Add a function that may change the list of parameters before they are set."""
        self._pre_set_callbacks.insert(0, callback)

    def add_on_set_parameters_callback(self, callback: Callable[[list[Parameter]], Any]) -> None:
        """Add a function that accepts or refuses parameters, by rcl_interfaces/SetParametersResult."""
        self._on_set_callbacks.insert(0, callback)

    def add_post_set_parameters_callback(self, callback: Callable[[list[Parameter]], object]) -> None:
        """Add a function that is called with the parameters that were set."""
        self._post_set_callbacks.insert(0, callback)

    def remove_pre_set_parameters_callback(self, callback: Callable[[list[Parameter]], list[Parameter]]) -> None:
        """Remove such a function. Raises ValueError if it is not there."""
        self._pre_set_callbacks.remove(callback)

    def remove_on_set_parameters_callback(self, callback: Callable[[list[Parameter]], Any]) -> None:
        """Remove such a function. Raises ValueError if it is not there."""
        self._on_set_callbacks.remove(callback)

    def remove_post_set_parameters_callback(self, callback: Callable[[list[Parameter]], object]) -> None:
        """Remove such a function. Raises ValueError if it is not there."""
        self._post_set_callbacks.remove(callback)


def _refusal(parameter: Parameter, descriptor: Any, *, is_new: bool) -> str:
    """Return the reason why a descriptor refuses a value; empty if it does not."""
    if parameter.name == SIM_TIME:
        if parameter.type_ is not Parameter.Type.BOOL:
            return f"'{SIM_TIME}' parameter must be a boolean"
        if parameter.value:
            return "cfepy does not have simulated time on /clock for nodes of ROS 2 yet; its own time is ROS's time"
    if descriptor is None:
        return ""
    if descriptor.read_only and not is_new:
        return f"Trying to set a read-only parameter: {parameter.name}."
    if parameter.type_ is Parameter.Type.NOT_SET:
        return "" if is_new or descriptor.dynamic_typing else "Static parameter cannot be undeclared"
    if not descriptor.dynamic_typing and descriptor.type not in (0, parameter.type_.value):
        expected = Parameter.Type(descriptor.type)
        if not expected.check(parameter.value):
            return f"Wrong parameter type, expected '{expected.value}' got '{parameter.type_.value}'"
    return _out_of_range(parameter, descriptor)


def _out_of_range(parameter: Parameter, descriptor: Any) -> str:
    ranges = {
        Parameter.Type.INTEGER: descriptor.integer_range,
        Parameter.Type.DOUBLE: descriptor.floating_point_range,
    }.get(parameter.type_, [])
    if not ranges:
        return ""
    limits, value = ranges[0], parameter.value
    if value in (limits.from_value, limits.to_value):
        return ""
    low, high, step = limits.from_value, limits.to_value, limits.step
    is_whole = parameter.type_ is Parameter.Type.INTEGER
    if not low <= value <= high:
        return (
            f"Parameter {parameter.name} out of range{'.' if is_whole else ''} Min: {low}, Max: {high}, value: {value}"
        )
    if step and abs((value - low) / step - round((value - low) / step)) > _NEAR:
        kind = "a valid step" if is_whole else "close enough to a valid step"
        text = f"The parameter value for {parameter.name} is not {kind}."
        return f"{text} Min: {low}, max: {high}, value: {value}, step: {step}"
    return ""
