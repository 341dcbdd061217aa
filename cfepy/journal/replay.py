"""Doing a journal's run again: what came from outside comes at the same instants, and the records are compared.

`Replay` has what makes a run a replay, for a caller that flies the mission piece by piece; `replay` flies it in one go.
A `Checker` compares the records with the checkpoints of the journal while the replay goes on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from hashlib import blake2b
from itertools import repeat

from cfepy.attachment import Attachment
from cfepy.journal.decisions import RetoldPolicy
from cfepy.journal.journal import Checkpoint, End, Journal, digest_of
from cfepy.journal.replay_files import HiddenRoot, Stage, staged
from cfepy.mission import Arrival, Mission
from cfepy.osal import Place, Stream
from cfepy.pilot import SUDDEN, Course, Flown, Host, Results, fly
from cfepy.rtos import Policy
from cfepy.script import ScriptRun
from cfepy.trace import ONLY_COMPARED, TimedRecords, Trace
from cfepy.writing.console import Console

Describe = Callable[[TimedRecords], list[str]]
"""Makes lines of text of records."""


class ReplayCourse(Course):
    """The course of a journal's run: it stops where something came from outside, and lets it come again.

    Args:
        mission: the mission.
        seconds: as of `Course`.
        script: as of `Course`.
        journal: the run.
        until_ns: virtual time at which to end, if that is earlier; None for the end of the run.
    """

    takes_company = False

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
        has_end = end is not None and end.reason not in SUDDEN
        self._visits = end.visits if end is not None and has_end else 1
        if until_ns is not None and (until_ns < known or not has_end):
            known, self._visits = until_ns, 1  # the journal has nothing after a sudden end, but the run may go on
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
        """The recorded run may have stood still at its last instant several times."""
        if self.is_over:
            return False
        outside = self.mission.outside
        return outside.until_ns < self.until_ns or outside.visits < self._visits

    def next_stop(self) -> int:
        """What came here from outside comes first."""
        outside, pauses = self.mission.outside, self._pauses
        while pauses and (pauses[-1].until_ns, pauses[-1].visits) <= (outside.until_ns, outside.visits):
            for event in pauses.pop().events:
                with suppress(Exception):  # what failed then fails again, and a run that has parted may lack its target
                    outside.repeat(event)
        stop_ns = super().next_stop()
        return min(stop_ns, pauses[-1].until_ns) if pauses else stop_ns


class _Answers(Attachment):
    """Lets the mission's own calls to the outside be answered as they were."""

    def __init__(self, answers: Sequence[Arrival]) -> None:
        self._answers = list(reversed(answers))

    def begin(self, mission: Mission) -> None:
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
        describe: makes text of what differs; None when nobody reads it.

    Attributes:
        journal, stage: as given.
        plan: what to run.
        policy: decides which task goes first; None for fifo.
        checker: compares the records.
        attachments: what a mission needs to be a replay.
        verdict: whether it was the same run; set by `compare`.
        problems: what went wrong in it, as `Results.problems`; steps of a script count at the end of the run only.
    """

    verdict: ReplayVerdict
    problems: Sequence[str] = ()

    def __init__(
        self,
        journal: Journal,
        stage: Stage,
        *,
        tasks: str | None = None,
        until_ns: int | None = None,
        describe: Describe | None = None,
    ) -> None:
        self.journal = journal
        self.stage = stage
        self._given = (tasks, until_ns, describe)
        self._is_cut_off = False
        self.plan = stage.plan if tasks is None else replace(stage.plan, tasks=tasks)
        self.until_ns = until_ns
        self.policy = self._policy()
        self.checker = Checker(journal.checkpoints, journal.end if self.is_whole else None, describe)
        paced = journal.header.paced is not None
        self.attachments: list[Attachment] = [*([_Answers(journal.answers)] if paced else []), self.checker]
        self.attachments += [HiddenRoot(stage.root)] if stage.root else []
        self._course: ReplayCourse

    def anew(self) -> Replay:
        """Another replay of the same, as this one was made."""
        tasks, until_ns, describe = self._given
        return Replay(self.journal, self.stage, tasks=tasks, until_ns=until_ns, describe=describe)

    def _policy(self) -> Policy | None:
        own = self.plan.schedule.policy()
        recorded = self.journal.header.policy
        if recorded is None:
            return own
        if own is None:
            own = Policy()
            vars(own).update(recorded)
        return RetoldPolicy(self.journal.decisions, self.journal.decided, own)

    def fly(
        self,
        attachments: Sequence[Attachment] = (),
        *,
        console: Console | None = None,
        trace: Trace | None = None,
        host: Host | None = None,
    ) -> Flown:
        """Fly to the end, and compare.

        Args:
            attachments: what watches the run.
            console: takes the lines; None drops them.
            trace: takes the records; their times are known where its list is `TimedRecords`.
            host: the host's side; None lets it go on by itself.

        Raises:
            UsageError: something in the mission is wrong.
            BootError: it cannot boot.
        """
        flown = fly(
            self.plan,
            spec=self.stage.spec(),
            attachments=[*attachments, *self.attachments],
            console=console,
            policy=self.policy,
            trace=trace,
            make_course=self.make_course,
            host=host,
        )
        found = [each.text for each in flown.problems if self.is_whole or not each.is_step]
        self.problems = [*found, *self._beside()]
        self.compare(flown.results)
        return flown

    def _beside(self) -> list[str]:
        """What went wrong in the missions that flew beside the recorded run."""
        return self.journal.end.beside if self.is_whole and self.journal.end is not None else []

    def make_course(self, mission: Mission, seconds: float | None, script: ScriptRun | None) -> ReplayCourse:
        """The course to fly."""
        self._course = ReplayCourse(mission, seconds, script, self.journal, self.until_ns)
        return self._course

    def end_here(self) -> None:
        """End the run as soon as the task that runs waits."""
        kernel = self._course.mission.kernel
        self.until_ns, self._is_cut_off = kernel.now, True
        self.checker.end_early()
        self._course.end_here()
        kernel.stop()

    def compare(self, results: Results) -> ReplayVerdict:
        """Whether it was the same run, now that it is over.

        Args:
            results: those of the replay.
        """
        end, difference = self.journal.end, self.checker.difference
        is_other = False
        if self.is_whole and difference is None and end is not None:
            is_other = digest_of(results, self.stage.root) != end.results
        self.verdict = ReplayVerdict(difference, self.checker.agreed, self.is_whole, is_other, end is None)
        return self.verdict

    @property
    def is_whole(self) -> bool:
        """Whether it goes to the end of the run, and that is known."""
        end = self.journal.end
        if end is None or end.reason in SUDDEN or self._is_cut_off:
            return False
        return self.until_ns is None or self.until_ns >= end.until_ns

    @property
    def why_over(self) -> str:
        """Why the run does not go on, for the user."""
        if self.is_whole:
            return "the recorded run ended there"
        return (
            "the journal ends there; continue with --until SECONDS"
            if self.until_ns is None
            else "the replay ended there"
        )


@dataclass(frozen=True, slots=True)
class ReplayVerdict:
    """Whether a replay was the run of its journal.

    Attributes:
        difference: where it parts; None when it does not.
        agreed: how far the records are known to agree.
        whole: the run was compared to its end.
        other_results: the trace is the same, and yet the report's numbers are not.
        cut_off: the journal has no end, so what it does not have cannot be compared.
    """

    difference: Difference | None
    agreed: Checkpoint
    whole: bool
    other_results: bool = False
    cut_off: bool = False

    @property
    def compared(self) -> bool:
        """Whether anything of the run was compared at all."""
        return self.whole or self.agreed.records > 0

    @property
    def same(self) -> bool:
        """Whether nothing differs of what was compared."""
        return self.difference is None and not self.other_results

    @property
    def proven(self) -> bool:
        """Whether it is known to be the run: nothing differs, something was compared, and the journal has an end."""
        return self.same and self.compared and not self.cut_off


@dataclass(frozen=True, slots=True)
class Replayed:
    """A replay that is over: the run, and how it compares."""

    flown: Flown
    verdict: ReplayVerdict


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
        attachments: what else watches the run, besides the comparison.
        tasks: what tasks run on; None as in the journal.
        until_ns: virtual time at which to end; None for the end of the run.
        from_disk: take the mission's files as they are on this computer, not those of the journal.
        console: takes the lines; None drops them.
        trace: takes the records.

    Raises:
        UsageError: something in it is wrong.
        BootError: the mission cannot boot.
    """
    with staged(journal, from_disk) as stage:
        again = Replay(journal, stage, tasks=tasks, until_ns=until_ns)
        return Replayed(again.fly(attachments, console=console, trace=trace), again.verdict)


