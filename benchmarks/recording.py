"""The cost of recording: missions/capture with a journal, against the same without."""

from __future__ import annotations

import tempfile
from pathlib import Path
from time import process_time

from cfepy.journal import record
from cfepy.pilot import RunPlan, fly

CAPTURE_S = 30
REPEATS = 5


def recording(contexts: tuple[str, ...]) -> dict[str, float]:
    """Return the relative CPU time of a recorded run, and the journal's bytes per virtual second."""
    figures: dict[str, float] = {}
    for context in contexts:
        plan = RunPlan(("capture",), seconds=CAPTURE_S, tasks=context)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "run.cfepy")
            plain, recorded = [], []
            for _ in range(REPEATS):  # in turns, so that both see the same load of the machine
                plain.append(_seconds(plan, None))
                recorded.append(_seconds(plan, path))
            figures[f"cost_of_recording.{context}"] = min(recorded) / min(plain)
            figures[f"journal_bytes_per_s.{context}"] = path.stat().st_size / CAPTURE_S
    return figures


def _seconds(plan: RunPlan, path: Path | None) -> float:
    begin = process_time()
    if path is None:
        fly(plan)
    else:
        record(plan, path)
    return process_time() - begin
