"""Finding a mission and reading what it is made of: the startup script, and the mission file beside it.

The mission file (`mission.yaml`, or the script's name with `.yaml`) is optional; docs/mission_file.md describes it.
Errors say file, line and field.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cfepy.msg import HIGHEST_VALID_MSG_ID
from cfepy.nodes.config import NodeConfig, RosConfig, TopicConfig
from cfepy.psp.marked_yaml import Marked, load
from cfepy.resources import shipped
from cfepy.status import UsageError

STARTUP_SCRIPT = "startup.scr"
MISSION_FILE = "mission.yaml"
SECTIONS = ("name", "board", "nodes", "topics", "params")


@dataclass(frozen=True, slots=True)
class MissionSpec:
    """What a mission is made of.

    `folder` shows as /cf in the mission; `script` is the startup script; `mission_file` is None when there is none;
    `board` is the board it is made for: a shipped board's name or a path.
    """

    name: str
    folder: Path
    script: Path
    mission_file: Path | None
    board: str
    ros: RosConfig


def shipped_missions() -> list[str]:
    """Names of the missions that cfepy brings along, sorted."""
    return sorted(path.parent.name for path in shipped("missions").glob(f"*/{STARTUP_SCRIPT}"))


def find_script(mission: str) -> Path:
    """The startup script that a user means.

    Args:
        mission: a path of a script, a folder with a startup.scr, or the name of a shipped mission.

    Raises:
        UsageError: nothing of the kind.
    """
    path = Path(mission)
    if path.is_file():
        return path.resolve()
    if (path / STARTUP_SCRIPT).is_file():
        return (path / STARTUP_SCRIPT).resolve()
    if mission in shipped_missions():
        return shipped("missions") / mission / STARTUP_SCRIPT
    names = ", ".join(shipped_missions())
    raise UsageError(
        f"no startup script, no folder with a {STARTUP_SCRIPT}, and no shipped mission ({names})", file=mission
    )


def read_mission(mission: str) -> MissionSpec:
    """Find a mission and read its mission file.

    Args:
        mission: see `find_script`.

    Raises:
        UsageError: there is no such mission, or its mission file is wrong.
    """
    script = find_script(mission)
    folder = script.parent
    mission_file = next((path for path in (script.with_suffix(".yaml"), folder / MISSION_FILE) if path.is_file()), None)
    name = folder.name if script.name == STARTUP_SCRIPT else script.stem
    if mission_file is None:
        return MissionSpec(name, folder, script, None, "linux", RosConfig())
    return _read_file(name, folder, script, mission_file)


def _read_file(name: str, folder: Path, script: Path, mission_file: Path) -> MissionSpec:
    root = load(mission_file)
    entries = root.mapping(SECTIONS)
    ros = RosConfig(
        nodes=_named(entries.get("nodes"), read_node),
        topics=_topics(entries.get("topics")),
        params=_tree(entries.get("params")),
    )
    board = entries["board"].text() if "board" in entries else "linux"
    if (folder / board).is_file():
        board = str(folder / board)
    return MissionSpec(entries["name"].text() if "name" in entries else name, folder, script, mission_file, board, ros)


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
    fields = entry.mapping(["name", "namespace", "remap", "params", "args", "env"])
    namespace = fields["namespace"].text() if "namespace" in fields else "/"
    if not namespace.startswith("/"):
        raise fields["namespace"].fail(f'is {namespace!r}; a namespace begins with "/"')
    return NodeConfig(
        app,
        name=fields["name"].text() if "name" in fields else None,
        namespace=namespace,
        remap=_texts(fields.get("remap")),
        params=_tree(fields.get("params")),
        args=tuple(str(item.value) for item in fields["args"].items()) if "args" in fields else (),
        env=_texts(fields.get("env")),
    )


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
    raw = fields["raw"].value if "raw" in fields else False
    if not isinstance(raw, bool):
        raise fields["raw"].fail(f"is {raw!r}; write true or false")
    return TopicConfig(name, msg_id, raw)


def _texts(section: Marked | None) -> Mapping[str, str]:
    return {key: str(value.value) for key, value in section.mapping().items()} if section is not None else {}


def _tree(section: Marked | None) -> dict[str, Any]:
    return {key: value.plain() for key, value in section.mapping().items()} if section is not None else {}
