"""Loggers of nodes (rclpy.logging). Lines go to standard error in the form of rcutils."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable
from enum import IntEnum
from typing import Any

from rclpy import _seam

__all__ = [
    "LoggingSeverity",
    "RcutilsLogger",
    "get_logger",
    "get_logger_effective_level",
    "get_logger_level",
    "get_logging_severity_from_string",
    "initialize",
    "set_logger_level",
    "shutdown",
]
_FORMAT = "[{severity}] [{time}] [{name}]: {message}"
_TOKEN = re.compile(r"\{(\w+)\}")
_OPTIONS = ("throttle_duration_sec", "throttle_time_source_type", "skip_first", "once")
_HERE = __file__
published: set[str] = set()
"""Names of the loggers whose lines are on /rosout: those of nodes, and their children."""


class LoggingSeverity(IntEnum):
    """Severities of lines."""

    UNSET = 0
    DEBUG = 10
    INFO = 20
    WARN = 30
    ERROR = 40
    FATAL = 50


_levels: dict[str, LoggingSeverity] = {"": LoggingSeverity.INFO}
"""Levels that were set, by the logger's name; "" is the default."""


class _Site:
    """A place in a program that logs with options; all calls there must have the same."""

    def __init__(self, severity: LoggingSeverity, options: dict[str, Any]) -> None:
        self.severity = severity
        self.options = options
        self.last_ns: int | None = None
        self.was_skipped = False
        self.was_logged = False

    def passes(self) -> bool:
        """Return True if a line passes the options: throttle, then skip_first, then once."""
        period = self.options.get("throttle_duration_sec")
        if period is not None:
            now = self._now()
            if self.last_ns is not None and now < self.last_ns + round(period * 1e9):
                return False
            self.last_ns = now
        if self.options.get("skip_first") and not self.was_skipped:
            self.was_skipped = True
            return False
        if self.options.get("once"):
            if self.was_logged:
                return False
            self.was_logged = True
        return True

    def _now(self) -> int:
        source = self.options.get("throttle_time_source_type")
        return _seam.steady_ns() if source is None or isinstance(source, str) else int(source.now().nanoseconds)


class RcutilsLogger:
    """A logger; a dot in its name separates it from its parent."""

    def __init__(self, name: str = "") -> None:
        self.name = name
        self._sites: dict[tuple[str, int], _Site] = {}

    def get_child(self, name: str) -> RcutilsLogger:
        """Return the child of a name.

        Raises:
            ValueError: the name is empty.
        """
        if not name:
            raise ValueError("Child logger name must not be empty.")
        full = f"{self.name}.{name}" if self.name else name
        if self.name in published:
            published.add(full)
        return RcutilsLogger(full)

    def set_level(self, level: LoggingSeverity | int) -> None:
        """Log lines of this severity or a higher one from now on."""
        set_logger_level(self.name, level)

    def get_effective_level(self) -> LoggingSeverity:
        """Return its level, or the one of its nearest parent with a level."""
        return get_logger_effective_level(self.name)

    def is_enabled_for(self, severity: LoggingSeverity | int) -> bool:
        """Return True if lines of a severity are logged."""
        return severity >= self.get_effective_level()

    def log(self, message: str, severity: LoggingSeverity | int, name: str | None = None, **options: Any) -> bool:
        """Log a line.

        Args:
            message: the text.
            severity: its severity.
            name: name of the logger; None takes this one's.
            options: `throttle_duration_sec`, `throttle_time_source_type` (a clock; otherwise the steady one counts),
                `skip_first` and `once`, which hold for the place of the call.

        Returns:
            True if the line was written.

        Raises:
            TypeError: an unknown option.
            ValueError: another call from the same place had another severity or other options.
        """
        severity = LoggingSeverity(severity)
        if not self.is_enabled_for(severity):
            return False
        frame = sys._getframe(1)
        while frame.f_code.co_filename == _HERE and frame.f_back is not None:
            frame = frame.f_back
        if options and not self._site(severity, options, (frame.f_code.co_filename, frame.f_lineno)).passes():
            return False
        _write(severity, self.name if name is None else name, str(message), frame)
        return True

    def _site(self, severity: LoggingSeverity, options: dict[str, Any], place: tuple[str, int]) -> _Site:
        unknown = sorted(set(options) - set(_OPTIONS))
        if unknown:
            raise TypeError(f'parameter "{unknown[0]}" is not one of the recognized logging options "{list(_OPTIONS)}"')
        if "throttle_time_source_type" in options and "throttle_duration_sec" not in options:
            raise TypeError('required parameter "throttle_duration_sec" not specified')
        site = self._sites.get(place)
        if site is None:
            site = self._sites[place] = _Site(severity, options)
        if site.severity != severity:
            raise ValueError("Logger severity cannot be changed between calls.")
        if site.options.keys() != options.keys():
            raise ValueError("Requested logging filters cannot be changed between calls.")
        return site

    def debug(self, message: str, **options: Any) -> bool:
        """Log a line of severity DEBUG; see `log`."""
        return self.log(message, LoggingSeverity.DEBUG, **options)

    def info(self, message: str, **options: Any) -> bool:
        """Log a line of severity INFO; see `log`."""
        return self.log(message, LoggingSeverity.INFO, **options)

    def warning(self, message: str, **options: Any) -> bool:
        """Log a line of severity WARN; see `log`."""
        return self.log(message, LoggingSeverity.WARN, **options)

    warn = warning

    def error(self, message: str, **options: Any) -> bool:
        """Log a line of severity ERROR; see `log`."""
        return self.log(message, LoggingSeverity.ERROR, **options)

    def fatal(self, message: str, **options: Any) -> bool:
        """Log a line of severity FATAL; see `log`."""
        return self.log(message, LoggingSeverity.FATAL, **options)


