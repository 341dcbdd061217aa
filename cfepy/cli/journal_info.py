"""`cfepy replay --info`: what a journal has, for a person."""

from __future__ import annotations

from typing import TextIO

from cfepy.journal.journal import Journal
from cfepy.rtos.units import NS_PER_S


def show_info(journal: Journal, stream: TextIO) -> None:
    """Write it down, a line for each thing."""
    header, end = journal.header, journal.end
    carried = sum(each.packed is not None for each in journal.files.values())
    events = sum(len(pause.events) for pause in journal.pauses) + len(journal.answers)
    rows = {
        "command": journal.plan.command_line(),
        "mission": f"{header.mission}, from {header.startup}",
        "recorded with": ", ".join(f"{name} {version}" for name, version in header.versions.items()),
        "on": f"{header.host.get('system', '?')} {header.host.get('machine', '?')}, in {header.cwd}",
        "files": f"{len(journal.files)}, of which the journal carries {carried}; hash {journal.mission_hash}",
        "from outside": f"{events} events" + (f", paced {header.paced:g} times real time" if header.paced else ""),
        "schedule": f"{len(journal.decisions):,} of {journal.decided:,} decisions were not fifo's",
        "goes to": f"{journal.known_until_ns / NS_PER_S:g} s of virtual time",
        "end": "none: its process came to a sudden end" if end is None else end.reason,
    }
    if end is not None:
        rows["records"] = f"{end.records:,}"
        rows["trace"] = end.trace
    for name, value in rows.items():
        print(f"{name + ':':<14} {value}", file=stream)
