"""The commands launch, node, rostest, rostopic, rosservice and rosparam; their options are defined here.

A command belongs here if it shows a mission as one of ROS's own tools shows a robot. This module imports argparse only,
for a quick start.
"""

from __future__ import annotations

import argparse

from cfepy.cli.flight_options import add_flight
from cfepy.cli.options import (
    MISSION_HELP,
    STATUS_HELP,
    add_action,
    add_ci_outputs,
    add_count,
    add_json,
    add_mission,
    add_output,
    add_run_options,
    count_of,
    factor_of,
    seconds_of,
)
from cfepy.cli.parser import hand_options_to_nodes, shared_group

_LAUNCH_WORDS = "a launch file, or a package and the name of a launch file in it; then its arguments, as NAME:=VALUE"
_NODE_WORDS = "a script, or a package and the name of a node in it; then the node's arguments and options"
_TEST_STATUS = "exit status: 0 all tests passed, 1 a test failed or could not be run, 2 bad usage, 130 ended by Ctrl-C"
_NODE_STATUS = (
    "exit status: that of the node, 0 when it still runs at the end; 2 bad usage, 130 ended by Ctrl-C; with "
    "--check-determinism 0 when all runs were the same, 1 when two differed"
)
_LIVE_HELP = "live:, the running flight of another terminal (several: live:NAME, live:PID)"
_SOURCE_HELP = f"a bag, {_LIVE_HELP}, or {MISSION_HELP}"
_PUB_HELP = f"{_LIVE_HELP}, or {MISSION_HELP}"
_TOPIC_HELP = "such as /odom, or with a field: /odom/pose/pose/position/x"
_TOPIC_STATUS = "exit status: 0 well, 1 nothing was found or something failed, 2 bad usage"
_PARAM_HELP = f"{MISSION_HELP}; or a file of a parameter table, or a folder with such files"
_FILES_HELP = "such as a dump of ROS.Params01; or a folder with such files"
_PARAM_STATUS = "exit status: 0 well, 1 there is no such parameter, 2 bad usage, or a mission that cannot boot"
_Actions = argparse._SubParsersAction


def add(commands: _Actions[argparse.ArgumentParser]) -> None:
    """Add these commands to the parser of `cfepy`."""
    _add_launch(commands)
    _add_node(commands)
    _add_rostest(commands)
    _add_topic(commands)
    _add_service(commands)
    _add_param(commands)


def _add_launch(commands: _Actions[argparse.ArgumentParser]) -> None:
    launch = commands.add_parser(
        "launch",
        aliases=["roslaunch"],
        help="run the nodes of a launch file",
        examples=("cfepy launch my_package robot.launch rate:=20", "cfepy launch robot.launch --for 60 --bag run.bag"),
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
        aliases=["rosrun"],
        help="run one ROS node",
        examples=("cfepy node talker.py --for 5", "cfepy node my_package talker.py _rate:=20 chatter:=/words"),
        description="Run one ROS node in virtual time, and show its output. Without --for it runs to its end, at "
        "most 60 virtual seconds. The node gets all words and options after it that cfepy does not have.",
        epilog=_NODE_STATUS,
    )
    node.add_argument("words", metavar="WORD", nargs="+", help=_NODE_WORDS)
    add_run_options(node, without=["launch_args"])
    add_flight(node)
    hand_options_to_nodes(node, bool)
    node.set_defaults(module="cfepy.cli.ros.node")


def _add_rostest(commands: _Actions[argparse.ArgumentParser]) -> None:
    test = commands.add_parser(
        "rostest",
        help="run the tests of a launch file",
        examples=("cfepy rostest my_package arm.test", "cfepy rostest arm.test --junit results.xml"),
        description="Run each <test> of a launch file with the file's nodes, in virtual time, and report.",
        epilog=_TEST_STATUS,
    )
    add_mission(test, "words", metavar="WORD", nargs="+", help=_LAUNCH_WORDS)
    test.add_argument("--text", "-t", action="store_true", help="show the output of nodes and tests")
    add_ci_outputs(shared_group(test, "continuous integration"))
    test.add_argument("--results", metavar="FILE", dest="junit", help="another name of --junit")
    add_run_options(test, without=["seconds"])  # each test has its own time limit
    test.set_defaults(module="cfepy.cli.ros.rostest")


