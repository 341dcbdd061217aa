"""The sources of a mission's dictionary, their declarations, and the choice among them.

A mission names them under `dictionary:` of its mission file, and has them in a folder `dictionary` beside its startup
script. cfepy recognizes a file by its content. Where two sources declare a packet of the same MsgId and function code,
the first of electronic data sheets, COSMOS, XTCE and debug data is used.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from functools import lru_cache, partial
from pathlib import Path
from typing import TYPE_CHECKING

from cfepy.es import NODE_SYMBOL, StartupEntry
from cfepy.ground import DICTIONARY, ForeignDeclarations
from cfepy.mission import MissionSpec, find_compiled
from cfepy.msg import Command, Layout, Telemetry
from cfepy.tbl import TableType

if TYPE_CHECKING:
    from cfepy.extra.dictionaries.packets import DeclaredPacket, DeclaredTable, SourceContent

DEBUG_DATA = "debug data"
MOST_FILES = 2_000
_SUFFIXES = (".xml", ".txt")


def declarations_of(spec: MissionSpec) -> ForeignDeclarations:
    """Return the declarations of all sources of a mission, each packet once."""
    contents = contents_of(spec)
    packets: dict[tuple[int, int], Command | Telemetry] = {}
    tables: dict[str, TableType] = {}
    names: dict[int, str] = {}
    for content in contents:
        for packet in content.packets:
            packets.setdefault((packet.msg_id, packet.code or 0), _as_packet(packet))
        for table in content.tables:
            tables.setdefault(table.name, _as_table(table))
        for msg_id, name in content.names.items():
            names.setdefault(msg_id, name)
    problems = [str(problem) for content in contents for problem in content.problems]
    return ForeignDeclarations(
        list(packets.values()), list(tables.values()), names, problems, partial(_layout, contents)
    )


def _layout(contents: Iterable[SourceContent], name: str) -> Layout | None:
    """Return a struct of the first source that has it."""
    found = (content.layout(name) for content in contents)
    return next((layout for layout in found if layout is not None), None)


def contents_of(spec: MissionSpec) -> tuple[SourceContent, ...]:
    """Return the content of each kind of source of a mission, the one with precedence first."""
    return contents_at(spec.dictionary, spec.folder, spec.entries)


def contents_at(named: Iterable[Path], folder: Path, entries: Iterable[StartupEntry]) -> tuple[SourceContent, ...]:
    """Return the content of each kind of source, the one with precedence first.

    Args:
        named: the files and folders that the mission file names.
        folder: the folder of the mission.
        entries: the entries of the startup script.
    """
    places = [*named, folder / DICTIONARY]
    files = tuple(dict.fromkeys(file for place in places for file in _files_at(place)))
    libraries = (find_compiled(entry.path, folder) for entry in entries if entry.symbol != NODE_SYMBOL)
    compiled = tuple(dict.fromkeys(each for each in libraries if each is not None))
    return (
        *_contents(tuple((file, *_stamp(file)) for file in files)),
        *_debug_data(tuple((file, *_stamp(file)) for file in compiled)),
    )


def _files_at(place: Path) -> Iterator[Path]:
    """Yield the files of a place that may be a source: the file itself, or those in the folder, in order."""
    if os.path.isfile(place):
        yield place
        return
    found = sorted(each for each in place.rglob("*") if each.suffix.lower() in _SUFFIXES)
    yield from (each for each in found[:MOST_FILES] if os.path.isfile(each))


def _stamp(file: Path) -> tuple[int, int]:
    try:
        found = os.stat(file)
    except OSError:
        return 0, 0
    return found.st_mtime_ns, found.st_size


@lru_cache(8)  # a mission is read for each of its tools
def _contents(files: tuple[tuple[Path, int, int], ...]) -> tuple[SourceContent, ...]:
    """Read files; their times and sizes distinguish them from earlier versions."""
    if not files:
        return ()
    from cfepy.extra.dictionaries.file_sources import contents_of_files  # most missions need no reader

    return contents_of_files(file for file, *_ in files)


@lru_cache(8)
def _debug_data(files: tuple[tuple[Path, int, int], ...]) -> tuple[SourceContent, ...]:
    """Read compiled applications; see `_contents`."""
    if not files:
        return ()
    from cfepy.extra.dictionaries.debug_data import read_debug_data

    found = read_debug_data(file for file, *_ in files)
    return (found,)


def _as_packet(packet: DeclaredPacket) -> Command | Telemetry:
    if packet.is_command:
        return Command(packet.name, packet.msg_id, packet.code, packet.payload, packet.text)
    return Telemetry(packet.name, packet.msg_id, packet.payload, packet.text, header_size=packet.header_size)


def _as_table(table: DeclaredTable) -> TableType:
    return TableType(table.name, table.row, table.rows, description=table.text[:31])
