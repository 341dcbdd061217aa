"""Where log records go: the console in the format of ROSCONSOLE_FORMAT, the topic /rosout, a log file.

The classes are made for each node on its own `logging` (rosgraph.roslogging.RosStreamHandler,
rospy.impl.rosout.RosOutHandler). Imports nothing of cfepy.
"""

from __future__ import annotations

import os
import re
from typing import TYPE_CHECKING, Any

from cfepy.rtos.units import NS_PER_S
from rospy_shim.genpy import Time as MessageTime
from rospy_shim.msg_ids import ROSOUT

if TYPE_CHECKING:
    from rospy_shim.node import Node

LEVELS = {1: 10, 2: 20, 4: 30, 8: 40, 16: 50}
"""rosgraph_msgs/Log's levels, and Python's."""
SHOWN = {"DEBUG": "DEBUG", "INFO": "INFO", "WARNING": "WARN", "ERROR": "ERROR", "CRITICAL": "FATAL"}
FILE_FORMAT = "[%(name)s][%(levelname)s] %(asctime)s: %(message)s"
WARNING = 30

_ROS_LEVELS = {number: level for level, number in LEVELS.items()}
_COLORS = {"DEBUG": "\033[32m", "WARN": "\033[33m", "ERROR": "\033[31m", "FATAL": "\033[31m"}
_TAG = re.compile(r"\$\{(\w+)(?::([^}]*))?\}")


def make_stream_handler(node: Node) -> type:
    """The class of the handler that writes to a node's console."""
    base: Any = node.logs.logging.Handler
    as_text = node.logs.logging.Formatter().format

    class RosStreamHandler(base):  # type: ignore[misc]  # the base exists in the node's module universe only
        """Writes records on the console, warnings and worse on stderr.

        Args:
            colorize: in colour, if the stream is a terminal.
            stdout: stream for the others; None is sys.stdout as it is now.
            stderr: stream for warnings and worse; None is sys.stderr as it is now.
        """

        def __init__(self, colorize: bool = True, stdout: Any = None, stderr: Any = None) -> None:
            super().__init__()
            streams = node.universe.importer.modules["sys"]
            self._stdout = stdout or streams.stdout
            self._stderr = stderr or streams.stderr
            self._colorize = colorize

        def emit(self, record: Any) -> None:
            """Write a record."""
            level = SHOWN.get(record.levelname, record.levelname)
            form = node.universe.environ.get("ROSCONSOLE_FORMAT")
            message = as_text(record)
            if form is None:
                text = f"[{level}] [{_time(node)}]: {message}\n"
            else:
                text = _filled(node, form, level, message, record) + "\n"
            stream = self._stdout if record.levelno < WARNING else self._stderr
            color = _COLORS.get(level) if self._colorize and getattr(stream, "isatty", bool)() else None
            stream.write(f"{color}{text}\033[0m" if color else text)

    RosStreamHandler.__module__ = "rosgraph.roslogging"
    RosStreamHandler.__qualname__ = "RosStreamHandler"
    return RosStreamHandler


def _time(node: Node, shape: str | None = None) -> str:
    """The mission's time, in a form of `time.strftime` if one is given; with simulated time behind it if that is used.

    Args:
        node: whose time.
        shape: the form; None shows seconds.
    """
    wall = _wall(node, shape)
    return wall if node.clock.is_wallclock() else f"{wall}, {node.clock.get_time():f}"


def _wall(node: Node, shape: str | None) -> str:
    if shape is not None:
        return str(node.universe.importer.load("time").strftime(shape))
    seconds, rest = divmod(node.clock.wall_ns(), NS_PER_S)
    return f"{seconds}.{rest // 1000:06d}"


def _filled(node: Node, form: str, level: str, message: str, record: Any) -> str:
    """A line in the form that ROSCONSOLE_FORMAT gives (wiki.ros.org/rosconsole)."""
    values = {
        "severity": level,
        "message": message,
        "thread": record.thread,
        "logger": record.name,
        "file": record.pathname,
        "line": record.lineno,
        "function": record.funcName,
        "node": node.names.name,
    }

    def value(found: re.Match[str]) -> str:
        name, shape = found.groups()
        if name == "time":
            return _time(node, shape)
        if name == "walltime":
            return _wall(node, shape)
        return str(values.get(name, found.group()))

    return _TAG.sub(value, form)


def make_rosout_handler(node: Node) -> type:
    """The class of the handler that publishes a node's records on /rosout."""
    base: Any = node.logs.logging.Handler

    class RosOutHandler(base):  # type: ignore[misc]  # the base exists in the node's module universe only
        """Publishes records on /rosout."""

        def emit(self, record: Any) -> None:
            """Publish a record."""
            link = node.links.get(ROSOUT)
            if link is not None:
                link.send(_message(node, self.format(record), record))

    RosOutHandler.__module__ = "rospy.impl.rosout"
    RosOutHandler.__qualname__ = "RosOutHandler"
    return RosOutHandler


def _message(node: Node, text: str, record: Any) -> Any:
    """A record as rosgraph_msgs/Log."""
    log = node.library.message_class("rosgraph_msgs/Log")()
    log.header.stamp = MessageTime(*divmod(node.clock.now_ns(), NS_PER_S))
    log.level = _ROS_LEVELS.get(record.levelno, _ROS_LEVELS[20])
    log.name = node.names.name
    log.msg = text
    log.file, log.function, log.line = record.filename, record.funcName, record.lineno
    if not node.params.get_param("/rosout_disable_topics_generation", False):
        log.topics = list(dict.fromkeys([*node.links, *node.subscriptions]))
    return log


def log_file(node: Node, name: str) -> str:
    """Where a log file lies: what `__log:=` says, or a file in the folder of ROS's log files.

    Args:
        node: the node.
        name: of the file there.
    """
    path = node.names.get_mappings().get("__log")
    if path is None:
        environ = node.universe.environ
        home = environ.get("ROS_HOME") or os.path.join(environ.get("HOME", "/"), ".ros")
        path = os.path.join(environ.get("ROS_LOG_DIR") or os.path.join(home, "log"), name)
    return str(node.universe.resolve(path))
