"""The commands for ROS engineers: launch, node, rostest, topic, service, param, bag; their options are defined here.

A command belongs here if it shows a mission as one of ROS's own tools shows a robot. This module imports argparse only,
for a quick start.
"""

from __future__ import annotations

import argparse

from cfepy.cli.flight_options import add_flight
from cfepy.cli.options import (
    MISSION_HELP,
    STATUS_HELP,
    add_count,
    add_json,
    add_mission,
    add_output,
    add_run_options,
    count_of,
    factor_of,
    seconds_of,
)

_LAUNCH_WORDS = "a launch file, or a package and the name of a launch file in it; then its arguments, as NAME:=VALUE"
_NODE_WORDS = "a script, or a package and the name of a node in it; then what the node gets (options of it after --)"
_TEST_STATUS = "exit status: 0 all tests passed, 1 a test failed or could not be run, 2 bad usage, 130 ended by Ctrl-C"
_NODE_STATUS = (
    "exit status: that of the node, 0 when it still runs at the end; 2 bad usage, 130 ended by Ctrl-C; with "
    "--check-determinism 0 when all runs were the same, 1 when two differed"
)
_SOURCE_HELP = f"a bag, or {MISSION_HELP}"
_TOPIC_HELP = "such as /odom, or with a field: /odom/pose/pose/position/x"
_TOPIC_STATUS = "exit status: 0 well, 1 nothing was found or something failed, 2 bad usage"
_PARAM_HELP = f"{MISSION_HELP}; or a file of a parameter table, or a folder with such files"
_FILES_HELP = "such as a dump of ROS.Params01; or a folder with such files"
_PARAM_STATUS = "exit status: 0 well, 1 there is no such parameter, 2 bad usage, or a mission that cannot boot"
_BAG_STATUS = "exit status: 0 well, 1 the file is damaged or was not finished, 2 bad usage or nothing is left of it"
_Actions = argparse._SubParsersAction


def add(commands: _Actions[argparse.ArgumentParser]) -> None:
    """Add these commands to the parser of `cfepy`."""
    _add_launch(commands)
    _add_node(commands)
    _add_rostest(commands)
    _add_topic(commands)
    _add_service(commands)
    _add_param(commands)
    _add_bag(commands)


def _add_launch(commands: _Actions[argparse.ArgumentParser]) -> None:
    launch = commands.add_parser(
        "launch",
        help="run the ROS nodes of a launch file",
        description="Run the nodes of a roslaunch file in virtual time, each as an application, and report. The run "
        "ends with --for, when all nodes have ended, or with a required one.",
        epilog=STATUS_HELP,
    )
    add_mission(launch, "words", metavar="WORD", nargs="+", help=_LAUNCH_WORDS)
    launch.add_argument("--nodes", action="store_true", help="only list the names of the nodes")
    launch.add_argument("--console", action="store_true", help="show the flight computer's console and report as well")
    launch.add_argument("--dump-params", action="store_true", help="only show the parameters, as YAML")
    add_run_options(launch)
    add_flight(launch)
    launch.set_defaults(module="cfepy.cli.ros.launch")


def _add_node(commands: _Actions[argparse.ArgumentParser]) -> None:
    node = commands.add_parser(
        "node",
        help="run one ROS node, as rosrun does",
        description="Run one ROS node in virtual time, and show what it prints. Without --for it runs to its end, at "
        "most 60 virtual seconds.",
        epilog=_NODE_STATUS,
    )
    node.add_argument("words", metavar="WORD", nargs="+", help=_NODE_WORDS)
    add_run_options(node, without=["launch_args"])
    add_flight(node)
    node.set_defaults(module="cfepy.cli.ros.node", hint="; put the options of the node itself after --")


def _add_rostest(commands: _Actions[argparse.ArgumentParser]) -> None:
    test = commands.add_parser(
        "rostest",
        help="run the tests of a launch file, as rostest does",
        description="Run each <test> of a launch file with the file's nodes, in virtual time, and report.",
        epilog=_TEST_STATUS,
    )
    add_mission(test, "words", metavar="WORD", nargs="+", help=_LAUNCH_WORDS)
    test.add_argument("--text", "-t", action="store_true", help="show what the nodes and tests print")
    test.add_argument("--results", metavar="FILE", help="write the result of every test to a file, as JUnit XML")
    add_run_options(test, without=["seconds"])  # each test has its own time limit
    test.set_defaults(module="cfepy.cli.ros.rostest")


# -- topics and services -----------------------------------------------------------------------------------------------