@dataclass(frozen=True, slots=True)
class Difference:
    """Where a replay parts from its journal.

    Attributes:
        after: until there the records agree.
        before: there they do not agree any more; its numbers are those of the journal.
        lines: what the replay did between the two, as text.
    """

    after: Checkpoint
    before: Checkpoint
    lines: tuple[str, ...]


class Checker(Attachment):
    """Compares while the replay goes on.

    Args:
        checkpoints: of the journal.
        end: of the journal; None when the replay does not go that far.
        describe: makes text of what differs, of a trace whose records know their times; None: nobody reads it.

    Attributes:
        agreed: how far the records are known to agree.
        difference: where they part; None as long as they do not.
    """

    def __init__(self, checkpoints: Sequence[Checkpoint], end: End | None, describe: Describe | None) -> None:
        self.agreed = Checkpoint(0, 0, "")
        self.difference: Difference | None = None
        self._end = end
        self._describe = describe
        self._coming = list(reversed(checkpoints))
        self._hash = blake2b(digest_size=16)
        self._count = 0
        self._since = TimedRecords()
        self._finished = False
        self._trace: Trace

    def begin(self, mission: Mission) -> None:
        self._trace = mission.trace
        self._trace.also(self._take)

    def end_early(self) -> None:
        """The replay does not go to the end of the journal after all."""
        self._end = None

    def conclude(self) -> None:
        """How the nodes shut down is the run's own only at the run's own end."""
        if self._end is None:
            self._trace.flush()
            self._finished = True

    def finish(self) -> None:
        """Two runs may agree at all checkpoints, and yet not end alike."""
        self._finished = True
        end = self._end
        if end is not None and self.difference is None and self._hash.hexdigest() != end.trace:
            self._part(Checkpoint(end.now_ns, end.records, end.trace))

    def _take(self, records: list[bytes]) -> None:
        is_over = not self._coming and self._end is None  # the replay goes on where the journal has ended
        if self._finished or is_over or self.difference is not None:
            return
        times: Iterable[int] = records.times if isinstance(records, TimedRecords) else repeat(0)
        rest = [each for each in zip(records, times, strict=False) if each[0] and each[0][:1] not in ONLY_COMPARED]
        while self._coming and self.difference is None:
            missing = self._coming[-1].records - self._count
            if missing > len(rest):
                break
            self._add(rest[:missing])
            del rest[:missing]
            self._compare(self._coming.pop())
        self._add(rest)

    def _add(self, records: Sequence[tuple[bytes, int]]) -> None:
        self._hash.update(b"".join(record for record, _ in records))
        self._count += len(records)
        for record, time_ns in records:
            self._since.add(record, time_ns)

    def _compare(self, recorded: Checkpoint) -> None:
        if self._hash.hexdigest() == recorded.digest:
            self.agreed = recorded
            self._since.clear()
        else:
            self._part(recorded)

    def _part(self, recorded: Checkpoint) -> None:
        lines = self._describe(self._since) if self._describe is not None else ()
        self.difference = Difference(self.agreed, recorded, tuple(lines))
        self._since.clear()
