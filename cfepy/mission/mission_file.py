"""The mission file: a table of its sections and their readers.

`read_mission_file` reads the file once. It collects all mistakes, for a run as for `cfepy check`.
docs/reference/mission_file.md describes the file. The sections with rules for a run (`DEMANDS`) are kept unread;
`cfepy.monitors.run_rules` reads them.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cfepy.config.platform import REAL_TIME, SCHEDULINGS
from cfepy.config.versions import DEFAULT_RELEASE, RELEASES
from cfepy.mission.cpp_nodes import CppNodesConfig, read_cpp_nodes
from cfepy.mission.epoch import read_epoch, refuse_both
from cfepy.mission.limits import MissionLimits, read_limits
from cfepy.mission.parameter_files import merged, read_files, read_tree
from cfepy.mission.spec import CompiledConfig, SweepConfig
from cfepy.msg import HIGHEST_VALID_MSG_ID
from cfepy.nodes import BridgedPacket, NodeConfig, RosBridge, RosConfig, TopicConfig
from cfepy.psp import read_memory
from cfepy.reading.marked_yaml import Marked, load
from cfepy.reading.mistakes import Mistakes, each_of
from cfepy.reading.suggestions import did_you_mean
from cfepy.status import UsageError

if TYPE_CHECKING:
    from cfepy.mission.device_config import DeviceConfig
    from cfepy.mission.drawn_parameters import ParameterDistribution

DEMANDS = ("invariants", "results", "deadlines", "inversions")
"""Sections with rules for a run."""

LaunchFile = tuple[Path, Mapping[str, str]]
"""A launch file with its arguments."""


@dataclass(frozen=True, slots=True)
class MissionSections:
    """The content of a mission file, as far as it could be read.

    Attributes:
        name, board, memory, cfe_version, safe, scheduling, epoch, compiled, cpp_nodes, limits, nodes, topics, params,
            params_from, ordered_sets, connection_delay, ros_bridge, launch, sweep, dictionary, devices: the values of
            these sections; `name`, `board`, `memory` and `epoch` are None if missing.
        demands: the sections of `DEMANDS`, unread.
        places: all known sections in the file, unread.
    """

    name: str | None = None
    board: str | None = None
    memory: str | None = None
    cfe_version: str = DEFAULT_RELEASE
    safe: bool = False
    scheduling: str = REAL_TIME
    epoch: int | None = None
    compiled: CompiledConfig = field(default_factory=CompiledConfig)
    cpp_nodes: CppNodesConfig = field(default_factory=CppNodesConfig)
    limits: MissionLimits = field(default_factory=MissionLimits)
    nodes: Mapping[str, NodeConfig] = field(default_factory=dict)
    topics: Mapping[str, TopicConfig] = field(default_factory=dict)
    params: dict[str, Any] = field(default_factory=dict)
    params_from: dict[str, Any] = field(default_factory=dict)
    ordered_sets: bool = False
    connection_delay: int = 0
    ros_bridge: RosBridge = field(default_factory=RosBridge)
    launch: tuple[LaunchFile, ...] = ()
    sweep: SweepConfig = field(default_factory=SweepConfig)
    dictionary: tuple[Path, ...] = ()
    devices: Mapping[str, DeviceConfig] = field(default_factory=dict)
    demands: Mapping[str, Marked] = field(default_factory=dict)
    places: Mapping[str, Marked] = field(default_factory=dict)

    @property
    def ros(self) -> RosConfig:
        """The whole ROS configuration, except launch files."""
        params = merged(self.params_from, self.params)
        return RosConfig(
            nodes=self.nodes,
            topics=self.topics,
            params=params,
            ordered_sets=self.ordered_sets,
            connection_delay_ns=self.connection_delay,
            bridge=self.ros_bridge,
        )

    def board_in(self, folder: Path) -> str:
        """Return the board: a file in the mission's folder, otherwise a name or path; "linux" if none is given."""
        board = "linux" if self.board is None else self.board
        return str(folder / board) if os.path.isfile(folder / board) else board


def read_mission_file(path: Path, mistakes: Mistakes) -> MissionSections:
    """Read a mission file.

    Args:
        path: the file.
        mistakes: collects the mistakes.
    """
    root = mistakes.attempt(partial(load, path))
    places: dict[str, Marked] = {}
    said: dict[str, Any] = {}
    for name, section in () if root is None else mistakes.fields(root, SECTIONS):
        places[name] = section
        value = _READERS[name](section, mistakes) if name in _READERS else None
        if value is not None:
            said[name] = value
    if "epoch" in places and "limits" in places and (error := refuse_both(places["epoch"], places["limits"])):
        mistakes.add(error)
    return MissionSections(**said, demands={name: places[name] for name in DEMANDS if name in places}, places=places)


