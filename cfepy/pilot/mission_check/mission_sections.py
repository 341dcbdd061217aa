"""Checks of a mission file against the rest of the mission: nodes, deadlines, packets, MsgIds, the board."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator
from pathlib import Path

from cfepy.config.platform import PlatformConfig
from cfepy.es import CFE_APP, CFE_LIB, NODE_SYMBOL, StartupEntry
from cfepy.ground import dictionary_of
from cfepy.mission import CORE_APPS, LOCK_FILE, MissionSections, read_lock, read_mission
from cfepy.monitors import Demands
from cfepy.nodes import RosConfig
from cfepy.pilot.mission_check.problem import MissionProblem, problems_of, with_field
from cfepy.psp import BoardProfile, load_profile
from cfepy.reading.marked_yaml import Marked
from cfepy.reading.mistakes import Mistakes
from cfepy.reading.suggestions import expected
from cfepy.status import UsageError


def check_nodes_said(said: MissionSections, entries: list[StartupEntry]) -> Iterator[MissionProblem]:
    """Yield entries under `nodes:` that match no node of the startup script, and duplicate node names."""
    symbols = {entry.name: entry.symbol for entry in entries if entry.kind == CFE_APP}
    names: dict[str, str] = {}
    section = said.places.get("nodes")
    for app, place in ({} if section is None else Mistakes().mapping(section)).items():
        if app not in symbols:
            yield _unknown_app(f"nodes.{app}", app, place, symbols)
        elif symbols[app] != NODE_SYMBOL:
            text = f"nodes.{app}: {app} is not a ROS node; its entry point is {symbols[app]}"
            text += f"; write {NODE_SYMBOL} in the startup script, or remove this"
            yield MissionProblem(place.file, place.line, text)
        node = said.nodes.get(app)
        if node is not None and node.name is not None:
            full = f"{node.namespace.rstrip('/')}/{node.name.lstrip('/')}"
            other = names.setdefault(full, app)
            if other != app:
                text = (
                    f"nodes.{app}: the node name {full} is also used by {other}; change "
                    "one of them, or ROS ends the older node"
                )
                yield MissionProblem(place.file, place.line, text)


def check_lock(folder: Path, said: MissionSections) -> Iterator[MissionProblem]:
    """Yield the errors in the lock file of a mission, if it has one: a duplicate or invalid MsgId."""
    path = folder / LOCK_FILE
    if not os.path.isfile(path):
        return
    try:
        read_lock(path, RosConfig(topics=said.topics))
    except UsageError as error:
        yield from problems_of(error, path)


def check_deadlines(said: MissionSections, entries: list[StartupEntry]) -> Iterator[MissionProblem]:
    """Yield deadlines of applications that do not exist."""
    apps = [*(entry.name for entry in entries if entry.kind == CFE_APP), *CORE_APPS, "ROS"]
    section = said.demands.get("deadlines")
    if section is None or "launch" in said.places:
        return
    unread = Mistakes()  # they were reported before
    of_apps = unread.mapping(section).get("apps")
    for app, place in ({} if of_apps is None else unread.mapping(of_apps)).items():
        if app not in apps:
            yield _unknown_app(f"deadlines.apps.{app}", app, place, apps)


def check_packets(said: MissionSections, demands: Demands, script: Path) -> Iterator[MissionProblem]:
    """Yield packets in invariants and results that the mission does not have."""
    named = [(packet, "invariants", each.name) for each in demands.invariants for packet in each.packets]
    named += [(each.name, "results", each.name) for each in demands.results if each.is_of_packet]
    if not named:
        return
    try:
        dictionary = dictionary_of(read_mission(str(script)))
    except UsageError:  # an error of a launch file or the lock file, which is reported there
        return
    for name, section, key in named:
        place = said.demands[section].mapping()[key]
        try:
            if name not in dictionary.commands:
                dictionary.telemetry_of(name)
        except UsageError as error:
            yield MissionProblem(place.file, place.line, f"{place.field}: {error.text}")


def check_bridge(said: MissionSections, script: Path) -> Iterator[MissionProblem]:
    """Yield packets of the ROS bridge that the mission does not have, and subscribed topics without a MsgId."""
    section = said.places.get("ros_bridge")
    if section is None:
        return
    parts = Mistakes().mapping(section)
    for place in Mistakes().items(parts["subscribe"]) if "subscribe" in parts else ():
        if place.value in said.ros_bridge.subscribe and place.value not in said.topics:
            text = f"{place.value} requires a fixed MsgId; give it one under topics:"
            yield MissionProblem(place.file, place.line, f"{place.field}: {text}")
    if not said.ros_bridge.publish:
        return
    try:
        dictionary = dictionary_of(read_mission(str(script)))
    except UsageError:  # an error of another file, which is reported there
        return
    places = Mistakes().mapping(parts["publish"])
    for topic, bridged in said.ros_bridge.publish.items():
        try:
            dictionary.telemetry_of(bridged.packet)
        except UsageError as error:
            place = places[topic]
            yield MissionProblem(place.file, place.line, f"{place.field}: {error.text}")


def _unknown_app(field: str, app: str, place: Marked, apps: Collection[str]) -> MissionProblem:
    hint = expected(app, apps, subject="the startup script has", last="and")
    return MissionProblem(place.file, place.line, f"{field}: unknown application {app}; {hint}")


def check_board(
    script: Path, entries: list[StartupEntry], said: MissionSections, board: str | None, folder: Path
) -> Iterator[MissionProblem]:
    """Yield an unknown board, limits that it does not allow, and applications and stacks that do not fit.

    Args:
        script: the startup script.
        entries: its entries.
        said: the sections of the mission file.
        board: a board that overrides the mission's; None for the mission's.
        folder: folder of the mission.
    """
    try:
        profile = load_profile(board or said.board_in(folder))
    except UsageError as error:
        place = said.places.get("board")
        if error.file is None and place is not None and board is None:
            yield MissionProblem(place.file, place.line, with_field(error))
        else:
            yield from problems_of(error, script)
        return
    try:
        has_nodes = any(entry.symbol == NODE_SYMBOL for entry in entries)
        config = said.limits.config(profile, has_nodes, said.cfe_version)
    except UsageError as error:
        yield from problems_of(error, script)
        return
    yield from _check_limits(script, entries, profile, config)
    yield from _check_stacks(script, entries, profile, config)


def _check_limits(
    script: Path, entries: list[StartupEntry], profile: BoardProfile, config: PlatformConfig
) -> Iterator[MissionProblem]:
    ros = any(entry.symbol == NODE_SYMBOL for entry in entries)
    apps = [entry for entry in entries if entry.kind == CFE_APP]
    libraries = [entry for entry in entries if entry.kind == CFE_LIB]
    modules = [entry for entry in entries if entry.kind in (CFE_APP, CFE_LIB)]
    for what, these, limit, name in (
        ("application", apps, config.es_max_applications - len(CORE_APPS) - ros, "es_max_applications"),
        ("library", libraries, config.es_max_libraries, "es_max_libraries"),
        ("application and library", modules, config.os_max_modules - ros, "os_max_modules"),
    ):
        raise_it = "the board's limit" if name in profile.limits else f"limits.{name} in the mission file"
        for entry in these[limit:]:
            text = f"{entry.name} exceeds the limit: {profile.name} allows {limit} {what} entries"
            text += f"; start fewer, or raise {raise_it}"
            yield MissionProblem(script, entry.line, text)


def _check_stacks(
    script: Path, entries: list[StartupEntry], profile: BoardProfile, config: PlatformConfig
) -> Iterator[MissionProblem]:
    """Check stacks and task control blocks against the RAM; at run time, pools, queues and tables also take memory."""
    if not profile.sram_size:
        return
    block = profile.memory_costs.task_control_block
    used = len(CORE_APPS) * (config.es_start_task_stack_size + block)
    for entry in entries:
        if entry.kind != CFE_APP:
            continue
        used += entry.stack_size + block
        if used > profile.sram_size:
            text = f"with the stack of {entry.name} ({entry.stack_size:,} bytes), all stacks need {used:,} bytes"
            yield MissionProblem(
                script,
                entry.line,
                f"{text}, but {profile.name} has {profile.sram_size:,}; choose smaller stacks or fewer applications",
            )
            return
