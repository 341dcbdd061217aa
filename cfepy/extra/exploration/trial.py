"""A trial: one run of a mission under one schedule, and the verdict on it.

A trial is plain data, so it goes to other processes; a verdict comes back.
"""

from __future__ import annotations

import traceback
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple, Self

from cfepy.attachment import Attachment
from cfepy.extra.exploration import verdict
from cfepy.extra.exploration.deadlock import Waits, WaitWatch, stuck_for_good
from cfepy.extra.exploration.failure_kinds import FailureWatch
from cfepy.extra.exploration.result_watch import Result, ResultWatch, differences, digest_of
from cfepy.extra.exploration.step_accesses import Footprints
from cfepy.extra.exploration.switch_kinds import SwitchNotingPolicy
from cfepy.extra.exploration.verdict import Failure, Verdict
from cfepy.monitors import InversionWatch, Lack, Limits, LivenessWatch
from cfepy.pilot import LEAVES_OTHERS_WAITING, BootError, RunPlan, fly
from cfepy.rtos import NotingPolicy, Policy
from cfepy.schedules import ORDER, Schedule
from cfepy.status import UsageError
from cfepy.units import NS_PER_S

MOST_INVERSIONS = 3  # inversions in the report of one failure
PROBE_S = 1.0  # minimum wall time for a task that is known to spin


FOR_EVER = Limits()


def told_as(schedule: Schedule, deviations: Mapping[int, int]) -> Schedule:
    """Return a schedule for a command: one that develops during a run becomes the deviations of that run."""
    return schedule.at(deviations) if schedule.kind == ORDER else schedule


class Tried(NamedTuple):
    """A trial that was flown.

    Attributes:
        verdict: the verdict on it.
        results: the results themselves.
        notes: notes for the user of the plan.
        booted_ns: virtual time at which the mission became OPERATIONAL; None if it did not.
        tick_ns: of the board's clock; 0 for none.
        tasks: number of tasks that the run had.
        cores: of the board's processor; 0 if the board does not say.
    """

    verdict: Verdict
    results: tuple[Result, ...] = ()
    notes: tuple[str, ...] = ()
    booted_ns: int | None = None
    tick_ns: int = 0
    tasks: int = 0
    cores: int = 0


