"""Everything that is wrong with a mission before it boots: startup script, code, mission file, board.

Nothing of the mission is executed. Each finding says file, line, what is wrong and what to do.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from difflib import get_close_matches
from pathlib import Path
from typing import NamedTuple

from cfepy.config import PlatformConfig
from cfepy.es import startup_script
from cfepy.es.startup_script import CFE_APP, CFE_LIB, Entry
from cfepy.mission import sources
from cfepy.mission.check_file import CheckedFile, check_file
from cfepy.mission.dictionary import dictionary_of
from cfepy.mission.launch import LAUNCH_FILES, read_launch
from cfepy.mission.loader import NODE_SYMBOL, find_code, find_node
from cfepy.mission.spec import LOCK_FILE, MISSION_FILE, find_script, read_lock, read_mission
from cfepy.nodes.config import RosConfig
from cfepy.osal.limits import OS_MAX_FILE_NAME
from cfepy.psp.marked_yaml import Marked
from cfepy.psp.profile import BoardProfile, load_profile
from cfepy.status import UsageError

CORE_APPS = ("CFE_EVS", "CFE_SB", "CFE_ES", "CFE_TIME", "CFE_TBL")
NO_SYMBOL = "NULL"
FILES = "/cf/"
_NOTE = re.compile(r"(.+?):(\d+): (.*)", re.DOTALL)  # of a launch file, as far as it is about a line


class Finding(NamedTuple):
    """Something wrong: `line` counts from 1, 0 stands for the whole file."""

    file: Path
    line: int
    text: str


def check_mission(mission: str, board: str | None = None, args: Mapping[str, str] | None = None) -> list[Finding]:
    """Find everything that is wrong with a mission.

    Args:
        mission: see `spec.find_script`.
        board: name or file of a board; None takes the mission's own.
        args: arguments for a launch file.

    Returns:
        What was found, by file and line; nothing for a mission that can boot.

    Raises:
        UsageError: there is no such mission.
    """
    script = find_script(mission)
    if script.suffix in LAUNCH_FILES:
        return _check_launch_file(script, args)
    folder = script.parent
    data = script.read_bytes()
    entries = startup_script.entries(data)
    found = [Finding(script, note.line, note.explanation) for note in startup_script.check(data)]
    found += _check_names(script, entries)
    for entry in entries:
        found += _check_code(script, folder, entry)
    path = next((path for path in (script.with_suffix(".yaml"), folder / MISSION_FILE) if path.is_file()), None)
    said = check_file(path) if path is not None else CheckedFile()
    found += [Finding(Path(error.file or script), error.line or 0, _with_field(error)) for error in said.errors]
    found += _check_nodes(said, entries)
    found += _check_deadlines(said, entries)
    found += _check_packets(said, script)
    found += _check_lock(folder / LOCK_FILE, said)
    found += _check_board(script, entries, said, board, folder)
    return sorted(dict.fromkeys(found), key=lambda finding: (str(finding.file), finding.line))


def _check_launch_file(file: Path, args: Mapping[str, str] | None) -> list[Finding]:
    """What stops the file, or what of it is left out."""
    try:
        notes = read_launch(file, args).notes
    except UsageError as error:
        return [Finding(Path(error.file or file), error.line or 0, _with_field(error))]
    places = ((_NOTE.fullmatch(note), note) for note in notes)
    return [Finding(Path(at[1]), int(at[2]), at[3]) if at else Finding(file, 0, note) for at, note in places]


def _check_lock(path: Path, said: CheckedFile) -> Iterator[Finding]:
    if not path.is_file():
        return
    try:
        read_lock(path, RosConfig(topics=said.topics))
    except UsageError as error:
        yield Finding(Path(error.file or path), error.line or 0, _with_field(error))


def _with_field(error: UsageError) -> str:
    return f"{error.field}: {error.text}" if error.field else error.text


# -- the startup script ------------------------------------------------------------------------------------------------


def _check_names(script: Path, entries: list[Entry]) -> Iterator[Finding]:
    """Names that are missing or taken; applications and libraries have a name space each."""
    taken = {(CFE_APP, name): "the core application" for name in CORE_APPS}
    for entry in entries:
        if not entry.name:
            yield Finding(script, entry.line, "the name is empty; write one in the fourth field")
            continue
        key = (entry.kind, entry.name)
        if key in taken:
            text = f"the name {entry.name!r} is taken by {taken[key]}; give this one another name"
            yield Finding(script, entry.line, text)
        taken.setdefault(key, f"line {entry.line}")


def _check_code(script: Path, folder: Path, entry: Entry) -> Iterator[Finding]:
    if not entry.path.startswith(FILES) or ".." in entry.path:
        text = f"{entry.path} is not below /cf, which is the mission's folder; write {FILES}..."
        yield Finding(script, entry.line, text)
        return
    is_node = entry.symbol == NODE_SYMBOL
    if not is_node and len(entry.path.rpartition("/")[2]) >= OS_MAX_FILE_NAME:
        text = f"the file name in {entry.path} has {OS_MAX_FILE_NAME} characters or more; choose a shorter one"
        yield Finding(script, entry.line, text)
        return
    code = (find_node(entry.path, folder) if is_node else None) or find_code(entry.path, folder)
    if code is None:
        stem = Path(entry.path).stem
        text = f"no code for {entry.path}: no {stem}.py and no package {stem} in {folder}, no app or module {stem}"
        yield Finding(script, entry.line, text + "; add it, or correct the name")
        return
    if is_node and not isinstance(code, Path):
        yield Finding(script, entry.line, f"the node {entry.name} is no script of the mission's folder; add the script")
        return
    source = sources.source_of(code)
    if source is not None:
        broken = list(_check_syntax(source))
        yield from broken or _check_symbol(script, entry, source)


def _check_syntax(source: Path) -> Iterator[Finding]:
    for file in sources.files_of(source):
        error = sources.syntax_error(file)
        if error is not None:
            yield Finding(file, error[0], f"is not Python: {error[1]}")


def _check_symbol(script: Path, entry: Entry, source: Path) -> Iterator[Finding]:
    if entry.symbol == NODE_SYMBOL or (entry.kind == CFE_LIB and entry.symbol == NO_SYMBOL):
        return
    if not entry.symbol:
        yield Finding(script, entry.line, "the entry point is empty; write a function's name in the third field")
    elif not sources.defines(source, entry.symbol):
        functions = [name for file in sources.files_of(source) for name in sources.functions_of(file)]
        near = get_close_matches(entry.symbol, functions, 1)
        hint = f"; is {near[0]} meant?" if near else f"; write {NODE_SYMBOL} if it is a ROS node, or add the function"
        yield Finding(script, entry.line, f"{source} has no function {entry.symbol}{hint}")


# -- the mission file --------------------------------------------------------------------------------------------------


def _check_nodes(said: CheckedFile, entries: list[Entry]) -> Iterator[Finding]:
    """Entries under `nodes:` that belong to no node of the startup script, and node names given twice."""
    symbols = {entry.name: entry.symbol for entry in entries if entry.kind == CFE_APP}
    names: dict[str, str] = {}
    for app, place in said.node_places.items():
        if app not in symbols:
            yield _unknown_app(f"nodes.{app}", app, place, symbols)
        elif symbols[app] != NODE_SYMBOL:
            text = f"nodes.{app}: {app} is no ROS node, its entry point is {symbols[app]}"
            text += f"; write {NODE_SYMBOL} in the startup script, or remove this"
            yield Finding(place.file, place.line, text)
        node = said.nodes.get(app)
        if node is not None and node.name is not None:
            full = f"{node.namespace.rstrip('/')}/{node.name.lstrip('/')}"
            other = names.setdefault(full, app)
            if other != app:
                text = f"nodes.{app}: the node name {full} is that of {other} too; change one, or ROS ends the older"
                yield Finding(place.file, place.line, text)


def _check_deadlines(said: CheckedFile, entries: list[Entry]) -> Iterator[Finding]:
    """Deadlines of applications that are not there."""
    apps = [*(entry.name for entry in entries if entry.kind == CFE_APP), *CORE_APPS, "ROS"]
    for app, place in said.deadline_places.items():
        if app not in apps and not said.launches:
            yield _unknown_app(f"deadlines.apps.{app}", app, place, apps)


def _check_packets(said: CheckedFile, script: Path) -> Iterator[Finding]:
    """Packets that invariants and results name, and that the mission does not have."""
    if not said.packet_places or said.errors:
        return  # what the mission has is known when the rest of its file is right
    dictionary = dictionary_of(read_mission(str(script)))
    for name, place in said.packet_places:
        try:
            if name not in dictionary.commands:
                dictionary.telemetry_of(name)
        except UsageError as error:
            yield Finding(place.file, place.line, f"{place.field}: {error.text}")


def _unknown_app(field: str, app: str, place: Marked, apps: Collection[str]) -> Finding:
    near = get_close_matches(app, apps, 1)
    hint = f"is {near[0]} meant?" if near else f"the startup script has {', '.join(apps) or 'none'}"
    return Finding(place.file, place.line, f"{field}: no application is called {app}; {hint}")


# -- the board ---------------------------------------------------------------------------------------------------------


def _check_board(
    script: Path, entries: list[Entry], said: CheckedFile, board: str | None, folder: Path
) -> Iterator[Finding]:
    wanted = board or said.board or "linux"
    if board is None and (folder / wanted).is_file():
        wanted = str(folder / wanted)
    try:
        profile = load_profile(wanted)
    except UsageError as error:
        place = said.board_place
        if error.file is None and place is not None and board is None:
            yield Finding(place.file, place.line, _with_field(error))
        else:
            yield Finding(Path(error.file or script), error.line or 0, _with_field(error))
        return
    try:
        config = said.limits.config(profile, any(entry.symbol == NODE_SYMBOL for entry in entries))
    except UsageError as error:
        yield Finding(Path(error.file or script), error.line or 0, _with_field(error))
        return
    yield from _check_limits(script, entries, profile, config)
    yield from _check_stacks(script, entries, profile, config)


def _check_limits(
    script: Path, entries: list[Entry], profile: BoardProfile, config: PlatformConfig
) -> Iterator[Finding]:
    ros = any(entry.symbol == NODE_SYMBOL for entry in entries)
    apps = [entry for entry in entries if entry.kind == CFE_APP]
    libraries = [entry for entry in entries if entry.kind == CFE_LIB]
    for what, these, limit in (
        ("application", apps, config.es_max_applications - len(CORE_APPS) - ros),
        ("library", libraries, config.es_max_libraries),
    ):
        name = "es_max_applications" if what == "application" else "es_max_libraries"
        raise_it = "the board's limit" if name in profile.limits else f"limits.{name} in the mission file"
        for entry in these[limit:]:
            text = f"{entry.name} is one {what} too many, {profile.name} takes {limit}"
            text += f"; start fewer, or raise {raise_it}"
            yield Finding(script, entry.line, text)


def _check_stacks(
    script: Path, entries: list[Entry], profile: BoardProfile, config: PlatformConfig
) -> Iterator[Finding]:
    """Stacks and task control blocks against the RAM; pools, queues and tables come on top of them when it runs."""
    if not profile.sram_size:
        return
    block = profile.memory_costs.task_control_block
    used = len(CORE_APPS) * (config.es_start_task_stack_size + block)
    for entry in entries:
        if entry.kind != CFE_APP:
            continue
        used += entry.stack_size + block
        if used > profile.sram_size:
            text = f"with the stack of {entry.name} ({entry.stack_size:,} bytes) all stacks are {used:,} bytes"
            yield Finding(
                script,
                entry.line,
                f"{text}, {profile.name} has {profile.sram_size:,}; choose smaller stacks or fewer applications",
            )
            return
