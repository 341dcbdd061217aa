"""The ABI profile of a mission's compiled applications and libraries, held against what its mission file says."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from cfepy.es import StartupEntry
from cfepy.marked_yaml import Mistakes
from cfepy.mission import NODE_SYMBOL, MissionSections, find_compiled
from cfepy.pilot.check.problem import MissionProblem

_FIELD = "omit_deprecated"


def check_profiles(script: Path, entries: list[StartupEntry], said: MissionSections) -> Iterator[MissionProblem]:
    """Shared objects that were built for the other profile than the mission's, and those of which that is not known.

    Of the latter nothing is told when the mission file says itself which profile holds.

    Args:
        script: the startup script.
        entries: what it starts.
        said: what the mission file says.
    """
    named = [find_compiled(each.path, script.parent) for each in entries if each.symbol != NODE_SYMBOL]
    files = [file for file in dict.fromkeys(named) if file is not None]
    if not files:
        return
    from cfepy.c import AbiProfile, ElfError, abi_profile, read_shared_object

    omits = said.compiled.omit_deprecated
    unknown = []
    for file in files:
        try:
            profile = abi_profile(read_shared_object(file.read_bytes(), file.name))
        except ElfError:
            continue  # told with the line that names the file
        if profile.contradicts(omits):
            text = f"was built {profile.value}, and the mission is for the other: build it with the option"
            text += f" OMIT_DEPRECATED={_word(omits)}, or write {_line(not omits)} into the mission file"
            yield MissionProblem(file, 0, text)
        elif profile is AbiProfile.UNKNOWN:
            unknown.append(file.name)
    if unknown and not _says(said):
        text = f"whether {', '.join(unknown)} have OMIT_DEPRECATED cannot be told, without debug data of table handles;"
        text += (
            f" {_word(omits)} is taken: write {_line(omits)} into the mission file if that is right, or compile with -g"
        )
        yield MissionProblem(script, 0, text, is_warning=True)


def _word(value: bool) -> str:
    return str(value).lower()


def _line(omits: bool) -> str:
    return f"`compiled: {{{_FIELD}: {_word(omits)}}}`"


def _says(said: MissionSections) -> bool:
    """Whether the mission file itself says the profile."""
    section = said.places.get("compiled")
    return section is not None and _FIELD in Mistakes(keep=True).mapping(section)
