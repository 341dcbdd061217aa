"""A complete exploration: fly schedules, judge the runs, then shrink and report each failure.

    expedition = Expedition(plan, seeds=200)
    report = expedition.run()
    for told in report.findings: print(told.finding.failure.title, told.timeline)

The reference run, under fifo, comes first. Failures that it also has are marked, and the results of the other schedules
are compared with its results.
"""

from __future__ import annotations

import contextlib
import itertools
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import Any, TextIO

from cfepy.extra.exploration.campaign import Campaign, Crew, Search, Tally
from cfepy.extra.exploration.deadlock import waits_of
from cfepy.extra.exploration.extent import Breadth, PointCounter
from cfepy.extra.exploration.fork_server import ForkingNotes
from cfepy.extra.exploration.longest import Distribution, MeasuredTrial, Worst, WorstSearch, worst_of
from cfepy.extra.exploration.missing_points import OpenPlaces, SourceWatch, openings_of
from cfepy.extra.exploration.mission_transfer import files_read, identity_of, ship
from cfepy.extra.exploration.partial_orders import OrderSearch
from cfepy.extra.exploration.progress import make_progress
from cfepy.extra.exploration.results_file import ResultsFile, keep_failure
from cfepy.extra.exploration.schedule_kinds import NOTHING_FOUND
from cfepy.extra.exploration.search import SEEDED_POLICIES, NewSwitchSearch, SeededSearch, make_search
from cfepy.extra.exploration.shrink import SHRINK_S, NotedFlight, Shrinker, Shrunk, budget_of
from cfepy.extra.exploration.step_accesses import check_visible
from cfepy.extra.exploration.timeline import Story, story_of
from cfepy.extra.exploration.trial import Trial, Tried
from cfepy.extra.exploration.verdict import RACE, STALLED, Failure, Finding, Findings, Verdict
from cfepy.extra.exploration.worker_pools import make_crew
from cfepy.extra.exploration.workers import LONGEST_S, PROCESS_DIED
from cfepy.monitors import Limits, Measure
from cfepy.pilot import RunPlan
from cfepy.rtos import Policy, Stopwatch
from cfepy.schedules import Points, Schedule
from cfepy.status import UsageError
from cfepy.units import NS_PER_S
from cfepy.writing.work_progress import WorkProgress

FROM_OPERATIONAL = 0.0
BASE = "at"  # fifo as a policy object, so that decisions are counted and options apply
DEFAULT_SEEDS = 100
MOST_SCHEDULES = 100_000_000
_NO_WAY = (PROCESS_DIED, STALLED)  # an aborted run has no trace to compare
EVENTS = ("error", "critical", "none")


@dataclass(slots=True)
class Told:
    """A failure of the report.

    Attributes:
        finding: the failure, and the schedules that showed it.
        shrunk: its schedule with the fewest preemptions; None if there is none, or it was not searched for.
        story: the course of the run under that schedule.
        inversions: the priority inversions before it, a sentence each, the longest first. If the failed task had
            inversions, only its own.
        repeats: whether a second run under the schedule that showed it fails in the same way. If not, the failure does
            not depend on the schedule alone.
        is_steady: whether that run had the same trace.
    """

    finding: Finding
    shrunk: Shrunk[Trial] | None = None
    story: Story = field(default_factory=Story)
    inversions: list[str] = field(default_factory=list)
    repeats: bool = True
    is_steady: bool = True

    @property
    def timeline(self) -> list[str]:
        """The lines of the story, 100 characters wide."""
        return self.story.lines()