def _write(severity: LoggingSeverity, name: str, message: str, frame: Any) -> None:
    now = _seam.now_ns()
    tokens: dict[str, Callable[[], str]] = {
        "severity": lambda: severity.name,
        "time": lambda: f"{now // 10**9}.{now % 10**9:09d}",
        "time_as_nanoseconds": lambda: str(now),
        "name": lambda: name,
        "message": lambda: message,
        "function_name": lambda: str(frame.f_code.co_name),
        "file_name": lambda: str(frame.f_code.co_filename),
        "line_number": lambda: str(frame.f_lineno),
    }
    form = os.environ.get("RCUTILS_CONSOLE_OUTPUT_FORMAT") or _FORMAT
    line = _TOKEN.sub(lambda found: tokens[found[1]]() if found[1] in tokens else found[0], form)
    _seam.write(line + "\n")
    if name in published:
        code = frame.f_code
        _seam.log(now, int(severity), name, message, code.co_filename, code.co_name, frame.f_lineno)


def get_logger(name: str) -> RcutilsLogger:
    """Return a new logger of a name.

    Raises:
        ValueError: the name is empty.
    """
    if not name:
        raise ValueError("Logger name must not be empty.")
    return RcutilsLogger(name)


def initialize() -> None:
    """Do nothing: loggers need no preparation."""


def shutdown() -> None:
    """Do nothing: loggers hold nothing to release."""


def set_logger_level(name: str, level: LoggingSeverity | int, detailed_error: bool = False) -> None:
    """Set the level of the logger of a name; "" sets the default."""
    _levels[name] = LoggingSeverity(level)


def get_logger_level(name: str) -> LoggingSeverity:
    """Return the level that was set for a name, or UNSET."""
    return _levels.get(name, LoggingSeverity.UNSET)


def get_logger_effective_level(name: str) -> LoggingSeverity:
    """Return the level of a name, or the one of its nearest parent with a level."""
    while name:
        if level := _levels.get(name):
            return level
        name = name.rpartition(".")[0]
    return _levels[""]


def get_logging_severity_from_string(log_severity: str) -> LoggingSeverity:
    """Return the severity of a name such as "WARN".

    Raises:
        RuntimeError: it is not the name of a severity.
    """
    try:
        return LoggingSeverity[log_severity.upper()]
    except KeyError:
        raise RuntimeError(f"Failed to get severity from string: {log_severity}") from None
