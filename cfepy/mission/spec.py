"""Finding a mission and reading what it is made of: the startup script, and the mission file beside it.

The mission file (`mission.yaml`, or the script's name with `.yaml`) is optional; docs/mission_file.md describes it.
Errors say file, line and field.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cfepy.es.startup_script import entries
from cfepy.mission.deadlines import Deadlines, read_deadlines
from cfepy.mission.launch import LAUNCH_FILES, read_launch, with_launch_files
from cfepy.mission.limits import MissionLimits, read_limits
from cfepy.mission.loader import NODE_SYMBOL
from cfepy.mission.parameter_files import read_parameters
from cfepy.msg import HIGHEST_VALID_MSG_ID
from cfepy.nodes.config import ROSCORE_PARAMS, NodeConfig, RosConfig, TopicConfig
from cfepy.psp.marked_yaml import Marked, load
from cfepy.resources import shipped
from cfepy.status import UsageError

if TYPE_CHECKING:
    from cfepy.mission.invariants import Invariant
    from cfepy.mission.selected_results import SelectedResult

STARTUP_SCRIPT = "startup.scr"
MISSION_FILE = "mission.yaml"
LOCK_FILE = "topics.lock"
SECTIONS = (
    *("name", "board", "limits", "nodes", "topics", "params", "params_from", "ordered_sets", "launch"),
    *("invariants", "results", "deadlines"),
)
NODE_FIELDS = ("name", "namespace", "remap", "params", "params_from", "args", "env", "ordered_sets", "keys")


@dataclass(frozen=True, slots=True)
class MissionSpec:
    """What a mission is made of.

    `folder` shows as /cf in the mission; `script` is the startup script; `mission_file` is None when there is none;
    `board` is the board it is made for: a shipped board's name or a path; `limits` is what it asks for of a platform.
    `startup` is the startup script of a mission that was made in memory, where `script` names what it was made from;
    `notes` are what its user should know before it runs; `invariants` must hold of its messages, and `results` must not
    depend on who runs first; `deadlines` are what it is held to.
    """

    name: str
    folder: Path
    script: Path
    mission_file: Path | None
    board: str
    ros: RosConfig
    limits: MissionLimits = field(default_factory=MissionLimits)
    startup: bytes | None = None
    notes: tuple[str, ...] = ()
    invariants: tuple[Invariant, ...] = ()
    results: tuple[SelectedResult, ...] = ()
    deadlines: Deadlines = field(default_factory=Deadlines)

    @property
    def startup_script(self) -> bytes:
        """The startup script's contents: its own, or those of the file `script`."""
        return self.script.read_bytes() if self.startup is None else self.startup

    @property
    def has_nodes(self) -> bool:
        """Whether its startup script starts a ROS node."""
        return any(entry.symbol == NODE_SYMBOL for entry in entries(self.startup_script))


def shipped_missions() -> list[str]:
    """Names of the missions that cfepy brings along, sorted."""
    return sorted(path.parent.name for path in shipped("missions").glob(f"*/{STARTUP_SCRIPT}"))


def find_script(mission: str) -> Path:
    """The startup script or launch file that a user means.

    Args:
        mission: a path of a script or launch file, a folder with a startup.scr, or the name of a shipped mission.

    Raises:
        UsageError: nothing of the kind.
    """
    path = Path(mission)
    if path.is_file():
        _check_kind(path)
        return path.resolve()
    if (path / STARTUP_SCRIPT).is_file():
        return (path / STARTUP_SCRIPT).resolve()
    if mission in shipped_missions():
        return shipped("missions") / mission / STARTUP_SCRIPT
    names = ", ".join(shipped_missions())
    raise UsageError(
        f"no startup script, no folder with a {STARTUP_SCRIPT}, and no shipped mission ({names})", file=mission
    )


def _check_kind(path: Path) -> None:
    """What is neither a startup script nor a launch file must not boot as an empty mission.

    Raises:
        UsageError: it is something else.
    """
    data = path.read_bytes()
    if path.suffix == ".py" or data.startswith(b"#!"):
        raise UsageError("is a program and no mission; `cfepy node` runs a ROS node by itself", file=path)
    is_text = b"\0" not in data and any(mark in data for mark in (b"!", b"CFE_"))
    if path.suffix not in LAUNCH_FILES and data.strip() and not is_text:
        raise UsageError("is neither a startup script nor a launch file", file=path)