@dataclass(frozen=True, slots=True)
class Trial:
    """A run, and its criteria of a failure.

    Attributes:
        plan: the run; its own schedule does not matter.
        events: the events that are failures: "error" (ERROR and CRITICAL), "critical" or "none".
        reference: the results of the reference run, with which results are compared; None compares nothing.
        keep_widths: verdicts have the widths of decisions, which a systematic search needs.
        steps_from_ns: verdicts have the steps of the run from this virtual time on, as a search of orders needs; None
            keeps none.
        waits: of the default schedule (`cfepy.extra.exploration.deadlock`), against which tasks that wait forever are
            found; None lets them wait.
        liveness: limits for a ready task without running, and for an application without a message.
        keep_switches: verdicts have the kinds of their switches, which a search for new ones needs.
    """

    plan: RunPlan
    events: str = "error"
    reference: tuple[Result, ...] | None = None
    keep_widths: bool = False
    steps_from_ns: int | None = None
    waits: Waits | None = None
    liveness: Limits = FOR_EVER
    keep_switches: bool = False

    def run(self, schedule: Schedule, attachments: Sequence[Attachment] = ()) -> Verdict:
        """Fly the mission in this process.

        Args:
            schedule: which task runs when.
            attachments: other observers of the run.

        Returns:
            The verdict. An error of cfepy itself is its `trouble`, and not a failure of the mission.

        Raises:
            UsageError: the mission, its script or its faults cannot be read.
            KeyboardInterrupt: the user pressed Ctrl-C.
        """
        return self.fly(schedule, attachments).verdict

    def fly(self, schedule: Schedule, attachments: Sequence[Attachment] = (), policy: Policy | None = None) -> Tried:
        """Fly as `run` does. Returns also the results and other data of the flight.

        Args:
            schedule: which task runs when.
            attachments: other observers of the run.
            policy: decides in place of the schedule's own, whose options still apply.
        """
        noting = SwitchNotingPolicy if self.keep_switches else NotingPolicy
        recorded = noting(schedule.policy() if policy is None else policy)
        watch = FailureWatch(self.events)
        spec = self.plan.spec()
        results = ResultWatch(spec)
        waits = [WaitWatch()] if self.waits is not None else []
        steps = [Footprints(self.steps_from_ns)] if self.steps_from_ns is not None else []
        alive = [LivenessWatch(self.liveness)] if any(self.liveness) else []
        watching = [*attachments, watch, results, *waits, *steps, *alive]
        failed: tuple[Failure, ...]
        try:
            flown = fly(self.plan, spec=spec, attachments=watching, policy=recorded)
        except BootError as error:
            return Tried(self._verdict(schedule, recorded, (Failure(verdict.PROBLEM, "", error.text),)))
        except (UsageError, KeyboardInterrupt):
            raise
        except Exception:
            return Tried(replace(self._verdict(schedule, recorded, ()), trouble=traceback.format_exc()))
        if flown.stall is not None:
            told = self._verdict(schedule, recorded, watch.failures(flown.problems))
            return Tried(replace(told, end_ns=watch.end_ns), (), flown.notes)  # a stalled run has no results
        found = results.results()
        failed = (*watch.failures(flown.problems), *self._differences(found))
        failed += tuple(_lack(each) for watched in alive for each in watched.found)
        if waits and not any(failure.kind in LEAVES_OTHERS_WAITING for failure in failed):
            lost = {failure.task for failure in failed if failure.kind == verdict.STUCK}
            found_stuck = self._stuck(waits[0].waits, schedule, recorded, watch.end_ns)
            failed += tuple(failure for failure in found_stuck if failure.task not in lost)
        told = self._verdict(schedule, recorded, failed)
        trouble = "\n".join(watch.trouble)
        told = replace(told, results=digest_of(found), trace=flown.trace, end_ns=watch.end_ns, trouble=trouble)
        told = replace(told, steps=steps[0].steps if steps else ())
        kernel = flown.mission.kernel
        cores = flown.mission.board.cores
        return Tried(told, found, flown.notes, flown.mission.booted, kernel.tick_ns, kernel.tasks_made, cores)

    def _stuck(self, found: Waits, schedule: Schedule, policy: NotingPolicy, end_ns: int) -> Iterator[Failure]:
        assert self.waits is not None
        return stuck_for_good(found, self.waits, self.plan, end_ns, schedule.at(policy.deviations).policy)

    def against(self, reference: tuple[Result, ...]) -> Trial:
        """Return the same trial, in which results that differ from these are failures."""
        return replace(self, reference=reference)

    def probe(self) -> Trial:
        """Return the same trial for a known stall, with a shorter limit for a task that spins again."""
        limit = self.plan.stall
        return replace(self, plan=replace(self.plan, stall=min(limit, max(PROBE_S, limit / 10))))

    def inversions_before(self, schedule: Schedule, at_ns: int | None, task: str = "") -> list[str]:
        """Fly a run once more. Returns the priority inversions before its failure.

        Args:
            schedule: the schedule that fails.
            at_ns: time of the failure, in virtual ns; None is the end.
            task: the task that failed; if it has inversions, only these are returned.

        Returns:
            A sentence for each, the longest first; only the longest of each victim and lock.
        """
        watch = InversionWatch()
        self.fly(schedule, [watch])
        before = [each for each in watch.found if at_ns is None or each.at_ns <= at_ns]
        longest = {each.group: each for each in sorted(before, key=lambda each: each.lost_ns)}
        told = [each for each in longest.values() if each.victim == task] or list(longest.values())
        return [each.text for each in reversed(told)][:MOST_INVERSIONS]

    def until(self, end_ns: int) -> Self | None:
        """Return the same trial in a run that ends at this virtual time; None for a run that ends with its script."""
        if self.plan.script is not None:
            return None
        return replace(self, plan=replace(self.plan, seconds=end_ns / NS_PER_S))

    def command(self, schedule: Schedule) -> str:
        """Return the command that flies this mission under a schedule."""
        return self.plan.command_line(schedule=schedule)

    def _verdict(self, schedule: Schedule, policy: NotingPolicy, failed: tuple[Failure, ...]) -> Verdict:
        is_kept = failed or self.steps_from_ns is not None
        deviations = tuple(sorted(policy.deviations.items())) if is_kept else ()
        schedule = told_as(schedule, policy.deviations)
        pairs = zip(policy.widths, policy.running, strict=True)
        return Verdict(
            schedule,
            failed,
            decisions=policy.decisions,
            deviations=deviations,
            preemptions=policy.preemptions,
            missed=policy.missed,
            widths=tuple(-width if running else width for width, running in pairs) if self.keep_widths else (),
            switches=tuple(sorted(policy.switches)) if isinstance(policy, SwitchNotingPolicy) else (),
        )

    def _differences(self, found: tuple[Result, ...]) -> tuple[Failure, ...]:
        if self.reference is None:
            return ()
        return tuple(
            Failure(verdict.RESULTS, name, text, cause=name) for name, text in differences(self.reference, found)
        )


def _lack(found: Lack) -> Failure:
    """Return the failure for a starved task or an application in a livelock."""
    kind = verdict.LIVELOCK if found.is_livelock else verdict.STARVED
    return Failure(kind, found.app, found.text, found.at_ns, task=found.task, cause=found.task)
