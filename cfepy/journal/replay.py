"""Repeating a journal's run: input from outside comes at the same instants, and the records are compared.

`Replay` holds everything for a replay, for a caller that flies the mission in parts; `replay` flies it at once. A
`Checker` compares the records with the checkpoints of the journal during the replay.
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
"""Describes records as lines of text."""


class ReplayCourse(Course):
    """The course of a journal's run: it stops where input came from outside, and repeats the input.

    Args:
        mission: the mission.
        seconds: as for `Course`.
        script: as for `Course`.
        journal: the run.
        until_ns: virtual time at which to end earlier; None for the end of the run.
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
            known, self._visits = until_ns, 1  # the journal has nothing after a sudden end, but the run may continue
        if not has_end and (seconds is not None or journal.header.paced is None):
            known = min(known, self.until_ns)  # the sudden end came later, during the shutdown of the nodes
        self.until_ns = known
        self._pauses = [pause for pause in reversed(journal.pauses) if pause.until_ns <= known]

    def end_here(self) -> None:
        """The run does not continue."""
        self.until_ns, self._visits = -1, 0
        self._pauses.clear()

    @property
    def goes_on(self) -> bool:
        """The recorded run may have stopped at its last instant several times."""
        if self.is_over:
            return False
        outside = self.mission.outside
        return outside.until_ns < self.until_ns or outside.visits < self._visits

    def next_stop(self) -> int:
        """Repeat the input at this stop first."""
        outside, pauses = self.mission.outside, self._pauses
        while pauses and (pauses[-1].until_ns, pauses[-1].visits) <= (outside.until_ns, outside.visits):
            for event in pauses.pop().events:
                # it may have failed in the recorded run too, and a run that differs may lack its target
                with suppress(Exception):
                    outside.repeat(event)
        stop_ns = super().next_stop()
        return min(stop_ns, pauses[-1].until_ns) if pauses else stop_ns


class _Answers(Attachment):
    """Answers the mission's own calls to the outside as recorded."""

    def __init__(self, answers: Sequence[Arrival]) -> None:
        self._answers = list(reversed(answers))

    def begin(self, mission: Mission) -> None:
        def dial(source: Place, target: Place) -> Stream | None:
            values = self._answers.pop().values if self._answers else (*source, *target, False)
            ends = mission.outside.answer(source, target, tuple(values) == (*source, *target, True))
            return None if ends is None else ends[0]

        mission.network.dial = dial


