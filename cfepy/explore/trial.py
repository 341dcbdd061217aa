"""A trial: one run of a mission under one schedule, and the verdict on it.

A trial is plain data, so it goes to other processes; a verdict comes back. May import everything to the left of
cfepy.explore.
"""

from __future__ import annotations

import traceback
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from cfepy.attachment import Attachment
from cfepy.explore import verdict
from cfepy.explore.failures import FailureWatch
from cfepy.explore.results import Result, ResultWatch, differences, digest_of
from cfepy.explore.stuck import Waits, WaitWatch, stuck_for_good
from cfepy.explore.verdict import Failure, Verdict
from cfepy.mission.run_plan import RunPlan
from cfepy.rtos.policy import Policy, Recorded
from cfepy.rtos.schedule import Schedule
from cfepy.status import CfeError, UsageError

_LEAVES_OTHERS_WAITING = (verdict.DIED, verdict.RAISED, verdict.ENDED, verdict.RESET, verdict.DEADLOCK)


@dataclass(frozen=True, slots=True)
class Trial:
    """What is flown, and what counts as a failure.

    Attributes:
        plan: the run; its own schedule does not matter.
        events: which events are failures: "error" (ERROR and CRITICAL), "critical" or "none".
        reference: the results of the run that others are held against; None holds them against nothing.
        keep_widths: verdicts have the widths of decisions, which a systematic search needs.
        waits: of the default schedule (`cfepy.explore.stuck`), against which tasks that wait for ever are found; None
            lets them wait.
    """

    plan: RunPlan
    events: str = "error"
    reference: tuple[Result, ...] | None = None
    keep_widths: bool = False
    waits: Waits | None = None

    def run(self, schedule: Schedule | str, attachments: Sequence[Attachment] = ()) -> Verdict:
        """Fly the mission in this process.

        Args:
            schedule: who runs when.
            attachments: what else looks on.

        Returns:
            What became of it. An error of cfepy itself is told as `trouble` and is no failure of the mission.

        Raises:
            UsageError: the mission, its script or its faults cannot be read.
            KeyboardInterrupt: somebody wants it to end.
        """
        return self.fly(schedule, attachments)[0]

    def fly(
        self, schedule: Schedule | str, attachments: Sequence[Attachment] = (), policy: Policy | None = None
    ) -> tuple[Verdict, tuple[Result, ...]]:
        """As `run`, with the results themselves beside their digest.

        Args:
            schedule: who runs when.
            attachments: what else looks on.
            policy: decides in the place of the schedule's own.
        """
        chosen = Schedule.parse(schedule) if isinstance(schedule, str) else schedule
        recorded = Recorded(chosen.policy() if policy is None else policy)
        watch = FailureWatch(self.events)
        spec = self.plan.spec()
        results = ResultWatch(spec)
        waits = [WaitWatch()] if self.waits is not None else []
        failed: tuple[Failure, ...]
        try:
            flown = self.plan.fly([*attachments, watch, results, *waits], spec=spec, policy=recorded)
        except (UsageError, KeyboardInterrupt):
            raise
        except CfeError as error:
            failed = (Failure(verdict.PROBLEM, "", f"the mission cannot boot: {error}"),)
            return self._verdict(chosen, recorded, failed), ()
        except Exception:
            return replace(self._verdict(chosen, recorded, ()), trouble=traceback.format_exc()), ()
        found = results.results()
        failed = (*watch.failures(flown.outcome), *self._differences(found))
        if waits and not any(failure.kind in _LEAVES_OTHERS_WAITING for failure in failed):
            failed += tuple(self._stuck(waits[0].waits, chosen, recorded, watch.end_ns))
        told = self._verdict(chosen, recorded, failed)
        trouble = "\n".join(watch.trouble)
        told = replace(told, results=digest_of(found), trace=flown.trace, end_ns=watch.end_ns, trouble=trouble)
        return told, found

    def _stuck(self, found: Waits, chosen: Schedule, policy: Recorded, end_ns: int) -> Iterator[Failure]:
        assert self.waits is not None
        again = Schedule.parse(chosen.text()).at(policy.deviations)
        return stuck_for_good(found, self.waits, self.plan, end_ns, again.policy)

    def against(self, reference: tuple[Result, ...]) -> Trial:
        """The same trial, in which results that differ from these are failures."""
        return replace(self, reference=reference)

    def command(self, schedule: str) -> str:
        """The command that flies this mission under a schedule."""
        return self.plan.command_line(schedule=schedule)

    def _verdict(self, schedule: Schedule, policy: Recorded, failed: tuple[Failure, ...]) -> Verdict:
        deviations = tuple(sorted(policy.deviations.items())) if failed else ()
        pairs = zip(policy.widths, policy.running, strict=True)
        return Verdict(
            schedule.text(),
            failed,
            decisions=len(policy.choices),
            deviations=deviations,
            preemptions=policy.preemptions,
            widths=tuple(-width if running else width for width, running in pairs) if self.keep_widths else (),
        )

    def _differences(self, found: tuple[Result, ...]) -> tuple[Failure, ...]:
        if self.reference is None:
            return ()
        return tuple(Failure(verdict.RESULTS, name, text) for name, text in differences(self.reference, found))
