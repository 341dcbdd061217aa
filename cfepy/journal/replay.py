"""Doing a journal's run again: what came from outside comes at the same instants, and the records are compared.

`Replay` has what makes a run a replay, for whoever flies the mission piece by piece; `replay` flies it in one go. May
import cfepy.mission and its neighbours in cfepy.journal.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

from cfepy.attachment import Attachment
from cfepy.console import Console
from cfepy.journal.checking import Checker, Describe, Difference
from cfepy.journal.decisions import RetoldPolicy
from cfepy.journal.journal import Checkpoint, Journal
from cfepy.journal.moved import HiddenRoot
from cfepy.journal.result_digest import digest_of
from cfepy.journal.stage import Stage, staged
from cfepy.mission.course import BROKEN_OFF, Course
from cfepy.mission.mission import Mission
from cfepy.mission.outside import Event
from cfepy.mission.results import Results
from cfepy.mission.run_plan import Flown
from cfepy.mission.script import ScriptRun
from cfepy.osal.endpoints import Place, Stream
from cfepy.rtos.policy import Policy
from cfepy.rtos.schedule import Schedule
from cfepy.trace import Trace


class ReplayCourse(Course):
    """The course of a journal's run: it stops where something came from outside, and lets it come again.

    Args:
        mission: the mission.
        seconds: as of `Course`.
        script: as of `Course`.
        journal: the run.
        until_ns: virtual time at which to end, if that is earlier; None for the end of the run.
    """

    def __init__(
        self,
        mission: Mission,
        seconds: float | None,
        script: ScriptRun | None,
        journal: Journal,
        until_ns: int | None = None,
    ) -> None:
        super().__init__(mission, seconds, script)
        end = journal.end
        known = journal.known_until_ns
        has_end = end is not None and end.reason != BROKEN_OFF
        self._visits = end.visits if end is not None and has_end else 1
        if until_ns is not None and (until_ns < known or not has_end):
            known, self._visits = until_ns, 1  # nobody knows what came after a sudden end, but the run may go on
        if not has_end and (seconds is not None or journal.header.paced is None):
            known = min(known, self.until_ns)  # the sudden end came later, while the nodes shut down
        self.until_ns = known
        self._pauses = [pause for pause in reversed(journal.pauses) if pause.until_ns <= known]

    def end_here(self) -> None:
        """The run does not go on."""
        self.until_ns, self._visits = -1, 0
        self._pauses.clear()

    @property
    def goes_on(self) -> bool:
        """See `Course.goes_on`: the recorded run may have stood still at its last instant several times."""
        if self.is_over:
            return False
        outside = self.mission.outside
        return outside.until_ns < self.until_ns or outside.visits < self._visits

    def next_stop(self) -> int:
        """See `Course.next_stop`; what came here from outside comes first."""
        outside, pauses = self.mission.outside, self._pauses
        while pauses and (pauses[-1].until_ns, pauses[-1].visits) <= (outside.until_ns, outside.visits):
            for event in pauses.pop().events:
                with suppress(Exception):  # what failed then fails again, and a run that has parted may lack its target
                    outside.repeat(event)
        stop_ns = super().next_stop()
        return min(stop_ns, pauses[-1].until_ns) if pauses else stop_ns


class _Answers(Attachment):
    """Lets the mission's own calls to the outside be answered as they were."""

    def __init__(self, answers: Sequence[Event]) -> None:
        self._answers = list(reversed(answers))

    def begin(self, mission: Mission) -> None:
        """See `Attachment.begin`."""

        def dial(source: Place, target: Place) -> Stream | None:
            values = self._answers.pop().values if self._answers else (*source, *target, False)
            ends = mission.outside.answer(source, target, tuple(values) == (*source, *target, True))
            return None if ends is None else ends[0]

        mission.network.dial = dial


