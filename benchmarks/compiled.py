"""A compiled application against an equivalent one in Python: ratios of the wall time of calls.

`compiled_app/fsw/src/bench.c` also runs on NASA's cFE and prints its times there.
"""

from __future__ import annotations

import shutil
import tempfile
from itertools import pairwise
from pathlib import Path
from time import perf_counter

from cfepy.extra.c import build
from cfepy.mission import Mission
from cfepy.writing.console import Console

HERE = Path(__file__).parent / "compiled_app"
LINE = "CFE_APP, BENCH, BENCH_Main, BENCH, 50, 16384, 0x0, 0;\n!"
REPEATS = 5
FLIGHT_S = 5  # virtual
MARK = " BENCH "
PIECES = ("sb", "masked event", "event", "table")


class _Clock(Console):
    """Notes the wall time of the application's lines."""

    def __init__(self) -> None:
        super().__init__(quiet=True)
        self.times: list[tuple[str, float]] = []

    def write(self, text: str) -> None:
        if MARK in text and "CFE_ES_" not in text:
            self.times.append((text.partition(MARK)[2].partition(":")[0], perf_counter()))
        super().write(text)


def _pieces(folder: Path, context: str) -> dict[str, float]:
    """Return seconds that each piece took."""
    clock = _Clock()
    with Mission(str(folder), tasks=context, console=clock) as flight:
        flight.run_for(FLIGHT_S)
    times = clock.times
    return {what: end - begin for (_, begin), (what, end) in pairwise(times) if what in PIECES}


def compiled(contexts: tuple[str, ...]) -> dict[str, float]:
    """C by Python, the best of some repeats in turns, by context and kind of call."""
    figures: dict[str, float] = {}
    with tempfile.TemporaryDirectory() as made:
        folders = {kind: Path(made) / kind for kind in ("c", "python")}
        for folder in folders.values():
            folder.mkdir()
            (folder / "startup.scr").write_text(LINE, encoding="utf-8")
        build(HERE, folders["c"] / "BENCH.so")
        shutil.copy(HERE / "BENCH.py", folders["python"])
        for context in contexts:
            best: dict[tuple[str, str], float] = {}
            for _ in range(REPEATS):
                for kind, folder in folders.items():
                    for what, seconds in _pieces(folder, context).items():
                        best[what, kind] = min(seconds, best.get((what, kind), seconds))
            for what in {what for what, _ in best}:
                figures[f"{what.replace(' ', '_')}.{context}"] = best[what, "c"] / best[what, "python"]
    return dict(sorted(figures.items()))
