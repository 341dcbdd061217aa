"""Compiled applications before a boot: their file, their entry point, and the functions that they need."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from cfepy.es import CFE_LIB, StartupEntry
from cfepy.mission import find_compiled
from cfepy.pilot.check.problem import MissionProblem
from cfepy.suggestions import did_you_mean

NO_SYMBOLS = ("", "NULL")
SHOWN = 8
"""Names of missing functions that are listed."""


def check_compiled(
    script: Path, entries: Sequence[StartupEntry], entry: StartupEntry, file: Path
) -> Iterator[MissionProblem]:
    """What is wrong with a compiled application or library.

    Args:
        script: the startup script.
        entries: what it starts.
        entry: the line that names the file.
        file: the shared object.
    """
    from cfepy.c.elf import ElfError, read_shared_object

    try:
        source = read_shared_object(file.read_bytes(), file.name)
    except ElfError as error:
        yield MissionProblem(file, 0, str(error))
        return
    functions = [each.name for each in source.symbols if each.is_defined and each.kind == "STT_FUNC"]
    if entry.symbol not in (*NO_SYMBOLS, *functions):
        hint = did_you_mean(entry.symbol, functions, "correct the name, or export the function (it may be static)")
        yield MissionProblem(script, entry.line, f"{file.name} has no function {entry.symbol}; {hint}")
    yield from _check_needs(script, entries, entry, set(source.wanted()))


def _check_needs(
    script: Path, entries: Sequence[StartupEntry], entry: StartupEntry, wanted: set[str]
) -> Iterator[MissionProblem]:
    from cfepy.c.api import function_names

    wanted -= function_names()
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
        wanted -= exported
    if wanted:
        text = f"{entry.name} needs {_listed(wanted)}, which neither cfepy nor a library of the mission has"
        yield MissionProblem(script, entry.line, text + "; a call of it is a fault", is_warning=True)


def _exported(folder: Path, entry: StartupEntry) -> set[str]:
    """What a library has."""
    from cfepy.c.elf import ElfError, read_shared_object

    file = find_compiled(entry.path, folder) if entry.kind == CFE_LIB else None
    if file is None:
        return set()
    try:
        source = read_shared_object(file.read_bytes(), file.name)
    except ElfError:
        return set()
    return {each.name for each in source.symbols if each.is_defined}


def _listed(names: set[str]) -> str:
    ordered = sorted(names)
    more = f" and {len(ordered) - SHOWN} more" if len(ordered) > SHOWN else ""
    return ", ".join(ordered[:SHOWN]) + more