@dataclass(slots=True)
class Report:
    """The result of an exploration.

    Attributes:
        trial: the trial that was flown.
        reference: the verdict on the default schedule.
        tally: the numbers of schedules.
        troubles: verdicts that ended in an error of cfepy.
        findings: each failure once.
        notes: notes for the user.
        is_steady: whether two runs under the default schedule were the same. If not, no other schedules were flown.
        breadth: the extent of the search.
        worst: the longest measured value; None without a measure.
    """

    trial: Trial
    reference: Verdict
    tally: Tally
    troubles: list[Verdict]
    findings: list[Told] = field(default_factory=list)
    notes: tuple[str, ...] = ()
    is_steady: bool = True
    breadth: Breadth = field(default_factory=Breadth)
    worst: Worst | None = None

    @property
    def unsteady(self) -> Schedule | None:
        """A schedule under which two runs differed; None if all repeated runs were the same."""
        if not self.is_steady:
            return Schedule()
        return next((told.finding.verdict.schedule for told in self.findings if not told.is_steady), None)

    def schedule_of(self, told: Told) -> Schedule:
        """Return the schedule that showed a failure first. A run under it shows the failure, including a data race."""
        return _showing(
            told.finding.failure, Schedule() if told.finding.in_reference else told.finding.verdict.schedule
        )

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        found = []
        for told in self.findings:
            command = self.trial.command(_showing(told.finding.failure, told.finding.verdict.schedule))
            entry = told.finding.to_dict() | {"command": command, "repeats": told.repeats}
            entry |= {"inversions": told.inversions, "cause": told.story.cause, "timeline": told.timeline}
            found.append(entry | {"shrunk": None if told.shrunk is None else _shrunk_numbers(told.shrunk)})
        return {
            "plan": self.trial.plan.to_dict(),
            "reference": self.reference.to_dict(),
            "deterministic": self.unsteady is None,
            "schedules": self.tally.done,
            "failed": self.tally.failed,
            "troubled": self.tally.troubled,
            "notes": list(self.notes),
            "interrupted": self.tally.interrupted,
            "failures": found,
            "breadth": self.breadth.to_dict(),
            "worst": None if self.worst is None else self.worst.to_dict(),
            "troubles": [{"schedule": each.schedule.text(), "text": each.trouble} for each in self.troubles],
        }


def _showing(failure: Failure, schedule: Schedule) -> Schedule:
    """Return a schedule with the same choices that looks for the failure; fifo itself does not look for data races."""
    return schedule.at({}) if failure.kind == RACE and schedule.kind == "fifo" else schedule


def _shrunk_numbers(shrunk: Shrunk[Trial]) -> dict[str, Any]:
    return {
        "schedule": shrunk.verdict.schedule.text(),
        "command": shrunk.trial.command(shrunk.verdict.schedule),
        "preemptions": shrunk.verdict.preemptions,
        "moves": [each._asdict() | {"move": each.move.text()} for each in shrunk.moves],
        "probes": shrunk.probes,
    }