def _add_topic(commands: _Actions[argparse.ArgumentParser]) -> None:
    text = "show the ROS topics of a mission that is flown for it in virtual time, or of a bag"
    topic = commands.add_parser(
        "topic", help="show ROS topics", description=f"Like rostopic: {text}.", epilog=_TOPIC_STATUS
    )
    topic.set_defaults(module="cfepy.cli.ros.topic")
    actions = topic.add_subparsers(metavar="ACTION", dest="action", required=True)
    listing = _flown(actions, "list", "list the topics")
    listing.add_argument("namespace", nargs="?", metavar="NAMESPACE", help="only those in it")
    listing.add_argument("-v", "--verbose", action="store_true", help="with types, publishers and subscribers")
    _flown(actions, "info", "show who publishes a topic and who subscribes").add_argument("topic", metavar="TOPIC")
    _flown(actions, "type", "show the type of a topic").add_argument("topic", metavar="TOPIC")
    _flown(actions, "find", "list the topics of a type").add_argument("type", metavar="TYPE")
    _add_echo(_flown(actions, "echo", "show messages"))
    for name, help_text in (
        ("hz", "show how often messages come"),
        ("bw", "show how many bytes come"),
        ("delay", "show how old messages are when they come, by the stamp in their header"),
    ):
        meter = _flown(actions, name, help_text)
        _add_messages(meter)
        meter.add_argument(
            "-w", "--window", type=count_of, metavar="N", help="the newest N messages count (default: all)"
        )
    _add_pub(_flown(actions, "pub", "publish a message in a mission", MISSION_HELP))


def _flown(
    actions: _Actions[argparse.ArgumentParser], name: str, text: str, source_help: str = _SOURCE_HELP
) -> argparse.ArgumentParser:
    """Add an action that reads from a mission which is flown for it."""
    action = actions.add_parser(name, help=text, description=f"{text[0].upper()}{text[1:]}.", epilog=_TOPIC_STATUS)
    metavar = "SOURCE" if source_help == _SOURCE_HELP else "MISSION"
    add_mission(action, "source", metavar=metavar, help=source_help)
    add_run_options(action)
    add_json(action, "it")
    return action


def _add_messages(action: argparse.ArgumentParser) -> None:
    action.add_argument("topic", metavar="TOPIC", help=_TOPIC_HELP)
    add_count(action, "messages")


def _add_echo(echo: argparse.ArgumentParser) -> None:
    _add_messages(echo)
    echo.add_argument("-p", "--plot", action="store_true", help="a line each, its fields separated by commas")
    echo.add_argument("--filter", metavar="EXPRESSION", help="only messages for which it is true, such as 'm.data > 3'")
    echo.add_argument("--noarr", action="store_true", help="without arrays")
    echo.add_argument("--nostr", action="store_true", help="without texts")


def _add_pub(pub: argparse.ArgumentParser) -> None:
    pub.add_argument("topic", metavar="TOPIC", help="such as /cmd_vel")
    pub.add_argument("type", metavar="TYPE", help="such as geometry_msgs/Twist")
    pub.add_argument("values", nargs="*", metavar="VALUE", help="the message as YAML: 'data: hi', '{linear: {x: 1}}'")
    pub.add_argument("-r", "--rate", type=factor_of, metavar="HZ", help="how often (default: once, latched)")
    _add_at(pub)


def _add_at(action: argparse.ArgumentParser) -> None:
    action.add_argument(
        "--at", type=seconds_of, metavar="SECONDS", help="virtual time of the run (default: when the nodes start)"
    )


def _add_service(commands: _Actions[argparse.ArgumentParser]) -> None:
    text = "show or call the ROS services of a mission that is flown for it in virtual time"
    service = commands.add_parser(
        "service", help="show or call ROS services", description=f"Like rosservice: {text}.", epilog=_TOPIC_STATUS
    )
    service.set_defaults(module="cfepy.cli.ros.service")
    actions = service.add_subparsers(metavar="ACTION", dest="action", required=True)
    listing = _flown(actions, "list", "list the services", MISSION_HELP)
    listing.add_argument("namespace", nargs="?", metavar="NAMESPACE", help="only those in it")
    for name, help_text in (
        ("info", "show a service's node, type and arguments"),
        ("type", "show the type of a service"),
        ("args", "show the arguments of a service"),
    ):
        _flown(actions, name, help_text, MISSION_HELP).add_argument("service", metavar="SERVICE")
    call = _flown(actions, "call", "call a service once", MISSION_HELP)
    call.add_argument("service", metavar="SERVICE", help="such as /add_two_ints")
    call.add_argument("values", nargs="*", metavar="VALUE", help="the request as YAML: '{a: 1, b: 2}', or 1 2")
    _add_at(call)


