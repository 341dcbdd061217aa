"""The services `~get_loggers` and `~set_logger_level` of every node (roscpp/GetLoggers, roscpp/SetLoggerLevel).

Imports nothing of cfepy.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rospy_shim.log_handlers import SHOWN
from rospy_shim.service import make_quiet_service

if TYPE_CHECKING:
    from rospy_shim.node import Node

OF_ROSPY = (
    "rosgraph",
    "rosgraph.network",
    "rospy",
    "rospy.core",
    "rospy.impl",
    "rospy.impl.masterslave",
    "rospy.impl.statistics",
    "rospy.internal",
    "rospy.service",
    "rospy.tcpros",
    "rospy.topics",
    "rosout",
)
"""Loggers that a node with rospy has, whether it has asked for them or not."""


class LoggerServices:
    """The two services of a node.

    Args:
        node: the node.
    """

    def __init__(self, node: Node) -> None:
        self._node = node

    def offer(self) -> None:
        """`init_node`: offer them."""
        service, library = make_quiet_service(self._node), self._node.library
        self._logger = library.message_class("roscpp/Logger")
        service("~get_loggers", library.service_class("roscpp/GetLoggers"), self._get)
        service("~set_logger_level", library.service_class("roscpp/SetLoggerLevel"), self._set)

    def _get(self, request: Any) -> list[Any]:
        logging = self._node.logs.logging
        names = dict.fromkeys([*OF_ROSPY, *logging.Logger.manager.loggerDict])
        levels = ((name, logging.getLogger(name).getEffectiveLevel()) for name in names)
        return [[self._logger(name, SHOWN.get(text := logging.getLevelName(level), text)) for name, level in levels]]

    def _set(self, request: Any) -> list[Any]:
        logging, wanted = self._node.logs.logging, request.level.upper()
        level = next((name for name, shown in SHOWN.items() if shown == wanted), None)
        if level is None:
            logging.getLogger("rospy").error("Bad logging level: %s", wanted)
        else:
            logging.getLogger(request.logger).setLevel(level)
        return []
