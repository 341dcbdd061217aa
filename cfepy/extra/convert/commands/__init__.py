"""The options of the command convert, for ROS nodes in C++.

A command belongs here when it makes applications of cFE out of ROS nodes, or reports why that is not possible.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from typing import TYPE_CHECKING

from cfepy.cli.options import add_json, add_output

if TYPE_CHECKING:
    from cfepy.mission import CppNodesConfig

_WORDS = (
    "a package, its folder, or a launch file with its arguments as NAME:=VALUE; behind the word check also a C++ source"
)
_STATUS = "exit status: 0 well, 1 a node cannot be converted, 2 bad usage, or nothing to convert"


def cpp_nodes_config(arguments: argparse.Namespace) -> CppNodesConfig:
    """Return the build settings of nodes, from the command line and the mission file that it names.

    Args:
        arguments: of the command line.

    Raises:
        UsageError: there is no such mission, or its file is wrong.
    """
    from cfepy.mission import CppNodesConfig, cpp_nodes_of, read_sections

    if arguments.cpp_nodes is not None:
        said = cpp_nodes_of(arguments.cpp_nodes)
    else:
        said = CppNodesConfig() if arguments.ids is None else read_sections(arguments.ids).cpp_nodes
    return said if arguments.node_profile is None else replace(said, profile=arguments.node_profile)


def add(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add these commands to the parser of `cfepy`."""
    convert = commands.add_parser(
        "convert",
        help="make cFE applications of ROS nodes in C++",
        examples=("cfepy convert check my_package", "cfepy convert my_package robot.launch -o flight"),
        description="Make applications for a cFS 7.0.0 mission tree, and a mission for cfepy, of the ROS nodes in C++ "
        "of a launch file or a package. Their sources stay unchanged. `cfepy convert check WORD` writes nothing, and "
        "reports the parts of nodes that cannot be converted, by the rules of docs/how_to/convertor.md.",
        epilog=_STATUS,
    )
    convert.add_argument("words", metavar="WORD", nargs="+", help=_WORDS)
    add_output(convert, "a folder of the name here")
    convert.add_argument(
        "--node-profile",
        choices=("host", "pool", "strict"),
        help="rules for the nodes: host allows exceptions and the heap; pool has an arena in place of the heap, and no "
        "exceptions; strict allows neither (default: the profile of --cpp-nodes, or host)",
    )
    convert.add_argument(
        "--cpp-nodes",
        metavar="PROFILE|MISSION",
        help="take the profile of this name, or profile, arena and capacities of messages from the section cpp_nodes "
        "of this mission's file",
    )
    convert.add_argument(
        "--no-check", action="store_true", help="convert nodes that check refuses, too, and those that it cannot read"
    )
    convert.add_argument(
        "--ids", metavar="MISSION", help="take the MsgIds of this mission and its topics.lock, and its cpp_nodes"
    )
    convert.add_argument(
        "--cmake",
        action="store_true",
        help="ask CMake for the sources of nodes, which executes the commands of their CMakeLists.txt",
    )
    convert.add_argument("--force", action="store_true", help="write over files that were changed by hand, too")
    convert.add_argument(
        "--sarif",
        metavar="FILE|-",
        help="write the findings of check as SARIF 2.1.0; - writes to standard output",
    )
    add_json(convert, "the report")
    convert.set_defaults(module=f"{__name__}.convert")
