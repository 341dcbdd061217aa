"""`@explore` of `cfepy.testing`: runs a test under many schedules, and reports it if it fails under one of them.

Each run is complete, with setup and teardown, so function-scoped fixtures are made anew. Fixtures of a wider scope
stay. pytest sees the reports of one run: the first failed run, shrunk, or the last run.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Literal, cast

import pytest
from _pytest.runner import runtestprotocol

from cfepy.attachment import Attachment
from cfepy.extra.exploration import (
    Failure,
    Finding,
    SeededSearch,
    Shrinker,
    Shrunk,
    Tried,
    Verdict,
    budget_of,
    seeded_kinds,
    story_of,
    story_width,
)
from cfepy.pilot import RunPlan
from cfepy.rtos import Policy, Stopwatch
from cfepy.schedules import Schedule
from cfepy.status import UsageError
from cfepy.testing.explore_mark import Exploration
from cfepy.testing.missions import EXPLORE_MARK, SECTION, UNDER_TEST, Conditions, Missions
from cfepy.units import NS_PER_S
from cfepy.writing.escapes import visible

FAILED = "test failed"
MORE = 20  # schedules that are tried after a failure; the shortest ones that fail are shrunk


def schedules_of(exploration: Exploration, decisions: Callable[[], int], count: int) -> Iterator[Schedule]:
    """Yield this number of schedules: fifo first, then the policies in turn, each schedule with its own seed.

    Args:
        exploration: of the test.
        decisions: returns the number of decisions of the last run.
        count: number of schedules.
    """
    yield Schedule()
    steps = max(exploration.steps, decisions())
    kinds = [
        kind
        for each in exploration.policies
        for kind in seeded_kinds(each, exploration.depth, steps, exploration.options)
    ]
    search = SeededSearch(tuple(kinds), first_seed=1)
    for _ in range(count - 1):
        schedule = search.next()
        assert schedule is not None, "a search of seeds has a schedule at any time"
        yield schedule
        search.reckon_with(decisions())


@dataclass(frozen=True, slots=True)
class OneRun:
    """One run of a test.

    Attributes:
        reports: of setup, call and teardown.
        conditions: the conditions under which its missions were flown.
        expected: the groups of failures that the mission has under fifo as well.
    """

    reports: tuple[pytest.TestReport, ...]
    conditions: Conditions
    expected: frozenset[str] = frozenset()

    @property
    def is_done(self) -> bool:
        """Whether no other schedule is needed: the test failed, or was skipped."""
        return any(report.outcome != "passed" for report in self.reports)

    @property
    def failure(self) -> Failure | None:
        """The failure of the test; None if it passed. An expected failure (xfail) counts as one."""
        for report in self.reports:
            if report.failed or (report.skipped and hasattr(report, "wasxfail")):
                crash = getattr(report.longrepr, "reprcrash", None)
                place = "" if crash is None else f"{crash.path}:{crash.lineno} {crash.message.partition(':')[0]}"
                text = f"{report.when} {place.splitlines()[0] if place else ''}"
                cause = "|".join([text, *(each.group for each in self.own[:1])])
                return Failure(FAILED, report.nodeid, text, self.conditions.ended_ns, cause=cause)
        return None

    @property
    def own(self) -> list[Failure]:
        """The failures of the mission that it does not have under fifo; the first one identifies the cause."""
        return [each for each in self.conditions.failures if each.group not in self.expected]

    @property
    def verdict(self) -> Verdict:
        """The verdict: the failure of the test, then the failures of the mission."""
        recorded, own = self.conditions.recorded, self.failure
        return Verdict(
            self.conditions.schedule,
            (*([] if own is None else [own]), *self.own),
            deviations=tuple(sorted(recorded[0].deviations.items())) if recorded else (),
            preemptions=recorded[0].preemptions if recorded else 0,
            end_ns=self.conditions.ended_ns or 0,
        )


class ExploredTests:
    """The pytest plugin that runs explored tests; registered when there are any."""

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_protocol(self, item: pytest.Item, nextitem: pytest.Item | None) -> bool | None:
        """Run a test under its schedules. pytest runs other tests, and all tests under --cfepy-schedule."""
        mark = item.get_closest_marker(EXPLORE_MARK)
        if mark is None or item.config.getoption("--cfepy-schedule") is not None:
            return None
        item.ihook.pytest_runtest_logstart(nodeid=item.nodeid, location=item.location)
        for report in ExploredTest(item, mark.args[0]).explore(nextitem):
            item.ihook.pytest_runtest_logreport(report=report)
        item.ihook.pytest_runtest_logfinish(nodeid=item.nodeid, location=item.location)
        return True


class WorkLines:
    """Lines about long work on a test, which pytest shows without `-s`.

    Args:
        item: the test.

    Attributes:
        every_ns: wall time between two lines.
    """

    every_ns = 5 * NS_PER_S

    def __init__(self, item: pytest.Item) -> None:
        self._item = item
        self._watch = Stopwatch()
        self._due_ns = self.every_ns
        self._runs = 0

    def tell(self, work: str) -> None:
        """Count a run of the test; after every 5 s print a line with the work. Call it only between two runs."""
        self._runs += 1
        elapsed_ns = self._watch.elapsed_ns()
        reporter = self._item.config.pluginmanager.get_plugin("terminalreporter")
        if elapsed_ns < self._due_ns or reporter is None:
            return
        self._due_ns = elapsed_ns + self.every_ns
        reporter.ensure_newline()
        reporter.write_line(f"{self._item.nodeid}: {work}, {self._runs} runs in {elapsed_ns // NS_PER_S} s")


class ExploredTest:
    """One test under its schedules; a `Shrinkable` and a `Retellable` as the trials of `cfepy explore`.

    Args:
        item: the test.
        exploration: the settings of its schedules.
    """

    def __init__(self, item: pytest.Item, exploration: Exploration) -> None:
        self._item = item
        self._exploration = exploration
        self._properties = len(item.user_properties)
        self._flown = 0
        self._work = WorkLines(item)
        self._doing = ""
        self._expected: frozenset[str] = frozenset()
        self._last: OneRun

    def explore(self, nextitem: pytest.Item | None) -> Sequence[pytest.TestReport]:
        """Run the test. Returns the reports that stand for all runs."""
        count = self._item.config.getoption("--cfepy-schedules") or self._exploration.seeds
        schedules = schedules_of(self._exploration, self._decisions, count)
        for number, schedule in enumerate(schedules, 1):
            when = f"under schedule {number} of {count}"
            self._flown = number
            self._last = self._once(Conditions(schedule))
            if number == 1 and not self._last.is_done:
                self._expected = frozenset(each.group for each in self._last.conditions.failures)
            self._work.tell(f"{number} of {count} schedules")
            if self._last.is_done:
                break
            if not self._last.conditions.plans:
                self._last = OneRun((*self._last.reports, self._report("call", _complain)), self._last.conditions)
                return [*self._last.reports, *self._end_wider(nextitem)]
        reports = [*self._last.reports]
        failure = self._last.failure
        if failure is not None:
            reports = self._told(Finding(failure, self._flown, self._last.verdict), schedules, when)
        return [*reports, *self._end_wider(nextitem)]

    def _decisions(self) -> int:
        """Return the number of decisions of the longest mission of the last run."""
        return max((each.decisions for each in self._last.conditions.recorded), default=0)

    def _end_wider(self, nextitem: pytest.Item | None) -> list[pytest.TestReport]:
        """Tear down the wider-scoped fixtures that the next test does not need. Returns a report if that fails."""
        setup_state = self._item.session._setupstate
        report = self._report("teardown", lambda: setup_state.teardown_exact(nextitem))
        return [report] if report.failed else []

    def _report(self, when: Literal["call", "teardown"], act: Callable[[], None]) -> pytest.TestReport:
        """Return pytest's report of a phase of the test."""
        call = pytest.CallInfo.from_call(act, when)
        report: pytest.TestReport = self._item.ihook.pytest_runtest_makereport(item=self._item, call=call)
        return report

    def _told(self, finding: Finding, schedules: Iterator[Schedule], when: str) -> list[pytest.TestReport]:
        """Return the reports of the failure, shrunk if possible, with its story."""
        schedule = finding.verdict.schedule
        lines = [f"failed {when}, {schedule}"]
        first = self._last
        shrunk = self._shrunk(finding, schedules)
        if shrunk is not None:
            schedule = shrunk.verdict.schedule
            lines.append(f"the shortest schedule that fails in this way, after {shrunk.probes} runs: {schedule}")
            lines += [shrunk.text("shrink_time of @explore"), "", *self._story(shrunk, finding.failure.group), ""]
        elif self._last is not first:  # pytest reports the first failure
            self._last = self._once(Conditions(schedule))
        if self._missions is not None:
            lines.append(f"to reproduce: {self._missions.command(self._item, schedule)}")
        reports = list(self._last.reports)
        failed = next((each for each in reports if each.outcome != "passed"), reports[-1])
        failed.sections.append((f"{SECTION} explore", visible("\n".join(lines))))
        return reports

    def _shrunk(self, finding: Finding, schedules: Iterator[Schedule]) -> Shrunk[ExploredTest] | None:
        """Return the shortest schedule, or None if shrinking does not apply."""
        recorded, exploration = self._last.conditions.recorded, self._exploration
        is_alone = len(recorded) == 1 and recorded[0].moments
        if exploration.shrink == 0 or not is_alone or self._item.config.getoption("usepdb"):
            return None
        watch = Stopwatch()
        self._find_simpler(finding, schedules)
        budget = budget_of(self._flown) if exploration.shrink is None else exploration.shrink
        left_s = max(0.0, exploration.shrink_time - watch.elapsed_ns() / NS_PER_S)
        self._doing = "shrinking the schedule of a failure"
        starts = [verdict.schedule for verdict in finding.simplest]
        return Shrinker(self, starts, finding.failure.group, budget, left_s).run()

    def _find_simpler(self, finding: Finding, schedules: Iterator[Schedule]) -> None:
        """Run further schedules; as in `cfepy explore`, the shortest ones that fail are shrunk."""
        watch, limit_ns = Stopwatch(), self._exploration.shrink_time * NS_PER_S / 4
        for number, schedule in enumerate(islice(schedules, MORE), self._flown + 1):
            if watch.elapsed_ns() > limit_ns:
                break
            run = self._last = self._once(Conditions(schedule))
            verdict = run.verdict
            if verdict.failure(finding.failure.group) is not None and len(run.conditions.recorded) == 1:
                finding.again(number, verdict)
            self._work.tell("looking for a shorter schedule that fails")

    def _story(self, shrunk: Shrunk[ExploredTest], group: str) -> list[str]:
        """Return the story of the failure, as `cfepy explore` shows it: of the mission's own failure, if it has one."""
        self._doing = "recording the timeline of the failure"
        again = self._once(Conditions(shrunk.verdict.schedule))
        failures = again.verdict.failures
        failure = next((each for each in failures if each.group != group), failures[0] if failures else None)
        if failure is None:
            return []
        reporter = self._item.config.pluginmanager.get_plugin("terminalreporter")
        width = story_width(reporter is not None and reporter.isatty)
        lines = story_of(self, shrunk.verdict, failure, shrunk.moves).lines(width)
        self._last = self._once(Conditions(shrunk.verdict.schedule))  # pytest shows what this run reported
        return lines

    # -- one run -------------------------------------------------------------------------------------------------------

    events = "error"

    @property
    def plan(self) -> RunPlan:
        """The run of the mission."""
        return self._last.conditions.plans[0]

    def fly(self, schedule: Schedule, attachments: Sequence[Attachment] = (), policy: Policy | None = None) -> Tried:
        """Return the verdict under a schedule, or under a policy in its place, as `Trial.fly` does."""
        run = self._last = self._once(Conditions(schedule, policy, tuple(attachments)))
        self._work.tell(self._doing)
        return Tried(run.verdict)

    def until(self, end_ns: int) -> None:
        """Do nothing: the length of a test cannot be changed."""

    @property
    def _missions(self) -> Missions | None:
        return cast("Missions | None", self._item.config.pluginmanager.get_plugin("cfepy-missions"))

    def _once(self, conditions: Conditions) -> OneRun:
        """Run the whole test, from its setup to its teardown. Fixtures of a wider scope stay."""
        item = self._item
        item._report_sections.clear()  # of the run before
        del item.user_properties[self._properties :]
        item.config.stash[UNDER_TEST] = conditions
        try:
            parent = cast("pytest.Item", item.parent)  # fixtures that are not the parent's are torn down
            reports = runtestprotocol(item, log=False, nextitem=parent)
        finally:
            del item.config.stash[UNDER_TEST]
        return OneRun(tuple(reports), conditions, self._expected)


def _complain() -> None:
    text = "the test must boot a mission under the schedules, itself or in a function-scoped fixture"
    raise UsageError(text, field="@explore")
