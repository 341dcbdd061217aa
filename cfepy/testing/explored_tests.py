"""Runs tests with @explore: the whole test once for each schedule, and what to tell when it fails under one.

Each run is a complete one, with setup and teardown, so function-scoped fixtures are made anew; only those of a wider
scope stay. pytest sees the reports of one run: the first that failed, shrunk, or the last.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, cast

import pytest
from _pytest.runner import runtestprotocol

from cfepy.explore.shrink import Shrinker
from cfepy.explore.verdict import Failure, Verdict
from cfepy.mission.run_plan import RunPlan
from cfepy.mission.script_conditions import seconds
from cfepy.rtos.policy import Policy, Recorded
from cfepy.rtos.schedule import Schedule
from cfepy.testing.exploration import Exploration
from cfepy.testing.missions import SECTION, UNDER_TEST, Conditions, Missions
from cfepy.testing.plugin import EXPLORE_MARK

FAILED = "test failed"
MOST_MOMENTS = 20  # deviations that are told


@dataclass(frozen=True, slots=True)
class Run:
    """One run of a test.

    Attributes:
        reports: of setup, call and teardown.
        recorded: what the policies of its missions have decided.
    """

    reports: tuple[pytest.TestReport, ...]
    recorded: tuple[Recorded, ...]

    @property
    def is_done(self) -> bool:
        """Whether there is no need for another schedule: it failed, or was skipped."""
        return any(report.outcome != "passed" for report in self.reports)

    @property
    def failure(self) -> Failure | None:
        """How it failed; None when it did not. An expected failure (xfail) is one."""
        for report in self.reports:
            if report.failed or (report.skipped and hasattr(report, "wasxfail")):
                crash = getattr(report.longrepr, "reprcrash", None)
                place = "" if crash is None else f"{crash.path}:{crash.lineno} {crash.message.partition(':')[0]}"
                return Failure(FAILED, report.nodeid, f"{report.when} {place.splitlines()[0] if place else ''}")
        return None


class ExploredTests:
    """The pytest plugin that runs them; registered when there are any."""

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_protocol(self, item: pytest.Item, nextitem: pytest.Item | None) -> bool | None:
        """Run a test under its schedules; others, and all under --cfepy-schedule, are left to pytest."""
        mark = item.get_closest_marker(EXPLORE_MARK)
        if mark is None or item.config.getoption("--cfepy-schedule") is not None:
            return None
        item.ihook.pytest_runtest_logstart(nodeid=item.nodeid, location=item.location)
        for report in ExploredTest(item, mark.args[0]).explore(nextitem):
            item.ihook.pytest_runtest_logreport(report=report)
        item.ihook.pytest_runtest_logfinish(nodeid=item.nodeid, location=item.location)
        return True


class ExploredTest:
    """One test under its schedules; as the trial of a `Shrinker`, under one at a time.

    Args:
        item: the test.
        exploration: which schedules.
    """

    def __init__(self, item: pytest.Item, exploration: Exploration) -> None:
        self.plan = RunPlan((item.nodeid,))
        self._item = item
        self._exploration = exploration
        self._properties = len(item.user_properties)
        self._last: Run

    def explore(self, nextitem: pytest.Item | None) -> Sequence[pytest.TestReport]:
        """Run it; the reports that stand for all runs."""
        count = self._item.config.getoption("--cfepy-schedules") or self._exploration.seeds
        for number, schedule in enumerate(self._exploration.schedules(count), 1):
            when = f"under the {number}. of {count} schedules"
            self._last = self._once(schedule.text())
            if self._last.is_done:
                break
        reports = [*self._last.reports]
        failure = self._last.failure
        if failure is not None:
            reports = self._told(schedule, when, failure.group)
        return [*reports, *self._end_wider(nextitem)]

    def _end_wider(self, nextitem: pytest.Item | None) -> list[pytest.TestReport]:
        """Tear down the fixtures of a wider scope that the next test does not need; a report if that fails."""
        item = self._item
        call = pytest.CallInfo.from_call(lambda: item.session._setupstate.teardown_exact(nextitem), "teardown")
        return [] if call.excinfo is None else [item.ihook.pytest_runtest_makereport(item=item, call=call)]

    def _told(self, schedule: Schedule, when: str, group: str) -> list[pytest.TestReport]:
        """The reports of the failure, shrunk if that can be."""
        lines = [f"failed {when}, {schedule}"]
        shrunk = self._shrunk(schedule, group)
        if shrunk is not None:
            lines.append(f"the shortest schedule that fails in this way, after {shrunk[1]} runs: {shrunk[0]}")
        text = schedule.text() if shrunk is None else shrunk[0]
        if shrunk is not None:
            self._last = self._once(text)
        lines += _moments(self._last.recorded)
        missions = self._missions
        if missions is not None:
            lines.append(f"the same again: {missions.command(self._item, text)}")
        reports = list(self._last.reports)
        failed = next((each for each in reports if each.outcome != "passed"), reports[-1])
        failed.sections.append((f"{SECTION} explore", "\n".join(lines)))
        return reports

    def _shrunk(self, schedule: Schedule, group: str) -> tuple[str, int] | None:
        """The shortest schedule, and how many runs it took; None when there is none to look for."""
        is_alone = len(self._last.recorded) == 1 and self._last.recorded[0].moments
        if not (self._exploration.shrink and is_alone) or self._item.config.getoption("usepdb"):
            return None
        shrinker = Shrinker(cast(Any, self), schedule.text(), group, self._exploration.shrink)
        found = shrinker.run()
        return None if found is None else (found.verdict.schedule, found.probes)

    # -- one run -------------------------------------------------------------------------------------------------------

    def run(self, schedule: str) -> Verdict:
        """The verdict on one schedule."""
        return self.fly(Schedule.parse(schedule))[0]

    def fly(self, schedule: Schedule, policy: Policy | None = None) -> tuple[Verdict, tuple[()]]:
        """As `cfepy.explore.trial.Trial.fly`: the verdict under a schedule, or a policy in its place."""
        run = self._once(schedule.text(), policy)
        failure = run.failure
        deviations = tuple(sorted(run.recorded[0].deviations.items())) if run.recorded else ()
        return Verdict(schedule.text(), () if failure is None else (failure,), deviations=deviations), ()

    @property
    def _missions(self) -> Missions | None:
        return cast("Missions | None", self._item.config.pluginmanager.get_plugin("cfepy-missions"))

    def _once(self, schedule: str, policy: Policy | None = None) -> Run:
        """The whole test, from its setup to its teardown; fixtures of a wider scope stay."""
        item = self._item
        item._report_sections.clear()  # of the run before
        del item.user_properties[self._properties :]
        under_test = Conditions(schedule, policy)
        item.config.stash[UNDER_TEST] = under_test
        try:
            parent = cast("pytest.Item", item.parent)  # what is not the parent's is torn down
            reports = runtestprotocol(item, log=False, nextitem=parent)
        finally:
            del item.config.stash[UNDER_TEST]
        return Run(tuple(reports), tuple(under_test.recorded))


def _moments(recorded: Sequence[Recorded]) -> list[str]:
    """What was not as fifo would have it, a line each."""
    lines = []
    for number, each in enumerate(recorded, 1):
        which = f"mission {number}: " if len(recorded) > 1 else ""
        for moment in each.moments[:MOST_MOMENTS]:
            how = "could have gone on" if moment.preemption else "was first"
            lines.append(
                f"{which}at {seconds(moment.now)} s, decision {moment.decision}:"
                f" {moment.instead_of} {how}, {moment.chosen} ran instead"
            )
        if len(each.moments) > MOST_MOMENTS:
            lines.append(f"{which}... and {len(each.moments) - MOST_MOMENTS} more")
    return lines
