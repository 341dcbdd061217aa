"""All that is wrong with a mission file: where reading it for a run stops at the first error, this goes on.

Each key is read by itself, with the functions that read it for a run, so that the two cannot differ.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

from cfepy.mission.spec import SECTIONS, read_node, read_topic
from cfepy.nodes.config import NodeConfig
from cfepy.psp.marked_yaml import Marked, load
from cfepy.status import UsageError


@dataclass(slots=True)
class CheckedFile:
    """What a mission file says, as far as it could be read, and what is wrong with it.

    `node_places` has every entry under `nodes:`, also those that are wrong and so missing in `nodes`.
    """

    errors: list[UsageError] = field(default_factory=list)
    nodes: dict[str, NodeConfig] = field(default_factory=dict)
    node_places: dict[str, Marked] = field(default_factory=dict)
    board: str | None = None
    board_place: Marked | None = None


def check_file(path: Path) -> CheckedFile:
    """Read a mission file and collect its errors.

    Args:
        path: the file.
    """
    said = CheckedFile()
    root = _attempt(said, partial(load, path))
    sections = _attempt(said, root.mapping) if root is not None else None
    for key, value in (sections or {}).items():
        if key not in SECTIONS:
            said.errors.append(value.fail(f"is not known here; known are {', '.join(SECTIONS)}"))
        elif key in ("name", "board"):
            _attempt(said, value.text)
        elif key == "nodes":
            _check_nodes(said, value)
        elif key == "topics":
            _check_topics(said, value)
        else:
            _attempt(said, value.mapping)
    if sections and "board" in sections and isinstance(sections["board"].value, str):
        said.board, said.board_place = sections["board"].value, sections["board"]
    return said


def _attempt(said: CheckedFile, read: Callable[[], Any]) -> Any:
    """What `read` returns; None, and its error kept, when it fails."""
    try:
        return read()
    except UsageError as error:
        said.errors.append(error)
        return None


def _check_nodes(said: CheckedFile, section: Marked) -> None:
    for app, entry in (_attempt(said, section.mapping) or {}).items():
        said.node_places[app] = entry
        before = len(said.errors)
        for key, value in (_attempt(said, entry.mapping) or {}).items():
            alone = Marked({key: value}, entry.file, entry.line, entry.field)
            _attempt(said, partial(read_node, app, alone))
        if len(said.errors) == before:
            said.nodes[app] = read_node(app, entry)


def _check_topics(said: CheckedFile, section: Marked) -> None:
    by_id: dict[int, str] = {}
    for name, entry in (_attempt(said, section.mapping) or {}).items():
        topic = _attempt(said, partial(read_topic, name, entry))
        if topic is None:
            continue
        other = by_id.setdefault(topic.msg_id, topic.name)
        if other != topic.name:
            said.errors.append(entry.fail(f"has the MsgId 0x{topic.msg_id:04X} of {other}; change one of them"))
