"""A file in the Trace Event Format, which Perfetto (ui.perfetto.dev) and chrome://tracing open, and cFE's performance
log as such a file.

Many events happen at the same virtual instant, on a board without processor costs nearly all of them. To make their
order visible, each event is drawn at least `STEP_NS` after the previous one. The drawing returns to the virtual time as
soon as virtual time has caught up.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from typing import IO, Any

from cfepy import __version__

STEP_NS = 10
NS_PER_US = 1_000  # the format counts in us
CORE_MARKERS = {
    1: "CFE_ES main",
    2: "CFE_EVS main",
    3: "CFE_TBL main",
    4: "CFE_SB main",
    5: "CFE_SB message limit",
    6: "CFE_TIME main",
    7: "CFE_TIME tone interrupt",
    8: "CFE_TIME 1 Hz interrupt",
    9: "CFE_TIME send MET",
    10: "CFE_TIME 1 Hz task",
    11: "CFE_TIME tone task",
    27: "CFE_SB pipe overflow",
}
"""Names of cFE's own ids (cfe_perfids.h)."""


class TraceEvents:
    """Writes the file.

    Args:
        file: a text file, which the caller closes.

    Attributes:
        error: the error of writing, for the caller that closes the file. It is kept here because host errors must not
            be raised inside the simulation.
    """

    def __init__(self, file: IO[str]) -> None:
        self.error: OSError | None = None
        self._file = file
        self._drawn_ns = -STEP_NS
        self._is_first = True

    def begin(self) -> None:
        """Write the start of the file, before the first event."""
        self._put('{"displayTimeUnit":"ns","traceEvents":[\n')

    def end(self, about: Mapping[str, Any]) -> None:
        """Write the end of the file, after the last event; `about` describes the trace."""
        other = {**about, "cfepy": __version__, "drawn_apart_ns": STEP_NS}
        self._put(f'\n],"otherData":{json.dumps(other)}}}\n')

    def write(self, **fields: Any) -> None:
        """Write an event with these fields."""
        start = "" if self._is_first else ",\n"
        self._is_first = False
        self._put(start + json.dumps(fields, separators=(",", ":")))

    def _put(self, text: str) -> None:
        if self.error is None:
            try:
                self._file.write(text)
            except OSError as error:
                self.error = error

    def draw(self, at_ns: int) -> int:
        """Return the drawn time in ns of an event at a virtual time in ns."""
        self._drawn_ns = max(at_ns, self._drawn_ns + STEP_NS)
        return self._drawn_ns

    def name_process(self, pid: int, name: str) -> None:
        """Name a group of tracks."""
        self.write(ph="M", pid=pid, tid=0, name="process_name", args={"name": name})
        self.write(ph="M", pid=pid, tid=0, name="process_sort_index", args={"sort_index": pid})

    def name_thread(self, pid: int, tid: int, name: str) -> None:
        """Name a track."""
        self.write(ph="M", pid=pid, tid=tid, name="thread_name", args={"name": name})


def us(time_ns: int) -> float:
    """Return a time in the unit of the format."""
    return time_ns / NS_PER_US


def write_perf_log(file: IO[str], entries: Iterable[Mapping[str, Any]], about: Mapping[str, Any]) -> None:
    """Write a performance log: a track for each marker, with a slice from each entry to its exit.

    A slice without an exit lasts to the end of the log, and an exit without an entry is an instant.

    Args:
        file: a text file.
        entries: entries in their order, with `Id`, `IsExit` and `TimeUs`
            (`cfepy.ground.cfe_files.dump_files.read_perf_data`).
        about: a description of the log.
    """
    out, inside = TraceEvents(file), dict[int, int]()
    out.begin()
    out.name_process(1, "performance log")
    now_ns = 0
    for entry in entries:
        marker, now_ns = entry["Id"], round(entry["TimeUs"] * NS_PER_US)
        if marker not in inside:
            inside[marker] = 0
            out.name_thread(1, marker, f"{marker} {CORE_MARKERS.get(marker, '')}".strip())
        place = {"pid": 1, "tid": marker, "ts": us(out.draw(now_ns)), "name": f"marker {marker}"}
        args = {"virtual_ns": now_ns}
        if entry["IsExit"] and not inside[marker]:
            out.write(ph="i", s="t", cat="exit without an entry", args=args, **place)
        else:
            inside[marker] += -1 if entry["IsExit"] else 1
            out.write(ph="E" if entry["IsExit"] else "B", cat="performance log", args=args, **place)
    for marker, count in inside.items():
        for _ in range(count):
            out.write(ph="E", pid=1, tid=marker, ts=us(out.draw(now_ns)))
    out.end(about)
    if out.error is not None:
        raise out.error
