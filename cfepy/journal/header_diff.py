"""Differences of two journals apart from their records, as lines of text: plan, board, schedule, versions, files."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import zip_longest
from typing import Any

from cfepy.journal.journal import Journal
from cfepy.journal.mission_files import MissionFile

_INNOCENT = ("words", "launch_args")  # how the user named the mission; its files identify it


def differences(one: Journal, other: Journal) -> Iterator[str]:
    """Yield a line for each difference in the starting conditions of the runs."""
    plans = one.plan.to_dict(), other.plan.to_dict()
    yield from _changes("", plans[0], plans[1], _INNOCENT)
    yield from _changes("", _machine(one), _machine(other))
    yield from _changes("version of ", one.header.versions, other.header.versions)
    yield from _changes("host: ", one.header.host, other.header.host)
    yield from _changes("environment: ", one.header.environ, other.header.environ)
    yield from _files(_by_name(one), _by_name(other))
    if one.pauses != other.pauses or one.answers != other.answers:
        yield f"external input: {_inputs(one)}, {_inputs(other)}"


def _machine(journal: Journal) -> dict[str, Any]:
    header = journal.header
    return {"mission": header.mission, "joined to the network": header.paced is not None}


def _inputs(journal: Journal) -> str:
    count = sum(len(pause.events) for pause in journal.pauses) + len(journal.answers)
    return f"{count} event{'' if count == 1 else 's'}"


def _changes(
    what: str, one: Mapping[str, Any], other: Mapping[str, Any], left_out: tuple[str, ...] = ()
) -> Iterator[str]:
    for name in dict.fromkeys((*one, *other)):
        mine, theirs = one.get(name), other.get(name)
        if mine != theirs and name not in left_out:
            yield f"{what}{name}: {mine}, {theirs}"


def _by_name(journal: Journal) -> dict[str, MissionFile]:
    """Return files of the mission's folder by relative path, others by absolute path."""
    folder = f"{journal.header.folder}/"
    return {path.removeprefix(folder): each for path, each in journal.files.items()}


def _files(one: Mapping[str, MissionFile], other: Mapping[str, MissionFile]) -> Iterator[str]:
    for name in sorted({*one, *other}):
        mine, theirs = one.get(name), other.get(name)
        if mine is None or theirs is None:
            yield f"file {name}: only {'the second' if mine is None else 'the first'} run has it"
        elif mine.sha256 != theirs.sha256:
            yield f"file {name}: not the same{_place(mine, theirs)}"


def _place(one: MissionFile, other: MissionFile) -> str:
    """Return the first line that differs, if both are text and contained in the journals."""
    if one.data is None or other.data is None:
        return ""
    try:
        texts = (one.data.decode().splitlines(), other.data.decode().splitlines())
    except UnicodeDecodeError:
        return ""
    pairs = enumerate(zip_longest(*texts), 1)
    return next((f", from line {number} on" for number, (mine, theirs) in pairs if mine != theirs), "")
