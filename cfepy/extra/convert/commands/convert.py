"""`cfepy convert`: make applications of cFE out of the ROS nodes in C++ of a launch file or a package."""

from __future__ import annotations

import argparse
import os
import sys
from dataclasses import replace
from pathlib import Path

from cfepy.cli.json_output import check_json, write_json
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.cli.user_notes import tell, writing
from cfepy.extra.convert import (
    CMakeAnswers,
    Level,
    Profile,
    Program,
    check_program,
    converted,
    project_files,
    report,
    task_of,
    write_files,
)
from cfepy.extra.convert.commands import check, cpp_nodes_config
from cfepy.extra.convert.node_check import ArenaSize, arena_size
from cfepy.mission import LOCK_FILE, CppNodesConfig, read_lock, read_mission
from cfepy.nodes import RosConfig
from cfepy.status import UsageError


def run(arguments: argparse.Namespace) -> int:
    """Convert the nodes that the command line names, or check them if the first word is `check`.

    Returns:
        The exit status.

    Raises:
        UsageError: there is nothing to convert, or a file cannot be written.
    """
    if arguments.words[0] == "check":
        return check.run(arguments)
    if arguments.sarif is not None:
        raise UsageError("only valid with check: `cfepy convert check WORD --sarif FILE`", field="--sarif")
    check_json(arguments)
    config = cpp_nodes_config(arguments)
    task = task_of(arguments.words, dict(os.environ))
    folder = Path(arguments.output or task.made_from.stem).resolve()
    judge = _Judge(config)
    checked = (lambda program: "") if arguments.no_check else judge
    ids = _ids(arguments, folder)
    if arguments.cmake:
        answers = CMakeAnswers()
        tell([f"the sources of nodes are those that CMake {answers.version} lists"])
        made = converted(task, ids, checked, config.ground, answers.adjust)
    else:
        made = converted(task, ids, checked, config.ground)
    if not made.nodes:
        raise UsageError(f"has no node that can be converted: {'; '.join(made.refused.values())}", file=task.made_from)
    files = project_files(made, judge.sized(), folder)
    with writing(folder, "--output"):
        written = write_files(folder, files, arguments.force)
    tell([*task.notes, *(f"{name} is not converted: {why}" for name, why in made.refused.items())])
    write_json(arguments, report(made))
    print(f"{folder}: {len(made.nodes)} nodes, {len(files)} files, {len(written)} of them new", file=sys.stdout)
    return FOUND_PROBLEMS if made.refused else ENDED_WELL


class _Judge:
    """Checks programs before they are converted, and prints the errors that prevent it.

    Args:
        config: the build settings of nodes.
    """

    def __init__(self, config: CppNodesConfig) -> None:
        self._config = config
        self._arenas: dict[str, ArenaSize] = {}

    def __call__(self, program: Program) -> str:
        """Return why a program is not converted; empty if it can be."""
        report = check_program(program, Profile(self._config.profile), dict(os.environ), self._config)
        self._arenas[report.name] = arena_size(report.memory, report.profile, report.has_transforms)
        errors = report.at(Level.ERROR)
        tell([each.line(Level.ERROR) for each in errors])
        count = f"{len(errors)} error{'s' if len(errors) > 1 else ''}"
        return f"{count}, see above; --no-check converts it all the same" if errors else ""

    def sized(self) -> CppNodesConfig:
        """Return the settings, with the arena that the largest checked node needs if the mission file sets none.

        Prints the size of each node's arena and its reasons.
        """
        config = self._config
        if Profile(config.profile) is Profile.HOST or "arena_bytes" in config.places or not self._arenas:
            return config
        tell([f"{name}: {size}" for name, size in sorted(self._arenas.items())])
        return replace(config, arena_bytes=max(each.total for each in self._arenas.values()))


def _ids(arguments: argparse.Namespace, folder: Path) -> RosConfig:
    """Return the given MsgIds: a mission's, or the MsgIds of the last conversion."""
    if arguments.ids is not None:
        return read_mission(arguments.ids).ros
    lock = folder / "mission" / LOCK_FILE
    return read_lock(lock, RosConfig()) if lock.is_file() else RosConfig()
