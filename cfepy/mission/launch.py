"""Missions of ROS nodes: from launch files, with or without a startup script, and from a single node as with `rosrun`.

`rospy_shim.roslaunch` finds and reads launch files; it is loaded when there is one. Nothing is written to disk: the
startup script of such a mission is kept as bytes.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from cfepy.mission.cpp_nodes import CppNodesConfig, CppNodesError
from cfepy.mission.launch_names import (
    LAUNCH_FILES,
    MISSION_FILE,
    files_near,
    launch_file_of_package,
    mission_file_of,
)
from cfepy.mission.limits import MissionLimits
from cfepy.mission.parameter_files import merged
from cfepy.mission.spec import BuiltProgram, MissionSpec
from cfepy.nodes import ROSCORE_PARAMS, CppNode, NodeConfig, RosConfig
from cfepy.reading.mistakes import Mistakes, collected
from cfepy.reading.suggestions import did_you_mean
from cfepy.status import UsageError

if TYPE_CHECKING:
    from cfepy.mission.mission_file import MissionSections
    from rospy_shim.roslaunch.launch_plan import LaunchPlan

PRIORITY, STACK_BYTES, RESTART_NOTHING = 100, 16384, 0
COMPILED_STACK_BYTES = 65536  # C++ streams need more stack than C
ROOM = 64  # spare nodes in the limits, because a workstation does not limit threads
KEPT_ENVIRONMENT = ("HOME", "PATH", "ROS_PACKAGE_PATH", "CMAKE_PREFIX_PATH")


TEST_RESULTS = "/ram/gtest.xml"
"""The results file of a test in C++, in the mission's files."""


class NodeBuilder(Protocol):
    """Builds a ROS node in C++ for a mission."""

    def __call__(
        self, node: CppNode, params: Mapping[str, Any], others: Sequence[str], config: CppNodesConfig
    ) -> tuple[Path, str]:
        """Build a node.

        Args:
            node: the node.
            params: the parameter tree.
            others: full names of the mission's other nodes.
            config: the mission file's section `cpp_nodes:`.

        Returns:
            The shared object and its entry point.

        Raises:
            UsageError: if it cannot be built; the text gives the reason.
            CppNodesError: if the section is wrong.
        """


def spec_of(
    made_from: Path,
    nodes: Mapping[str, NodeConfig],
    params: Mapping[str, Any],
    notes: tuple[str, ...] = (),
    built: Mapping[str, BuiltProgram] | None = None,
) -> MissionSpec:
    """Return a mission of ROS nodes that is not on disk; the run ends when all nodes have ended.

    Args:
        made_from: the launch file or script; its folder appears as /cf.
        nodes: by cFE name, each with its script.
        params: the parameter tree.
        notes: notes for the user.
        built: nodes in C++ by cFE name.
    """
    built = built or {}
    return MissionSpec(
        name=made_from.stem,
        folder=made_from.parent,
        script=made_from,
        mission_file=None,
        board="linux",
        ros=RosConfig(
            nodes=nodes, params=params, spread=True, ends_with_nodes=bool(nodes or built), compiled=_ends(built)
        ),
        limits=MissionLimits(nodes=len(nodes) + len(built) + ROOM, yields=True),
        startup=lines_for(nodes) + compiled_lines(built) + b"!\n",
        notes=notes,
        built=built,
    )


def read_launch(file: Path, args: Mapping[str, str] | None = None, build: NodeBuilder | None = None) -> MissionSpec:
    """Return the mission of a launch file without a startup script, in the user's environment.

    Args:
        file: the launch file.
        args: values of its arguments.
        build: builds nodes in C++; None omits them.

    Raises:
        UsageError: if it is wrong or has no node that can run here.
    """
    from rospy_shim.roslaunch.launch_plan import plan_of

    path, said = mission_file_of(file), None
    if path is not None:
        said = collected(partial(sections_beside, path))
    plan = plan_of(file, args or {}, dict(os.environ), cwd=Path.cwd(), with_compiled=build is not None)
    built, left_out = built_programs(plan, build, None if said is None else said.cpp_nodes)
    notes = (*plan.notes, *left_out)
    if not plan.nodes and not built:
        why = "; ".join(notes) or "it has no <node>"
        raise UsageError(f"has no node that cfepy can run: {why}", file=file)
    spec = spec_of(file, plan.nodes, plan.params, notes, built)
    return spec if path is None or said is None else _with_sections(spec, path, said)


