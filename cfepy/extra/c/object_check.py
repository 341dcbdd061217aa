"""Compiled code that a startup script names, checked before a run: entry points, missing functions, the ABI,
the layouts of its ground names."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from cfepy.es import CFE_LIB, NODE_SYMBOL, StartupEntry
from cfepy.extra.c.abi import AbiProfile, abi_profile
from cfepy.extra.c.api import function_names
from cfepy.extra.c.devices import TERMINAL_FUNCTIONS
from cfepy.extra.c.elf import ElfError, SharedObject, read_shared_object
from cfepy.extra.c.ground_check import ground_differences
from cfepy.extra.c.linking import refused_names, undefined_on_linux, wanted_names
from cfepy.extra.c.refused import BY_REASON, REASONS
from cfepy.extra.c.source_places import CodePlace, first_calls
from cfepy.extra.c.toolchain.cfe6 import is_name_of_cfe_6
from cfepy.mission import MissionSections, find_compiled
from cfepy.pilot import MissionProblem
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import OBJECT_BYTES
from cfepy.reading.marked_yaml import load
from cfepy.reading.mistakes import Mistakes
from cfepy.reading.suggestions import did_you_mean
from cfepy.status import UsageError

NO_SYMBOL = "NULL"
PROFILE = "omit_deprecated"
MISSION_FILE, DEVICES = "mission.yaml", "devices"


def check_compiled(
    script: Path, entries: Sequence[StartupEntry], entry: StartupEntry, file: Path
) -> Iterator[MissionProblem]:
    """Yield the problems of a compiled application or library.

    Args:
        script: the startup script.
        entries: its entries.
        entry: the line that names the file.
        file: the shared object.
    """
    try:
        source = read_shared_object(read_limited(file, OBJECT_BYTES), file.name)
        wanted = set(wanted_names(source)) - function_names() | refused_names(source)
        terminal = TERMINAL_FUNCTIONS.intersection(wanted_names(source))
    except ElfError as error:
        yield MissionProblem(file, 0, str(error))
        return
    functions = [each.name for each in source.symbols if each.is_defined and each.kind == "STT_FUNC"]
    if entry.symbol not in ("", NO_SYMBOL, *functions):
        hint = did_you_mean(entry.symbol, functions, "correct the name, or export the function (it may be static)")
        yield MissionProblem(script, entry.line, f"{file.name} has no function {entry.symbol}; {hint}")
    yield from _check_needs(script, entries, entry, source, wanted)
    if terminal and not _has_devices(script):
        listed = _listed(set(terminal), first_calls(source, set(terminal)))
        text = f"{entry.name} needs {listed} for a device, but the mission connects none"
        yield MissionProblem(script, entry.line, f"{text}; add `devices:` to the mission file", is_warning=True)
    yield from ground_differences(entry.path, script.parent)


def _has_devices(script: Path) -> bool:
    """Return True if the mission file connects devices, so that device files can be opened."""
    beside = script.with_suffix(".yaml")
    try:
        return DEVICES in load(beside if beside.is_file() else script.parent / MISSION_FILE).mapping()
    except UsageError:
        return False


def _check_needs(
    script: Path, entries: Sequence[StartupEntry], entry: StartupEntry, source: SharedObject, wanted: set[str]
) -> Iterator[MissionProblem]:
    before = True
    for each in entries:
        if each is entry:
            before = False
            continue
        exported = _exported(script.parent, each) & wanted
        if exported and not before:
            text = (
                f"{entry.name} needs {_listed(exported)} of the library {each.name}, which line {each.line} loads later"
            )
            yield MissionProblem(script, entry.line, text + "; move that line up", is_warning=True)
        wanted = wanted - exported
    unknown = {name for name in wanted if name not in REASONS}
    places = first_calls(source, wanted)
    if unknown:
        listed = _listed(unknown, places)
        text = f"{entry.name} needs {listed}, but cfepy and the libraries of the mission do not define them"
        if any(map(is_name_of_cfe_6, unknown)):
            text += ", because it was built for cFE 6; build its sources with cfepy build --cfe 6.5, 6.7 or 6.8"
        nowhere = undefined_on_linux(source, sorted(unknown))
        so = f"; it cannot be loaded without {_listed(set(nowhere))}" if nowhere else "; calling it is a fault"
        yield MissionProblem(script, entry.line, text + so, is_warning=not nowhere)
    for reason, names in BY_REASON.items():
        refused = wanted.intersection(names)
        if refused:
            text = f"{entry.name} needs {_listed(refused, places)}, but {reason}; calling it is a fault"
            yield MissionProblem(script, entry.line, text, is_warning=True)


def _exported(folder: Path, entry: StartupEntry) -> set[str]:
    """Return the names that a library defines."""
    file = find_compiled(entry.path, folder) if entry.kind == CFE_LIB else None
    if file is None:
        return set()
    try:
        source = read_shared_object(read_limited(file, OBJECT_BYTES), file.name)
    except ElfError:
        return set()
    return {each.name for each in source.symbols if each.is_defined}


def check_profiles(script: Path, entries: list[StartupEntry], said: MissionSections) -> Iterator[MissionProblem]:
    """Yield problems for shared objects with another profile than the mission's, or an unknown profile.

    An object of unknown profile gets no warning when the mission file names the profile.

    Args:
        script: the startup script.
        entries: its entries.
        said: the sections of the mission file.
    """
    named = [find_compiled(each.path, script.parent) for each in entries if each.symbol != NODE_SYMBOL]
    files = [file for file in dict.fromkeys(named) if file is not None]
    if not files:
        return
    omits = said.compiled.omit_deprecated
    unknown = []
    for file in files:
        try:
            profile = abi_profile(read_shared_object(read_limited(file, OBJECT_BYTES), file.name))
        except ElfError:
            continue  # reported with the line that names the file
        if profile.contradicts(omits):
            text = f"was built {profile.value}, but the mission requires the opposite; build it with the option"
            text += f" OMIT_DEPRECATED={_word(omits)}, or add {_line(not omits)} to the mission file"
            yield MissionProblem(file, 0, text)
        elif profile is AbiProfile.UNKNOWN:
            unknown.append(file.name)
    if unknown and not _says_profile(said):
        text = (
            f"cannot determine whether {', '.join(unknown)} have OMIT_DEPRECATED, "
            "because debug data of table handles is missing;"
        )
        text += (
            f" {_word(omits)} is assumed; add {_line(omits)} to the mission file if that is right, or compile with -g"
        )
        yield MissionProblem(script, 0, text, is_warning=True)


def _word(value: bool) -> str:
    return str(value).lower()


def _line(omits: bool) -> str:
    return f"`compiled: {{{PROFILE}: {_word(omits)}}}`"


def _says_profile(said: MissionSections) -> bool:
    """Return True if the mission file itself sets the profile."""
    section = said.places.get("compiled")
    return section is not None and PROFILE in Mistakes().mapping(section)


def _listed(names: set[str], places: Mapping[str, CodePlace] | None = None) -> str:
    """Return names, each with the file and line of its first call where that is known."""
    known = places or {}
    return ", ".join(
        f"{each} ({known[each].name}:{known[each].line})" if each in known else each for each in sorted(names)
    )