# -- topics and services -----------------------------------------------------------------------------------------------


def _add_topic(commands: _Actions[argparse.ArgumentParser]) -> None:
    topic = commands.add_parser(
        "rostopic",
        help="show topics, and publish",
        examples=(
            "cfepy rostopic list capture",
            "cfepy rostopic echo run.bag /odom/pose/pose/position -n 3",
            "cfepy rostopic hz live: /odom",
        ),
        description="Show the topics of a bag, of a flight that runs in another terminal, or of a mission, which the "
        "command runs in virtual time; or publish.",
        epilog=_TOPIC_STATUS,
    )
    topic.set_defaults(module="cfepy.cli.ros.rostopic")
    actions = topic.add_subparsers(metavar="ACTION", dest="action", required=True)
    listing = _flown(actions, "list", "list the topics", "rostopic list capture -v")
    listing.add_argument("namespace", nargs="?", metavar="NAMESPACE", help="only those in it")
    listing.add_argument("-v", "--verbose", action="store_true", help="with types, publishers and subscribers")
    info = _flown(actions, "info", "show publishers and subscribers of a topic", "rostopic info capture /joint_states")
    info.add_argument("topic", metavar="TOPIC")
    kind = _flown(actions, "type", "show the type of a topic", "rostopic type run.bag /odom")
    kind.add_argument("topic", metavar="TOPIC")
    find = _flown(actions, "find", "list the topics of a type", "rostopic find capture sensor_msgs/JointState")
    find.add_argument("type", metavar="TYPE")
    _add_echo(_flown(actions, "echo", "show messages", "rostopic echo capture /hand_pose/position -n 3"))
    for name, help_text in (
        ("hz", "show the rate of messages"),
        ("bw", "show the bytes per second"),
        ("delay", "show the age of messages on arrival, by the stamp in their header"),
    ):
        meter = _flown(actions, name, help_text, f"rostopic {name} run.bag /odom")
        _add_messages(meter)
        meter.add_argument(
            "-w", "--window", type=count_of, metavar="N", help="the newest N messages count (default: all)"
        )
    example = "rostopic pub robot.launch /cmd_vel geometry_msgs/Twist '{linear: {x: 1}}' --at 5"
    _add_pub(_flown(actions, "pub", "publish a message in a mission", example, _PUB_HELP))


def _flown(
    actions: _Actions[argparse.ArgumentParser], name: str, text: str, example: str, source_help: str = _SOURCE_HELP
) -> argparse.ArgumentParser:
    """Add an action that reads from a mission, which the command runs."""
    action = add_action(actions, name, text, example, _TOPIC_STATUS)
    metavar = "SOURCE" if source_help == _SOURCE_HELP else "MISSION"
    add_mission(action, "source", metavar=metavar, help=source_help)
    add_run_options(action)
    add_json(action, "the answer")
    return action


def _add_messages(action: argparse.ArgumentParser) -> None:
    action.add_argument("topic", metavar="TOPIC", help=_TOPIC_HELP)
    add_count(action, "messages")


def _add_echo(echo: argparse.ArgumentParser) -> None:
    _add_messages(echo)
    echo.add_argument("-p", "--plot", action="store_true", help="a message a line, fields separated by commas")
    echo.add_argument("--filter", metavar="EXPRESSION", help="only messages for which this is true: 'm.data > 3'")
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
    service = commands.add_parser(
        "rosservice",
        help="show and call services",
        examples=("cfepy rosservice list capture", "cfepy rosservice call robot.launch /add '{a: 1, b: 2}' --at 5"),
        description="Show or call the services of a mission, which the command runs in virtual time.",
        epilog=_TOPIC_STATUS,
    )
    service.set_defaults(module="cfepy.cli.ros.rosservice")
    actions = service.add_subparsers(metavar="ACTION", dest="action", required=True)
    listing = _flown(actions, "list", "list the services", "rosservice list capture", MISSION_HELP)
    listing.add_argument("namespace", nargs="?", metavar="NAMESPACE", help="only those in it")
    for name, help_text in (
        ("info", "show a service's node, type and arguments"),
        ("type", "show the type of a service"),
        ("args", "show the arguments of a service"),
    ):
        action = _flown(actions, name, help_text, f"rosservice {name} robot.launch /reset", MISSION_HELP)
        action.add_argument("service", metavar="SERVICE")
    example = "rosservice call robot.launch /add '{a: 1, b: 2}' --at 5"
    call = _flown(actions, "call", "call a service once", example, MISSION_HELP)
    call.add_argument("service", metavar="SERVICE", help="such as /add_two_ints")
    call.add_argument("values", nargs="*", metavar="VALUE", help="the request as YAML: '{a: 1, b: 2}', or 1 2")
    _add_at(call)


