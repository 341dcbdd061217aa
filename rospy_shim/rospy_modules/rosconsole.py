"""rospy.rosconsole: the program `rosconsole`, which shows log messages, and shows and sets the levels of loggers."""

from __future__ import annotations

import re
import sys
from argparse import ArgumentParser
from collections.abc import Sequence
from datetime import datetime
from typing import Any, ClassVar, NoReturn

import rosgraph
import rospy
from rosgraph_msgs.msg import Log
from rospy.logger_level_service_caller import LoggerLevelServiceCaller, ROSConsoleException

__all__ = ["NAME", "RosConsoleEcho", "error", "main"]

NAME = "rosconsole"
USAGE = """rosconsole shows and sets the loggers of nodes.

Commands:
\trosconsole get\tshow the level of a logger: NODE LOGGER
\trosconsole list\tshow the loggers of a node: NODE
\trosconsole set\tset the level of a logger: NODE LOGGER LEVEL
\trosconsole echo\tshow log messages: [NAME PATTERN]
"""


def error(status: int, msg: str) -> NoReturn:
    """Exit with a message."""
    print(f"{NAME}: error: {msg}", file=sys.stderr)
    sys.exit(status)


class RosConsoleEcho:
    """Prints log messages.

    Args:
        options: filter (a pattern for names of nodes), level, nocolor, verbose, once, topic.
    """

    LEVEL_COLOR: ClassVar[dict[str, int]] = {"DEBUG": 92, "INFO": 97, "WARN": 93, "ERROR": 91, "FATAL": 95}
    LEVEL_MAX_LENGTH = 5

    def __init__(self, options: Any) -> None:
        self._filter = re.compile(options.filter)
        self._level = getattr(Log, options.level.upper())
        self._options = options
        self._shown = {getattr(Log, level): self._show(level) for level in self.LEVEL_COLOR}
        rospy.Subscriber(options.topic, Log, self._on_log)

    def _show(self, level: str) -> str:
        text = level.ljust(self.LEVEL_MAX_LENGTH)
        return text if self._options.nocolor else f"\033[{self.LEVEL_COLOR[level]}m{text}\033[0m"

    @staticmethod
    def get_levels() -> list[str]:
        """Return the levels, the least severe first."""
        return sorted(RosConsoleEcho.LEVEL_COLOR, key=lambda level: int(getattr(Log, level)))

    def _on_log(self, message: Any) -> None:
        if message.level >= self._level and self._filter.search(message.name):
            self._print(message)
        if self._options.once:
            rospy.signal_shutdown("Done")

    def _print(self, message: Any) -> None:
        print(f"[ {self._shown[message.level]} ] [\033[1m{message.name}\033[21m]: {message.msg}")
        if self._options.verbose:
            stamp = message.header.stamp.to_sec()
            where = f"[{message.function}]: {message.file}:{message.line}"
            print(f"          [{datetime.fromtimestamp(stamp)} ({stamp:.6f})] {where}")


def main(argv: Sequence[str] | None = None) -> None:
    """Run the program.

    Args:
        argv: its command line, the program's name first; None is sys.argv.
    """
    words = rospy.myargv(sys.argv if argv is None else argv)
    commands = {"echo": _echo, "get": _get, "list": _list, "set": _set}
    if len(words) < 2 or words[1] not in commands:
        print(USAGE)
        sys.exit(0 if len(words) < 2 or words[1] in ("-h", "--help") else 1)
    try:
        commands[words[1]](words[2:])
    except (rosgraph.MasterException, ROSConsoleException) as failure:
        error(1, str(failure))


def _parse(command: str, words: Sequence[str], *names: str) -> tuple[LoggerLevelServiceCaller, Any]:
    """Parse the options of a command about a node, and get the node's loggers."""
    parser = ArgumentParser(prog=f"{NAME} {command}")
    for name in names:
        parser.add_argument(name)
    options = parser.parse_args(words)
    rospy.init_node(NAME, anonymous=True, disable_rosout=True, disable_signals=True)
    caller = LoggerLevelServiceCaller()
    caller.get_loggers(options.node)
    if "logger" in names and options.logger not in caller._current_levels:
        error(2, f"node {options.node} does not contain logger {options.logger}")
    return caller, options


def _list(words: Sequence[str]) -> None:
    caller, _ = _parse("list", words, "node")
    print("\n".join(caller._current_loggers))


def _get(words: Sequence[str]) -> None:
    caller, options = _parse("get", words, "node", "logger")
    print(caller._current_levels[options.logger])


def _set(words: Sequence[str]) -> None:
    caller, options = _parse("set", words, "node", "logger", "level")
    if options.level.lower() not in caller.get_levels():
        error(2, f"invalid level {options.level}")
    caller.send_logger_change_message(options.node, options.logger, options.level)


def _echo(words: Sequence[str]) -> None:
    parser = ArgumentParser(prog=f"{NAME} echo", description="Print logger messages")
    levels = [level.lower() for level in RosConsoleEcho.get_levels()]
    parser.add_argument("filter", metavar="FILTER", nargs="?", default=".*", help="pattern for names of nodes")
    parser.add_argument("-l", "--level", default="warn", choices=levels, help="least severe level that is shown")
    parser.add_argument("-1", "--once", action="store_true", help="end after one message")
    parser.add_argument("--topic", default="/rosout", help="topic of the messages")
    parser.add_argument("--nocolor", action="store_true", help="without color")
    parser.add_argument("-v", "--verbose", action="store_true", help="with time and place")
    options = parser.parse_args(words)
    rospy.init_node(NAME, anonymous=True)
    RosConsoleEcho(options)
    rospy.spin()
