"""Performance data of ES: which parts of the flight software were entered and left when, and how long each took.

An entry of the log is an id, a bit that says "left", and a time of the board's timer in two halves.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from cfepy.es.packets import PERF_ENTRY, PERF_METADATA
from cfepy.rtos.units import US_PER_S

EXIT_BIT = 0x80000000
WHOLE_WORD = 1 << 32


@dataclass(slots=True)
class Timing:
    """How long a part took, in us, each time that it was entered and left; `open` are entries without an exit yet."""

    taken_us: list[float] = field(default_factory=list)
    open: list[float] = field(default_factory=list)
    unpaired: int = 0


def read_perf_data(body: bytes) -> tuple[dict[str, Any], list[dict[str, Any]], str]:
    """The metadata, the entries in order of time, and what is wrong with the file.

    Args:
        body: what follows the file header.
    """
    if len(body) < PERF_METADATA.size:
        return {}, [], f"is cut off: the metadata have {len(body)} of {PERF_METADATA.size} bytes"
    about = PERF_METADATA.unpack(body)
    if about["Endian"]:
        return about, [], "was written by a big-endian processor, which is not read here"
    entries = body[PERF_METADATA.size :]
    count, rest = divmod(len(entries), PERF_ENTRY.size)
    records = [_record(PERF_ENTRY.unpack(entries, number * PERF_ENTRY.size), about) for number in range(count)]
    problem = ""
    if rest or count < about["DataCount"]:
        problem = f"is cut off: it has {count} of {about['DataCount']} entries"
    return about, records, problem


def _record(entry: dict[str, int], about: dict[str, Any]) -> dict[str, Any]:
    rollover = about["TimerLow32Rollover"] or WHOLE_WORD
    ticks = entry["TimerUpper32"] * rollover + entry["TimerLower32"]
    time_us = ticks * US_PER_S / (about["TimerTicksPerSecond"] or US_PER_S)
    return {"Id": entry["Data"] & ~EXIT_BIT, "IsExit": bool(entry["Data"] & EXIT_BIT), "TimeUs": time_us}


def timings(records: Iterable[dict[str, Any]]) -> dict[int, Timing]:
    """Times between entry and exit, by id; an entry within an entry of the same id is left first."""
    found: dict[int, Timing] = {}
    for record in records:
        timing = found.setdefault(record["Id"], Timing())
        if not record["IsExit"]:
            timing.open.append(record["TimeUs"])
        elif timing.open:
            timing.taken_us.append(record["TimeUs"] - timing.open.pop())
        else:
            timing.unpaired += 1
    return dict(sorted(found.items()))
