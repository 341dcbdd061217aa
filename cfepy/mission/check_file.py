"""All that is wrong with a mission file: where reading it for a run stops at the first error, this goes on.

Each key is read by itself, with the functions that read it for a run, so that the two cannot differ.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

from cfepy.mission.deadlines import entries_of, read_app_deadline, read_topic_deadline
from cfepy.mission.invariants import read_invariant
from cfepy.mission.launch import mission_environment, plan_of
from cfepy.mission.limits import MissionLimits, read_limits
from cfepy.mission.parameter_files import read_parameters
from cfepy.mission.selected_results import read_selected_result
from cfepy.mission.spec import SECTIONS, read_launches, read_node, read_topic, truth
from cfepy.nodes.config import NodeConfig, TopicConfig
from cfepy.psp.marked_yaml import Marked, load
from cfepy.status import UsageError


@dataclass(slots=True)
class CheckedFile:
    """What a mission file says, as far as it could be read, and what is wrong with it.

    `node_places` has every entry under `nodes:`, also those that are wrong and so missing in `nodes`;
    `deadline_places` those of applications under `deadlines:`, `packet_places` the packets that invariants and results
    name. `launches` says that launch files add more nodes.
    """

    errors: list[UsageError] = field(default_factory=list)
    nodes: dict[str, NodeConfig] = field(default_factory=dict)
    node_places: dict[str, Marked] = field(default_factory=dict)
    topics: dict[str, TopicConfig] = field(default_factory=dict)
    limits: MissionLimits = field(default_factory=MissionLimits)
    deadline_places: dict[str, Marked] = field(default_factory=dict)
    packet_places: list[tuple[str, Marked]] = field(default_factory=list)
    launches: bool = False
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
        elif key == "limits":
            _check_limits(said, value)
        elif key == "launch":
            _check_launch(said, value)
        elif key == "invariants":
            for name, entry in (_attempt(said, value.mapping) or {}).items():
                invariant = _attempt(said, partial(read_invariant, name, entry, path.parent))
                said.packet_places += [(packet, entry) for packet in (invariant.packets if invariant else ())]
        elif key == "results":
            for name, entry in (_attempt(said, value.mapping) or {}).items():
                result = _attempt(said, partial(read_selected_result, name, entry))
                said.packet_places += [(name, entry)] if result and result.is_of_packet else []
        elif key == "deadlines":
            _check_deadlines(said, value)
        elif key == "ordered_sets":
            _attempt(said, partial(truth, value))
        elif key in ("params", "params_from"):
            own, files = (value, None) if key == "params" else (None, value)
            _attempt(said, partial(read_parameters, own, files))
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


def _check_launch(said: CheckedFile, section: Marked) -> None:
    """Each launch file is read, with all that it includes."""
    said.launches = True
    for item in _attempt(said, section.items) or []:
        alone = Marked([item], item.file, item.line, section.field)
        for file, args in _attempt(said, partial(read_launches, alone, item.file.parent)) or []:
            _attempt(said, partial(plan_of, file, args, mission_environment()))


def _check_limits(said: CheckedFile, section: Marked) -> None:
    """Each limit by itself; those that are good are kept together."""
    good = {}
    for name, entry in (_attempt(said, section.mapping) or {}).items():
        if _attempt(said, partial(read_limits, Marked({name: entry}, entry.file, entry.line, entry.field))) is not None:
            good[name] = entry
    said.limits = read_limits(Marked(good, section.file, section.line, section.field))


def _check_deadlines(said: CheckedFile, section: Marked) -> None:
    for part, name, entry in _attempt(said, lambda: list(entries_of(section))) or []:
        if part == "apps":
            said.deadline_places[name] = entry
        _attempt(said, partial(read_app_deadline if part == "apps" else read_topic_deadline, name, entry))


def _check_topics(said: CheckedFile, section: Marked) -> None:
    by_id: dict[int, str] = {}
    for name, entry in (_attempt(said, section.mapping) or {}).items():
        topic = _attempt(said, partial(read_topic, name, entry))
        if topic is None:
            continue
        said.topics[name] = topic
        other = by_id.setdefault(topic.msg_id, topic.name)
        if other != topic.name:
            said.errors.append(entry.fail(f"has the MsgId 0x{topic.msg_id:04X} of {other}; change one of them"))
