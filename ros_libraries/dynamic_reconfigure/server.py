"""`Server`: lets other nodes change a node's parameters."""

from __future__ import annotations

import copy
import threading
from collections.abc import Callable, Mapping
from typing import Any

import rospy

from dynamic_reconfigure import DynamicReconfigureCallbackException
from dynamic_reconfigure.encoding import (
    decode_config,
    encode_config,
    encode_description,
    extract_params,
    get_tree,
    initial_config,
)
from dynamic_reconfigure.msg import Config as ConfigMsg
from dynamic_reconfigure.msg import ConfigDescription
from dynamic_reconfigure.srv import Reconfigure

_ALL = ~0  # the level of the first call, in which everything may have changed


class Server:
    """Offers parameters.

    It latches `parameter_descriptions` and `parameter_updates`, answers `set_parameters`, and mirrors the values to the
    parameters of the same names. Values that were set as parameters beforehand override the defaults.

    Args:
        type: a generated module, e.g. `my_package.cfg.MyConfig`.
        callback: `(config, level) -> config`, called at once and for each change; it may alter values. `level` is the
            union of the levels of the parameters that change.
        namespace: namespace of topics and parameters; the node's own by default.

    Raises:
        DynamicReconfigureCallbackException: the callback returns None.
    """

    def __init__(self, type: Any, callback: Callable[[Any, int], Any], namespace: str = "") -> None:
        self.mutex = threading.Lock()
        self.ns = _prefix(namespace)
        self.type = type
        self.config = type.defaults.copy()
        self.description = encode_description(type)
        self._copy_from_parameter_server()
        self.callback = callback
        self._clamp(self.config)
        self.config["groups"] = get_tree(self.description)
        self.config = initial_config(encode_config(self.config), type.config_description)
        self.descr_topic = self._latched("parameter_descriptions", ConfigDescription)
        self.descr_topic.publish(self.description)
        self.update_topic = self._latched("parameter_updates", ConfigMsg)
        self._change_config(self.config, _ALL)
        self.set_service = rospy.Service(self.ns + "set_parameters", Reconfigure, self._set_callback)

    def update_configuration(self, changes: Mapping[str, Any]) -> Any:
        """Change values from within the node, and call the callback.

        Returns:
            the resulting configuration.
        """
        with self.mutex:
            changed = copy.deepcopy(self.config)
            changed.update(changes)
            self._clamp(changed)
            return self._change_config(changed, self._calc_level(changed, self.config))

    def _latched(self, name: str, kind: Any) -> Any:
        return rospy.Publisher(self.ns + name, kind, latch=True, queue_size=10)

    def _params(self) -> list[dict[str, Any]]:
        return extract_params(self.type.config_description)

    def _copy_from_parameter_server(self) -> None:
        for param in self._params():
            try:
                self.config[param["name"]] = rospy.get_param(self.ns + param["name"])
            except KeyError:
                continue  # not set: the default stays

    def _copy_to_parameter_server(self) -> None:
        for param in self._params():
            rospy.set_param(self.ns + param["name"], self.config[param["name"]])

    def _change_config(self, config: Any, level: int) -> Any:
        self.config = self.callback(config, level)
        if self.config is None:
            problem = "Reconfigure callback should return a possibly updated configuration."
            rospy.logerr(problem)
            raise DynamicReconfigureCallbackException(problem)
        self._copy_to_parameter_server()
        self.update_topic.publish(encode_config(self.config))
        return self.config

    def _calc_level(self, config1: Mapping[str, Any], config2: Mapping[str, Any]) -> int:
        level = 0
        for param in self._params():
            if config1[param["name"]] != config2[param["name"]]:
                level |= param["level"]
        return level

    def _clamp(self, config: Any) -> None:
        for param in self._params():
            name = param["name"]
            low, high = self.type.min[name], self.type.max[name]
            if high != "" and config[name] > high:
                config[name] = high
            elif low != "" and config[name] < low:
                config[name] = low

    def _set_callback(self, req: Any) -> Any:
        changes = decode_config(req.config, self.type.config_description)
        return encode_config(self.update_configuration(changes))


def _prefix(namespace: str) -> str:
    """Return the prefix of the names of topics and parameters."""
    if not namespace or namespace == "~":
        return "~"
    absolute = namespace if namespace[0] in "/~" else f"~{namespace}"
    return f"{absolute}/".replace("//", "/")
