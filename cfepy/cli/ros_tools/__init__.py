"""The commands rosnode, rosmsg, rossrv, rosbag and tf; their options are defined here.

A command belongs here if it is one of ROS's own and its library for nodes exists already. It gets the words of the
command line unchanged, so its output is the same as for a node (`cfepy.cli.ros_tools.tool`).
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import Any

from cfepy.cli.options import (
    MISSION_HELP,
    add_action,
    add_count,
    add_drawing,
    add_json,
    add_mission,
    add_output,
    add_run_options,
    count_of,
    factor_of,
    seconds_of,
)

_RECORDINGS = "cfepy.cli.ros_tools.recordings"
_RECORDING_STATUS = (
    "exit status: 0 well, 1 the file is damaged or was not finished, 2 bad usage, or no message is readable"
)
_FILE_STATUS = "exit status: 0 well, 1 it could not be done, 2 bad usage"
_STATUS = "exit status: 0 well, 1 nothing was found or something failed, 2 bad usage, or a mission that cannot boot"
_Actions = argparse._SubParsersAction


class _Handed(argparse.Action):
    """An option that is passed on to the tool unchanged."""

    def __call__(self, parser: Any, namespace: Any, values: Any, option_string: str | None = None) -> None:
        words = [self.option_strings[0], *([] if self.nargs == 0 else [values])]
        setattr(namespace, self.dest, [*getattr(namespace, self.dest), *words])


class _Recordings(argparse.Action):
    """Names of recordings. MCAP files go to cfepy's own command, since ROS's tool does not know them."""

    def __call__(self, parser: Any, namespace: Any, values: Any, option_string: str | None = None) -> None:
        setattr(namespace, self.dest, values)
        if all(each.endswith(".mcap") for each in values):
            namespace.module = _RECORDINGS


def add(commands: _Actions[argparse.ArgumentParser]) -> None:
    """Add these commands to the parser of `cfepy`."""
    _add_rosnode(commands)
    _add_definitions(
        commands,
        "rosmsg",
        "message",
        ("cfepy rosmsg show sensor_msgs/JointState", "cfepy rosmsg package geometry_msgs"),
        help="show the definitions of messages (rossrv: of services)",
    )
    _add_definitions(
        commands, "rossrv", "service", ("cfepy rossrv show std_srvs/SetBool", "cfepy rossrv package std_srvs")
    )
    _add_rosbag(commands)
    _add_tf(commands)


def _tool(
    commands: _Actions[argparse.ArgumentParser], name: str, description: str, examples: Sequence[str], **said: Any
) -> _Actions[argparse.ArgumentParser]:
    """Add a tool. Without `help` among `said`, the help of `cfepy` does not list it. Returns its actions."""
    tool = commands.add_parser(name, description=description, examples=examples, **said)
    tool.set_defaults(module="cfepy.cli.ros_tools.tool", tool=name)
    return tool.add_subparsers(metavar="ACTION", dest="action", required=True)


def _action(
    actions: _Actions[argparse.ArgumentParser], name: str, text: str, example: str, status: str = _STATUS
) -> argparse.ArgumentParser:
    action = add_action(actions, name, text, example, status)
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
    "fix": "cfepy has no migration rules; `cfepy rosbag check FILE` shows which definitions differ",
}
"""Hints for actions of rosbag that other commands replace, or that are not available."""


def _add_rosbag(commands: _Actions[argparse.ArgumentParser]) -> None:
    actions = _tool(
        commands,
        "rosbag",
        "Show, filter, compress, repair and convert bags and MCAP files.",
        ("cfepy rosbag info run.bag", "cfepy rosbag convert run.bag -o run.mcap"),
        help="show, filter, repair and convert bags and MCAP files",
        epilog=_RECORDING_STATUS,
    )
    info = _action(actions, "info", "show the contents of bags or MCAP files", "rosbag info run.bag", _FILE_STATUS)
    info.add_argument("words", metavar="BAG", nargs="+", action=_Recordings)
    _hand(info, "-y", "--yaml", text="as YAML")
    _hand(info, "-k", "--key", text="only one value of the YAML, such as messages", value="KEY")
    _hand(info, "--freq", text="with the frequencies of topics")
    check = _action(
        actions,
        "check",
        "show messages of a bag whose definitions differ from those installed here",
        "rosbag check old.bag",
        _FILE_STATUS,
    )
    check.add_argument("words", metavar="BAG", nargs=1)
    example = "rosbag filter run.bag odom.bag 'topic == \"/odom\"'"
    chosen = _action(actions, "filter", "copy some messages of a bag", example, _FILE_STATUS)
    text = "the bag, the new bag, and a Python expression of topic, m (the message) and t, such as 'topic == \"/tf\"'"
    chosen.add_argument("words", metavar=("BAG", "NEW_BAG", "EXPRESSION"), nargs=3, help=text)
    _hand(chosen, "-p", "--print", text="an expression to print for each message", value="EXPRESSION")
    compress = _rewrite(actions, "compress", "compress bags", "rosbag compress --lz4 run.bag")
    _hand(compress, "-j", "--bz2", text="with bz2 (the default)")
    _hand(compress, "--lz4", text="with LZ4")
    _rewrite(actions, "decompress", "decompress bags", "rosbag decompress run.bag")
    _rewrite(
        actions, "reindex", "write the index of bags again, after a recording was cut off", "rosbag reindex run.bag"
    )
    for name, text, example in (
        ("verify", "show what a bag or MCAP file contains, and which parts are damaged", "rosbag verify run.mcap"),
        ("recover", "copy the readable messages of a damaged or unfinished recording", "rosbag recover run.bag"),
        (
            "convert",
            "convert a bag to MCAP, MCAP to a bag, or change the compression",
            "rosbag convert run.bag -o run.mcap",
        ),
    ):
        _add_recordings(_action(actions, name, text, example, _RECORDING_STATUS), writes=name != "verify")
    for name, hint in _ELSEWHERE.items():
        other = actions.add_parser(name, help=hint, description=f"{hint}.")
        other.add_argument("words", nargs="*", help=argparse.SUPPRESS)
        other.set_defaults(elsewhere=hint, hint=f"; {hint}")


def _add_recordings(action: argparse.ArgumentParser, writes: bool) -> None:
    """Add the options of an action on bags and MCAP files alike."""
    action.set_defaults(module=_RECORDINGS)
    action.add_argument("file", metavar="FILE", help="a bag or an MCAP file")
    add_json(action, "the contents and the damage")
    if writes:
        add_output(action, "beside FILE; the ending sets the format")
        text = "of the chunks (default: none); bz2 is only for bags, zstd only for MCAP files"
        action.add_argument("--compression", choices=("none", "bz2", "lz4", "zstd"), help=text)


def _bags(action: argparse.ArgumentParser) -> argparse.ArgumentParser:
    action.add_argument("words", metavar="BAG", nargs="+")
    return action


def _rewrite(actions: _Actions[argparse.ArgumentParser], name: str, text: str, example: str) -> argparse.ArgumentParser:
    action = _bags(_action(actions, name, text, example, _FILE_STATUS))
    _hand(
        action,
        "--output-dir",
        text="folder for the new bag; the default keeps the old one as NAME.orig.bag",
        value="DIR",
    )
    _hand(action, "-f", "--force", text="overwrite an older NAME.orig.bag")
    _hand(action, "-q", "--quiet", text="print less")
    return action


# -- rosmsg, rossrv ----------------------------------------------------------------------------------------------------


def _add_definitions(
    commands: _Actions[argparse.ArgumentParser], tool: str, kind: str, examples: tuple[str, str], **said: Any
) -> None:
    description = f"Show the definitions of {kind}s, with packages found as {tool} finds them."
    actions = _tool(commands, tool, description, examples, **said)
    show_example, package_example = (example.removeprefix("cfepy ") for example in examples)
    for name in ("show", "info"):
        show = _action(
            actions,
            name,
            f"show the definition of a {kind}",
            show_example.replace(" show ", f" {name} "),
            _FILE_STATUS,
        )
        show.add_argument("words", metavar="TYPE", nargs=1, help="such as geometry_msgs/Pose, or Pose of any package")
        _hand(show, "-r", "--raw", text="as it was written, with comments")
        if kind == "message":
            _hand(show, "-b", "--bag", text="as a bag has it; TYPE then needs its package", value="BAG")
    _action(actions, "list", f"list all {kind}s", f"{tool} list", _FILE_STATUS)
    md5_example = show_example.replace(" show ", " md5 ")
    md5 = _action(actions, "md5", f"show the md5sum of a {kind}", md5_example, _FILE_STATUS)
    md5.add_argument("words", metavar="TYPE", nargs=1)
    package = _action(actions, "package", f"list the {kind}s of a package", package_example, _FILE_STATUS)
    package.add_argument("words", metavar="PACKAGE", nargs=1)
    text = f"list the packages that have {kind}s"
    packages = _action(actions, "packages", text, f"{tool} packages -s", _FILE_STATUS)
    for each in (package, packages):
        _hand(each, "-s", text="all on one line")


# -- rosnode -----------------------------------------------------------------------------------------------------------


def _add_rosnode(commands: _Actions[argparse.ArgumentParser]) -> None:
    actions = _tool(
        commands,
        "rosnode",
        "Show, ping and end the nodes of a mission, which the command runs in virtual time.",
        ("cfepy rosnode list capture", "cfepy rosnode info capture /arm_control"),
        help="show, ping and end nodes",
    )
    listing = _flown(actions, "list", "list the nodes", "capture -a", words=("NAMESPACE", "?"))
    _hand(listing, "-u", text="their URIs instead")
    _hand(listing, "-a", "--all", text="with their URIs")
    text = "show what nodes publish, subscribe to and offer"
    info = _flown(actions, "info", text, "capture /arm_control", words=("NODE", "+"))
    _hand(info, "-q", "--quiet", text="without their connections")
    ping = _flown(actions, "ping", "see whether a node answers", "capture /arm_control -c 3", words=("NODE", "?"))
    _hand(ping, "-a", "--all", text="all nodes, once each")
    ping.add_argument("-c", dest="pings", type=count_of, default=3, metavar="N", help="how often (default: 3)")
    _flown(actions, "machine", "list the computers, or the nodes on one", "capture", words=("MACHINE", "?"))
    kill = _flown(actions, "kill", "end nodes during the run", "capture /arm_control --at 5", words=("NODE", "*"))
    _hand(kill, "-a", "--all", text="all nodes")
    _flown(actions, "cleanup", "forget nodes that do not answer", "capture")


def _flown(
    actions: _Actions[argparse.ArgumentParser],
    name: str,
    text: str,
    example: str,
    words: tuple[str, str] | None = None,
) -> argparse.ArgumentParser:
    """Add an action on a mission that the command runs."""
    action = _action(actions, name, text, f"rosnode {name} {example}")
    add_mission(action, "source")
    if words is not None:
        action.add_argument("words", metavar=words[0], nargs=words[1])
    add_run_options(action)
    action.add_argument(
        "--at", type=seconds_of, metavar="SECONDS", help="virtual time of the action (default: the end of the run)"
    )
    return action


# -- tf ----------------------------------------------------------------------------------------------------------------


def _add_tf(commands: _Actions[argparse.ArgumentParser]) -> None:
    actions = _tool(
        commands,
        "tf",
        "Show the transforms of a bag, or of a mission, which the command runs in virtual time.",
        ("cfepy tf echo run.bag base_link hand -n 5", "cfepy tf frames robot.launch --dot frames.dot"),
        help="show transforms, as tf_echo and view_frames do",
    )
    text = "print the transform between two frames again and again"
    echo = _action(actions, "echo", text, "tf echo run.bag base_link hand -n 5")
    _source(echo)
    echo.add_argument("words", nargs=2, metavar=("SOURCE_FRAME", "TARGET_FRAME"), help="the two frames, as for tf_echo")
    echo.add_argument("-r", "--rate", type=factor_of, default=1.0, metavar="HZ", help="how often (default: 1)")
    add_count(echo, "transforms")
    text = "show the tree of frames, as view_frames draws it"
    frames = _action(actions, "frames", text, "tf frames robot.launch --dot frames.dot")
    _source(frames)
    add_drawing(frames, "dot", "write the tree for graphviz, as view_frames does,")
    frames.add_argument("--pdf", metavar="FILE", help="draw the tree with graphviz")


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
