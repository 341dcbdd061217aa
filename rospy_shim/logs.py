"""rospy's logging: `loginfo` and its kin, on the node's own `logging`, shown the way rospy shows it.

Records go through the logger "rosout", so that a node can add handlers and set levels. Each is a line on the console of
the simulated computer (OS_printf) and, when somebody subscribes, a message on /rosout. Imports nothing of cfepy.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

from cfepy.rtos.units import NS_PER_S
from rospy_shim.genpy import Time as MessageTime
from rospy_shim.graph import ROSOUT
from rospy_shim.msgs import message_class
from rospy_shim.rostime import nanoseconds

if TYPE_CHECKING:
    from collections.abc import Callable

    from rospy_shim.node import Node

DEBUG = 1  # the levels of rosgraph_msgs/Log
INFO = 2
WARN = 4
ERROR = 8
FATAL = 16

PYTHON_LEVELS = {DEBUG: 10, INFO: 20, WARN: 30, ERROR: 40, FATAL: 50}
_SHOWN = {10: "DEBUG", 20: "INFO", 30: "WARN", 40: "ERROR", 50: "FATAL"}
_ROS_LEVELS = {number: level for level, number in PYTHON_LEVELS.items()}
_TOP = "rosout"


class Logs:
    """The log functions of one node.

    Args:
        node: the node.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._once: set[tuple[str, int, int]] = set()
        self._last: dict[tuple[str, int, int], int] = {}
        self._last_text: dict[tuple[str, int, int], tuple[int, str]] = {}
        self._logging: Any = None
        self._formatter: Any = None
        for name, level in (("debug", 10), ("info", 20), ("warn", 30), ("err", 40), ("fatal", 50)):
            self._add(name, level)

    logdebug: Callable[..., None]
    loginfo: Callable[..., None]
    logwarn: Callable[..., None]
    logerr: Callable[..., None]
    logfatal: Callable[..., None]

    @property
    def logging(self) -> Any:
        """The node's own module `logging`."""
        if self._logging is None:
            self._logging = self._node.universe.importer.load("logging")
        return self._logging

    def _add(self, name: str, level: int) -> None:
        """The five functions of a level. They look at the call site, so they are called by the node directly."""

        def log(msg: Any, *args: Any, **kwargs: Any) -> None:
            self._log(level, msg, args, kwargs)

        def log_once(msg: Any, *args: Any, **kwargs: Any) -> None:
            site = _call_site()
            if site not in self._once:
                self._once.add(site)
                self._log(level, msg, args, kwargs)

        def log_throttle(period: Any, msg: Any, *args: Any, **kwargs: Any) -> None:
            if self._is_due(_call_site(), period):
                self._log(level, msg, args, kwargs)

        def log_throttle_identical(period: Any, msg: Any, *args: Any, **kwargs: Any) -> None:
            if self._is_new(_call_site(), period, str(msg)):
                self._log(level, msg, args, kwargs)

        for suffix, function in (
            ("", log),
            ("_once", log_once),
            ("_throttle", log_throttle),
            ("_throttle_identical", log_throttle_identical),
        ):
            function.__name__ = function.__qualname__ = f"log{name}{suffix}"
            setattr(self, function.__name__, function)

    def _log(self, level: int, msg: Any, args: tuple[Any, ...], kwargs: dict[str, Any]) -> None:
        name = kwargs.pop("logger_name", None)
        kwargs.setdefault("stacklevel", 3)  # the node's line, behind this function and the one that it called
        logger = self.logging.getLogger(f"{_TOP}.{name}" if name else _TOP)
        logger.log(level, msg, *args, **kwargs)

    def _is_due(self, site: tuple[str, int, int], period: Any) -> bool:
        now = self._node.clock.now_ns()
        if now - self._last.get(site, -1 << 62) < nanoseconds(period):
            return False
        self._last[site] = now
        return True

    def _is_new(self, site: tuple[str, int, int], period: Any, text: str) -> bool:
        now = self._node.clock.now_ns()
        when, former = self._last_text.get(site, (-1 << 62, ""))
        if former == text and now - when < nanoseconds(period):
            return False
        self._last_text[site] = now, text
        return True

    def configure(self, level: int, publish: bool) -> None:
        """`init_node`: show records from a level on, and publish them on /rosout.

        Args:
            level: one of rosgraph_msgs/Log's.
            publish: whether /rosout gets them.
        """
        logger = self.logging.getLogger(_TOP)
        logger.setLevel(PYTHON_LEVELS[level])
        logger.propagate = False
        self._formatter = self.logging.Formatter()
        logger.addHandler(self._handler(self._show))
        if publish:
            self._node.link(ROSOUT, message_class("rosgraph_msgs/Log"))
            logger.addHandler(self._handler(self._publish))

    def _handler(self, emit: Callable[[Any], None]) -> Any:
        handler = self.logging.Handler()
        handler.emit = emit
        handler.setFormatter(self._formatter)
        return handler

    def _show(self, record: Any) -> None:
        """A line on the console: warnings and worse on stderr."""
        text = self._formatter.format(record)
        level = _SHOWN.get(record.levelno, record.levelname)
        seconds, rest = divmod(self._node.universe.clock.epoch_ns + self._node.kernel.now, NS_PER_S)
        streams = self._node.universe.importer.modules["sys"]
        stream = streams.stderr if record.levelno >= 30 else streams.stdout
        stream.write(f"[{level}] [{seconds}.{rest // 1000:06d}]: {text}\n")

    def _publish(self, record: Any) -> None:
        link = self._node.links.get(ROSOUT)
        if link is None or not link.get_num_connections():
            return
        log = message_class("rosgraph_msgs/Log")()
        log.header.stamp = MessageTime(*divmod(self._node.universe.clock.epoch_ns + self._node.kernel.now, NS_PER_S))
        log.level = _ROS_LEVELS.get(record.levelno, INFO)
        log.name = self._node.names.name
        log.msg = record.getMessage()
        log.file, log.function, log.line = record.filename, record.funcName, record.lineno
        log.topics = list(self._node.links)
        link.send(log)


def _call_site() -> tuple[str, int, int]:
    """Where the node called the log function from: file, line and byte code offset."""
    frame = sys._getframe(2)
    return frame.f_code.co_filename, frame.f_lineno, frame.f_lasti
