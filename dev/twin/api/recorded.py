"""Recorded answers of a real cFE, for machines without one: tests/data/api_answers/<release>_<seed>_<count>.txt.xz."""

from __future__ import annotations

import lzma
from pathlib import Path

FOLDER = Path(__file__).parents[3] / "tests/data/api_answers"


Record = tuple[str, int, int]
"""Release, seed, and number of calls."""


def write_record(record: Record, answers: list[str]) -> None:
    """Keep the answers to a script."""
    FOLDER.mkdir(exist_ok=True)
    data = "\n".join(answers).encode("utf-8", "surrogateescape")
    _path(record).write_bytes(lzma.compress(data, preset=9))


def records() -> list[Record]:
    """Return each script that was recorded."""
    names = sorted(each.name.partition(".txt")[0] for each in FOLDER.glob("*_*_*.txt.xz"))
    parts = (name.split("_") for name in names)
    return [(release, int(seed), int(count)) for release, seed, count in parts]


def read_record(record: Record) -> list[str]:
    """Return the answers to a script."""
    return lzma.decompress(_path(record).read_bytes()).decode("utf-8", "surrogateescape").splitlines()


def _path(record: Record) -> Path:
    release, seed, count = record
    return FOLDER / f"{release}_{seed}_{count}.txt.xz"
