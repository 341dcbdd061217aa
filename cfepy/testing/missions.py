"""`Missions`, returned by the fixture `mission`: boots missions, and ends them with the test or fixture that booted
them.

It is a separate pytest plugin, registered when the first test asks for a mission. It adds the state of its missions and
the command that repeats the test to the report of a failed test.
"""

from __future__ import annotations

import os
from collections.abc import Generator, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from cfepy.attachment import Attachment
from cfepy.flight import SEED, ExpectationError, Faults, Flight, command_for, fault_attachments, fault_text, schedule_of
from cfepy.interpreter.host_system import command_line
from cfepy.interpreter.own_code import source_file
from cfepy.mission import is_mission_folder
from cfepy.pilot import Failure, RunPlan
from cfepy.rtos import AUTO, NotingPolicy, Policy
from cfepy.schedules import Schedule
from cfepy.status import UsageError
from cfepy.testing.hypothesis_tests import ExampleTests
from cfepy.testing.keywords import suggests_keywords
from cfepy.writing.escapes import visible
from cfepy.writing.work_progress import progress_lines

if TYPE_CHECKING:
    from cfepy.testing.journals import FlightJournals

__tracebackhide__ = True  # pytest shows the line of the test

SECTION = "cfepy"
_BELOW_TESTS = (Path(__file__).parents[1], Path(os.__file__).parent)  # cfepy, and the library that it calls
FIFO = Schedule().text()
BETWEEN = ";"  # between the schedules of several missions in one test
EXPLORE_MARK = "cfepy_explore"  # as in `cfepy.extra.exploration.in_tests`, which is loaded for tests with this mark
UNDER_TEST = pytest.StashKey["Conditions"]()
"""In the stash of the configuration: how the missions of an explored test are flown."""
BELOW = 'the command in the section "cfepy" below'


@dataclass(slots=True)
class Conditions:
    """How the missions of one run of an explored test are flown.

    Attributes:
        schedule: schedule of each mission.
        policy: instead of the schedule's own; None for that.
        attachments: observe each mission.
        plans: flown plans, one per mission.
        recorded: decisions of the policies, one per mission.
        ended_ns: virtual time of the mission when the test function ended; None if there is not exactly one.
        failures: the mission's own failures by then; only of a failed or observed test, and under fifo.
    """

    schedule: Schedule
    policy: Policy | None = None
    attachments: Sequence[Attachment] = ()
    plans: list[RunPlan] = field(default_factory=list)
    recorded: list[NotingPolicy] = field(default_factory=list)
    ended_ns: int | None = None
    failures: tuple[Failure, ...] = ()

    def note_end(self, flights: Sequence[Flight], failed: bool) -> None:
        """Note the state of the mission at the end of the test function, while it still flies."""
        if len(flights) == 1 == len(self.plans):
            self.ended_ns = flights[0].mission.kernel.now
            if failed or self.attachments or self.schedule.kind == FIFO:
                first: dict[str, Failure] = {}
                for each in flights[0].failures:
                    first.setdefault(each.group, each)
                self.failures = tuple(first.values())


class ScheduleWarning(pytest.PytestWarning):
    """A part of the schedule that the command line or the test gives was not possible, so it is another schedule."""


@contextmanager
def reported_progress(config: pytest.Config) -> Iterator[None]:
    """Write a line every five seconds of long work, also while pytest captures the output; a context manager.

    A process of pytest-xdist has no report and writes nothing.

    Args:
        config: pytest's configuration.
    """
    reporter = config.pluginmanager.get_plugin("terminalreporter")
    capture = config.pluginmanager.get_plugin("capturemanager")
    if reporter is None or capture is None:
        yield
        return

    def write(line: str) -> None:
        with capture.global_and_fixture_disabled():
            reporter.ensure_newline()
            reporter.write_line(line)

    with progress_lines(write):
        yield


def leave_out_own_lines(failure: pytest.ExceptionInfo[BaseException]) -> None:
    """Show the test's lines and not those of cfepy, for a wrong call or a failed expectation.

    Args:
        failure: its traceback is cut at the last line of the test; that of any other error stays.
    """
    if not isinstance(failure.value, (UsageError, ExpectationError)):
        return
    last, each = None, failure.value.__traceback__
    while each is not None:
        file = Path(source_file(each.tb_frame.f_code.co_filename))
        if not any(file.is_relative_to(folder) for folder in _BELOW_TESTS):
            last = each
        each = each.tb_next
    if last is not None:
        last.tb_next = None