def _with_sections(spec: MissionSpec, path: Path, said: MissionSections) -> MissionSpec:
    """Return the mission of a launch file with the sections of the mission file beside it."""
    config = said.ros
    ros = replace(
        spec.ros,
        topics=config.topics,
        params=merged(spec.ros.params, config.params),
        ordered_sets=config.ordered_sets,
        connection_delay_ns=config.connection_delay_ns,
        bridge=config.bridge,
    )
    limits = said.limits if said.limits.nodes else replace(said.limits, nodes=spec.limits.nodes, yields=True)
    return replace(
        spec,
        name=spec.name if said.name is None else said.name,
        mission_file=path,
        board=said.board_in(spec.folder),
        memory=said.memory,
        ros=ros,
        limits=limits,
        cfe_version=said.cfe_version,
        safe=said.safe,
        scheduling=said.scheduling,
        epoch_ns=said.epoch,
        compiled=said.compiled,
        cpp_nodes=said.cpp_nodes,
        demands=said.demands,
        sweep=said.sweep,
        dictionary=said.dictionary,
        devices=said.devices,
    )


def sections_beside(path: Path, mistakes: Mistakes) -> MissionSections:
    """Read a mission file beside a launch file that is run itself.

    Args:
        path: the mission file.
        mistakes: gets its mistakes, also sections that the launch file sets itself.
    """
    from cfepy.mission.mission_file import read_mission_file

    said = read_mission_file(path, mistakes)
    for name in ("nodes", "launch"):
        if name in said.places:
            text = "is not available beside a launch file that is run itself; name the launch file in `launch:` of a "
            text += f"{MISSION_FILE} in another folder, and run that"
            mistakes.add(UsageError(text, file=path, line=said.places[name].line, field=name))
    return said


def built_programs(
    plan: LaunchPlan, build: NodeBuilder | None, config: CppNodesConfig | None = None
) -> tuple[dict[str, BuiltProgram], list[str]]:
    """Build the nodes in C++ of a launch file.

    Args:
        plan: the plan of the launch file.
        build: builds a node; None builds none.
        config: the section of the mission file; None without one.

    Returns:
        The built nodes by cFE name, and notes about those that cannot be built.

    Raises:
        UsageError: if a required node cannot be built, or the mission file is wrong.
    """
    config = config or CppNodesConfig()
    built: dict[str, BuiltProgram] = {}
    notes = []
    names = [f"/{node.name}" for node in plan.nodes.values()]
    names += [node.full_name for node in plan.compiled.values()]
    for app, node in plan.compiled.items():
        if build is None:  # they were not requested
            break
        try:
            others = [each for each in names if each != node.full_name]
            built[app] = BuiltProgram(node.full_name, *build(node, plan.params, others, config), node)
        except CppNodesError:
            raise
        except UsageError as error:
            if node.required:
                text = f"{node.full_name} is required, but cannot be built: {error}"
                raise UsageError(text, file=node.near, line=node.line, field="<node>") from None
            notes.append(f"{node.near}:{node.line}: node {node.full_name} is left out: it cannot be built: {error}")
    return built, notes


def launch_file(words: Sequence[str]) -> tuple[Path, dict[str, str]]:
    """Return the launch file and the arguments that a command line names.

    Raises:
        UsageError: if there is no such file.
    """
    args = dict(word.split(":=", 1) for word in words if ":=" in word)
    names = [word for word in words if ":=" not in word]
    if len(names) > 1 and os.path.isfile(names[0]):
        raise UsageError(f"invalid argument {names[1]!r}; expected NAME:=VALUE", file=names[0])
    if len(names) not in (1, 2):
        raise UsageError(
            f"expected a launch file, or a package and the name of a launch file in it; found {len(names)} names"
        )
    file = Path(names[0])
    if len(names) == 1 and os.path.isfile(file):
        return file.resolve(), args
    found = launch_file_of_package(" ".join(names))
    if found is None:
        what_to_do = "give the path of one, or a package and the name of one in it"
        hint = did_you_mean(names[-1], files_near(file, LAUNCH_FILES), what_to_do)
        raise UsageError(f"launch file not found; {hint}", file=" ".join(names))
    return found, args


def with_launch_files(
    spec: MissionSpec, launches: Sequence[tuple[Path, Mapping[str, str]]], build: NodeBuilder | None = None
) -> MissionSpec:
    """Return a mission with the nodes of launch files added to its own.

    Args:
        spec: the mission.
        launches: launch files, and the arguments of each.
        build: builds nodes in C++; None omits them.

    Raises:
        UsageError: if one of them is wrong.
    """
    from rospy_shim.roslaunch.launch_plan import plan_of

    environ = mission_environment()
    nodes, params, notes = dict(spec.ros.nodes), dict(spec.ros.params), list(spec.notes)
    taken = [entry.name for entry in spec.entries]
    added: dict[str, NodeConfig] = {}
    built: dict[str, BuiltProgram] = {}
    for file, args in launches:
        plan = plan_of(file, args, environ, taken=[*taken, *added, *built], with_compiled=build is not None)
        added.update(plan.nodes)
        params = merged(plan.params, params)
        more, left_out = built_programs(plan, build, spec.cpp_nodes)
        built.update(more)
        notes += [*plan.notes, *left_out]
    head = spec.startup_script.partition(b"!")[0]
    ros = replace(spec.ros, nodes={**nodes, **added}, params=params, compiled=_ends(built))
    startup = head + lines_for(added) + compiled_lines(built) + b"!\n"
    return replace(spec, ros=ros, startup=startup, notes=tuple(notes), built=built)


