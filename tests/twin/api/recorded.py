"""Answers of a real cFE 7.0.0, kept for machines that have none: tests/data/api_answers/<seed>_<count>.txt.xz."""

from __future__ import annotations

import lzma
from pathlib import Path

FOLDER = Path(__file__).parents[2] / "data" / "api_answers"


def write_record(seed: int, count: int, answers: list[str]) -> None:
    """Keep the answers to a script."""
    FOLDER.mkdir(exist_ok=True)
    data = "\n".join(answers).encode("utf-8", "surrogateescape")
    (FOLDER / f"{seed}_{count}.txt.xz").write_bytes(lzma.compress(data, preset=9))


def records() -> list[tuple[int, int]]:
    """Seed and number of calls of each script that was recorded."""
    names = sorted(each.name.partition(".")[0] for each in FOLDER.glob("*_*.txt.xz"))
    return [(int(name.split("_")[0]), int(name.split("_")[1])) for name in names]


def read_record(seed: int, count: int) -> list[str]:
    """The answers to a script."""
    data = lzma.decompress((FOLDER / f"{seed}_{count}.txt.xz").read_bytes())
    return data.decode("utf-8", "surrogateescape").splitlines()