def read_launches(section: Marked, mistakes: Mistakes) -> tuple[LaunchFile, ...]:
    """Return the launch files under `launch:`, each as a path, or as a mapping with its arguments.

    Args:
        section: the list; paths are relative to the folder of its file.
        mistakes: collects missing files and unknown keys.
    """
    found = (mistakes.attempt(partial(_launch, item)) for item in mistakes.items(section))
    return tuple(each for each in found if each is not None)


def read_dictionary(section: Marked, mistakes: Mistakes) -> tuple[Path, ...]:
    """Return the files and folders under `dictionary:`, which declare packets and tables of applications.

    Args:
        section: the list; paths are relative to the folder of its file.
        mistakes: collects missing files.
    """
    found = (mistakes.attempt(partial(_dictionary, item)) for item in mistakes.items(section))
    return tuple(each for each in found if each is not None)


def _dictionary(item: Marked) -> Path:
    path = Path(os.path.normpath(item.file.parent / item.text()))
    if not os.path.exists(path):
        raise item.fail(f"file not found: {path}; give a file or folder relative to the mission's folder")
    return path


def _launch(item: Marked) -> LaunchFile:
    fields = item.mapping(LAUNCH_FIELDS) if isinstance(item.value, dict) else {"file": item}
    if "file" not in fields:
        raise item.fail("missing file; add it, such as `file: demo.launch`")
    path = Path(os.path.normpath(item.file.parent / fields["file"].text()))
    if not os.path.isfile(path):
        raise fields["file"].fail(
            f"file not found: {path}; give the path of a launch file relative to the mission's folder"
        )
    return path, _texts(fields["args"]) if "args" in fields else {}


def read_compiled(section: Marked, mistakes: Mistakes) -> CompiledConfig:
    """Return the section `compiled:`.

    Args:
        section: its value.
        mistakes: collects unknown keys, and values that are neither true nor false.
    """
    said = {name: mistakes.attempt(value.flag) for name, value in mistakes.fields(section, COMPILED_FIELDS)}
    return CompiledConfig(**{name: value for name, value in said.items() if value is not None})


# -- nodes and topics --------------------------------------------------------------------------------------------------


def read_nodes(section: Marked, mistakes: Mistakes) -> dict[str, NodeConfig]:
    """Return the section `nodes:`, without invalid nodes.

    Args:
        section: its value.
        mistakes: collects unknown keys and invalid values.
    """
    nodes: dict[str, NodeConfig] = {}
    for app, entry in mistakes.mapping(section).items():
        before = len(mistakes.errors)
        said: dict[str, Any] = {}
        for name, value in mistakes.fields(entry, NODE_FIELDS):
            said[name] = mistakes.attempt(partial(NODE_FIELDS[name], value))
        if len(mistakes.errors) == before:
            if said.get("respawn") and said.get("required"):
                mistakes.add(
                    entry.fail(
                        "respawn cannot be combined with required, because the end of a required node ends the run"
                    )
                )
                continue
            if "respawn_delay" in said:
                said["respawn_delay_ns"] = said.pop("respawn_delay")
            said["params"] = merged(said.pop("params_from", {}), said.get("params", {}))
            nodes[app] = NodeConfig(app, **said)
    return nodes


def read_topics(section: Marked, mistakes: Mistakes) -> dict[str, TopicConfig]:
    """Return the section `topics:`, without invalid topics.

    Args:
        section: its value.
        mistakes: collects unknown keys, missing, invalid or duplicate MsgIds, and names without "/".
    """
    topics: dict[str, TopicConfig] = {}
    by_id: dict[int, str] = {}
    for name, entry in mistakes.mapping(section).items():
        topic = mistakes.whole(partial(_topic, name, entry))
        if topic is None:
            continue
        topics[name] = topic
        other = by_id.setdefault(topic.msg_id, name)
        if other != name:
            mistakes.add(entry.fail(f"the MsgId 0x{topic.msg_id:04X} is already used by {other}; change one of them"))
    return topics


