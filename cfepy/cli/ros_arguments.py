"""What the command line understands of ROS's parameters: param. Imports only argparse."""

from __future__ import annotations

import argparse

from cfepy.cli.arguments import MISSION_HELP, add_launch_arguments, seconds_of

SOURCE_HELP = f"{MISSION_HELP}; or a file of a parameter table, or a folder with such files"
FILES_HELP = "such as a dump of ROS.Params01; or a folder with such files"
STATUS = "exit status: 0 well, 1 there is no such parameter, 2 bad usage, or a mission that cannot boot"


def add(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add this command to the parser of `cfepy`."""
    param = commands.add_parser(
        "param",
        help="show a mission's ROS parameters, and make table files of them",
        description="ROS parameters: of a mission as it starts or after some time, and in the table files of "
        "the application ROS, which keeps them.",
        epilog=STATUS,
    )
    actions = param.add_subparsers(metavar="ACTION", dest="action", required=True)
    _add_shows(actions)
    _add_files(actions)


def _add_shows(actions: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    show = _add_show(actions, "list", "list the names of parameters")
    show.add_argument("name", metavar="NAMESPACE", nargs="?", help="only those in it")
    get = _add_show(actions, "get", "show one parameter, or what is in a namespace")
    get.add_argument("name", metavar="NAME", help="full name")
    dump = _add_show(actions, "dump", "write parameters as YAML, which params_from of a mission file takes")
    dump.add_argument("name", metavar="NAMESPACE", nargs="?", help="only those in it")
    dump.add_argument("-o", "--output", metavar="FILE", help="where to (default: standard output)")


def _add_show(
    actions: argparse._SubParsersAction[argparse.ArgumentParser], name: str, text: str
) -> argparse.ArgumentParser:
    action = _add_action(actions, name, text)
    action.add_argument("source", metavar="MISSION|FILE.tbl|DIR", help=SOURCE_HELP)
    action.add_argument(
        "--for",
        dest="seconds",
        type=seconds_of,
        metavar="SECONDS",
        help="fly the mission for so many virtual seconds first (default: what its mission file says)",
    )
    action.add_argument("--board", metavar="NAME|FILE", help="fly on this board instead of the mission's own")
    add_launch_arguments(action)
    return action


def _add_files(actions: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    change = _add_action(actions, "set", "change one parameter in table files, for the ground to load")
    change.add_argument("file", metavar="FILE.tbl|DIR", help=FILES_HELP)
    change.add_argument("name", metavar="NAME", help="full name")
    change.add_argument("value", metavar="VALUE", help="in YAML, as for rosparam set")
    delete = _add_action(actions, "delete", "take one parameter out of table files")
    delete.add_argument("file", metavar="FILE.tbl|DIR", help=FILES_HELP)
    delete.add_argument("name", metavar="NAME", help="full name")
    for action in (change, delete):
        action.add_argument("-o", "--output", metavar="DIR", help="write to this folder instead")
    build = _add_action(actions, "build", "make table files from a YAML file of parameters")
    build.add_argument("file", metavar="FILE.yaml", help="parameters, as rosparam load takes them")
    build.add_argument("--mission", metavar="MISSION", help="whose tables they shall fit")
    build.add_argument("-o", "--output", metavar="DIR", help="where to (default: beside the YAML file)")


def _add_action(
    actions: argparse._SubParsersAction[argparse.ArgumentParser], name: str, text: str
) -> argparse.ArgumentParser:
    action = actions.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".", epilog=STATUS)
    action.set_defaults(module="param")
    return action