class Replay:
    """What makes a run the replay of a journal.

    Args:
        journal: the run.
        stage: where its files are; it must last as long as the replay.
        tasks: what tasks run on; None as in the journal.
        until_ns: virtual time at which to end; None for the end of the run.
        describe: makes text of what differs.

    Attributes:
        journal, stage: as given.
        plan: what to run.
        policy: who goes first; None for fifo.
        checker: compares the records.
        attachments: what a mission needs to be a replay.
        verdict: whether it was the same run; set by `compare`.
    """

    verdict: Verdict

    def __init__(
        self,
        journal: Journal,
        stage: Stage,
        *,
        tasks: str | None = None,
        until_ns: int | None = None,
        describe: Describe = lambda records, now_ns: [],
    ) -> None:
        self.journal = journal
        self.stage = stage
        self.plan = stage.plan if tasks is None else replace(stage.plan, tasks=tasks)
        self.until_ns = until_ns
        self.policy = self._policy()
        self.checker = Checker(journal.checkpoints, journal.end if self.is_whole else None, describe)
        paced = journal.header.paced is not None
        self.attachments: list[Attachment] = [*([_Answers(journal.answers)] if paced else []), self.checker]
        self.attachments += [HiddenRoot(stage.root)] if stage.root else []
        self._course: ReplayCourse

    def _policy(self) -> Policy | None:
        own = Schedule.parse(self.plan.schedule, self.plan.seed).policy()
        recorded = self.journal.header.policy
        if recorded is None:
            return own
        if own is None:
            own = Policy()
            vars(own).update(recorded)
        return RetoldPolicy(self.journal.decisions, self.journal.decided, own)

    def fly(
        self, attachments: Sequence[Attachment] = (), *, console: Console | None = None, trace: Trace | None = None
    ) -> Flown:
        """Fly to the end in one go, and compare.

        Args:
            attachments: what looks on.
            console: takes the lines; None drops them.
            trace: takes the records.

        Raises:
            UsageError: something in the mission is wrong.
            CfeError: it cannot boot.
        """
        flown = self.plan.fly(
            [*self.attachments, *attachments],
            spec=self.stage.spec(),
            console=console,
            policy=self.policy,
            trace=trace,
            make_course=self.make_course,
        )
        self.compare(flown.results)
        return flown

    def make_course(self, mission: Mission, seconds: float | None, script: ScriptRun | None) -> ReplayCourse:
        """The course to fly."""
        self._course = ReplayCourse(mission, seconds, script, self.journal, self.until_ns)
        return self._course

    def end_here(self) -> None:
        """Somebody has seen enough: the run ends as soon as the task that runs waits."""
        kernel = self._course.mission.kernel
        self.until_ns = kernel.now
        self.checker.end_early()
        self._course.end_here()
        kernel.stop()

    def compare(self, results: Results) -> Verdict:
        """Whether it was the same run, now that it is over.

        Args:
            results: what it came to.
        """
        end, difference = self.journal.end, self.checker.difference
        is_other = False
        if self.is_whole and difference is None and end is not None:
            is_other = digest_of(results, self.stage.root) != end.results
        self.verdict = Verdict(difference, self.checker.agreed, self.is_whole, is_other)
        return self.verdict

    @property
    def is_whole(self) -> bool:
        """Whether it goes to the end of the run, and that is known."""
        end = self.journal.end
        if end is None or end.reason == BROKEN_OFF:
            return False
        return self.until_ns is None or self.until_ns >= end.until_ns

    @property
    def why_over(self) -> str:
        """Why it does not go on, for a user who wonders."""
        if self.is_whole:
            return "there the recorded run ended"
        return "there the journal ends, --until SECONDS goes on" if self.until_ns is None else "the replay ended there"


@dataclass(frozen=True, slots=True)
class Verdict:
    """Whether a replay was the run of its journal.

    Attributes:
        difference: where it parts; None when it does not.
        agreed: how far the records are known to agree.
        whole: the run was compared to its end.
        other_results: the trace is the same, and yet the report's numbers are not.
    """

    difference: Difference | None
    agreed: Checkpoint
    whole: bool
    other_results: bool = False

    @property
    def same(self) -> bool:
        """Whether nothing differs."""
        return self.difference is None and not self.other_results


@dataclass(frozen=True, slots=True)
class Replayed:
    """A replay that is over: the run, and how it compares."""

    flown: Flown
    verdict: Verdict


def replay(
    journal: Journal,
    attachments: Sequence[Attachment] = (),
    *,
    tasks: str | None = None,
    until_ns: int | None = None,
    from_disk: bool = False,
    console: Console | None = None,
    trace: Trace | None = None,
) -> Replayed:
    """Fly a journal's run again to its end.

    Args:
        journal: the run.
        attachments: what looks on, beside the comparison.
        tasks: what tasks run on; None as in the journal.
        until_ns: virtual time at which to end; None for the end of the run.
        from_disk: take the mission's files as they are on this computer, not those of the journal.
        console: takes the lines; None drops them.
        trace: takes the records.

    Raises:
        UsageError: something in it is wrong.
        CfeError: the mission cannot boot.
    """
    with staged(journal, from_disk) as stage:
        again = Replay(journal, stage, tasks=tasks, until_ns=until_ns)
        return Replayed(again.fly(attachments, console=console, trace=trace), again.verdict)