# -- parameters --------------------------------------------------------------------------------------------------------


def _add_param(commands: _Actions[argparse.ArgumentParser]) -> None:
    param = commands.add_parser(
        "param",
        help="show a mission's ROS parameters, and make table files of them",
        description="ROS parameters: of a mission as it starts or after some time, and in the table files of "
        "the application ROS, which keeps them.",
        epilog=_PARAM_STATUS,
    )
    param.set_defaults(module="cfepy.cli.ros.param")
    actions = param.add_subparsers(metavar="ACTION", dest="action", required=True)
    _add_param_shows(actions)
    _add_param_files(actions)


def _add_param_shows(actions: _Actions[argparse.ArgumentParser]) -> None:
    show = _add_param_show(actions, "list", "list the names of parameters")
    show.add_argument("name", metavar="NAMESPACE", nargs="?", help="only those in it")
    get = _add_param_show(actions, "get", "show one parameter, or what is in a namespace")
    get.add_argument("name", metavar="NAME", help="full name")
    dump = _add_param_show(actions, "dump", "write parameters as YAML, which params_from of a mission file takes")
    dump.add_argument("name", metavar="NAMESPACE", nargs="?", help="only those in it")
    add_output(dump, "standard output", "-")


def _add_param_show(actions: _Actions[argparse.ArgumentParser], name: str, text: str) -> argparse.ArgumentParser:
    action = _add_param_action(actions, name, text)
    add_mission(action, "source", metavar="MISSION|FILE.tbl|DIR", help=_PARAM_HELP)
    action.add_argument(
        "--for",
        dest="seconds",
        type=seconds_of,
        metavar="SECONDS",
        help="fly the mission for so many virtual seconds first (default: what its mission file says)",
    )
    add_run_options(action, without=["seconds"])
    return action


def _add_param_files(actions: _Actions[argparse.ArgumentParser]) -> None:
    change = _add_param_action(actions, "set", "change one parameter in table files, for the ground to load")
    change.add_argument("file", metavar="FILE.tbl|DIR", help=_FILES_HELP)
    change.add_argument("name", metavar="NAME", help="full name")
    change.add_argument("value", metavar="VALUE", help="in YAML, as for rosparam set")
    delete = _add_param_action(actions, "delete", "take one parameter out of table files")
    delete.add_argument("file", metavar="FILE.tbl|DIR", help=_FILES_HELP)
    delete.add_argument("name", metavar="NAME", help="full name")
    for action in (change, delete):
        add_output(action, "the files themselves")
    build = _add_param_action(actions, "build", "make table files from a YAML file of parameters")
    build.add_argument("file", metavar="FILE.yaml", help="parameters, as rosparam load takes them")
    add_mission(build, "--mission", help="whose tables they shall fit")
    add_output(build, "beside the YAML file")


def _add_param_action(actions: _Actions[argparse.ArgumentParser], name: str, text: str) -> argparse.ArgumentParser:
    return actions.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".", epilog=_PARAM_STATUS)


# -- recordings --------------------------------------------------------------------------------------------------------


def _add_bag(commands: _Actions[argparse.ArgumentParser]) -> None:
    text = "show, save and convert bags and MCAP files"
    bag = commands.add_parser("bag", help=text, description=f"{text[0].upper()}{text[1:]}.", epilog=_BAG_STATUS)
    bag.set_defaults(module="cfepy.cli.ros.bag")
    actions = bag.add_subparsers(metavar="ACTION", dest="action", required=True)
    for name, help_text in (
        ("info", "show what is in a recording, and what is wrong with it"),
        ("recover", "write what is left of a recording that is damaged, cut off or was not finished"),
        ("convert", "make an MCAP file of a bag, a bag of an MCAP file, or the same with another compression"),
    ):
        description = f"{help_text[0].upper()}{help_text[1:]}."
        action = actions.add_parser(name, help=help_text, description=description, epilog=_BAG_STATUS)
        action.add_argument("file", metavar="FILE", help="a bag or an MCAP file")
        add_json(action, "it")
        if name != "info":
            add_output(action, "beside FILE; its ending says the format")
            kinds = ("none", "bz2", "lz4", "zstd")
            help_text = "of the chunks (default: none); bz2 in bags alone, zstd in MCAP files alone"
            action.add_argument("--compression", choices=kinds, help=help_text)
