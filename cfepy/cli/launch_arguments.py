"""What the command line understands of launch files and single nodes: launch, node, rostest. Imports only argparse."""

from __future__ import annotations

import argparse

from cfepy.cli.arguments import STATUS_HELP, add_end, add_machine, add_outputs, add_recording, factor_of

_LAUNCH_WORDS = "a launch file, or a package and the name of a launch file in it; then its arguments, as NAME:=VALUE"
_NODE_WORDS = "a script, or a package and the name of a node in it; then what the node gets (options of it after --)"
_TEST_STATUS = "exit status: 0 all tests passed, 1 a test failed or could not be run, 2 bad usage, 130 ended by Ctrl-C"
_NODE_STATUS = "exit status: that of the node, 0 when it still runs at the end; 2 bad usage, 130 ended by Ctrl-C"


def add(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add these commands to the parser of `cfepy`."""
    _add_launch(commands)
    _add_node(commands)
    _add_rostest(commands)


def _add_launch(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    launch = commands.add_parser(
        "launch",
        help="run the ROS nodes of a launch file",
        description="Run the nodes of a roslaunch file in virtual time, each as an application, and report. The run "
        "ends with --for, when all nodes have ended, or with a required one.",
        epilog=STATUS_HELP,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    launch.add_argument("words", metavar="WORD", nargs="+", help=_LAUNCH_WORDS)
    launch.add_argument("--nodes", action="store_true", help="only list the names of the nodes")
    launch.add_argument("--console", action="store_true", help="show the flight computer's console and report as well")
    launch.add_argument("--dump-params", action="store_true", help="only show the parameters, as YAML")
    add_end(launch)
    add_machine(launch)
    _add_pace(launch)
    add_outputs(launch)
    launch.set_defaults(module="launch", script=None, port=[], stop_on_failure=False)


def _add_node(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    node = commands.add_parser(
        "node",
        help="run one ROS node, as rosrun does",
        description="Run one ROS node in virtual time, and show what it prints. Without --for it runs to its end, at "
        "most 60 virtual seconds.",
        epilog=_NODE_STATUS,
    )
    node.add_argument("words", metavar="WORD", nargs="+", help=_NODE_WORDS)
    add_end(node)
    add_machine(node)
    _add_pace(node)
    node.add_argument("--json", metavar="FILE", help="write the numbers of the run's report to a file")
    node.add_argument("--trace", metavar="FILE", help="write everything that happened to a file, a line each")
    add_recording(node)
    node.set_defaults(
        hint="; what the node itself is to get comes after --",
        module="node",
        script=None,
        port=[],
        stop_on_failure=False,
        quiet=False,
    )


def _add_rostest(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    test = commands.add_parser(
        "rostest",
        help="run the tests of a launch file, as rostest does",
        description="Run each <test> of a launch file with the file's nodes, in virtual time, and report.",
        epilog=_TEST_STATUS,
    )
    test.add_argument("words", metavar="WORD", nargs="+", help=_LAUNCH_WORDS)
    test.add_argument("--text", "-t", action="store_true", help="show what the nodes and tests print")
    test.add_argument("--results-file", metavar="FILE", help="write the results of all tests as JUnit XML")
    add_machine(test)
    test.set_defaults(module="rostest", script=None, port=[], stop_on_failure=False, realtime=None, quiet=True)


def _add_pace(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--realtime",
        nargs="?",
        type=factor_of,
        const=1.0,
        metavar="FACTOR",
        help="pace virtual time to the wall clock, FACTOR times as fast (default: 1)",
    )