def _topic(name: str, entry: Marked, mistakes: Mistakes) -> TopicConfig:
    if not name.startswith("/"):
        mistakes.add(entry.fail(f'invalid topic name {name!r}; it must begin with "/"'))
    fields = dict(mistakes.fields(entry, TOPIC_FIELDS))
    is_raw = mistakes.attempt(fields["raw"].flag) if "raw" in fields else False
    if "msg_id" not in fields and mistakes.errors:
        raise mistakes.errors.pop()  # its key may be misspelt
    if "msg_id" not in fields:
        raise entry.fail("missing msg_id; add it, such as `msg_id: 0x0901`")
    msg_id = fields["msg_id"].value
    if not isinstance(msg_id, int) or not 0 < msg_id <= HIGHEST_VALID_MSG_ID:
        shown = fields["msg_id"].shown()
        raise fields["msg_id"].fail(f"must be a number from 1 to 0x{HIGHEST_VALID_MSG_ID:X}, not {shown}")
    return TopicConfig(name, msg_id, bool(is_raw))


MOST_CLOCK_HZ = 1000


def read_bridge(section: Marked, mistakes: Mistakes) -> RosBridge:
    """Return the section `ros_bridge:`, without invalid entries.

    Args:
        section: its value.
        mistakes: collects unknown keys, topic names without "/", and invalid rates.
    """
    publish: dict[str, BridgedPacket] = {}
    subscribe: list[str] = []
    clock_hz = 0
    for name, part in mistakes.fields(section, BRIDGE_FIELDS):
        if name == "publish":
            for topic, entry in mistakes.mapping(part).items():
                packet = mistakes.whole(partial(_bridged, topic, entry))
                if packet is not None:
                    publish[topic] = packet
        elif name == "clock":
            clock_hz = mistakes.attempt(partial(_clock_hz, part)) or 0
        else:
            heard = [mistakes.attempt(partial(_global_topic, item)) for item in mistakes.items(part)]
            subscribe = [each for each in heard if each is not None]
    return RosBridge(publish, tuple(subscribe), clock_hz)


def read_sweep(section: Marked, mistakes: Mistakes) -> SweepConfig:
    """Return the section `sweep:`: the rates, topics and distributions of the mission, for `cfepy sweep`.

    Args:
        section: its value.
        mistakes: collects unknown keys, values that are not lists of names, and invalid distributions.
    """
    said: dict[str, Any] = {}
    for name, entry in mistakes.fields(section, SWEEP_FIELDS):
        if name == "draw":
            drawn = {each: mistakes.attempt(partial(_drawn, item)) for each, item in mistakes.mapping(entry).items()}
            said[name] = {each: found for each, found in drawn.items() if found is not None}
            continue
        items = mistakes.items(entry)
        texts = [mistakes.attempt(item.text) for item in items]
        said[name] = tuple(text for text in texts if text)
        for item, text in zip(items, texts, strict=True):
            if name == "topics" and text and not text.startswith("/"):
                mistakes.add(item.fail(f'invalid topic name {text!r}; it must begin with "/"'))
    return SweepConfig(**said)


def _drawn(entry: Marked) -> ParameterDistribution:
    from cfepy.mission.drawn_parameters import ParameterDistribution

    try:
        return ParameterDistribution.parse(entry.text())
    except UsageError as error:
        raise error if error.file is not None else entry.fail(error.text) from None


def _clock_hz(entry: Marked) -> int:
    if type(entry.value) is not int or not 1 <= entry.value <= MOST_CLOCK_HZ:
        raise entry.fail(f"must be a rate of /clock in Hz from 1 to {MOST_CLOCK_HZ}, not {entry.shown()}")
    return entry.value


def _bridged(topic: str, entry: Marked, mistakes: Mistakes) -> BridgedPacket:
    if not topic.startswith("/"):
        mistakes.add(entry.fail(f'invalid topic name {topic!r}; it must begin with "/"'))
    if not isinstance(entry.value, dict):
        return BridgedPacket(entry.written())
    fields = dict(mistakes.fields(entry, PACKET_FIELDS))
    is_raw = mistakes.attempt(fields["raw"].flag) if "raw" in fields else False
    if "packet" not in fields and mistakes.errors:
        raise mistakes.errors.pop()  # its key may be misspelt
    if "packet" not in fields:
        raise entry.fail("missing packet; add it, such as `packet: CFE_ES_HK_TLM`")
    return BridgedPacket(fields["packet"].written(), bool(is_raw))


def _global_topic(entry: Marked) -> str:
    topic = entry.text()
    if not topic.startswith("/"):
        raise entry.fail(f'invalid topic name {topic!r}; it must begin with "/"')
    return topic


def _namespace(entry: Marked) -> str:
    namespace = entry.text()
    if not namespace.startswith("/"):
        raise entry.fail(f'invalid namespace {namespace!r}; it must begin with "/"')
    return namespace


