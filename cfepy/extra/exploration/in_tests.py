"""`@explore` of `cfepy.testing`: runs a test under many schedules, and reports it if it fails under one of them.

Each run is complete, with setup and teardown, so function-scoped fixtures are made anew. Fixtures of a wider scope
stay. pytest sees the reports of one run: the first failed run, shrunk, or the last run.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal, cast

import pytest
from _pytest.runner import runtestprotocol

from cfepy.extra.exploration import (
    Failure,
    MadeMove,
    SeededSearch,
    Shrinker,
    Shrunk,
    Story,
    TaskLook,
    Tried,
    Verdict,
    budget_of,
    important,
    seeded_kinds,
)
from cfepy.rtos import Policy
from cfepy.schedules import Schedule
from cfepy.status import UsageError
from cfepy.testing.explore_mark import Exploration
from cfepy.testing.missions import EXPLORE_MARK, SECTION, UNDER_TEST, Conditions, Missions
from cfepy.writing.escapes import visible

FAILED = "test failed"


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
    """

    reports: tuple[pytest.TestReport, ...]
    conditions: Conditions

    @property
    def is_done(self) -> bool:
        """Whether no other schedule is needed: the test failed, or was skipped."""
        return any(report.outcome != "passed" for report in self.reports)

    @property
    def failure(self) -> Failure | None:
        """The failure; None if it passed. An expected failure (xfail) counts as one."""
        for report in self.reports:
            if report.failed or (report.skipped and hasattr(report, "wasxfail")):
                crash = getattr(report.longrepr, "reprcrash", None)
                place = "" if crash is None else f"{crash.path}:{crash.lineno} {crash.message.partition(':')[0]}"
                return Failure(FAILED, report.nodeid, f"{report.when} {place.splitlines()[0] if place else ''}")
        return None


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


class ExploredTest:
    """One test under its schedules; a `cfepy.extra.exploration.Shrinkable`, under one at a time.

    Args:
        item: the test.
        exploration: the settings of its schedules.
    """

    def __init__(self, item: pytest.Item, exploration: Exploration) -> None:
        self._item = item
        self._exploration = exploration
        self._properties = len(item.user_properties)
        self._flown = 0
        self._last: OneRun

    def explore(self, nextitem: pytest.Item | None) -> Sequence[pytest.TestReport]:
        """Run the test. Returns the reports that stand for all runs."""
        count = self._item.config.getoption("--cfepy-schedules") or self._exploration.seeds
        for number, schedule in enumerate(schedules_of(self._exploration, self._decisions, count), 1):
            when = f"under schedule {number} of {count}"
            self._flown = number
            self._last = self._once(Conditions(schedule))
            if self._last.is_done:
                break
            if not self._last.conditions.plans:
                self._last = OneRun((*self._last.reports, self._report("call", _complain)), self._last.conditions)
                return [*self._last.reports, *self._end_wider(nextitem)]
        reports = [*self._last.reports]
        failure = self._last.failure
        if failure is not None:
            reports = self._told(schedule, when, failure.group)
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

    def _told(self, schedule: Schedule, when: str, group: str) -> list[pytest.TestReport]:
        """Return the reports of the failure, shrunk if possible."""
        lines = [f"failed {when}, {schedule}"]
        shrunk = self._shrunk(schedule, group)
        if shrunk is not None:
            schedule = shrunk.verdict.schedule
            lines.append(f"the shortest schedule that fails in this way, after {shrunk.probes} runs: {schedule}")
            lines += ["", *self._timeline(schedule, shrunk.moves), ""]
        if self._missions is not None:
            lines.append(f"to reproduce: {self._missions.command(self._item, schedule)}")
        reports = list(self._last.reports)
        failed = next((each for each in reports if each.outcome != "passed"), reports[-1])
        failed.sections.append((f"{SECTION} explore", visible("\n".join(lines))))
        return reports

    def _shrunk(self, schedule: Schedule, group: str) -> Shrunk[ExploredTest] | None:
        """Return the shortest schedule, or None if shrinking does not apply."""
        recorded = self._last.conditions.recorded
        is_alone = len(recorded) == 1 and recorded[0].moments
        if self._exploration.shrink == 0 or not is_alone or self._item.config.getoption("usepdb"):
            return None
        budget = budget_of(self._flown) if self._exploration.shrink is None else self._exploration.shrink
        return Shrinker(self, [schedule], group, budget).run()

    def _timeline(self, schedule: Schedule, moves: Sequence[MadeMove]) -> list[str]:
        """Run the test once more under a schedule. Returns its timeline, with a column for each task that matters."""
        look = TaskLook(self._last.conditions.plans[0].spec())
        policy = look.policy(schedule.policy() or Policy())
        self._last = self._once(Conditions(schedule, policy, (look,)))
        return Story(tuple(look.rows), important(look.rows, moves)).lines()

    # -- one run -------------------------------------------------------------------------------------------------------

    def fly(self, schedule: Schedule, policy: Policy | None = None) -> Tried:
        """Return the verdict under a schedule, or under a policy in its place, as `Trial.fly` does."""
        run = self._once(Conditions(schedule, policy))
        failure, recorded = run.failure, run.conditions.recorded
        deviations = tuple(sorted(recorded[0].deviations.items())) if recorded else ()
        return Tried(Verdict(schedule, () if failure is None else (failure,), deviations=deviations))

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
        return OneRun(tuple(reports), conditions)


def _complain() -> None:
    text = "the test must boot a mission under the schedules, itself or in a function-scoped fixture"
    raise UsageError(text, field="@explore")