def read_mission(mission: str, args: Mapping[str, str] | None = None) -> MissionSpec:
    """Find a mission and read its mission file, or the launch file that it is.

    Args:
        mission: see `find_script`.
        args: arguments for a launch file.

    Raises:
        UsageError: there is no such mission, its mission file is wrong, or it takes no arguments.
    """
    script = find_script(mission)
    if script.suffix in LAUNCH_FILES:
        return read_launch(script, args)
    if args:
        raise UsageError("only a launch file takes arguments", file=mission, field="--arg")
    folder = script.parent
    mission_file = next((path for path in (script.with_suffix(".yaml"), folder / MISSION_FILE) if path.is_file()), None)
    name = folder.name if script.name == STARTUP_SCRIPT else script.stem
    if mission_file is None:
        spec = MissionSpec(name, folder, script, None, "linux", RosConfig())
    else:
        spec = _read_file(name, folder, script, mission_file)
    if spec.has_nodes:
        spec = replace(spec, ros=replace(spec.ros, params={**ROSCORE_PARAMS, **spec.ros.params}))
    lock = folder / LOCK_FILE
    return replace(spec, ros=read_lock(lock, spec.ros)) if lock.is_file() else spec


def _read_file(name: str, folder: Path, script: Path, mission_file: Path) -> MissionSpec:
    sections = load(mission_file).mapping(SECTIONS)
    ros = RosConfig(
        nodes=_named(sections.get("nodes"), read_node),
        topics=_topics(sections.get("topics")),
        params=read_parameters(sections.get("params"), sections.get("params_from")),
        ordered_sets=truth(sections["ordered_sets"]) if "ordered_sets" in sections else False,
    )
    board = sections["board"].text() if "board" in sections else "linux"
    if (folder / board).is_file():
        board = str(folder / board)
    name = sections["name"].text() if "name" in sections else name
    spec = MissionSpec(
        name,
        folder,
        script,
        mission_file,
        board,
        ros,
        read_limits(sections.get("limits")),
        invariants=_invariants(sections.get("invariants"), folder),
        results=_results(sections.get("results")),
        deadlines=read_deadlines(sections.get("deadlines")),
    )
    return with_launch_files(spec, read_launches(sections["launch"], folder)) if "launch" in sections else spec


def _invariants(section: Marked | None, folder: Path) -> tuple[Invariant, ...]:
    """The section `invariants:`; only a mission that has one imports what reads it."""
    if section is None:
        return ()
    from cfepy.mission.invariants import read_invariants

    return read_invariants(section, folder)


def _results(section: Marked | None) -> tuple[SelectedResult, ...]:
    """The section `results:`, in the same way."""
    if section is None:
        return ()
    from cfepy.mission.selected_results import read_selected_results

    return read_selected_results(section)


def read_launches(section: Marked, folder: Path) -> list[tuple[Path, Mapping[str, str]]]:
    """The launch files under `launch:`, each by its path, or as a mapping with its arguments.

    Args:
        section: the list.
        folder: the mission's, which their paths start at.

    Raises:
        UsageError: there is no such file, or an unknown key.
    """
    found: list[tuple[Path, Mapping[str, str]]] = []
    for item in section.items():
        fields = item.mapping(("file", "args")) if isinstance(item.value, dict) else {"file": item}
        if "file" not in fields:
            raise item.fail("needs a file, such as `file: demo.launch`")
        path = Path(os.path.normpath(folder / fields["file"].text()))
        if not path.is_file():
            raise fields["file"].fail(
                f"is {path}, which is no file; give a launch file's path from the mission's folder"
            )
        found.append((path, _texts(fields.get("args"))))
    return found


