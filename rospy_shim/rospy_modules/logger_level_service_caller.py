"""rospy.logger_level_service_caller: requests the loggers of nodes and sets their levels."""

from __future__ import annotations

from typing import Any

import rosgraph
import rospy
from roscpp.srv import GetLoggers, SetLoggerLevel

__all__ = ["LoggerLevelServiceCaller", "ROSConsoleException"]

_SET = "/set_logger_level"


class ROSConsoleException(Exception):
    """A service of the node could not be called."""


class LoggerLevelServiceCaller:
    """Calls the services `get_loggers` and `set_logger_level` of nodes."""

    def __init__(self) -> None:
        self._current_loggers: list[str] = []
        self._current_levels: dict[str, str] = {}

    def get_levels(self) -> list[str]:
        """Return the levels, the least severe first."""
        return ["debug", "info", "warn", "error", "fatal"]

    def get_loggers(self, node: str) -> list[str]:
        """Return the names of a node's loggers.

        Raises:
            ROSConsoleException: a service of the node could not be called.
        """
        self._current_loggers = []
        self._current_levels = {}
        for logger in self._call(node, "get_loggers", GetLoggers).loggers:
            self._current_loggers.append(logger.name)
            self._current_levels[logger.name] = logger.level
        return self._current_loggers

    def get_node_names(self) -> list[str]:
        """Return the nodes whose levels can be set."""
        _, _, services = rosgraph.Master(rospy.get_name()).getSystemState()
        return sorted(name[: -len(_SET)] for name, _ in services if name.endswith(_SET))

    def send_logger_change_message(self, node: str, logger: str, level: str) -> bool:
        """Set the level of a logger. Returns True if the level changed.

        Raises:
            ROSConsoleException: a service of the node could not be called.
            KeyError: `get_loggers` has not returned the logger.
        """
        if self._current_levels[logger] == level:
            return False
        self._call(node, "set_logger_level", SetLoggerLevel, logger, level)
        self._current_levels[logger] = level.upper()
        return True

    def _call(self, node: str, name: str, kind: Any, *args: str) -> Any:
        namespace = rosgraph.names.get_ros_namespace()
        service = rosgraph.names.resolve_name(rosgraph.names.ns_join(node, name), namespace)
        try:
            return rospy.ServiceProxy(service, kind)(*args)
        except rospy.ServiceException as error:
            raise ROSConsoleException(f"node '{node}' logger request failed: {error}") from error
