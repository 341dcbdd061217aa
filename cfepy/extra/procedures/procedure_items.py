"""Procedures as tests of pytest: `pytest --procedures suites --mission lab`.

Each suite flies once, and each of its tests is a test item. Setups and teardowns run in the order of COSMOS, before and
after the selected tests. `cfepy.testing.plugin` loads this module for the option `--procedures`.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from cfepy.extra.procedures.flying_suites import (
    FAIL,
    PASS,
    SKIP,
    CampaignResult,
    FlyingSuite,
    ProcedureResult,
    Settings,
)
from cfepy.extra.procedures.matrix import matrix_csv, matrix_page
from cfepy.extra.procedures.procedure_loader import find_procedures, suites_in
from cfepy.extra.procedures.racy_tests import Verdicts, explore_procedures
from cfepy.extra.procedures.requirements import Requirements
from cfepy.extra.procedures.suites import SETUP, TEARDOWN, ProcedureStep
from cfepy.flight import command_for
from cfepy.pilot import RunPlan
from cfepy.rtos import AUTO
from cfepy.schedules import Schedule

_LAST_EVENTS = 8
_LAST_LINES = 20
STATES = "cfepy_requirements"
"""The key of the states of requirements in the properties of a test's report."""


class ProcedureFailure(Exception):
    """A test of a procedure failed."""