# -- parameters --------------------------------------------------------------------------------------------------------


def _add_param(commands: _Actions[argparse.ArgumentParser]) -> None:
    param = commands.add_parser(
        "rosparam",
        help="show parameters, and make table files of them",
        examples=("cfepy rosparam get capture /arm", "cfepy rosparam set params.tbl /arm/rate 50"),
        description="Show the parameters of a mission as it starts, or after some time, and those in the table files "
        "of the application ROS, which keeps them; or change such files.",
        epilog=_PARAM_STATUS,
    )
    param.set_defaults(module="cfepy.cli.ros.rosparam")
    actions = param.add_subparsers(metavar="ACTION", dest="action", required=True)
    _add_param_shows(actions)
    _add_param_files(actions)


def _add_param_shows(actions: _Actions[argparse.ArgumentParser]) -> None:
    show = _add_param_show(actions, "list", "list the names of parameters", "list capture /arm")
    show.add_argument("name", metavar="NAMESPACE", nargs="?", help="only those in it")
    get = _add_param_show(actions, "get", "show one parameter, or all in a namespace", "get capture /arm --for 5")
    get.add_argument("name", metavar="NAME", help="full name")
    text = "write parameters as YAML, which params_from of a mission file takes"
    dump = _add_param_show(actions, "dump", text, "dump capture -o params.yaml")
    dump.add_argument("name", metavar="NAMESPACE", nargs="?", help="only those in it")
    add_output(dump, "standard output", "-")


def _add_param_show(
    actions: _Actions[argparse.ArgumentParser], name: str, text: str, example: str
) -> argparse.ArgumentParser:
    action = _add_param_action(actions, name, text, example)
    add_mission(action, "source", metavar="MISSION|FILE.tbl|DIR", help=_PARAM_HELP)
    action.add_argument(
        "--for",
        dest="seconds",
        type=seconds_of,
        metavar="SECONDS",
        help="run the mission for so many virtual seconds first (default: show the values in its mission file)",
    )
    add_run_options(action, without=["seconds"])
    return action


def _add_param_files(actions: _Actions[argparse.ArgumentParser]) -> None:
    text = "change one parameter in table files, for the ground to load"
    change = _add_param_action(actions, "set", text, "set params.tbl /arm/rate 50")
    change.add_argument("file", metavar="FILE.tbl|DIR", help=_FILES_HELP)
    change.add_argument("name", metavar="NAME", help="full name")
    change.add_argument("value", metavar="VALUE", help="in YAML, as for rosparam set")
    text = "remove one parameter from table files"
    delete = _add_param_action(actions, "delete", text, "delete params.tbl /arm/rate")
    delete.add_argument("file", metavar="FILE.tbl|DIR", help=_FILES_HELP)
    delete.add_argument("name", metavar="NAME", help="full name")
    for action in (change, delete):
        add_output(action, "the files themselves")
    text = "make table files of a YAML file of parameters"
    build = _add_param_action(actions, "build", text, "build params.yaml --mission my_mission")
    build.add_argument("file", metavar="FILE.yaml", help="parameters, as for rosparam load")
    add_mission(build, "--mission", help="make tables that fit this mission")
    add_output(build, "beside the YAML file")


def _add_param_action(
    actions: _Actions[argparse.ArgumentParser], name: str, text: str, example: str
) -> argparse.ArgumentParser:
    return add_action(actions, name, text, f"rosparam {example}", _PARAM_STATUS)
