"""`topics.lock`: the MsgIds of a mission's topics and services, written once and kept from then on.

The file lies in the mission's folder, is made by `cfepy mids --lock`, and belongs under version control. An id in it
never moves; the mission file's `topics:` come before it. rospy_shim, which hands MsgIds out, is loaded by name.
"""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from cfepy.console import Console
from cfepy.mission.mids import LOOK_S
from cfepy.mission.mission import Mission
from cfepy.mission.spec import LOCK_FILE, MissionSpec
from cfepy.nodes.config import RosConfig

_HEAD = "# MsgIds of ROS topics and services, written by `cfepy mids --lock`. Keep this file: ids in it never move.\n"


def lock(spec: MissionSpec, board: str | None = None) -> RosConfig:
    """Give every topic and service of a mission a MsgId of its own.

    Args:
        spec: the mission; it runs for 10 virtual seconds to see what topics and services there are.
        board: name or file of a board; None takes the mission's own.

    Returns:
        The mission's configuration with `locked_topics` and `locked_services`.

    Raises:
        CfeError: it cannot boot.
        UsageError: no such board, or more names than MsgIds.
    """
    topics: list[str] = []
    services: list[str] = []
    trial = replace(spec, ros=replace(spec.ros, spread=True))
    with Mission(trial, board=board, console=Console(quiet=True)) as mission:
        mission.run(LOOK_S)
        if mission.ros is not None:
            topics, services = mission.ros.graph.ids.claimed()
    of_topics, of_services = importlib.import_module("rospy_shim.msg_ids").locked(spec.ros, topics, services)
    return replace(spec.ros, locked_topics=of_topics, locked_services=of_services)


def lock_text(config: RosConfig) -> str:
    """What stands in the lock file."""
    return _HEAD + _section("topics", config.locked_topics) + _section("services", config.locked_services)


def lock_path(spec: MissionSpec) -> Path:
    """Where a mission's lock file is."""
    return spec.folder / LOCK_FILE


def _section(title: str, ids: Mapping[str, int]) -> str:
    if not ids:
        return f"{title}: {{}}\n"
    return f"{title}:\n" + "".join(f"  {_quoted(name)}: 0x{ids[name]:04X}\n" for name in sorted(ids))


def _quoted(name: str) -> str:
    """A resolved name needs no quotes in YAML; one that breaks ROS's rules may."""
    plain = all(letter.isalnum() or letter in "/_" for letter in name)
    return name if plain else '"' + name.replace("\\", "\\\\").replace('"', '\\"') + '"'