class ProcedureTests:
    """The pytest plugin of procedures.

    Args:
        config: pytest's configuration, with the options of `cfepy.testing.plugin`.

    Raises:
        UsageError: if there are no procedures.
    """

    def __init__(self, config: pytest.Config) -> None:
        self._config = config
        self._folders = [Path(each).resolve() for each in config.getoption("--procedures")]
        self._files = {file for folder in self._folders for file in find_procedures(folder)}
        self.requirements = Requirements(_path(config.getoption("--requirements")))
        self._results: list[ProcedureResult] = []
        mission = config.getoption("--mission")
        stall = config.getoption("--cfepy-stall")
        plan = RunPlan(
            (mission,),
            command_for(mission),
            seed=config.getoption("--cfepy-seed"),
            tasks=config.getoption("--cfepy-tasks") or AUTO,
            schedule=Schedule.parse(config.getoption("--cfepy-schedule") or "fifo"),
            faults=config.getoption("--faults"),
            stall=float(config.getini("cfepy_stall") if stall is None else stall),
        )
        self.settings = Settings(
            plan,
            requirements=_path(config.getoption("--requirements")),
            answers=_path(config.getoption("--answers")),
            journals=_path(config.getoption("--cfepy-record")),
        )
        self.explored: int | None = config.getoption("--explore")

    @pytest.hookimpl(wrapper=True)
    def pytest_collect_file(
        self, file_path: Path, parent: pytest.Collector
    ) -> Generator[None, list[pytest.Collector], list[pytest.Collector]]:
        """Collect a file of procedures, and no other file of their folders as a test of Python."""
        found = yield
        resolved = file_path.resolve()
        if resolved in self._files:
            return [ProcedureFile.from_parent(parent, path=file_path, tests=self)]
        is_below = any(resolved.is_relative_to(folder) for folder in self._folders if folder.is_dir())
        return [] if is_below and resolved.suffix == ".py" else found

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        """Put the tests of procedures back into their order, which other plugins may have changed."""
        own = [each for each in items if isinstance(each, ProcedureItem)]
        ordered = iter(sorted(own, key=lambda each: each.place))
        items[:] = [next(ordered) if isinstance(each, ProcedureItem) else each for each in items]

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Take the states of requirements from the report of a test, which may come from another process."""
        if report.when != "call" and not report.skipped:
            return
        for name, value in report.user_properties:
            if name == STATES and isinstance(value, list):
                self.requirements.current = report.nodeid
                for key, state, message in value:
                    self.requirements.set_status([key], state, message)
        verdict = SKIP if report.skipped else PASS if report.passed else FAIL
        suite, _, test = report.nodeid.partition("::")
        self._results.append(ProcedureResult(suite, test, verdict, str(report.longrepr or "").split("\n", 1)[0]))

    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        """Write the requirement matrix; with xdist, only the controlling process does."""
        if hasattr(self._config, "workerinput"):
            return
        result = CampaignResult(self._results, self.requirements)
        page, table = self._config.getoption("--matrix-html"), self._config.getoption("--matrix-csv")
        if page is not None:
            Path(page).write_text(matrix_page(result, "Requirements"), encoding="utf-8")
        if table is not None:
            Path(table).write_text(matrix_csv(self.requirements), encoding="utf-8")


def _path(text: str | None) -> Path | None:
    return None if text is None else Path(text)


class ProcedureFile(pytest.File):
    """A file of procedures."""

    def __init__(self, *, tests: ProcedureTests, **options: Any) -> None:
        super().__init__(**options)
        self.tests = tests

    def collect(self) -> Iterator[pytest.Collector]:
        for suite in suites_in(self.path.resolve()):
            yield SuiteNode.from_parent(self, name=suite or self.path.stem, suite=suite, tests=self.tests)


class SuiteNode(pytest.Collector):
    """A suite and its flight, which lasts from its first selected test to its last."""

    def __init__(self, *, suite: str, tests: ProcedureTests, **options: Any) -> None:
        super().__init__(**options)
        self.tests = tests
        self.file = self.path.resolve()
        self.suite = suite
        self.flying: FlyingSuite | None = None
        self._begun: list[str] = []
        self._verdicts: dict[str, Verdicts] | None = None

    def collect(self) -> Iterator[pytest.Item]:
        with FlyingSuite(self.file, self.suite, self.tests.settings, Requirements(), offline=True) as offline:
            names = [step.name for step in offline.steps if step.is_test]
            texts = {step.name: step.text for step in offline.steps}
        for number, name in enumerate(dict.fromkeys(names)):
            place = str(self.file), self.name, number
            yield ProcedureItem.from_parent(self, name=name, text=texts[name], place=place)

    def setup(self) -> None:
        """Boot the mission."""
        if self.tests.explored is None:
            self.flying = FlyingSuite(self.file, self.suite, self.tests.settings, self.tests.requirements)
            self.flying.__enter__()

    def teardown(self) -> None:
        """Run the teardowns that are left, and end the mission."""
        flying, self.flying = self.flying, None
        if flying is None:
            return
        try:
            failed = [self._end_group(flying, group) for group in self._begun[-1:]]
            failed.append(self._run(flying, "", TEARDOWN))
        finally:
            self._begun.clear()
            flying.__exit__(None, None, None)
        for each in failed:
            if each is not None:
                raise ProcedureFailure(_text(each, flying))

    def run(self, name: str) -> ProcedureResult:
        """Run a test, with the setups and teardowns that come before it; a failed one is the result."""
        flying = self.flying
        assert flying is not None
        step = next(each for each in flying.steps if each.name == name)
        before: list[ProcedureResult | None] = []
        if not self._begun:
            before.append(self._run(flying, "", SETUP))
            self._begun.append("")
        if step.group != self._begun[-1]:
            before.append(self._end_group(flying, self._begun[-1]))
            self._begun.append(step.group)
            before.append(self._run(flying, step.group, SETUP))
        for each in before:
            if each is not None:
                return each
        result = flying.run(step)
        assert result is not None
        return result

    def _end_group(self, flying: FlyingSuite, group: str) -> ProcedureResult | None:
        return self._run(flying, group, TEARDOWN) if group else None

    def _run(self, flying: FlyingSuite, group: str, script: str) -> ProcedureResult | None:
        found: list[ProcedureStep] = [each for each in flying.steps if each.group == group and each.script == script]
        return flying.run(found[0]) if found else None

    def verdicts(self, name: str) -> Verdicts:
        """Return the verdicts of a test under all schedules; the first call flies them."""
        if self._verdicts is None:
            settings = replace(self.tests.settings, journals=None)
            found = explore_procedures([self.file], settings, self.tests.explored or 1)
            self._verdicts = {each.name.split("::", 1)[1]: each for each in found}
        return self._verdicts.get(name) or Verdicts(name)


class ProcedureItem(pytest.Item):
    """A test of a suite.

    Args:
        text: its docstring.
        place: file, suite and number in the suite, for the order.
        options: as for `pytest.Item`.
    """

    def __init__(self, *, text: str, place: tuple[str, str, int], **options: Any) -> None:
        super().__init__(**options)
        self.text, self.place = text, place

    @property
    def suite(self) -> SuiteNode:
        """The suite."""
        assert isinstance(self.parent, SuiteNode)
        return self.parent

    def runtest(self) -> None:
        """Run the test.

        Raises:
            ProcedureFailure: if it failed, or is racy.
        """
        if self.suite.tests.explored is not None:
            self._explore()
            return
        result = self.suite.run(self.name)
        self.user_properties.append(("virtual_s", round(result.seconds, 6)))
        self.user_properties.append((STATES, [list(each) for each in result.states]))
        self.user_properties += [("requirement", each) for each in result.requirements]
        if result.output:
            self.add_report_section("call", "procedure", "\n".join(result.output))
        if result.verdict == SKIP:
            pytest.skip(result.message or "SkipScript")
        if result.verdict == FAIL:
            assert self.suite.flying is not None
            raise ProcedureFailure(_text(result, self.suite.flying))

    def _explore(self) -> None:
        verdicts = self.suite.verdicts(self.name)
        if verdicts.first is None:
            return
        kind = "racy" if verdicts.is_racy else "always failed"
        lines = [f"{kind}: {verdicts.passed} passed, {verdicts.failed} failed", verdicts.first.message]
        if verdicts.is_racy:
            lines.append(f"cause: {verdicts.cause}")
        lines.append(
            f"first under {verdicts.schedule} with the ground seed {verdicts.ground_seed}, {verdicts.first.place}"
        )
        raise ProcedureFailure("\n".join(lines))

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """Return the text of a failed procedure, without lines of cfepy."""
        if isinstance(excinfo.value, ProcedureFailure):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """Return file, line and name for reports."""
        return self.path, None, f"{self.suite.name}::{self.name}"


def _text(result: ProcedureResult, flying: FlyingSuite) -> str:
    """Return message, place, last events, console and the command that repeats the flight."""
    lines = [result.message]
    if not result.is_test:
        lines[0] = f"{result.full_name}: {result.message}"
    lines += [f"at {result.place}"] if result.place else []
    if result.events:
        lines += ["the last events:", *(f"  {each}" for each in result.events[-_LAST_EVENTS:])]
    if flying.flight is not None:
        lines += ["console:", *(f"  {each}" for each in flying.flight.console[-_LAST_LINES:])]
    if flying.journal is not None:
        lines.append(f"journal: {flying.journal}")
    lines.append(f"to reproduce: {flying.command()}")
    return "\n".join(lines)
