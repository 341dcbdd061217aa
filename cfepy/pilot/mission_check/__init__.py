"""Check of a mission before it boots: startup script, code, mission file, launch files, board.

No code of the mission is executed. Each problem has the file, the line, the mistake and the remedy. A check belongs
here if its result is certain without a run. Readers of files, which runs use too, belong elsewhere.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

from cfepy.config.versions import RELEASES
from cfepy.es import CFE_APP, NODE_SYMBOL, StartupEntry, entries
from cfepy.mission import (
    LAUNCH_FILES,
    WITHOUT_LAUNCH,
    CppNodesConfig,
    MissionSections,
    cpp_nodes_of,
    find_node,
    find_script,
    is_alone,
    is_mission_folder,
    is_node,
    mission_environment,
    mission_file_of,
    read_mission_file,
    sections_beside,
)
from cfepy.monitors import read_demands
from cfepy.pilot.mission_check.cfe_names import wrong_names
from cfepy.pilot.mission_check.missing_imports import check_imports_of_app, check_imports_of_nodes
from cfepy.pilot.mission_check.mission_sections import (
    check_board,
    check_bridge,
    check_deadlines,
    check_lock,
    check_nodes_said,
    check_packets,
)
from cfepy.pilot.mission_check.problem import MissionProblem, problem_of, shown_file
from cfepy.pilot.mission_check.ros_files import NodeScript, check_definitions_of, check_launch, check_nodes
from cfepy.pilot.mission_check.startup import app_sources, check_startup
from cfepy.plugins import Hook
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import STARTUP_BYTES
from cfepy.reading.mistakes import Mistakes
from cfepy.status import UsageError

CHECK_PROFILES: Hook[Callable[[Path, list[StartupEntry], MissionSections], Iterable[MissionProblem]]] = Hook(
    "check_profiles"
)
"""Checks all code of a mission together: the startup script, its entries, the mission file."""
CHECK_SECTIONS: Hook[Callable[[MissionSections], Iterable[MissionProblem]]] = Hook("check_sections")
"""Checks the sections of a mission file."""
CHECK_TREE: Hook[Callable[[Path], list[MissionProblem] | None]] = Hook("check_tree")
"""Checks a mission tree of cFS sources. Returns None for another folder."""
__all__ = ["MissionProblem", "check_mission", "problem_of", "shown_file"]


def check_mission(
    mission: str, board: str | None = None, args: Mapping[str, str] | None = None, cpp_nodes: str | None = None
) -> list[MissionProblem]:
    """Find all problems of a mission.

    Args:
        mission: see `cfepy.mission.find_script`; or the script of a node, or a cFS mission tree.
        board: name or file of a board; None takes the mission's own.
        args: arguments for a launch file.
        cpp_nodes: how nodes in C++ are built, which overrides the mission; see `cfepy.mission.cpp_nodes_of`.

    Returns:
        The problems, by file and line; a mission that can boot has only warnings.

    Raises:
        UsageError: if the mission does not exist or takes no arguments, or the settings for nodes in C++ are wrong.
    """
    config = None if cpp_nodes is None else cpp_nodes_of(cpp_nodes)
    if is_node(mission):
        return _sorted(_check_node(Path(mission).resolve()))
    tree = _check_tree(Path(mission))
    if tree is not None:
        return _sorted(tree)
    script = find_script(mission)
    if script.suffix in LAUNCH_FILES:
        return _sorted(_check_launch_file(script, args or {}, config))
    if args:
        raise UsageError("is not a launch file, so it takes no arguments", file=mission, field="--arg")
    return _sorted(_check_folder(script, board, config))


def _check_tree(folder: Path) -> list[MissionProblem] | None:
    """Check a folder that is no mission as a mission tree. Returns None if it is none."""
    if not os.path.isdir(folder) or is_mission_folder(folder):
        return None
    found = (check(folder) for check in CHECK_TREE.all())
    return next((each for each in found if each is not None), None)


def _sorted(found: Iterable[MissionProblem]) -> list[MissionProblem]:
    return sorted(dict.fromkeys(found), key=lambda problem: (str(problem.file), problem.line))


def _check_launch_file(file: Path, args: Mapping[str, str], config: CppNodesConfig | None) -> list[MissionProblem]:
    """Check a launch file without a startup script, in the user's environment."""
    path, mistakes = mission_file_of(file), Mistakes()
    if path is not None:
        said = sections_beside(path, mistakes)
        read_demands(said.demands, mistakes)
        config = config or said.cpp_nodes
    found, scripts = check_launch(file, args, dict(os.environ), alone=True, config=config)
    found += [problem_of(error, file) for error in mistakes.errors]
    return [*found, *check_nodes(scripts), *check_imports_of_nodes(scripts), *check_definitions_of(scripts, file)]


def _check_node(file: Path) -> list[MissionProblem]:
    """Check a single node, in the user's environment."""
    scripts = [NodeScript(file, dict(os.environ))]
    return [*check_nodes(scripts), *check_imports_of_nodes(scripts), *check_definitions_of(scripts, file)]


def _check_folder(script: Path, board: str | None, config: CppNodesConfig | None) -> list[MissionProblem]:
    """Check a startup script with all its files."""
    data = b"!\n" if is_alone(script) else read_limited(script, STARTUP_BYTES)
    mistakes = Mistakes()
    path = mission_file_of(script)
    said = MissionSections() if path is None else read_mission_file(path, mistakes)
    if is_alone(script) and not said.launch and not mistakes.errors:
        raise UsageError(WITHOUT_LAUNCH, file=script)
    longest = RELEASES[said.cfe_version].longest_entry
    started = entries(data, longest)
    demands = read_demands(said.demands, mistakes)
    found = [*check_startup(script, data, started, longest), *(problem_of(error, script) for error in mistakes.errors)]
    for check_code in CHECK_PROFILES.all():
        found += check_code(script, started, said)
    for source, entry_point in dict.fromkeys(app_sources(script.parent, started)):
        found += wrong_names(source, entry_point)
        found += check_imports_of_app(source, script.parent)
    nodes = _nodes_of(script.parent, started, said)
    for file, args in said.launch:
        problems, scripts = check_launch(
            file, args, mission_environment(), alone=False, config=config or said.cpp_nodes
        )
        found += [*problems, *check_nodes(scripts)]
        nodes += scripts
    found += check_nodes_said(said, started)
    found += check_deadlines(said, started)
    if not mistakes.errors:  # the content of the mission is known only if its file is right
        found += check_packets(said, demands, script)
        found += check_bridge(said, script)
    for check_said in CHECK_SECTIONS.all():
        found += check_said(said)
    found += check_lock(script.parent, said)
    found += check_board(script, started, said, board, script.parent)
    return [*found, *check_nodes(nodes), *check_imports_of_nodes(nodes), *check_definitions_of(nodes, script)]


def _nodes_of(folder: Path, started: list[StartupEntry], said: MissionSections) -> list[NodeScript]:
    """Return the scripts of the nodes in the startup script."""
    nodes = [entry for entry in started if entry.kind == CFE_APP and entry.symbol == NODE_SYMBOL]
    found = ((entry.name, find_node(entry.path, folder)) for entry in nodes if entry.path.startswith("/cf/"))
    known = ((script, said.nodes.get(name)) for name, script in found if script is not None)
    return [
        NodeScript(script, {}) if config is None else NodeScript(script, dict(config.env), config.ros)
        for script, config in known
    ]
