"""Nodes in C++ for a mission of cfepy, built when the mission is read, with the settings of its launch file.

MsgIds are not among them: the mission's application ROS assigns them when the node starts.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from cfepy.extra.c import CompilerError, check_elf_reader
from cfepy.extra.convert.build import BuildOptions, build_node, provided_packages
from cfepy.extra.convert.capacities import capacities_of
from cfepy.extra.convert.catkin_reader import TESTING
from cfepy.extra.convert.cpp_sources import collect, main_form
from cfepy.extra.convert.entry import NodeEntry, parameter_rows
from cfepy.extra.convert.google_test import add_google_test, uses_google_test
from cfepy.extra.convert.message_headers import Profile
from cfepy.extra.convert.packages import program_of, read_package
from cfepy.extra.convert.source_names import resolved
from cfepy.mission import CppNodesConfig
from cfepy.nodes import CppNode
from cfepy.status import UsageError
from rospy_shim.types.msgs import Library, OnDisk, Packages, shipped

LINES_SHOWN = 12
"""Lines of the compiler's output in the error for a node that cannot be built."""
_OF_A_CHAIN = re.compile(r"(In file included|\s+) from \S+:\d+[,:]$|In file included from \S+:\d+:\d+[,:]$")


def build_for_flight(
    node: CppNode, params: Mapping[str, Any], others: Sequence[str], config: CppNodesConfig | None = None
) -> tuple[Path, str]:
    """Build a node; see `cfepy.mission.NodeBuilder`.

    Args:
        node: the node.
        params: the tree of parameters.
        others: full names of the mission's other nodes.
        config: the mission file's section `cpp_nodes:`; None without one.

    Returns:
        The shared object and its entry point.

    Raises:
        UsageError: it cannot be built, or pyelftools is not installed.
        CppNodesError: the section is wrong.
    """
    check_elf_reader()  # the mission reads the built node
    config = config or CppNodesConfig()
    packages = Packages(node.near, node.env)
    package = read_package(node.folders[0], node.package)
    if node.type not in (*package.executables(), *package.nodelets()):
        package = read_package(node.folders[0], node.package, TESTING)
    program = program_of(package, node.type, packages, provided_packages())
    missing = collect(program.sources, program.includes).missing
    if uses_google_test(missing):
        add_google_test(program, missing)
    name = node.full_name

    def in_graph(one: str) -> str:
        return resolved(one, node.namespace, name)

    entry = NodeEntry(
        node.app,
        node.name,
        node.namespace,
        node.args,
        remaps={
            resolved(one, node.namespace, name): resolved(other, node.namespace, name) for one, other in node.remaps
        },
        rows=parameter_rows(params, name, others),
        takes_arguments=bool(program.nodelet) or main_form(program.sources, package.folder),
        nodelet=program.nodelet,
        params_are_given=True,
        ground=config.ground.get(name),
    )
    library = message_library(packages)
    options = BuildOptions(Profile(config.profile), capacities_of(config, library), config.arena_bytes)
    try:
        built = build_node(program, entry, library, options)
    except CompilerError as error:
        raise UsageError(shortened(str(error)), file=package.folder) from None
    return built.library, built.entry


def message_library(packages: Packages) -> Library:
    """Return the message types that a node can include: from nearby packages, and the types that come with cfepy."""
    return Library([OnDisk(packages)], base=shipped())


def shortened(text: str) -> str:
    """Return the first lines of a compiler's output, without the chains of headers that lead to a line."""
    lines = [line for line in text.splitlines() if not _OF_A_CHAIN.match(line)]
    more = [f"... and {len(lines) - LINES_SHOWN} more lines"] if len(lines) > LINES_SHOWN else []
    return "\n".join([*lines[:LINES_SHOWN], *more])