@dataclass(frozen=True, slots=True)
class Expedition:
    """The settings of an exploration. Each attribute except the first is an option of `cfepy explore`.

    Attributes:
        plan: the run; its own schedule does not matter.
        seeds: number of schedules; None for any number, which the budget or `until_known` ends.
        until_known: end when schedules bring no switch of a new kind (`switch_kinds`).
        budget_s: wall time after which no further schedule begins; None for no limit.
        policy: source of the schedules: "random", "pct", "abreast" (tasks side by side), "dfs" (every one with few
            preemptions), "orders" (all orders that differ, each once), or "all".
        depth: for pct, the depth of the bugs; for dfs, the most preemptions; for orders, the number of steps of a run
            in which they may differ.
        first_seed: seed of the first schedule.
        any_priority: less urgent tasks may run before more urgent ones.
        hold_s: longest delay of the running task, in virtual s.
        connect_s: longest time for a connection between two ROS nodes, in virtual s.
        points: preemption points in addition to calls (`cfepy.schedules.preemption_points`); empty for none.
        from_s: virtual time until which all decisions are fifo's; 0 for the time at which the mission becomes
            OPERATIONAL.
        until_failure: whether the first failure ends the exploration.
        events: the events that are failures: "error", "critical" or "none".
        starved_s, livelock_s: virtual time for which a task may be ready without running, and for which an application
            may run on without a message; None for any time.
        fair: decisions in which a task may be passed over; None for any number.
        worst: the measure to maximize, such as "response:ARM" (`cfepy.monitors.durations`); None for none.
        stuck: whether it is a failure if a task waits forever and does not by default.
        jobs: processes on this computer; None for one on each CPU.
        cluster: address of a dask scheduler, or local:N.
        longest_s: wall time that a schedule may take.
        results: file that keeps the verdicts, from which the exploration resumes.
        shrink: runs that shrinking a failure may take; None for the number of `budget_of`, 0 for no shrinking.
        shrink_s: wall time that shrinking a failure may take.
        progress: stream for the progress; None shows nothing.
    """

    plan: RunPlan
    seeds: int | None = DEFAULT_SEEDS
    until_known: bool = False
    budget_s: float | None = None
    policy: str = "all"
    depth: int | None = None
    first_seed: int = 0
    any_priority: bool = False
    hold_s: float | None = None
    connect_s: float | None = None
    points: str = ""
    from_s: float | None = None
    until_failure: bool = False
    events: str = "error"
    starved_s: float | None = None
    livelock_s: float | None = None
    fair: int | None = None
    worst: str | None = None
    stuck: bool = True
    jobs: int | None = None
    cluster: str | None = None
    longest_s: float = LONGEST_S
    results: str | None = None
    shrink: int | None = None
    shrink_s: float = SHRINK_S
    progress: TextIO | None = None

    def run(self, tell: Callable[[tuple[str, ...]], object] = lambda notes: None) -> Report:
        """Explore.

        Args:
            tell: gets the notes for the user, before the campaign.

        Raises:
            UsageError: the mission cannot be explored with these options.
        """
        self._check_end()
        watch, options = Stopwatch(), self._options()
        if self.policy == "orders":
            check_visible(self.plan.spec())
        measure = None if self.worst is None else Measure.parse(self.worst)
        bare = Trial(self.plan, self.events, keep_widths=self.policy == "dfs")
        if measure is not None:
            bare = MeasuredTrial(self.plan, self.events, keep_widths=True, measure=measure)
        bare = replace(bare, liveness=self._liveness)
        counter = PointCounter(options.policy() or Policy())
        sources = SourceWatch()
        first = bare.fly(options, [sources], policy=counter)
        sources.check(self.points)
        breadth = Breadth(dict(counter.kinds), first.tasks)
        reference, notes = first.verdict, first.notes
        tell(notes)
        if self.from_s == FROM_OPERATIONAL:
            options = self._from_operational(options, first.booted_ns)
        trial = beside_fifo(bare, first, options if self.stuck else None)
        findings = Findings(reference)
        openings = self._openings(bare, first, options)
        breadth.options = options
        search = self._search(first, options, openings or NOTHING_FOUND)
        if self.policy == "orders":
            trial = replace(trial, steps_from_ns=options.from_ns)
        if isinstance(search, NewSwitchSearch):
            breadth.switches, trial = search.switches, replace(trial, keep_switches=True)
        distribution = None if measure is None else Distribution.of(measure, reference)

        def see(number: int, verdict: Verdict) -> bool:
            """Take a verdict. Returns whether the search has seen enough."""
            breadth.take(verdict)
            if distribution is not None:
                distribution.take(number, verdict)
            return self.until_known and breadth.switches is not None and breadth.switches.are_all_known

        tally = self._fly(trial, search, findings, reference, watch, see)
        if tally is None:
            return Report(trial, reference, Tally(), [], notes=notes, is_steady=False)
        if isinstance(search, OrderSearch):
            breadth.seen = search.seen
            trial = replace(trial, steps_from_ns=None)
        trial = replace(trial, keep_switches=False)
        report = Report(trial, reference, tally, findings.troubles, notes=notes, breadth=breadth)
        for finding in findings.all():
            report.findings.append(self._told(trial, finding, tally))
        self._keep(report)
        if not report.findings and not tally.interrupted and not self.points:
            try:
                seen = openings_of(bare, options) if openings is None else openings
                breadth.gaps, breadth.files = list(seen.gaps), list(seen.files)
            except KeyboardInterrupt:  # keep the findings so far
                tally.interrupted = True
        if distribution is not None and isinstance(trial, MeasuredTrial):
            budget = budget_of(tally.done) if self.shrink is None else self.shrink
            report.worst = worst_of(trial, distribution, 0 if tally.interrupted else budget, self.shrink_s)
        return report

    def _openings(self, bare: Trial, first: Tried, options: Schedule) -> OpenPlaces | None:
        """Return the places where further schedules could differ; None if the policy does not use them."""
        is_over = self.until_failure and first.verdict.failed
        if self.policy != "all" or self.points or self.worst is not None or is_over or first.verdict.end_ns is None:
            return None
        if any(failure.kind in _NO_WAY for failure in first.verdict.failures):
            return None
        found = openings_of(bare, options)
        return found._replace(overlaps=found.overlaps and first.cores != 1)

    def _search(self, first: Tried, options: Schedule, openings: OpenPlaces) -> Search:
        """Return the search of `make_search`; with a measure, the search for the longest value that begins with it."""
        holds = self.worst is None  # a delayed task is late by the delay, not by the mission
        steps, tick_ns = first.verdict.decisions, first.tick_ns
        is_open = self.seeds is None and holds
        found = make_search(
            self.policy,
            self.depth,
            steps,
            options,
            self.first_seed,
            tick_ns,
            holds=holds,
            new_switches=is_open,
            openings=openings,
        )
        return found if holds or not isinstance(found, SeededSearch) else WorstSearch(found, self.first_seed)

    def _check_end(self) -> None:
        """Check that a search with `until_known` can end by itself.

        Raises:
            UsageError: its schedules do not come from seeds alone.
        """
        if self.until_known and self.worst is not None:
            raise UsageError("auto is possible only without --worst", field="--seeds")
        if self.until_known and self.policy not in SEEDED_POLICIES:
            raise UsageError(f"auto is possible only with --policy {' or '.join(SEEDED_POLICIES)}", field="--seeds")

    @property
    def _liveness(self) -> Limits:
        return Limits(*(round((each or 0.0) * NS_PER_S) for each in (self.starved_s, self.livelock_s)))

    def _options(self) -> Schedule:
        """Return the options that all schedules share, as a schedule.

        Raises:
            UsageError: a time is invalid.
        """
        words = [BASE]
        words += ["any"] if self.any_priority else []
        words += [f"fair={self.fair}"] if self.fair is not None else []
        for option, time_s in (("hold", self.hold_s), ("connect", self.connect_s), ("from", self.from_s)):
            if time_s is None or (option, time_s) == ("from", FROM_OPERATIONAL):
                continue
            words += [f"{option}={round(time_s * NS_PER_S)}ns"]
            try:
                Schedule.parse(":".join(words))
            except UsageError as error:
                raise UsageError(error.text, field=f"--{option}") from None
        return Schedule.parse(":".join(words)).with_points(Points.parse(self.points).text())

    @staticmethod
    def _from_operational(options: Schedule, booted_ns: int | None) -> Schedule:
        if booted_ns is None:
            raise UsageError("the mission does not become OPERATIONAL; give a time, such as 600ms", field="--from")
        return replace(options, from_ns=booted_ns)

    def _fly(
        self,
        trial: Trial,
        search: Search,
        findings: Findings,
        reference: Verdict,
        watch: Stopwatch,
        see: Callable[[int, Verdict], bool],
    ) -> Tally | None:
        """Run all schedules, or until the first failure. None if another process runs differently under fifo."""
        if self.until_failure and reference.failed:
            return Tally()
        files = files_read(trial.plan) if self.results is not None or self.cluster is not None else []
        file = None if self.results is None else ResultsFile(self.results, self._identity(trial, files))
        most = MOST_SCHEDULES if self.seeds is None else self.seeds
        crew = make_crew(most, self.jobs, self.cluster, lambda: ship(trial.plan, files), self.longest_s)
        with contextlib.ExitStack() as stack:
            stack.callback(crew.close)
            if not self._is_steady(trial, crew, reference):
                return None
            stack.pop_all()  # the campaign closes it
        progress = make_progress(self.progress, self.seeds, 0 if file is None else len(file), self.budget_s)

        def take(number: int, verdict: Verdict) -> bool:
            is_over = see(number, verdict)
            is_over |= self.budget_s is not None and watch.elapsed_ns() > self.budget_s * NS_PER_S
            return (findings.take(number, verdict) and self.until_failure) or is_over

        return Campaign(trial, search, most, crew, file, progress).run(take)

    def _keep(self, report: Report) -> None:
        """Write the shortest schedule of each failure to the results file, for `cfepy explore --replay-all`."""
        if self.results is None:
            return
        for told in report.findings:
            shortest = report.schedule_of(told) if told.shrunk is None else told.shrunk.verdict.schedule
            keep_failure(self.results, told.finding.failure.group, told.finding.failure.title, shortest)

    def _is_steady(self, trial: Trial, crew: Crew, reference: Verdict) -> bool:
        """Return True if the run under the default schedule is the same again in a process of the crew."""
        if reference.trouble or any(failure.kind in _NO_WAY for failure in reference.failures):
            return True
        once = [(0, reference.schedule)]
        with contextlib.closing(crew.run(trial, lambda limit: [once.pop()] if once else [])) as verdicts:
            return all(self._is_same(reference, verdict) for _, verdict in verdicts)

    def _fly_again(self, trial: Trial, told: Told) -> None:
        """Record whether another run, in this process, is the same as the run that showed a failure."""
        finding = told.finding
        if not finding.in_reference and finding.failure.kind not in _NO_WAY:
            again = trial.fly(finding.verdict.schedule).verdict
            told.repeats = again.failure(finding.failure.group) is not None
            told.is_steady = told.repeats and self._is_same(finding.verdict, again)

    def _is_same(self, one: Verdict, other: Verdict) -> bool:
        """Return True if two runs are the same.

        On another computer a mission lies in another folder, which is in the trace. An aborted run has no trace.
        """
        if self.cluster is not None:
            return one.groups == other.groups
        return one.trace == other.trace or bool(other.trouble) or not other.trace

    def _identity(self, trial: Trial, files: list[str]) -> dict[str, Any]:
        """Return the values, by option name, that must be the same for a results file to be resumed."""
        search = {name: getattr(self, name) for name in ("policy", "depth", "first_seed", "any_priority", "events")}
        search |= {"hold": self.hold_s, "connect": self.connect_s, "from": self.from_s, "no_stuck": not self.stuck}
        search |= {"points": self.points} if self.points else {}
        search |= {"worst": self.worst} if self.worst is not None else {}
        search |= {"liveness": list(self._liveness)} if any(self._liveness) else {}
        search |= {"fair": self.fair} if self.fair is not None else {}
        search |= {"until": "auto" if self.until_known else "budget"} if self.seeds is None else {}
        return identity_of(trial.plan, files, search)

    def _told(self, trial: Trial, finding: Finding, tally: Tally) -> Told:
        """Fly a failure once more and shrink it. Returns it with its timeline."""
        told = Told(finding)
        try:
            if not tally.interrupted:
                self._fly_again(trial, told)
                if finding.failure.kind not in _NO_WAY:
                    failure, schedule = finding.failure, finding.verdict.schedule
                    told.inversions = trial.inversions_before(schedule, failure.at_ns, failure.task)
                told.shrunk = self._shrunk(trial, finding, tally.done) if told.repeats else None
            if told.shrunk is not None:
                told.story = _story(told.shrunk, finding)
            elif finding.in_reference and finding.failure.kind not in _NO_WAY and not tally.interrupted:
                told.story = story_of(trial, finding.verdict, finding.failure, ())
        except KeyboardInterrupt:  # keep the findings so far
            tally.interrupted = True
        return told

    def _shrunk(self, trial: Trial, finding: Finding, flown: int) -> Shrunk[Trial] | None:
        """Return the schedule with the fewest preemptions; None if the failure needs none, or ends its process."""
        if self.shrink == 0 or finding.in_reference or finding.failure.kind == PROCESS_DIED:
            return None
        probed = trial.probe() if finding.failure.kind == STALLED else trial
        schedules = [verdict.schedule for verdict in finding.simplest]
        budget = budget_of(flown) if self.shrink is None else self.shrink
        with self._noting_flights(finding.failure.title, budget) as fly:
            shrunk = Shrinker(probed, schedules, finding.failure.group, budget, self.shrink_s, fly).run()
        if shrunk is None:
            return None
        plan = replace(shrunk.trial.plan, stall=trial.plan.stall)
        return replace(shrunk, trial=replace(shrunk.trial, plan=plan))

    @contextlib.contextmanager
    def _noting_flights(self, title: str, budget: int) -> Iterator[Callable[[Trial, Schedule], NotedFlight]]:
        """Yield the function that flies for shrinking; a terminal shows the number of flights.

        Args:
            title: of the failure.
            budget: most flights.
        """
        with contextlib.closing(ForkingNotes()) as forks:
            if self.progress is None:
                yield forks.fly
                return
            numbers = itertools.count(1)

            def fly(trial: Trial, schedule: Schedule) -> NotedFlight:
                progress.show(f"shrinking: {next(numbers)} of at most {budget} runs, {title}")
                return forks.fly(trial, schedule)

            with WorkProgress(Stopwatch().elapsed_ns, self.progress) as progress:
                yield fly


def beside_fifo(bare: Trial, first: Tried, options: Schedule | None) -> Trial:
    """Return a trial that compares its runs with the run under the default schedule.

    Args:
        bare: the trial.
        first: its flight under the default schedule.
        options: fifo's schedule with the options of the others; None if tasks may wait forever.
    """
    if any(failure.kind == STALLED for failure in first.verdict.failures):  # a stalled run has no results
        return bare
    trial, end_ns = bare.against(first.results), first.verdict.end_ns
    if options is None or not end_ns:
        return trial
    return replace(trial, waits=waits_of(bare.plan, end_ns, options.policy()))


def _story(shrunk: Shrunk[Trial], finding: Finding) -> Story:
    failure = shrunk.verdict.failure(finding.failure.group)
    return Story() if failure is None else story_of(shrunk.trial, shrunk.verdict, failure, shrunk.moves)
