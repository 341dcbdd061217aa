"""What `cfepy explore` tells at its end: each failure once, how to replay it, and its timeline."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, TextIO

from cfepy.explore.campaign import Tally
from cfepy.explore.findings import Finding
from cfepy.explore.shrink import Shrunk
from cfepy.explore.trial import Trial
from cfepy.explore.verdict import Verdict
from cfepy.rtos.units import NS_PER_S


@dataclass(slots=True)
class Report:
    """What an exploration came to.

    Attributes:
        trial: what was flown.
        reference: the verdict on the default schedule.
        tally: how many schedules there were.
        troubles: verdicts that ended in an error of cfepy.
        findings: each failure, its shrunk form if it has one, the lines of its timeline.
    """

    trial: Trial
    reference: Verdict
    tally: Tally
    troubles: list[Verdict]
    findings: list[tuple[Finding, Shrunk | None, list[str]]] = field(default_factory=list)

    def to_dict(self) -> dict[str, Any]:
        """Plain data."""
        found = []
        for finding, shrunk, lines in self.findings:
            entry = finding.to_dict() | {"command": self.trial.command(finding.verdict.schedule), "timeline": lines}
            found.append(entry | {"shrunk": None if shrunk is None else _shrunk_numbers(shrunk)})
        return {
            "plan": self.trial.plan.to_dict(),
            "reference": self.reference.to_dict(),
            "schedules": self.tally.done,
            "failed": self.tally.failed,
            "troubled": self.tally.troubled,
            "interrupted": self.tally.interrupted,
            "failures": found,
            "troubles": [{"schedule": each.schedule, "text": each.trouble} for each in self.troubles],
        }


def show(report: Report, stream: TextIO) -> None:
    """Print it."""
    for number, (finding, shrunk, lines) in enumerate(report.findings, 1):
        print(f"failure {number}: {finding.failure.title}", file=stream)
        for line in _about(report, finding, shrunk, lines):
            print(f"  {line}".rstrip(), file=stream)
        print(file=stream)
    for trouble in report.troubles[:1]:
        print(f"an error in cfepy itself, under {trouble.schedule}; please report it:", file=stream)
        print(trouble.trouble, file=stream)
    print(summary(report), file=stream)


def summary(report: Report) -> str:
    """The last line: how many schedules, how many failed, of how many kinds."""
    tally = report.tally
    parts = [f"{tally.done} schedules", f"{tally.failed} failed"]
    if tally.troubled:
        parts.append(f"{tally.troubled} with an error in cfepy itself")
    if tally.resumed:
        parts.append(f"{tally.resumed} from the results file")
    if tally.interrupted:
        parts.append("ended by Ctrl-C")
    kinds = len(report.findings)
    found = "no failure" if not kinds else "1 distinct failure" if kinds == 1 else f"{kinds} distinct failures"
    return f"{', '.join(parts)}: {found}"


def _about(report: Report, finding: Finding, shrunk: Shrunk | None, lines: Sequence[str]) -> Iterator[str]:
    failure = finding.failure
    if failure.at_ns is not None:
        yield f"at {failure.at_ns / NS_PER_S:.6f} s"
    yield from failure.detail.splitlines()
    for other in finding.others:
        yield f"and in the same run: {other}"
    yield from _how_often(report, finding)
    schedule = "fifo" if finding.in_reference else finding.verdict.schedule
    yield f"replay: {report.trial.command(schedule)}"
    if shrunk is not None:
        yield f"shrunk: {shrunk.trial.command(shrunk.verdict.schedule)}"
        yield f"        {_moves_text(shrunk)}, found in {shrunk.probes} runs"
    if lines:
        yield ""
        yield from lines


def _how_often(report: Report, finding: Finding) -> Iterator[str]:
    if finding.in_reference:
        yield "under the default schedule, fifo, already"
    if finding.numbers:
        median = finding.median_schedules
        count = f"{len(finding.numbers)} of {report.tally.done} schedules"
        yield f"{count}, first number {finding.numbers[0]}; one in {median:g} in the median"


def _moves_text(shrunk: Shrunk) -> str:
    preemptions = shrunk.verdict.preemptions
    others = len(shrunk.verdict.deviations) - preemptions
    parts = [f"{preemptions} {'preemption' if preemptions == 1 else 'preemptions'}"]
    if others:
        parts.append(f"{others} {'change' if others == 1 else 'changes'} of order")
    return " and ".join(parts)


def _shrunk_numbers(shrunk: Shrunk) -> dict[str, Any]:
    return {
        "schedule": shrunk.verdict.schedule,
        "command": shrunk.trial.command(shrunk.verdict.schedule),
        "preemptions": shrunk.verdict.preemptions,
        "moves": [move._asdict() for move in shrunk.moves],
        "probes": shrunk.probes,
    }