def _ends(built: Mapping[str, BuiltProgram]) -> dict[str, NodeConfig]:
    """Return the settings for the end of nodes in C++, by cFE name."""
    return {app: program.config for app, program in built.items()}


def mission_environment() -> dict[str, str]:
    """Return the environment variables that launch files in a mission see: only a few, so that they behave the same
    everywhere.
    """
    return {name: os.environ[name] for name in KEPT_ENVIRONMENT if name in os.environ}


def lines_for(nodes: Mapping[str, NodeConfig]) -> bytes:
    """Return the startup script lines of nodes; the name is also the name of the file, which is never opened."""
    numbers = f"{PRIORITY}, {STACK_BYTES}, 0x0, {RESTART_NOTHING}"
    return "".join(f"CFE_APP, {app}, __main__, {app}, {numbers};\n" for app in nodes).encode()


def compiled_lines(built: Mapping[str, BuiltProgram]) -> bytes:
    """Return the startup script lines of nodes in C++, by cFE name."""
    numbers = f"{PRIORITY}, {COMPILED_STACK_BYTES}, 0x0, {RESTART_NOTHING}"
    return "".join(f"CFE_APP, {app}, {each.entry}, {app}, {numbers};\n" for app, each in built.items()).encode()


def node_script(words: Sequence[str]) -> tuple[Path, list[str]]:
    """Return the script that a command line names, and the node's arguments.

    Args:
        words: a script, or a package and the name of a node in it; then the node's arguments.

    Raises:
        UsageError: if there is none.
    """
    if os.path.isfile(words[0]):
        return Path(words[0]).resolve(), list(words[1:])
    if len(words) == 1 or words[0].endswith(".py"):
        otherwise = "give one, or a package and the name of a node in it"
        hint = did_you_mean(words[0], files_near(Path(words[0]), (".py",)), otherwise)
        raise UsageError(f"script not found; {hint}", file=words[0])
    from rospy_shim.roslaunch.launch_plan import node_file

    return node_file(words[0], words[1], Path.cwd() / words[1], os.environ), list(words[2:])


def spec_of_node(words: Sequence[str], build: NodeBuilder | None = None) -> MissionSpec:
    """Return the mission of a single node named on a command line.

    Args:
        words: see `node_script`.
        build: builds a node in C++; None for none.

    Raises:
        UsageError: if there is none, or it cannot be built.
    """
    from rospy_shim.roslaunch.launch_plan import node_environment, node_in_cpp

    environ = node_environment(os.environ, os.environ.get("ROS_NAMESPACE", "/"))
    setup = _setup_of(words)
    if setup is not None:
        return spec_of_script(setup, words[2:], words[1])
    is_pair = build is not None and len(words) > 1 and not os.path.isfile(words[0])
    node = node_in_cpp(words[0], words[1], Path.cwd() / words[1], environ, words[2:]) if is_pair else None
    if node is None or build is None:
        return spec_of_script(*node_script(words))
    params = merged(ROSCORE_PARAMS, {})
    return spec_of(
        node.folders[0] / "CMakeLists.txt",
        {},
        params,
        (),
        {node.app: BuiltProgram(node.full_name, *build(node, params, (), CppNodesConfig()), node)},
    )


def _setup_of(words: Sequence[str]) -> Path | None:
    """Return the setup.py of the package that a command line names, if it names the node, too."""
    from rospy_shim.roslaunch.launch_plan import packages_near
    from rospy_shim.types.entry_points import entry_points, setup_file

    if len(words) < 2 or os.path.isfile(words[0]) or words[0].endswith(".py"):
        return None
    folders = packages_near(Path.cwd() / words[1], os.environ, words[0]).folders(words[0])
    return next((setup_file(each) for each in folders if words[1] in entry_points(each)), None)


def spec_of_script(script: Path, words: Sequence[str], executable: str = "") -> MissionSpec:
    """Return the mission of a single node with its arguments.

    Args:
        script: its program, or the setup.py of its package.
        words: the arguments.
        executable: its name in that setup.py; empty runs the script itself.
    """
    from rospy_shim.roslaunch.launch_plan import app_name, node_environment

    environ = node_environment(os.environ, os.environ.get("ROS_NAMESPACE", "/"))
    app = app_name(executable or script.stem)
    config = NodeConfig(
        app, args=tuple(words), env=environ, script=script, cwd=Path.cwd(), required=True, executable=executable
    )
    return spec_of(script, {app: config}, ROSCORE_PARAMS)
