"""rospy's logging: `loginfo` and related functions, on the node's own `logging`, and the outputs of records.

Records pass through the logger "rosout", so that a node can add handlers and set levels. They are shown on the console
in the format of ROSCONSOLE_FORMAT and sent to the topic /rosout. As in rospy, `init_node` sets up the root logger too,
whose records go to a log file, not to the console. The handlers' classes are made for each node on its own `logging`
(rosgraph.roslogging.RosStreamHandler, rospy.impl.rosout.RosOutHandler). Every node offers the services `~get_loggers`
and `~set_logger_level`.
"""

from __future__ import annotations

import os
import re
import sys
from types import FrameType
from typing import TYPE_CHECKING, Any, ClassVar

from cfepy.reading.texts import without_addresses
from cfepy.units import NS_PER_S
from rospy_shim.client.rostime import Duration
from rospy_shim.client.service import make_quiet_service
from rospy_shim.graph.msg_ids import ROSOUT
from rospy_shim.types.exceptions import ROSException
from rospy_shim.types.genpy import Time as MessageTime

if TYPE_CHECKING:
    from collections.abc import Callable

    from rospy_shim.client.node import Node

LEVELS = {1: 10, 2: 20, 4: 30, 8: 40, 16: 50}
"""rosgraph_msgs/Log's levels, and Python's."""
SHOWN = {"DEBUG": "DEBUG", "INFO": "INFO", "WARNING": "WARN", "ERROR": "ERROR", "CRITICAL": "FATAL"}
FILE_FORMAT = "[%(name)s][%(levelname)s] %(asctime)s: %(message)s"
WARNING = 30
_ROS_LEVELS = {number: level for level, number in LEVELS.items()}
_COLORS = {"DEBUG": "\033[32m", "WARN": "\033[33m", "ERROR": "\033[31m", "FATAL": "\033[31m"}
_TAG = re.compile(r"\$\{(\w+)(?::([^}]*))?\}")
DEBUG = 1  # the levels of rosgraph_msgs/Log
INFO = 2
WARN = 4
ERROR = 8
FATAL = 16
Site = tuple[str, int, int]
"""The call site of a log function: file, line and byte code offset."""
_TOP = "rosout"
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
"""Loggers that every node with rospy has."""


def make_stream_handler(node: Node) -> type:
    """Make the class of the handler that writes to a node's console."""
    base: Any = node.logs.logging.Handler
    as_text = node.logs.logging.Formatter().format

    class RosStreamHandler(base):  # type: ignore[misc]  # the base exists in the node's module universe only
        """Writes records on the console, warnings and worse on stderr.

        Args:
            colorize: in colour, if the stream is a terminal.
            stdout: stream for the others; None is the present sys.stdout.
            stderr: stream for warnings and worse; None is the present sys.stderr.
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
    """Format the mission's time, followed by simulated time if the node uses it.

    Args:
        node: the node.
        shape: a format of `time.strftime`; None shows seconds.
    """
    wall = _wall(node, shape)
    return wall if node.clock.is_wallclock() else f"{wall}, {node.clock.get_time():f}"


def _wall(node: Node, shape: str | None) -> str:
    if shape is not None:
        return str(node.universe.importer.load("time").strftime(shape))
    seconds, rest = divmod(node.clock.wall_ns(), NS_PER_S)
    return f"{seconds}.{rest // 1000:06d}"


def _filled(node: Node, form: str, level: str, message: str, record: Any) -> str:
    """Return a line in the format of ROSCONSOLE_FORMAT (wiki.ros.org/rosconsole)."""
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
    """Make the class of the handler that publishes a node's records on /rosout."""
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
    """Return a record as rosgraph_msgs/Log."""
    log = node.library.message_class("rosgraph_msgs/Log")()
    log.header.stamp = MessageTime(*divmod(node.clock.now_ns(), NS_PER_S))
    log.level = _ROS_LEVELS.get(record.levelno, _ROS_LEVELS[20])
    log.name = node.names.name
    log.msg = without_addresses(text)
    log.file, log.function, log.line = record.filename, record.funcName, record.lineno
    if not node.params.asked_by_rosout("/rosout_disable_topics_generation"):
        log.topics = list(dict.fromkeys([*node.links, *node.subscriptions]))
    return log


