"""Rules for a run, and the attachments that check them: observer, invariants, deadlines, priority inversions.

An attachment that observes a run without changing it belongs here, as does the reader of the section of the mission
file that configures it. Faults are in `cfepy.faults`, commands and expected answers in `cfepy.script`.

The names below are loaded on first use, so a run loads only the parts of this package that it needs. The central file
is `cfepy/monitors/observer.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.monitors.deadlines import Check, DeadlineResult, Overrun
    from cfepy.monitors.durations import RESPONSE, WAIT, LongestWatch, Measure
    from cfepy.monitors.inversions import InversionWatch
    from cfepy.monitors.liveness import Lack, Limits, LivenessWatch
    from cfepy.monitors.observed_messages import Heard, MessageWatch, unknown_packets
    from cfepy.monitors.observer import Observer, Sent, app_of
    from cfepy.monitors.predicate import Predicate, short, shortened
    from cfepy.monitors.race_watch import LOCKS_GIVEN, LOCKS_TAKEN, RaceWatch
    from cfepy.monitors.record import DeadlineRecord, InvariantRecords
    from cfepy.monitors.run_rules import Demands, demands_of, judges_of, read_demands
    from cfepy.monitors.selected_results import FILE, OUTPUT, SelectedResult
    from cfepy.monitors.traffic_watch import Arrivals, TrafficWatch

__all__ = [
    "FILE",
    "LOCKS_GIVEN",
    "LOCKS_TAKEN",
    "OUTPUT",
    "RESPONSE",
    "WAIT",
    "Arrivals",
    "Check",
    "DeadlineRecord",
    "DeadlineResult",
    "Demands",
    "Heard",
    "InvariantRecords",
    "InversionWatch",
    "Lack",
    "Limits",
    "LivenessWatch",
    "LongestWatch",
    "Measure",
    "MessageWatch",
    "Observer",
    "Overrun",
    "Predicate",
    "RaceWatch",
    "SelectedResult",
    "Sent",
    "TrafficWatch",
    "app_of",
    "demands_of",
    "judges_of",
    "read_demands",
    "short",
    "shortened",
    "unknown_packets",
]

if not TYPE_CHECKING:  # type checkers see only the names above
    __getattr__, __dir__ = face(
        __name__,
        {
            ".deadlines": ("Check", "DeadlineResult", "Overrun"),
            ".run_rules": (
                "Demands",
                "demands_of",
                "judges_of",
                "read_demands",
            ),
            ".inversions": ("InversionWatch",),
            ".liveness": (
                "Lack",
                "Limits",
                "LivenessWatch",
            ),
            ".durations": (
                "RESPONSE",
                "WAIT",
                "LongestWatch",
                "Measure",
            ),
            ".record": ("DeadlineRecord", "InvariantRecords"),
            ".selected_results": ("FILE", "OUTPUT", "SelectedResult"),
            ".race_watch": ("LOCKS_GIVEN", "LOCKS_TAKEN", "RaceWatch"),
            ".observed_messages": (
                "Heard",
                "MessageWatch",
                "unknown_packets",
            ),
            ".observer": (
                "Observer",
                "Sent",
                "app_of",
            ),
            ".predicate": (
                "Predicate",
                "short",
                "shortened",
            ),
            ".traffic_watch": ("Arrivals", "TrafficWatch"),
        },
    )
