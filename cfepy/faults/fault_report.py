"""The report on each fault of a plan: how often and when it happened, or why it never did."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

from cfepy.faults.fault_plan import Fault

MOST_LINES = 5  # maximum number of lines on the console for one fault
MOST_INSTANTS = 1000  # maximum number of recorded times of one fault


@dataclass(slots=True)
class FaultRecord:
    """One fault.

    Attributes:
        fault: the fault in the plan.
        times: how often it happened.
        last_ns: time of its last occurrence.
        at_ns: virtual times in ns of its first 1000 occurrences.
        texts: their descriptions.
        why_not: why it has not happened so far.
    """

    fault: Fault
    times: int = 0
    last_ns: int = 0
    at_ns: list[int] = field(default_factory=list)
    texts: list[str] = field(default_factory=list)
    why_not: str = "the run ended before"


class FaultReport:
    """Faults of a run, across all resets of the processor.

    Args:
        faults: faults of the plan.
        now: the virtual time in ns.
        console: receives a line for each of the first occurrences of a fault.
        note: receives a text for the trace, for all later ones.
    """

    def __init__(
        self,
        faults: Iterable[Fault],
        now: Callable[[], int],
        console: Callable[[str], object],
        note: Callable[[str], object],
    ) -> None:
        self.records = {fault.name: FaultRecord(fault) for fault in faults}
        self._now = now
        self._console = console
        self._note = note

    def happened(self, fault: Fault, text: str) -> None:
        """Record a fault that happens now; `text` describes it."""
        record = self.records[fault.name]
        record.times += 1
        record.last_ns = self._now()
        if record.times <= MOST_INSTANTS:
            record.at_ns.append(self._now())
            record.texts.append(text)
        line = f"cfepy fault {fault.name}: {text}"
        if record.times <= MOST_LINES:
            more = " (later ones are in the trace and in the report)" if record.times == MOST_LINES else ""
            self._console(line + more)
        else:
            self._note(line)

    def missed(self, fault: Fault, why: str) -> None:
        """Record why a fault could not happen now."""
        record = self.records[fault.name]
        if why != record.why_not:
            self._console(f"cfepy fault {fault.name}: did not happen: {why}")
        record.why_not = why

    def rows(self) -> list[dict[str, Any]]:
        """Return a row for each fault, in the plan's order, as in the results of a run; times in s."""
        return [_row(record) for record in self.records.values()]


def _row(record: FaultRecord) -> dict[str, Any]:
    return {
        "name": record.fault.name,
        "what": record.fault.text,
        "explored": record.fault.when.explored > 0,
        "times": record.times,
        "first_at_s": record.at_ns[0] / 1e9 if record.times else None,
        "last_at_s": record.last_ns / 1e9 if record.times else None,
        "at_s": [at_ns / 1e9 for at_ns in record.at_ns],
        "details": list(record.texts),
        "never": None if record.times else record.why_not,
    }
