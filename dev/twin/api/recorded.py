"""Recorded answers of a real cFE, for machines without one: <release>_<kind>_<seed>_<count>.txt.xz in
tests/data/api_answers. The usual kind of script is not named.
"""

from __future__ import annotations

import lzma
from pathlib import Path
from typing import NamedTuple

USUAL = "usual"
FOLDER = Path(__file__).parents[3] / "tests/data/api_answers"


class Record(NamedTuple):
    """A script that was played: release, seed, number of calls, kind of script."""

    release: str
    seed: int
    calls: int
    kind: str = USUAL


def write_record(record: Record, answers: list[str]) -> None:
    """Keep the answers to a script."""
    FOLDER.mkdir(exist_ok=True)
    data = "\n".join(answers).encode("utf-8", "surrogateescape")
    _path(record).write_bytes(lzma.compress(data, preset=9))


def records() -> list[Record]:
    """Return each script that was recorded."""
    names = sorted(each.name.partition(".txt")[0] for each in FOLDER.glob("*_*_*.txt.xz"))
    found = []
    for release, *kind, seed, count in (name.split("_") for name in names):
        found.append(Record(release, int(seed), int(count), *kind))
    return found


def read_record(record: Record) -> list[str]:
    """Return the answers to a script."""
    return lzma.decompress(_path(record).read_bytes()).decode("utf-8", "surrogateescape").splitlines()


def _path(record: Record) -> Path:
    kind = "" if record.kind == USUAL else f"{record.kind}_"
    return FOLDER / f"{record.release}_{kind}{record.seed}_{record.calls}.txt.xz"
