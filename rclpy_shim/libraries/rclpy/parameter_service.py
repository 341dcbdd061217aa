"""The services of a node for its parameters (rclpy.parameter_service); they cost nothing before their first call."""

from __future__ import annotations

from typing import Any

from rclpy.exceptions import ParameterNotDeclaredException
from rclpy.parameter import PARAMETER_SEPARATOR_STRING, Parameter


class ParameterService:
    """Offers the six services of a node.

    Args:
        node: the node.
    """

    def __init__(self, node: Any) -> None:
        from rcl_interfaces.srv import (
            DescribeParameters,
            GetParameters,
            GetParameterTypes,
            ListParameters,
            SetParameters,
            SetParametersAtomically,
        )

        self._node = node
        for kind, name, handler in (
            (DescribeParameters, "describe_parameters", self._describe),
            (GetParameters, "get_parameters", self._get),
            (GetParameterTypes, "get_parameter_types", self._types),
            (ListParameters, "list_parameters", self._list),
            (SetParameters, "set_parameters", self._set),
            (SetParametersAtomically, "set_parameters_atomically", self._set_atomically),
        ):
            node._create_quiet_service(kind, f"~/{name}", handler)

    def _describe(self, request: Any, response: Any) -> Any:
        for name in request.names:
            try:
                response.descriptors.append(self._node.describe_parameter(name))
            except ParameterNotDeclaredException:
                response.descriptors.clear()
                break
        return response

    def _get(self, request: Any, response: Any) -> Any:
        for name in request.names:
            try:
                response.values.append(self._node.get_parameter(name).get_parameter_value())
            except Exception:  # as in rclpy: one unknown name, and there is no value at all
                response.values.clear()
                break
        return response

    def _types(self, request: Any, response: Any) -> Any:
        try:
            response.types = self._node.get_parameter_types(request.names)
        except ParameterNotDeclaredException:
            response.types = []
        return response

    def _list(self, request: Any, response: Any) -> Any:
        names = []
        for name in self._node._parameters:
            level = name.count(PARAMETER_SEPARATOR_STRING) + 1
            if request.prefixes:
                heads = [each for each in request.prefixes if name == each or name.startswith(f"{each}.")]
                if not heads:
                    continue
                level -= max(each.count(PARAMETER_SEPARATOR_STRING) + 1 for each in heads)
            if not request.depth or level <= request.depth:
                names.append(name)
        response.result.names = names
        found = {name.rpartition(PARAMETER_SEPARATOR_STRING)[0] for name in names}
        response.result.prefixes = sorted(found - {""})
        return response

    def _set(self, request: Any, response: Any) -> Any:
        response.results = [self._result(self._node.set_parameters_atomically, [each]) for each in request.parameters]
        return response

    def _set_atomically(self, request: Any, response: Any) -> Any:
        response.result = self._result(self._node.set_parameters_atomically, request.parameters)
        return response

    @staticmethod
    def _result(set_all: Any, messages: Any) -> Any:
        from rcl_interfaces.msg import SetParametersResult

        try:
            return set_all([Parameter.from_parameter_msg(each) for each in messages])
        except (ParameterNotDeclaredException, RuntimeError, ValueError) as error:
            return SetParametersResult(successful=False, reason=str(error))