def _keys(entry: Marked) -> tuple[str | float, ...]:
    """Return the keys typed at a node's terminal."""
    return tuple(each_of(partial(_key, item) for item in entry.items()))


def _key(item: Marked) -> str | float:
    key = item.value
    if isinstance(key, bool) or not isinstance(key, str | int | float) or (not isinstance(key, str) and key < 0):
        raise item.fail(f"must be a text to type or a number of seconds to wait, not {item.shown()}")
    return key


def _computing(entry: Marked) -> dict[str, int]:
    """Return the computing times of callbacks in ns, by name."""
    parts = entry.mapping()
    return dict(zip(parts, each_of(value.time for value in parts.values()), strict=True))


def _scheduling(entry: Marked) -> str:
    """Return a way to schedule tasks."""
    if entry.value not in SCHEDULINGS:
        hint = did_you_mean(str(entry.value), SCHEDULINGS, before="; ")
        raise entry.fail(f"unknown scheduling {entry.shown()}; expected {' or '.join(SCHEDULINGS)}{hint}")
    return str(entry.value)


def _release(entry: Marked) -> str:
    """Return a release of cFE."""
    if not isinstance(entry.value, str) or entry.value not in RELEASES:
        choice = " or ".join(f'"{name}"' for name in RELEASES)
        raise entry.fail(f"unknown release of cFE {entry.shown()}; expected {choice}")
    return entry.value


def _texts(section: Marked) -> Mapping[str, str]:
    parts = section.mapping()
    return dict(zip(parts, each_of(value.written for value in parts.values()), strict=True))


# -- the tables --------------------------------------------------------------------------------------------------------

COMPILED_FIELDS = ("omit_deprecated", "guard")
LAUNCH_FIELDS = ("file", "args")
TOPIC_FIELDS = ("msg_id", "raw")
BRIDGE_FIELDS = ("publish", "subscribe", "clock")
PACKET_FIELDS = ("packet", "raw")
SWEEP_FIELDS = ("rate", "topics", "draw")


def _version_of_ros(entry: Marked) -> int:
    """Return the version of ROS that a node is written for."""
    if entry.value not in (1, 2) or isinstance(entry.value, bool):
        raise entry.fail(f"must be 1 or 2, not {entry.shown()}")
    return int(entry.value)


NODE_FIELDS: Mapping[str, Callable[[Marked], Any]] = {
    "name": Marked.text,
    "namespace": _namespace,
    "remap": _texts,
    "params": read_tree,
    "params_from": read_files,
    "args": lambda entry: tuple(each_of(item.written for item in entry.items())),
    "env": _texts,
    "ordered_sets": Marked.flag,
    "keys": _keys,
    "compute": _computing,
    "respawn": Marked.flag,
    "respawn_delay": Marked.time,
    "required": Marked.flag,
    "ros": _version_of_ros,
    "executable": Marked.text,
}
"""The readers of the fields of a node, which return the values of `NodeConfig`."""


def _single(read: Callable[[Marked], Any]) -> Callable[[Marked, Mistakes], Any]:
    """Return a reader for a section that can have only one mistake."""
    return lambda section, mistakes: mistakes.attempt(partial(read, section))


def _read_devices(section: Marked, mistakes: Mistakes) -> Mapping[str, DeviceConfig]:
    from cfepy.mission.device_config import read_devices  # few missions have devices

    return read_devices(section, mistakes)


_READERS: Mapping[str, Callable[[Marked, Mistakes], Any]] = {
    "name": _single(Marked.text),
    "board": _single(Marked.text),
    "memory": _single(read_memory),
    "cfe_version": _single(_release),
    "safe": _single(Marked.flag),
    "scheduling": _single(_scheduling),
    "epoch": _single(read_epoch),
    "compiled": read_compiled,
    "cpp_nodes": read_cpp_nodes,
    "limits": read_limits,
    "nodes": read_nodes,
    "topics": read_topics,
    "params": _single(read_tree),
    "params_from": _single(read_files),
    "ordered_sets": _single(Marked.flag),
    "connection_delay": _single(Marked.time),
    "ros_bridge": read_bridge,
    "launch": read_launches,
    "sweep": read_sweep,
    "dictionary": read_dictionary,
    "devices": _read_devices,
}
"""The readers of the sections, which return the attributes of `MissionSections`, or None for an invalid section."""

SECTIONS = (*_READERS, *DEMANDS)
"""All sections of a mission file."""