class Missions:
    """Boots missions for tests; see the fixture `mission`.

    Args:
        config: pytest's configuration.
        current: key of the running test in the stash of `config`.

    Attributes:
        flown: the missions of this test, in order, without missions of fixtures with a wider scope.
    """

    def __init__(self, config: pytest.Config, current: pytest.StashKey[pytest.Item]) -> None:
        self.flown: list[Flight] = []
        self._config = config
        self._current = current
        self._fixtures: list[pytest.FixtureRequest] = []  # fixtures that are being set up
        self._warned: set[str] = set()  # warnings about schedules in this test
        self._fixed = 0  # number of flown missions that were booted by fixtures: the first ones
        folder = config.getoption("--cfepy-record")
        self._journals = None if folder is None else _journals(folder)
        self._examples = ExampleTests(config.getoption("--cfepy-example"), self._end_example)

    @suggests_keywords
    def __call__(
        self,
        name: str | os.PathLike[str],
        *,
        board: str | None = None,
        seed: int | None = None,
        schedule: str | Schedule | None = None,
        tasks: str | None = None,
        faults: Faults | None = None,
        args: Mapping[str, object] | None = None,
        races: bool | None = None,
        attachments: Sequence[Attachment] = (),
    ) -> Flight:
        """Boot a mission: it is at virtual time 0, and runs when the test lets it run.

        Args:
            name: a mission's folder, startup script or launch file, or a node's program, searched relative to the
                test's file first; or the name of a mission included in cfepy.
            board: name or file of a board; None for the mission's own.
            seed: seed of everything random in it; None for --cfepy-seed.
            schedule: which task goes first, such as "random:7"; None for the schedule of @explore or --cfepy-schedule.
            tasks: "thread", "greenlet" or "auto"; None for --cfepy-tasks.
            faults: injected faults: a plan's path, "seed:N", a `cfepy.faults.FaultPlan` or a dictionary of that form.
            args: arguments of a launch file.
            races: whether unordered accesses in Python code fail the test; None as in @explore.
            attachments: observe or modify the run (`cfepy.attachment.Attachment`).

        Raises:
            UsageError: if there is no such mission or board, or it has a mistake.
        """
        place = self._place(name)
        plan = RunPlan(
            (place,),
            command_for(place),
            launch_args=tuple((key, str(value)) for key, value in (args or {}).items()),
            seed=self._config.getoption("--cfepy-seed") if seed is None else seed,
            board=board,
            tasks=tasks or self._config.getoption("--cfepy-tasks") or AUTO,
            schedule=self._schedule(schedule),
            faults=self._fault_text(faults),
            stall=self._stall(),
            races=self._wants_races if races is None else races,
        )
        return self._fly(plan, fault_attachments(faults), attachments)

    def _fly(self, plan: RunPlan, faults: Sequence[Attachment], attachments: Sequence[Attachment]) -> Flight:
        is_own = bool(attachments or faults)  # not available on the command line of a run
        policy = plan.schedule.policy()
        conditions = None if self._is_wide else self._conditions
        if conditions is not None:
            policy = NotingPolicy(policy if conditions.policy is None else conditions.policy)
            conditions.recorded.append(policy)
            conditions.plans.append(plan)
            attachments = [*attachments, *conditions.attachments]
        journal = None if self._journals is None else self._journals.begin(plan, policy)
        flight = Flight(
            plan,
            policy=policy if journal is None else journal.recorder.policy,
            attachments=[*attachments, *([] if journal is None else [journal.recorder]), *faults],
            again=None if self._item is None else self._again,
        )
        flight.touched = is_own or conditions is not None
        if journal is not None:
            journal.flight = flight
        if self._fixtures:
            wide = self._fixtures[-1].node if self._is_wide else None
            self._fixtures[-1].addfinalizer(lambda: self._close(flight, wide))
        if not self._is_wide:
            self.flown.append(flight)
            self._fixed += bool(self._fixtures)
        return flight

    # -- context -------------------------------------------------------------------------------------------------------

    @property
    def _item(self) -> pytest.Item | None:
        return self._config.stash.get(self._current, None)

    @property
    def _conditions(self) -> Conditions | None:
        """Conditions of an explored test; None in others."""
        return self._config.stash.get(UNDER_TEST, None)

    @property
    def _is_wide(self) -> bool:
        """Whether a fixture with a wider scope than the test is being set up."""
        return bool(self._fixtures) and self._fixtures[-1].scope != "function"

    @property
    def _wants_races(self) -> bool:
        """Whether @explore looks for races in the test."""
        mark = None if self._item is None or self._is_wide else self._item.get_closest_marker(EXPLORE_MARK)
        return mark is not None and mark.args[0].races

    def _place(self, name: str | os.PathLike[str]) -> str:
        """Return a path as on the command line, or a name unchanged."""
        item = self._item
        beside = None if item is None else item.path.parent / os.fspath(name)
        if beside is None or not (beside.is_file() or is_mission_folder(beside)):
            return os.fspath(name)
        found = beside.resolve()
        here = Path.cwd()
        return os.path.relpath(found, here) if found.is_relative_to(here) else str(found)

    def _schedule(self, given: str | Schedule | None) -> Schedule:
        """Return the schedule of the next mission.

        Args:
            given: schedule given by the test; None for the schedule of @explore or --cfepy-schedule.
        """
        if given is not None:
            return schedule_of(given)
        if self._conditions is not None and not self._is_wide:
            return self._conditions.schedule
        texts = (self._config.getoption("--cfepy-schedule") or FIFO).split(BETWEEN)
        return Schedule.parse(texts[0 if self._is_wide else min(len(self.flown), len(texts) - 1)])

    def _fault_text(self, faults: Faults | None) -> str | None:
        text = fault_text(faults)
        return text if text is None or text.startswith(SEED) else self._place(text)

    def _stall(self) -> float:
        """Return for how many seconds a task may keep the CPU.

        Raises:
            UsageError: if the configuration has no valid number.
        """
        given = self._config.getoption("--cfepy-stall")
        text = str(self._config.getini("cfepy_stall") if given is None else given)
        try:
            seconds = float(text)
        except ValueError:
            seconds = -1.0
        if not 0 <= seconds < float("inf"):
            raise UsageError(f"invalid number of seconds {text!r}; expected 0 (never) or more", field="cfepy_stall")
        return seconds

    def command(self, item: pytest.Item, schedule: Schedule | None = None, example: str | None = None) -> str:
        """Return the command that repeats a test.

        Args:
            item: the test.
            schedule: schedule of its missions; None for the current one.
            example: example of a Hypothesis test, as for `--cfepy-example`.
        """
        conditions = self._conditions
        if schedule is None and conditions is not None:
            schedule = conditions.schedule
        given = self._config.getoption("--cfepy-schedule") or FIFO
        tasks = self._config.getoption("--cfepy-tasks")
        options = [
            "--cfepy-seed",
            str(self._config.getoption("--cfepy-seed")),
            "--cfepy-schedule",
            given if schedule is None else schedule.text(),
        ]
        options += ["--cfepy-tasks", tasks] if tasks else []
        options += ["--cfepy-example", example] if example else []
        return pytest_command(self._config, item, options)

    def _again(self) -> str:
        item = self._item
        assert item is not None
        return BELOW if self._examples.concerns(item) else self.command(item)

    # -- pytest's hooks ------------------------------------------------------------------------------------------------

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, request: pytest.FixtureRequest) -> Generator[None, Any, Any]:
        """Note for which fixture a mission is booted."""
        self._fixtures.append(request)
        try:
            return (yield)
        finally:
            self._fixtures.pop()

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_call(self, item: pytest.Item) -> Generator[None, Any, Any]:
        """Handle the examples of Hypothesis; a passed test fails if there were races in its missions."""
        self._examples.prepare(item)
        result = yield
        races = [race for flight in self.flown if flight.plan.races for race in flight.mission.record.data_races]
        if races:
            text = "\n".join(f"data race: {race.text}\n{race.detail}" for race in races)
            pytest.fail(visible(text), pytrace=False)
        return result

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_runtest_makereport(
        self, item: pytest.Item, call: pytest.CallInfo[None]
    ) -> Generator[None, pytest.TestReport, pytest.TestReport]:
        """Add the command that repeats a failure; for wrong calls in a test, show the test's own lines."""
        if call.excinfo is not None:
            leave_out_own_lines(call.excinfo)
        if call.when == "call" and self._conditions is not None:
            self._conditions.note_end(self.flown, call.excinfo is not None)
        report = yield
        if call.excinfo is not None and report.failed:
            if self._journals is not None:
                self._journals.keep(item)
            lines = self._lines(item, call.excinfo.value)
            if lines:
                report.sections.append((SECTION, visible("\n".join(lines))))
        return report

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_teardown(self, item: pytest.Item) -> Generator[None, Any, Any]:
        """End the missions of the test."""
        try:
            return (yield)
        finally:
            self._fixed = 0
            self._end_from(0)
            self._warned.clear()
            if self._journals is not None:
                self._journals.end_test()

    def _lines(self, item: pytest.Item, error: BaseException) -> list[str]:
        lines = [] if self._journals is None else [f"journal: {path}" for path in self._journals.kept]
        if not self.flown and not self._examples.concerns(item):
            return lines
        if not isinstance(error, ExpectationError):
            for number, flight in enumerate(self.flown, 1):
                lines += [f"mission {number}, {flight.plan.words[0]}:"] if len(self.flown) > 1 else []
                lines += flight.state_lines()
        if not isinstance(error, ExpectationError) or self._examples.concerns(item):
            example = self._examples.code_of(error)
            lines.append(f"to reproduce: {self.command(item, example=example)}")
        return lines

    def _end_example(self, failed: bool) -> None:
        """End an example of Hypothesis."""
        if failed and self._journals is not None:
            self._journals.set_aside()
        self._end_from(self._fixed)

    def _end_from(self, first: int) -> None:
        """End the missions of the test, or those that its body has booted."""
        for flight in reversed(self.flown[first:]):
            self._close(flight, None if self._is_searched else self._item)
        del self.flown[first:]
        if self._journals is not None:
            self._journals.drop(first)

    @property
    def _is_searched(self) -> bool:
        """Whether a search chose the schedules: `@explore`, or a strategy of Hypothesis."""
        item = self._item
        drawn = (
            item is not None and self._examples.concerns(item) and self._config.getoption("--cfepy-schedule") is None
        )
        return self._conditions is not None or drawn

    def _close(self, flight: Flight, node: pytest.Item | pytest.Collector | None) -> None:
        """End a mission, and warn once if its schedule was not possible.

        Args:
            flight: the mission.
            node: the test or the collection to which the warning belongs; None for no warning.
        """
        flight.close()
        policy = flight.mission.kernel.policy
        if node is None or policy is None:
            return
        for note in policy.notes:
            if note not in self._warned:
                self._warned.add(note)
                node.warn(ScheduleWarning(visible(note)))


def _journals(folder: str) -> FlightJournals:
    """Only runs with --cfepy-record load the journal modules."""
    from cfepy.testing.journals import FlightJournals

    return FlightJournals(folder)


def pytest_command(config: pytest.Config, item: pytest.Item, options: Sequence[str]) -> str:
    """Return the command, as it can be entered where this run was started.

    Args:
        config: configuration of this run.
        item: the test.
        options: options to add.
    """
    file, _, rest = item.nodeid.partition("::")
    start = config.invocation_params.dir
    path = os.path.relpath(config.rootpath / file, start)
    kept = [word for name in ("-m", "-c", "--rootdir") for word in _given(config, name)]
    return command_line(["pytest", *kept, f"{path}::{rest}", *options])


def _given(config: pytest.Config, name: str) -> list[str]:
    """Return an option of this run that selects tests, with its value, if it was given."""
    words = [str(word) for word in config.invocation_params.args]
    for index, word in enumerate(words):
        if word == name and index + 1 < len(words):
            return [name, words[index + 1]]
        if word.startswith(f"{name}=") or (len(name) == 2 and word.startswith(name) and len(word) > 2):
            return [word]
    return []
