"""Finding the mission that a user names, and reading all its files.

A mission is a startup script with an optional mission file next to it (`mission.yaml`, or the script's name with
`.yaml`) and an optional lock file of its MsgIds. It can also be a launch file.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from cfepy.mission.cpp_nodes import GROUND_SERVICE, PROFILES, CppNodesConfig
from cfepy.mission.launch_names import (
    LAUNCH_FILES,
    MISSION_FILE,
    STARTUP_SCRIPT,
    WITHOUT_LAUNCH,
    files_near,
    is_alone,
    is_mission_folder,
    launch_file_of_package,
    mission_file_of,
)
from cfepy.mission.spec import MissionSpec
from cfepy.msg import HIGHEST_VALID_MSG_ID
from cfepy.nodes import ROSCORE_PARAMS, RosConfig
from cfepy.reading.input_files import beginning_of, read_limited
from cfepy.reading.input_limits import LINE_FILE_BYTES, XML_BYTES
from cfepy.reading.marked_yaml import Marked, load
from cfepy.reading.mistakes import Mistakes, collected
from cfepy.reading.resources import shipped
from cfepy.reading.suggestions import did_you_mean, expected, listed
from cfepy.status import UsageError

if TYPE_CHECKING:
    from cfepy.mission.launch import NodeBuilder
    from cfepy.mission.mission_file import MissionSections

LOCK_FILE = "topics.lock"
STARTUP_SUFFIX = ".scr"
_MISSION_FILES = (STARTUP_SUFFIX, *LAUNCH_FILES)
_LONGEST_FIRST_LINE = 200


def shipped_missions() -> list[str]:
    """Return the names of the missions included in cfepy, sorted."""
    return sorted(path.parent.name for path in shipped("missions").glob(f"*/{STARTUP_SCRIPT}"))


def find_script(mission: str) -> Path:
    """Return the startup script or launch file for a user's name.

    Args:
        mission: a path of a script or launch file, a folder with a startup.scr, the name of a shipped mission, or one
            with another startup script in its folder (`pathfinder/mended.scr`), or a package and the name of a launch
            file in it, with a blank between them; or a mission file without a startup script, or its folder.

    Raises:
        UsageError: if it is none of these.
    """
    path = Path(mission)
    if os.path.isfile(path):
        if not is_alone(path):
            _check_kind(path)
        return path.resolve()
    if os.path.isfile(path / STARTUP_SCRIPT):
        return (path / STARTUP_SCRIPT).resolve()
    if is_alone(path / MISSION_FILE):
        return (path / MISSION_FILE).resolve()
    if mission in shipped_missions():
        return shipped("missions") / mission / STARTUP_SCRIPT
    if path.suffix == STARTUP_SUFFIX and str(path.parent) in shipped_missions():
        script = shipped("missions") / path
        if os.path.isfile(script):
            return script
    file = launch_file_of_package(mission)
    if file is not None:
        return file
    names = shipped_missions()
    hint = did_you_mean(mission, [*names, *missions_near(path)], f"shipped missions are {listed(names, 'and')}")
    text = (
        "unknown mission; expected a startup script, a launch file, a folder "
        f"with a {STARTUP_SCRIPT} or a {MISSION_FILE}, or a shipped mission"
    )
    raise UsageError(f"{text}; {hint}", file=mission)


def missions_near(path: Path) -> list[str]:
    """Return the missions in the folder of a path, written like the path."""
    folders = [str(each) for each in path.parent.glob("*") if is_mission_folder(each)]
    return sorted([*folders, *files_near(path, _MISSION_FILES)])


def is_node(mission: str) -> bool:
    """Return whether a text names a Python program, which is flown as a single ROS node."""
    path = Path(mission)
    if not os.path.isfile(path):
        return False
    first = beginning_of(path, _LONGEST_FIRST_LINE).partition(b"\n")[0]
    return path.suffix == ".py" or (first.startswith(b"#!") and b"python" in first)


def _check_kind(path: Path) -> None:
    """Check that a file is a startup script or a launch file; another file must not boot as an empty mission.

    Raises:
        UsageError: if it is another kind of file.
    """
    data = read_limited(path, max(LINE_FILE_BYTES, XML_BYTES))
    if path.suffix == ".py" or data.startswith(b"#!"):
        raise UsageError("is a program, not a mission; use `cfepy node` to run a ROS node alone", file=path)
    is_text = b"\0" not in data and any(mark in data for mark in (b"!", b"CFE_"))
    if path.suffix not in LAUNCH_FILES and data.strip() and not is_text:
        is_mission_file = path.name == MISSION_FILE and os.path.isfile(path.parent / STARTUP_SCRIPT)
        hint = f"; give the mission's folder {path.parent}" if is_mission_file else ""
        raise UsageError(f"is not a startup script or a launch file{hint}", file=path)


def read_mission(mission: str, args: Mapping[str, str] | None = None, build: NodeBuilder | None = None) -> MissionSpec:
    """Find a mission, and read its mission file or launch file.

    Args:
        mission: see `find_script`.
        args: arguments for a launch file.
        build: builds the nodes in C++ of launch files; None omits them.

    Raises:
        UsageError: if there is no such mission, its mission file is wrong, or it takes no arguments.
    """
    script = find_script(mission)
    if script.suffix in LAUNCH_FILES:
        from cfepy.mission.launch import read_launch

        spec = read_launch(script, args, build)
        return _with_ground(spec, spec.folder / LOCK_FILE) if spec.cpp_nodes.ground else spec
    if args:
        raise UsageError("is not a launch file, so it takes no arguments", file=mission, field="--arg")
    alone = is_alone(script)
    name = script.parent.name if alone or script.name == STARTUP_SCRIPT else script.stem
    spec = MissionSpec(name=name, folder=script.parent, script=script, startup=b"!\n" if alone else None)
    path = mission_file_of(script)
    if path is not None:
        spec = _with_mission_file(spec, path, build)
    if spec.has_nodes:
        spec = replace(spec, ros=replace(spec.ros, params={**ROSCORE_PARAMS, **spec.ros.params}))
    lock = spec.folder / LOCK_FILE
    if os.path.isfile(lock):
        spec = replace(spec, ros=read_lock(lock, spec.ros))
    return _with_ground(spec, lock) if spec.cpp_nodes.ground else spec


def _with_ground(spec: MissionSpec, lock: Path) -> MissionSpec:
    """Return a mission in which no topic or service gets a MsgId that the ground has of a node."""
    of_services = dict(spec.ros.locked_services)
    topics = {each.msg_id: name for name, each in spec.ros.topics.items()}
    locked = topics | {msg_id: name for name, msg_id in spec.ros.locked_topics.items()}
    for node, ground in spec.cpp_nodes.ground.items():
        name = f"{node}{GROUND_SERVICE}"
        others = locked | {msg_id: other for other, msg_id in of_services.items() if other != name}
        if ground.msg_id in others:
            where = lock if ground.msg_id not in topics and os.path.isfile(lock) else spec.mission_file
            raise UsageError(
                f"the MsgId 0x{ground.msg_id:04X} of {node} belongs to {others[ground.msg_id]}; choose another one",
                file=where,
                field="cpp_nodes.ground",
            )
        of_services[name] = ground.msg_id
    return replace(spec, ros=replace(spec.ros, locked_services=of_services))


def _with_mission_file(spec: MissionSpec, path: Path, build: NodeBuilder | None) -> MissionSpec:
    """Return a mission with the content of its mission file; without such a file its readers are not loaded."""
    from cfepy.mission.mission_file import read_mission_file

    said = collected(partial(read_mission_file, path))
    spec = replace(
        spec,
        name=spec.name if said.name is None else said.name,
        mission_file=path,
        board=said.board_in(spec.folder),
        memory=said.memory,
        ros=said.ros,
        limits=said.limits,
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
    if not said.launch:
        if spec.startup is not None:
            raise UsageError(WITHOUT_LAUNCH, file=path)
        return spec
    from cfepy.mission.launch import with_launch_files

    return with_launch_files(spec, said.launch, build)


def read_sections(mission: str) -> MissionSections:
    """Return the sections of a mission file, or the defaults for a mission without one.

    Args:
        mission: the file itself, or its mission; see `find_script`.

    Raises:
        UsageError: if there is neither, or the file is wrong.
    """
    from cfepy.mission.mission_file import MissionSections, read_mission_file

    named = Path(mission)
    path = (
        named if named.suffix in (".yaml", ".yml") and os.path.isfile(named) else mission_file_of(find_script(mission))
    )
    return MissionSections() if path is None else collected(partial(read_mission_file, path))


def cpp_nodes_source(said: str) -> str:
    """Return the source of the build settings for nodes in C++ from a command line: a profile's name, or the path of a
    YAML file.

    Args:
        said: a profile, a YAML file with a section `cpp_nodes:`, or the mission of one.

    Raises:
        UsageError: if there is neither.
    """
    if said in PROFILES or (said.endswith((".yaml", ".yml")) and os.path.isfile(said)):
        return said
    try:
        path = mission_file_of(find_script(said))
    except UsageError as error:
        if error.file is not None and os.path.exists(error.file):
            raise
        hint = expected(said, [*PROFILES, "a YAML file", "a mission"])
        raise UsageError(f"unknown profile {said!r}; {hint}", field="--cpp-nodes") from None
    if path is None:
        raise UsageError("requires a mission with a mission file", file=said, field="--cpp-nodes")
    return str(path)


def cpp_nodes_of(said: str) -> CppNodesConfig:
    """Return the build settings for nodes in C++ from a command line.

    Args:
        said: see `cpp_nodes_source`.

    Raises:
        UsageError: if the file or the section does not exist, or the file is wrong.
    """
    source = cpp_nodes_source(said)
    if source in PROFILES:
        return CppNodesConfig(profile=source)
    from cfepy.mission.mission_file import read_mission_file

    sections = collected(partial(read_mission_file, Path(source)))
    if "cpp_nodes" not in sections.places:
        raise UsageError("the section cpp_nodes is missing", file=source, field="--cpp-nodes")
    return sections.cpp_nodes


def read_lock(path: Path, ros: RosConfig) -> RosConfig:
    """Return the ROS configuration with the MsgIds of a lock file.

    Args:
        path: the file; see `cfepy.ground.survey`.
        ros: the configuration in the mission file.

    Raises:
        UsageError: if it is not a lock file, or has a duplicate MsgId.
    """
    return collected(partial(_locked, load(path), ros))


def _locked(root: Marked, ros: RosConfig, mistakes: Mistakes) -> RosConfig:
    by_id = {topic.msg_id: topic.name for topic in ros.topics.values()}
    found: dict[str, dict[str, int]] = {"topics": {}, "services": {}}
    for title, section in mistakes.fields(root, ("topics", "services")):
        for name, entry in mistakes.mapping(section).items():
            if title == "topics" and name in ros.topics:
                continue  # the mission file has a newer choice
            msg_id = mistakes.attempt(partial(entry.integer, 1, HIGHEST_VALID_MSG_ID))
            if msg_id is None:
                continue
            if msg_id in by_id:
                text = (
                    f"the MsgId 0x{msg_id:04X} is already used by {by_id[msg_id]}; remove "
                    "one of them, and lock the mission again"
                )
                mistakes.add(entry.fail(text))
            by_id[msg_id] = name
            found[title][name] = msg_id
    return replace(ros, locked_topics=found["topics"], locked_services=found["services"])
