"""ROS's own tools as commands: rosbag, rosmsg, rossrv, rosnode, tf; their options are defined here.

A command belongs here if it is one of ROS's own and its library for nodes exists already. It gets the words of the
command line unchanged, so its output is the same as for a node (`cfepy.cli.ros_tools.tool`).
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import Any

from cfepy.cli.options import (
    MISSION_HELP,
    add_count,
    add_drawing,
    add_mission,
    add_run_options,
    count_of,
    factor_of,
    seconds_of,
)

_FILE_STATUS = "exit status: 0 well, 1 it could not be done, 2 bad usage"
_STATUS = "exit status: 0 well, 1 nothing was found or something failed, 2 bad usage, or a mission that cannot boot"
_Actions = argparse._SubParsersAction


class _Handed(argparse.Action):
    """An option that is passed on to the tool unchanged."""

    def __call__(self, parser: Any, namespace: Any, values: Any, option_string: str | None = None) -> None:
        words = [self.option_strings[0], *([] if self.nargs == 0 else [values])]
        setattr(namespace, self.dest, [*getattr(namespace, self.dest), *words])


def add(commands: _Actions[argparse.ArgumentParser]) -> None:
    """Add these commands to the parser of `cfepy`."""
    _add_rosbag(commands)
    for tool, what in (("rosmsg", "message"), ("rossrv", "service")):
        _add_definitions(commands, tool, what)
    _add_rosnode(commands)
    _add_tf(commands)


def _tool(commands: _Actions[argparse.ArgumentParser], name: str, text: str) -> _Actions[argparse.ArgumentParser]:
    tool = commands.add_parser(name, help=text, description=f"{text[0].upper()}{text[1:]}, as {name} does.")
    tool.set_defaults(module="cfepy.cli.ros_tools.tool", tool=name)
    return tool.add_subparsers(metavar="ACTION", dest="action", required=True)


def _action(
    actions: _Actions[argparse.ArgumentParser], name: str, text: str, status: str = _STATUS
) -> argparse.ArgumentParser:
    action = actions.add_parser(name, help=text, description=f"{text[0].upper()}{text[1:]}.", epilog=status)
    action.set_defaults(handed=[])
    return action


def _hand(action: argparse.ArgumentParser, *names: str, text: str, value: str | None = None) -> None:
    """Add an option that is passed on to the tool, with a value or without one."""
    shape: dict[str, Any] = {"nargs": 0} if value is None else {"metavar": value}
    action.add_argument(*names, action=_Handed, dest="handed", default=[], help=text, **shape)


# -- rosbag ------------------------------------------------------------------------------------------------------------

_ELSEWHERE = {
    "record": "`cfepy run MISSION --bag FILE` records the topics of a run",
    "play": "`cfepy run MISSION --play FILE` plays a bag into a mission",
    "fix": "there are no migration rules here; `cfepy rosbag check FILE` says what does not fit",
}
"""Hints for actions of rosbag that other commands replace, or that are not available."""


def _add_rosbag(commands: _Actions[argparse.ArgumentParser]) -> None:
    actions = _tool(commands, "rosbag", "look into bags and write them anew")
    info = _bags(_action(actions, "info", "tell what is in bags", _FILE_STATUS))
    _hand(info, "-y", "--yaml", text="as YAML")
    _hand(info, "-k", "--key", text="only one value of the YAML, such as messages", value="KEY")
    _hand(info, "--freq", text="with the frequencies of topics")
    check = _action(actions, "check", "tell which messages of a bag have other definitions than here", _FILE_STATUS)
    check.add_argument("words", metavar="BAG", nargs=1)
    chosen = _action(actions, "filter", "copy some messages of a bag", _FILE_STATUS)
    text = "the bag, the new bag, and a Python expression of topic, m (the message) and t, such as 'topic == \"/tf\"'"
    chosen.add_argument("words", metavar=("BAG", "NEW_BAG", "EXPRESSION"), nargs=3, help=text)
    _hand(chosen, "-p", "--print", text="an expression to print for each message", value="EXPRESSION")
    compress = _rewrite(actions, "compress", "compress bags")
    _hand(compress, "-j", "--bz2", text="with bz2 (as it is anyway)")
    _hand(compress, "--lz4", text="with LZ4")
    _rewrite(actions, "decompress", "decompress bags")
    _rewrite(actions, "reindex", "make the index of bags anew, after a recording was broken off")
    for name, hint in _ELSEWHERE.items():
        other = actions.add_parser(name, help=hint, description=f"{hint}.")
        other.add_argument("words", nargs="*", help=argparse.SUPPRESS)
        other.set_defaults(elsewhere=hint, hint=f"; {hint}")


def _bags(action: argparse.ArgumentParser) -> argparse.ArgumentParser:
    action.add_argument("words", metavar="BAG", nargs="+")
    return action


def _rewrite(actions: _Actions[argparse.ArgumentParser], name: str, text: str) -> argparse.ArgumentParser:
    action = _bags(_action(actions, name, text, _FILE_STATUS))
    _hand(action, "--output-dir", text="where to; the default keeps the old bag as NAME.orig.bag", value="DIR")
    _hand(action, "-f", "--force", text="write over an older NAME.orig.bag")
    _hand(action, "-q", "--quiet", text="say less")
    return action


# -- rosmsg, rossrv ----------------------------------------------------------------------------------------------------


def _add_definitions(commands: _Actions[argparse.ArgumentParser], tool: str, what: str) -> None:
    actions = _tool(commands, tool, f"show the definitions of {what}s")
    for name in ("show", "info"):
        show = _action(actions, name, f"show the definition of a {what}", _FILE_STATUS)
        show.add_argument("words", metavar="TYPE", nargs=1, help="such as geometry_msgs/Pose, or Pose of any package")
        _hand(show, "-r", "--raw", text="as it was written, with comments")
        if what == "message":
            _hand(show, "-b", "--bag", text="as a bag has it; then with its package", value="BAG")
    _action(actions, "list", f"list all {what}s", _FILE_STATUS)
    md5 = _action(actions, "md5", f"show the md5sum of a {what}", _FILE_STATUS)
    md5.add_argument("words", metavar="TYPE", nargs=1)
    package = _action(actions, "package", f"list the {what}s of a package", _FILE_STATUS)
    package.add_argument("words", metavar="PACKAGE", nargs=1)
    packages = _action(actions, "packages", f"list the packages that have {what}s", _FILE_STATUS)
    for each in (package, packages):
        _hand(each, "-s", text="all on one line")


# -- rosnode -----------------------------------------------------------------------------------------------------------


def _add_rosnode(commands: _Actions[argparse.ArgumentParser]) -> None:
    actions = _tool(commands, "rosnode", "ask for the nodes of a mission that is flown for it")
    listing = _flown(actions, "list", "list the nodes", words=("NAMESPACE", "?"))
    _hand(listing, "-u", text="their URIs instead")
    _hand(listing, "-a", "--all", text="with their URIs")
    info = _flown(actions, "info", "show what nodes publish, subscribe to and offer", words=("NODE", "+"))
    _hand(info, "-q", "--quiet", text="without their connections")
    ping = _flown(actions, "ping", "see whether a node answers", words=("NODE", "?"))
    _hand(ping, "-a", "--all", text="all nodes, once each")
    ping.add_argument("-c", dest="pings", type=count_of, default=3, metavar="N", help="how often (default: 3)")
    _flown(actions, "machine", "list the computers, or the nodes on one", words=("MACHINE", "?"))
    kill = _flown(actions, "kill", "end nodes, and fly on", words=("NODE", "*"))
    _hand(kill, "-a", "--all", text="all nodes")
    _flown(actions, "cleanup", "forget the nodes that do not answer, after others were killed")


def _flown(
    actions: _Actions[argparse.ArgumentParser], name: str, text: str, words: tuple[str, str] | None = None
) -> argparse.ArgumentParser:
    """Add an action on a mission that is flown for it."""
    action = _action(actions, name, text)
    add_mission(action, "source")
    if words is not None:
        action.add_argument("words", metavar=words[0], nargs=words[1])
    add_run_options(action)
    action.add_argument(
        "--at", type=seconds_of, metavar="SECONDS", help="virtual time of the run to do it (default: its end)"
    )
    return action


# -- tf ----------------------------------------------------------------------------------------------------------------


def _add_tf(commands: _Actions[argparse.ArgumentParser]) -> None:
    actions = _tool(commands, "tf", "show the transforms of a mission that is flown for it, or of a bag")
    echo = _action(actions, "echo", "print the transform between two frames again and again")
    _source(echo)
    echo.add_argument("words", nargs=2, metavar=("SOURCE_FRAME", "TARGET_FRAME"), help="from where, and what is seen")
    echo.add_argument("-r", "--rate", type=factor_of, default=1.0, metavar="HZ", help="how often (default: 1)")
    add_count(echo, "transforms")
    frames = _action(actions, "frames", "show the tree of frames, as view_frames draws it")
    _source(frames)
    add_drawing(frames, "dot", "write the tree for graphviz, as view_frames does,")
    frames.add_argument("--pdf", metavar="FILE", help="draw it with graphviz")


def _source(action: argparse.ArgumentParser) -> None:
    add_mission(action, "source", metavar="MISSION|BAG", help=f"a bag, or {MISSION_HELP}")
    add_run_options(action)


def words_of(arguments: argparse.Namespace, more: Sequence[str] = ()) -> list[str]:
    """Return the command line of the tool itself.

    Args:
        arguments: the command line of `cfepy`.
        more: words after its options.
    """
    words = getattr(arguments, "words", None) or []
    return [arguments.action, *arguments.handed, *more, *([words] if isinstance(words, str) else words)]
