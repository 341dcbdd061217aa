"""`Client`: changes the parameters of a node that runs a `Server`, and follows their changes."""

from __future__ import annotations

import ast
import sys
import threading
import time
from collections.abc import Callable
from typing import Any

import rospy

from dynamic_reconfigure import DynamicReconfigureCallbackException, DynamicReconfigureParameterException
from dynamic_reconfigure.encoding import decode_config, decode_description, encode_config, extract_params
from dynamic_reconfigure.msg import Config as ConfigMsg
from dynamic_reconfigure.msg import ConfigDescription
from dynamic_reconfigure.srv import Reconfigure

Callback = Callable[[Any], object] | None

_TYPES: dict[str, type] = {"int": int, "double": float, "str": str, "bool": bool}
_TRUE = ("yes", "true", "t", "1")
_LOOK_UP_S = 1.0  # a thread that waits without a limit checks at this interval whether the node is to end


class Client:
    """Connects to a server and waits for it.

    Args:
        name: name of the server, usually the node's name.
        timeout: in s; None or 0 waits forever.
        config_callback: called with the configuration whenever it changes.
        description_callback: called with the list of parameters when it arrives.

    Raises:
        ROSException: the server was not available in time.
    """

    def __init__(
        self,
        name: str,
        timeout: float | None = None,
        config_callback: Callback = None,
        description_callback: Callback = None,
    ) -> None:
        self.name = name
        self.config: Any = None
        self.param_description: Any = None
        self.group_description: Any = None
        self._param_types: dict[str, type] = {}
        self._cv = threading.Condition()
        self._config_callback = config_callback
        self._description_callback = description_callback
        self._set_service = self._get_service_proxy("set_parameters", timeout)
        self._descriptions_sub = self._subscribe("parameter_descriptions", ConfigDescription, self._descriptions_msg)
        self._updates_sub = self._subscribe("parameter_updates", ConfigMsg, self._updates_msg)

    def get_configuration(self, timeout: float | None = None) -> Any:
        """Return the server's configuration, waiting for the first one.

        Args:
            timeout: in s; None or 0 waits forever.

        Returns:
            values by name, or None if there is none in time.
        """
        if not timeout and self._wait_for("config", 1.0) is None:
            print("Waiting for configuration...", file=sys.stderr)
        return self._wait_for("config", timeout)

    def get_parameter_descriptions(self, timeout: float | None = None) -> Any:
        """Return the list of the server's parameters, each a dict, or None if it does not arrive in time."""
        return self._wait_for("param_description", timeout)

    def get_group_descriptions(self, timeout: float | None = None) -> Any:
        """Return the tree of the server's groups, or None if it does not arrive in time."""
        return self._wait_for("group_description", timeout)

    def update_configuration(self, changes: dict[str, Any]) -> Any:
        """Change values of the server.

        Args:
            changes: values by name, converted to the parameters' types; constants of an enum may be given by name.
                Groups are opened and closed by a dict of states by name under "groups".

        Returns:
            the resulting configuration.

        Raises:
            DynamicReconfigureParameterException: an unknown parameter, or a value that does not fit.
            DynamicReconfigureCallbackException: the server did not answer.
        """
        if self.param_description is None:
            self.get_parameter_descriptions()
        if self.param_description is not None:
            for name, value in list(changes.items()):
                if name != "groups":
                    changes[name] = self._converted(name, value)
        if "groups" in changes:
            changes["groups"] = self.update_groups(changes["groups"])
        try:
            msg = self._set_service(encode_config(changes)).config
        except rospy.ServiceException as error:
            raise DynamicReconfigureCallbackException("service call failed") from error
        if self.group_description is None:
            self.get_group_descriptions()
        return decode_config(msg, self.group_description)

    def update_groups(self, changes: dict[str, Any]) -> Any:
        """Return the tree of groups with new states.

        Args:
            changes: states by group name.
        """
        description = self.get_group_descriptions()
        for name, state in changes.items():
            _set_state(description, name, state)
        return description

    def close(self) -> None:
        """Follow the server no longer."""
        self._descriptions_sub.unregister()
        self._updates_sub.unregister()

    def get_config_callback(self) -> Callback:
        """Return the callback for new configurations."""
        return self._config_callback

    def set_config_callback(self, value: Callback) -> None:
        """Set the callback for new configurations. It gets the present configuration at once."""
        self._config_callback = value
        if value is not None:
            value(self.config)

    config_callback = property(get_config_callback, set_config_callback)

    def get_description_callback(self) -> Callback:
        """Return the callback for the list of parameters."""
        return self._description_callback

    def set_description_callback(self, value: Callback) -> None:
        """Set the callback for the list of parameters. It gets the present list at once."""
        self._description_callback = value
        if value is not None:
            value(self.param_description)

    description_callback = property(get_description_callback, set_description_callback)

    def _converted(self, name: str, value: Any) -> Any:
        kind = self._param_types.get(name)
        if kind is None:
            raise DynamicReconfigureParameterException(f"don't know parameter: {name}")
        if isinstance(value, str):
            if kind is bool:
                return value.lower() in _TRUE
            constants = self._constants(name)
            if value.lower() in constants:
                return constants[value.lower()]
        try:
            return kind(value)
        except ValueError as error:
            problem = f"can't set parameter '{name}' of {kind}: {error}"
            raise DynamicReconfigureParameterException(problem) from None

    def _constants(self, name: str) -> dict[str, Any]:
        """Return values of a parameter's enum by lower-case name."""
        method = next(each["edit_method"] for each in self.param_description if each["name"] == name)
        listed = ast.literal_eval(method)["enum"] if method else []
        return {each["name"].lower(): self._param_type_from_string(each["type"])(each["value"]) for each in listed}

    def _wait_for(self, attribute: str, timeout: float | None) -> Any:
        """Return an attribute of this client as soon as it is not None."""
        end = time.time() + timeout if timeout else None
        with self._cv:
            while getattr(self, attribute) is None and not rospy.is_shutdown():
                left = _LOOK_UP_S if end is None else end - time.time()
                if left <= 0.0:
                    break
                self._cv.wait(left)
        return getattr(self, attribute)

    def _get_service_proxy(self, suffix: str, timeout: float | None) -> Any:
        name = rospy.resolve_name(f"{self.name}/{suffix}")
        try:
            rospy.wait_for_service(name, timeout or 1.0)
        except rospy.ROSException:
            if timeout:
                raise
            print(f"Waiting for service {name}...", file=sys.stderr)
            rospy.wait_for_service(name)
        return rospy.ServiceProxy(name, Reconfigure)

    def _subscribe(self, suffix: str, kind: Any, callback: Callable[[Any], None]) -> Any:
        return rospy.Subscriber(rospy.resolve_name(f"{self.name}/{suffix}"), kind, callback=callback)

    def _updates_msg(self, msg: Any) -> None:
        if self.group_description is None:
            self.get_group_descriptions()
        self.config = decode_config(msg, self.group_description)
        self._tell(self._config_callback, self.config)

    def _descriptions_msg(self, msg: Any) -> None:
        self.group_description = decode_description(msg)
        params = extract_params(self.group_description)
        self._param_types = {each["name"]: self._param_type_from_string(each["type"]) for each in params}
        self.param_description = params
        self._tell(self._description_callback, params)

    def _tell(self, callback: Callback, value: Any) -> None:
        with self._cv:
            self._cv.notify_all()
        if callback is not None:
            callback(value)

    def _param_type_from_string(self, type_str: str) -> type:
        if type_str not in _TYPES:
            raise DynamicReconfigureParameterException(f"parameter has unknown type: {type_str}")
        return _TYPES[type_str]


def _set_state(group: Any, name: str, state: Any) -> None:
    for inner in group["groups"].values():
        if inner["name"] == name:
            inner["state"] = state
        else:
            _set_state(inner, name, state)
