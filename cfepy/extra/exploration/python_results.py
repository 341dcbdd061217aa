"""The result of `cfepy.explore`, made from the report of an expedition."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from cfepy.extra.exploration.exploration import Expedition, Report, Told
from cfepy.flight import Explored, FoundFailure
from cfepy.pilot import RunPlan
from cfepy.units import NS_PER_S


def explore(plan: RunPlan, **settings: Any) -> Explored:
    """Fly a plan under many schedules; see `cfepy.explore`.

    Args:
        plan: of the runs.
        settings: attributes of `Expedition`.
    """
    report = Expedition(plan, **settings).run()
    leak = () if report.unsteady is None else (f"not deterministic: two runs under {report.unsteady} differ",)
    return Explored(
        mission=" ".join(plan.words),
        failures=[_failure(report, told) for told in report.findings],
        schedules=report.tally.done,
        failed=report.tally.failed,
        worst=report.worst,
        troubles=[each.trouble for each in report.troubles],
        notes=(*report.notes, *leak),
        numbers=report.to_dict(),
    )


def _failure(report: Report, told: Told) -> FoundFailure:
    finding, shrunk = told.finding, told.shrunk
    failure = finding.failure
    schedule = report.schedule_of(told) if shrunk is None else shrunk.verdict.schedule
    trial = report.trial if shrunk is None else shrunk.trial
    return FoundFailure(
        title=failure.title,
        detail=failure.detail,
        at=None if failure.at_ns is None else failure.at_ns / NS_PER_S,
        schedules=len(finding.numbers),
        under_fifo=finding.in_reference,
        schedule=schedule,
        preemptions=None if shrunk is None else shrunk.verdict.preemptions,
        cause=told.story.cause,
        timeline=list(told.timeline),
        plan=replace(trial.plan, schedule=schedule),
    )