class Replay:
    """The plan, policy and attachments that make a run the replay of a journal.

    Args:
        journal: the run.
        stage: files of the replay; it must last as long as the replay.
        tasks: implementation of tasks; None as in the journal.
        until_ns: virtual time at which to end; None for the end of the run.
        describe: describes differences as text; None for no descriptions.

    Attributes:
        plan: plan of the run.
        policy: decides which task goes first; None for fifo.
        checker: compares the records.
        attachments: attachments that a mission needs to be a replay.
        verdict: whether it was the same run; set by `compare`.
        problems: its problems, as `Results.problems`; steps of a script count only at the end of the run.
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
        """Return another replay with the same arguments."""
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
            attachments: observe the run.
            console: receives the lines; None drops them.
            trace: receives the records; with `TimedRecords` as list their times are known.
            host: the host's side; None lets the run continue without it.

        Raises:
            UsageError: if there is a mistake in the mission.
            BootError: if it cannot boot.
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
        """The problems of the missions that flew together with the recorded run."""
        return self.journal.end.beside if self.is_whole and self.journal.end is not None else []

    def make_course(self, mission: Mission, seconds: float | None, script: ScriptRun | None) -> ReplayCourse:
        """Return the course to fly. Steps of the script are reported with the path that it had in the recorded run."""
        if script is not None:
            script.script = replace(script.script, file=script.script.file.removeprefix(self.stage.root))
        self._course = ReplayCourse(mission, seconds, script, self.journal, self.until_ns)
        return self._course

    def end_here(self) -> None:
        """End the run as soon as the running task waits."""
        kernel = self._course.mission.kernel
        self.until_ns, self._is_cut_off = kernel.now, True
        self.checker.end_early()
        self._course.end_here()
        kernel.stop()

    def compare(self, results: Results) -> ReplayVerdict:
        """Return whether it was the same run, after its end.

        Args:
            results: results of the replay.
        """
        end, difference = self.journal.end, self.checker.difference
        is_other = False
        if self.is_whole and difference is None and end is not None:
            is_other = digest_of(results, self.stage.root) != end.results
        self.verdict = ReplayVerdict(difference, self.checker.agreed, self.is_whole, is_other, end is None)
        return self.verdict

    @property
    def is_whole(self) -> bool:
        """Return whether it reaches the end of the run, and the end is known."""
        end = self.journal.end
        if end is None or end.reason in SUDDEN or self._is_cut_off:
            return False
        return self.until_ns is None or self.until_ns >= end.until_ns

    @property
    def why_over(self) -> str:
        """Return why the run does not continue, for the user."""
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
        difference: where it differs; None if it does not.
        agreed: up to where the records are known to agree.
        whole: whether the run was compared to its end.
        other_results: whether the trace is the same but the report's numbers differ.
        cut_off: whether the journal has no end, so that the rest cannot be compared.
    """

    difference: Difference | None
    agreed: Checkpoint
    whole: bool
    other_results: bool = False
    cut_off: bool = False

    @property
    def compared(self) -> bool:
        """Whether anything was compared."""
        return self.whole or self.agreed.records > 0

    @property
    def same(self) -> bool:
        """Whether nothing that was compared differs."""
        return self.difference is None and not self.other_results

    @property
    def proven(self) -> bool:
        """Whether it is known to be the same run: nothing differs, something was compared, and the journal has
        an end.
        """
        return self.same and self.compared and not self.cut_off


@dataclass(frozen=True, slots=True)
class Replayed:
    """A finished replay: the run, and the comparison."""

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
    """Repeat a journal's run to its end.

    Args:
        journal: the run.
        attachments: observe the run, in addition to the comparison.
        tasks: implementation of tasks; None as in the journal.
        until_ns: virtual time at which to end; None for the end of the run.
        from_disk: use the mission's files on this computer instead of those in the journal.
        console: receives the lines; None drops them.
        trace: receives the records.

    Raises:
        UsageError: if there is a mistake in it.
        BootError: if the mission cannot boot.
    """
    with staged(journal, from_disk) as stage:
        again = Replay(journal, stage, tasks=tasks, until_ns=until_ns)
        return Replayed(again.fly(attachments, console=console, trace=trace), again.verdict)


@dataclass(frozen=True, slots=True)
class Difference:
    """Where a replay starts to differ from its journal.

    Attributes:
        after: the records agree up to there.
        before: they differ there; its numbers come from the journal.
        lines: the replay's records between the two, as text.
    """

    after: Checkpoint
    before: Checkpoint
    lines: tuple[str, ...]


class Checker(Attachment):
    """Compares during the replay.

    Args:
        checkpoints: checkpoints of the journal.
        end: end of the journal; None if the replay does not reach it.
        describe: describes differences as text, for a trace whose records know their times; None for no descriptions.

    Attributes:
        agreed: up to where the records are known to agree.
        difference: where they differ; None if they do not.
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
        """The replay does not reach the end of the journal after all."""
        self._end = None

    def conclude(self) -> None:
        """The shutdown of the nodes is the same only at the run's own end."""
        if self._end is None:
            self._trace.flush()
            self._finished = True

    def finish(self) -> None:
        """Compare the ends: two runs may agree at all checkpoints but end differently."""
        self._finished = True
        end = self._end
        if end is not None and self.difference is None and self._hash.hexdigest() != end.trace:
            self._part(Checkpoint(end.now_ns, end.records, end.trace))

    def _take(self, records: list[bytes]) -> None:
        is_over = not self._coming and self._end is None  # the replay continues after the end of the journal
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