def log_file(node: Node, name: str) -> str:
    """Return the path of a log file, from `__log:=`, or in the folder of ROS's log files.

    Args:
        node: the node.
        name: name of the file there.
    """
    path = node.names.get_mappings().get("__log")
    if path is None:
        environ = node.universe.environ
        home = environ.get("ROS_HOME") or os.path.join(environ.get("HOME", "/"), ".ros")
        path = os.path.join(environ.get("ROS_LOG_DIR") or os.path.join(home, "log"), name)
    return node.universe.absolute(path)


class Logs:
    """The log functions of one node.

    Args:
        node: the node.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self.once = LoggingOnce()
        self.LoggingThrottle = type("LoggingThrottle", (LoggingThrottle,), {"__module__": "rospy.core", "_node": node})
        self.throttle: LoggingThrottle = self.LoggingThrottle()
        self.identical = LoggingIdentical()
        self.file: str | None = None
        self._logging: Any = None
        self._postponed: list[Callable[[], None]] = []
        self._handlers: dict[str, type] = {}
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

    @property
    def RosStreamHandler(self) -> type:  # rospy's name
        """The class of the handler for the console."""
        return self._handlers.get("console") or self._handlers.setdefault("console", make_stream_handler(self._node))

    @property
    def RosOutHandler(self) -> type:  # rospy's name
        """The class of the handler for /rosout."""
        return self._handlers.get("rosout") or self._handlers.setdefault("rosout", make_rosout_handler(self._node))

    # -- log functions -----------------------------------------------------------------------------------------------

    def _add(self, name: str, level: int) -> None:
        """Add the four functions of a level. They look at the call site, so the node must call them directly."""

        def log(msg: Any, *args: Any, **kwargs: Any) -> None:
            self._log(level, msg, args, kwargs)

        def log_once(msg: Any, *args: Any, **kwargs: Any) -> None:
            if self.once(_call_site()):
                self._log(level, msg, args, kwargs)

        def log_throttle(period: Any, msg: Any, *args: Any, **kwargs: Any) -> None:
            if not period or self.throttle(_call_site(), period):
                self._log(level, msg, args, kwargs)

        def log_throttle_identical(period: Any, msg: Any, *args: Any, **kwargs: Any) -> None:
            site = _call_site()
            due = period is not None and self.throttle(site, period)
            if self.identical(site, msg) or due:
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
        logger = self.logging.getLogger(f"{_TOP}.{name}" if name else _TOP)
        if logger.isEnabledFor(level):
            logger.handle(_record(logger, level, sys._getframe(2), msg, args, **kwargs))

    # -- set-up ------------------------------------------------------------------------------------------------------

    def configure(self, level: int | None, publish: bool) -> None:
        """Show records, and publish them on /rosout; called by `init_node`.

        Args:
            level: the lowest level of records, one of rosgraph_msgs/Log's; None is INFO.
            publish: publish them on /rosout.
        """
        environ, mappings = self._node.universe.environ, self._node.names.get_mappings()
        keep = "__log" in mappings or "ROS_LOG_DIR" in environ
        self.file = self._file_of(self._node.names.name)
        if publish:
            self.init_rosout()

        def work() -> None:
            self._set_up(self._node.names.name, keep)
            if publish:
                self.load_rosout_handlers(level)

        self._postponed.append(work)
        if keep or "logging" in self._node.universe.importer.modules:
            self.load_logging()

    def load_logging(self) -> Any:
        """Return the node's `logging`, set up as `init_node` asked for.

        It is a third of the cost of a small node, so nodes that neither log nor import it do without.
        """
        logging = self._node.universe.importer.load_standard("logging")
        work, self._postponed = self._postponed, []
        for each in work:
            each()
        return logging

    def init_rosout(self) -> bool:
        """Publish /rosout."""
        link = self._node.link(ROSOUT, self._node.library.message_class("rosgraph_msgs/Log"))
        link.enable_latch()
        return True

    def load_rosout_handlers(self, level: int | None) -> None:
        """Publish records on /rosout.

        Args:
            level: the lowest level of records, one of rosgraph_msgs/Log's; None leaves it unchanged.
        """
        logger = self.logging.getLogger(_TOP)
        logger.addHandler(self.RosOutHandler())
        if level is not None:
            logger.setLevel(LEVELS[level])

    def configure_logging(self, node_name: str, level: int = 20) -> None:
        """Set up the loggers, and keep a log file (rospy.core.configure_logging).

        Args:
            node_name: resolved name of the node; the file is named after it.
            level: accepted, and without effect, as in rospy.

        Raises:
            ROSException: the name is "/".
        """
        self._set_up(node_name, keep=True)

    def _set_up(self, node_name: str, keep: bool) -> None:
        self.file = self._file_of(node_name)
        root, rosout = self.logging.getLogger(), self.logging.getLogger(_TOP)
        self._refit(root, self._file_handler() if keep else self.logging.NullHandler())
        self._refit(rosout, self.RosStreamHandler())

    def _file_of(self, node_name: str) -> str:
        stem = node_name.replace("/", "_").removeprefix("_")
        if not stem:
            raise ROSException(f"invalid configure_logging parameter: {node_name}")
        return log_file(self._node, f"{stem}.log")

    def _refit(self, logger: Any, handler: Any) -> None:
        """Give a logger one handler in place of its present ones."""
        for former in logger.handlers[:]:
            logger.removeHandler(former)
        logger.addHandler(handler)
        logger.setLevel(self.logging.INFO)

    def _file_handler(self) -> Any:
        os_module = self._node.universe.importer.load("os")
        os_module.makedirs(os.path.dirname(str(self.file)), exist_ok=True)
        handler = self.logging.FileHandler(self.file)
        handler.setFormatter(self.logging.Formatter(FILE_FORMAT))
        return handler


class LoggingOnce:
    """Decides whether a call site logs for the first time (rospy.core.LoggingOnce)."""

    __module__ = "rospy.core"

    def __init__(self) -> None:
        self.called_caller_ids: set[object] = set()

    def __call__(self, caller_id: object) -> bool:
        """Return True for the first call of a call site."""
        first = caller_id not in self.called_caller_ids
        self.called_caller_ids.add(caller_id)
        return first


class LoggingThrottle:
    """Decides whether a call site last logged longer ago than a period, or later than now (rospy.core.LoggingThrottle).

    Each node has a subclass that knows the node.
    """

    __module__ = "rospy.core"
    _node: ClassVar[Node]

    def __init__(self) -> None:
        self.last_logging_time_table: dict[object, int] = {}  # ns

    def __call__(self, caller_id: object, period: Any) -> bool:
        """Return True if a call site may log; `period` is in s.

        Raises:
            ROSInitException: before `init_node`.
        """
        now = self._node.clock.now_ns()
        last = self.last_logging_time_table.get(caller_id)
        if last is not None and last <= now <= last + Duration(period).to_nsec():
            return False
        if last is not None and last > now:
            self.last_logging_time_table.clear()
        self.last_logging_time_table[caller_id] = now
        return True


class LoggingIdentical:
    """Decides whether a call site logs another text than the last time (rospy.core.LoggingIdentical)."""

    __module__ = "rospy.core"

    def __init__(self) -> None:
        self.last_logging_msg_table: dict[object, str] = {}

    def __call__(self, caller_id: object, msg: Any) -> bool:
        """Return True if the text of a call site is new."""
        text = str(msg)
        new = self.last_logging_msg_table.get(caller_id) != text
        self.last_logging_msg_table[caller_id] = text
        return new


def _record(
    logger: Any,
    level: int,
    frame: FrameType,
    msg: Any,
    args: tuple[Any, ...],
    *,
    exc_info: Any = None,
    extra: dict[str, Any] | None = None,
    stack_info: bool = False,
    stacklevel: int = 1,
) -> Any:
    """Make a record of `logging` that names the line of the node, and the function with its class as rospy does."""
    for _ in range(stacklevel - 1):
        frame = frame.f_back or frame
    if isinstance(exc_info, BaseException):
        exc_info = (type(exc_info), exc_info, exc_info.__traceback__)
    elif exc_info and not isinstance(exc_info, tuple):
        exc_info = sys.exc_info()
    code, owner = frame.f_code, frame.f_locals.get("self")
    function = code.co_name if owner is None else f"{type(owner).__name__}.{code.co_name}"
    stack = logger.findCaller(stack_info, 4)[3] if stack_info else None
    where = (code.co_filename, frame.f_lineno)
    return logger.makeRecord(logger.name, level, *where, msg, args, exc_info or None, function, extra, stack)


def _call_site() -> Site:
    """Return the place of the node's call of the log function."""
    frame = sys._getframe(2)
    return frame.f_code.co_filename, frame.f_lineno, frame.f_lasti


class LoggerServices:
    """The two services of a node.

    Args:
        node: the node.
    """

    def __init__(self, node: Node) -> None:
        self._node = node

    def offer(self) -> None:
        """Offer them; called by `init_node`."""
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