def read_lock(path: Path, ros: RosConfig) -> RosConfig:
    """The MsgIds of a lock file, with all else that is said about ROS.

    Args:
        path: the file; see `cfepy.mission.topics_lock`.
        ros: what the mission file says.

    Raises:
        UsageError: it is no such file, or gives a MsgId twice.
    """
    sections = load(path).mapping(("topics", "services"))
    by_id = {topic.msg_id: topic.name for topic in ros.topics.values()}
    found: dict[str, dict[str, int]] = {"topics": {}, "services": {}}
    for title, section in sections.items():
        for name, entry in section.mapping().items():
            if title == "topics" and name in ros.topics:
                continue  # the mission file has chosen another since
            msg_id = entry.integer(1, HIGHEST_VALID_MSG_ID)
            if msg_id in by_id:
                text = f"has the MsgId 0x{msg_id:04X} of {by_id[msg_id]}; remove one, and lock the mission again"
                raise entry.fail(text)
            by_id[msg_id] = name
            found[title][name] = msg_id
    return replace(ros, locked_topics=found["topics"], locked_services=found["services"])


def _named(section: Marked | None, read: Any) -> dict[str, Any]:
    if section is None:
        return {}
    return {key: read(key, value) for key, value in section.mapping().items()}


def read_node(app: str, entry: Marked) -> NodeConfig:
    """One entry under `nodes:`.

    Args:
        app: its key, the cFE name of the node's application.
        entry: its value.

    Raises:
        UsageError: an unknown key, or a value that cannot be.
    """
    fields = entry.mapping(NODE_FIELDS)
    namespace = fields["namespace"].text() if "namespace" in fields else "/"
    if not namespace.startswith("/"):
        raise fields["namespace"].fail(f'is {namespace!r}; a namespace begins with "/"')
    return NodeConfig(
        app,
        name=fields["name"].text() if "name" in fields else None,
        namespace=namespace,
        remap=_texts(fields.get("remap")),
        params=read_parameters(fields.get("params"), fields.get("params_from")),
        args=tuple(str(item.value) for item in fields["args"].items()) if "args" in fields else (),
        env=_texts(fields.get("env")),
        ordered_sets=truth(fields["ordered_sets"]) if "ordered_sets" in fields else None,
        keys=_keys(fields["keys"]) if "keys" in fields else None,
    )


def _keys(entry: Marked) -> tuple[str | float, ...]:
    """What is typed at a node's terminal."""
    keys = tuple(item.value for item in entry.items())
    for item, key in zip(entry.items(), keys, strict=True):
        if isinstance(key, bool) or not isinstance(key, str | int | float) or (not isinstance(key, str) and key < 0):
            raise item.fail(f"is {key!r}; write a text that is typed, or a number of seconds to wait")
    return keys


def _topics(section: Marked | None) -> dict[str, TopicConfig]:
    topics: dict[str, TopicConfig] = _named(section, read_topic)
    by_id: dict[int, str] = {}
    for topic in topics.values():
        other = by_id.setdefault(topic.msg_id, topic.name)
        if other != topic.name and section is not None:
            raise section.fail(f"gives MsgId 0x{topic.msg_id:04X} to both {other} and {topic.name}; change one of them")
    return topics


def read_topic(name: str, entry: Marked) -> TopicConfig:
    """One entry under `topics:`.

    Args:
        name: its key, the topic's resolved name.
        entry: its value.

    Raises:
        UsageError: an unknown key, a missing or impossible MsgId, a name without "/".
    """
    if not name.startswith("/"):
        raise entry.fail(f'is the topic {name!r}; a topic name here begins with "/"')
    fields = entry.mapping(["msg_id", "raw"])
    if "msg_id" not in fields:
        raise entry.fail("needs a msg_id, such as `msg_id: 0x0901`")
    msg_id = fields["msg_id"].value
    if not isinstance(msg_id, int) or not 0 < msg_id <= HIGHEST_VALID_MSG_ID:
        raise fields["msg_id"].fail(f"is {msg_id!r}; a MsgId is a number from 1 to 0x{HIGHEST_VALID_MSG_ID:X}")
    return TopicConfig(name, msg_id, truth(fields["raw"]) if "raw" in fields else False)


def truth(entry: Marked) -> bool:
    """A value that is true or false.

    Raises:
        UsageError: it is neither.
    """
    if not isinstance(entry.value, bool):
        raise entry.fail(f"is {entry.value!r}; write true or false")
    return entry.value


def _texts(section: Marked | None) -> Mapping[str, str]:
    return {key: str(value.value) for key, value in section.mapping().items()} if section is not None else {}
