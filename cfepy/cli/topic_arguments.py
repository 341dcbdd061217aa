"""What the command line understands of `cfepy topic` and `cfepy service`. Imports only argparse."""

from __future__ import annotations

import argparse

from cfepy.cli.arguments import add_launch_arguments, count_of, factor_of, seconds_of

_SOURCE_HELP = "a bag, a mission (startup script, folder, shipped mission's name), a launch file, or a node's .py file"
_MISSION_HELP = "a mission (startup script, folder, shipped mission's name), a launch file, or a node's .py file"
_TOPIC_HELP = "such as /odom, or with a field: /odom/pose/pose/position/x"
_STATUS = "exit status: 0 well, 1 nothing was found or something failed, 2 bad usage"
_Actions = argparse._SubParsersAction


def add(commands: _Actions[argparse.ArgumentParser]) -> None:
    """Add these commands to the parser of `cfepy`."""
    _add_topic(commands)
    _add_service(commands)


def _add_topic(commands: _Actions[argparse.ArgumentParser]) -> None:
    text = "show the ROS topics of a mission that is flown for it in virtual time, or of a bag"
    topic = commands.add_parser("topic", help="show ROS topics", description=f"Like rostopic: {text}.", epilog=_STATUS)
    topic.set_defaults(module="topic")
    actions = topic.add_subparsers(metavar="ACTION", dest="action", required=True)
    listing = _action(actions, "list", "list the topics")
    listing.add_argument("namespace", nargs="?", metavar="NAMESPACE", help="only those in it")
    listing.add_argument("-v", "--verbose", action="store_true", help="with types, publishers and subscribers")
    _action(actions, "info", "show who publishes a topic and who subscribes").add_argument("topic", metavar="TOPIC")
    _action(actions, "type", "show the type of a topic").add_argument("topic", metavar="TOPIC")
    _action(actions, "find", "list the topics of a type").add_argument("type", metavar="TYPE")
    _add_echo(_action(actions, "echo", "show messages"))
    for name, help_text in (
        ("hz", "show how often messages come"),
        ("bw", "show how many bytes come"),
        ("delay", "show how old messages are when they come, by the stamp in their header"),
    ):
        meter = _action(actions, name, help_text)
        _add_messages(meter)
        meter.add_argument(
            "-w", "--window", type=count_of, metavar="N", help="the newest N messages count (default: all)"
        )
    _add_pub(_action(actions, "pub", "publish a message in a mission", _MISSION_HELP))


def _action(
    actions: _Actions[argparse.ArgumentParser], name: str, text: str, source_help: str = _SOURCE_HELP
) -> argparse.ArgumentParser:
    action = actions.add_parser(name, help=text, description=f"{text[0].upper()}{text[1:]}.", epilog=_STATUS)
    metavar = "SOURCE" if source_help == _SOURCE_HELP else "MISSION"
    action.add_argument("source", metavar=metavar, help=source_help)
    action.add_argument(
        "--for",
        dest="seconds",
        type=seconds_of,
        metavar="SECONDS",
        help="virtual seconds to fly, or of the bag (default: 10, or as long as the script takes; the whole bag)",
    )
    action.add_argument("--script", metavar="FILE", help="fly this script meanwhile")
    action.add_argument("--seed", type=int, default=0, metavar="N", help="of everything random (default: 0)")
    action.add_argument("--board", metavar="NAME|FILE", help="fly on this board instead of the mission's own")
    action.add_argument("--json", action="store_true", help="as JSON")
    add_launch_arguments(action)
    action.set_defaults(stop_on_failure=False)
    return action


def _add_messages(action: argparse.ArgumentParser) -> None:
    action.add_argument("topic", metavar="TOPIC", help=_TOPIC_HELP)
    action.add_argument("-n", "--count", type=count_of, metavar="N", help="end after so many messages")


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
    pub.add_argument("-r", "--rate", type=factor_of, metavar="HZ", help="again and again (default: once, latched)")
    _add_at(pub)


def _add_at(action: argparse.ArgumentParser) -> None:
    action.add_argument(
        "--at", type=seconds_of, metavar="SECONDS", help="virtual time of the run (default: when the nodes start)"
    )


def _add_service(commands: _Actions[argparse.ArgumentParser]) -> None:
    text = "show or call the ROS services of a mission that is flown for it in virtual time"
    service = commands.add_parser(
        "service", help="show or call ROS services", description=f"Like rosservice: {text}.", epilog=_STATUS
    )
    service.set_defaults(module="service")
    actions = service.add_subparsers(metavar="ACTION", dest="action", required=True)
    listing = _action(actions, "list", "list the services", _MISSION_HELP)
    listing.add_argument("namespace", nargs="?", metavar="NAMESPACE", help="only those in it")
    for name, help_text in (
        ("info", "show a service's node, type and arguments"),
        ("type", "show the type of a service"),
        ("args", "show the arguments of a service"),
    ):
        _action(actions, name, help_text, _MISSION_HELP).add_argument("service", metavar="SERVICE")
    call = _action(actions, "call", "call a service once", _MISSION_HELP)
    call.add_argument("service", metavar="SERVICE", help="such as /add_two_ints")
    call.add_argument("values", nargs="*", metavar="VALUE", help="the request as YAML: '{a: 1, b: 2}', or 1 2")
    _add_at(call)
