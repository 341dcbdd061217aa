"""`cfepy rostest`: run the tests of a launch file, each with the file's nodes in a mission of its own."""

from __future__ import annotations

import argparse
import os
import re
import sys
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from xml.etree import ElementTree

from cfepy.cli.ci_outputs import write_ci_outputs
from cfepy.cli.display import Display, PlainDisplay, SilentDisplay
from cfepy.cli.json_output import check_ci_outputs, wants_ci_outputs
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS, INTERRUPTED
from cfepy.cli.options import launch_words
from cfepy.cli.options import plan_of as run_plan_of
from cfepy.cli.ros.view import NodesDisplay
from cfepy.cli.run.outputs import SavedRunFiles
from cfepy.cli.user_notes import tell
from cfepy.cli.watched_host import Interrupts, WatchedHost
from cfepy.interpreter.own_code import is_library, is_shown
from cfepy.mission import TEST_RESULTS, BuiltProgram, CppNodesConfig, NodeBuilder, built_programs, launch_file, spec_of
from cfepy.nodes import CppNode, NodeConfig
from cfepy.pilot import LAUNCH, Flown, builder, fly, is_reported
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import XML_BYTES
from cfepy.reading.plain_xml import XmlError, plain_xml
from cfepy.status import UsageError
from cfepy.units import NS_PER_S
from cfepy.writing.ci_findings import CiFinding, FindingPlace
from cfepy.writing.junit import ERROR, FAILURE, Case, Problem, Suite
from rospy_shim.roslaunch.launch_plan import LaunchPlan, PlannedTest, plan_of

BOARD = "workstation"  # calls of nodes take time on it, as required by tests of nodes that never rest
LAST_LINES = 25  # of the output of a test that leaves no results
MOST_PLACES = 2
_KINDS = {FAILURE: "a test failed", ERROR: "a test could not run to its end"}
_FRAME = re.compile(r'^\s*File "(?P<file>.+)", line (?P<line>\d+)', re.MULTILINE)


@dataclass(slots=True)
class TestResults:
    """The results of one or more suites; the counts are those that the suites report."""

    tests: int = 0
    errors: int = 0
    failures: int = 0
    cases: list[Case] = field(default_factory=list)

    @property
    def passed(self) -> bool:
        """True if there were no errors and no failures."""
        return not self.errors and not self.failures

    def add(self, other: TestResults) -> None:
        """Add the tests of another result."""
        self.tests += other.tests
        self.errors += other.errors
        self.failures += other.failures
        self.cases += other.cases

    def text(self) -> str:
        """Return a line for each test with its problems, and a summary in the format of rostest."""
        lines = [line for case in self.cases for line in _case_lines(case)]
        verdict = "SUCCESS" if self.passed else "FAIL"
        counts = [f" * TESTS: {self.tests}", f" * ERRORS: {self.errors}", f" * FAILURES: {self.failures}"]
        return "\n".join([f"[ROSTEST]{'-' * 71}", "", *lines, "", "SUMMARY", f" * RESULT: {verdict}", *counts])

    def suite(self, name: str, properties: Mapping[str, str]) -> Suite:
        """Return everything as one JUnit suite called `name`."""
        counts = {"tests": self.tests, "failures": self.failures, "errors": self.errors, "skipped": 0}
        return Suite(name, self.cases, properties, counts)

    def findings(self) -> Iterator[CiFinding]:
        """Yield a finding for each problem."""
        for case in self.cases:
            for problem in case.problems:
                places = (*_lines_of(problem.detail or problem.text), *([] if case.place is None else [case.place]))
                text = f"{case.suite}.{case.name}: {problem.text}"
                yield CiFinding(problem.kind, text, tuple(dict.fromkeys(places))[:MOST_PLACES])


def _lines_of(traceback: str) -> Iterator[FindingPlace]:
    """Yield the line of a traceback that is nearest to the error, and not of a library."""
    found = [FindingPlace(Path(each["file"]), int(each["line"])) for each in _FRAME.finditer(traceback)]
    own = [each for each in found if is_shown(str(each.file)) and not is_library(str(each.file))]
    yield from own[-1:]


def broken(suite: str, name: str, text: str, kind: str = ERROR) -> TestResults:
    """Make the result of a test program that did not run properly."""
    case = Case(suite, name, problems=(Problem(kind, text),))
    return TestResults(1, int(kind == ERROR), int(kind == FAILURE), [case])


def read_results(file: Path, suite: str) -> TestResults:
    """Read the results that a test program wrote.

    Args:
        file: the XML file.
        suite: package and name of the test.

    Returns:
        The results.

    Raises:
        OSError: there is no such file.
        ValueError: it is not XML, or has no suite.
    """
    try:
        root = plain_xml(read_limited(file, XML_BYTES))
    except XmlError as error:
        raise ValueError(error.text) from None
    results = TestResults()
    suites = [tag for tag in root.iter("testsuite") if tag.find("testcase") is not None or tag is root]
    if not suites and root.tag != "testsuites":
        raise ValueError(f"unexpected <{root.tag}>; expected <testsuite>")
    for tag in suites:
        tests, errors, failures = (int(tag.get(name, 0)) for name in ("tests", "errors", "failures"))
        results.add(TestResults(tests, errors, failures, list(_cases(tag, suite))))
    return results


def _cases(tag: ElementTree.Element, suite: str) -> Iterable[Case]:
    for each in tag.findall("testcase"):
        problems = [_problem(kind, found) for kind in (ERROR, FAILURE) for found in each.findall(kind)]
        name = f"{each.get('classname', '')}/{each.get('name', '')}".lstrip("/")
        yield Case(suite, name, float(each.get("time") or 0), tuple(problems))


def _problem(kind: str, tag: ElementTree.Element) -> Problem:
    text = (tag.text or "").strip()
    return Problem(kind, tag.get("message") or text, tag.get("type", ""), text if tag.get("message") else "")


def _case_lines(case: Case) -> Iterable[str]:
    name = f"[{case.suite}.{case.name}]"
    if not case.problems:
        yield f"{name}[passed]"
    for problem in case.problems:
        yield f"{name}[{problem.kind.upper()}]"
        yield from (f"    {line}" for line in problem.text.splitlines())


def run(arguments: argparse.Namespace) -> int:
    """Run the tests of the launch file that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: there is no such file, it has an error, or it has no test.
    """
    check_ci_outputs(arguments)
    file, args = launch_file(launch_words(arguments))
    with tempfile.TemporaryDirectory() as folder, Interrupts() as interrupts:
        environ, results = dict(os.environ), Path(folder)
        plan = plan_of(file, args, environ, cwd=Path.cwd(), results=results, with_compiled=True)
        if not plan.tests:
            raise UsageError("missing <test>; use `cfepy launch` to run a launch file without tests", file=file)
        build = builder(arguments.cpp_nodes)
        built, left_out = built_programs(plan, build)
        tell([*plan.notes, *left_out, *(test.displaces for test in plan.tests if test.displaces is not None)])
        tests = TestResults()
        for test in plan.tests:
            if not interrupts.asked:
                tests.add(_placed(_Runner(file, plan, built, build, arguments, interrupts).run(test), test))
    print(tests.text())
    if wants_ci_outputs(arguments):
        properties = {"seed": str(arguments.seed), "board": arguments.board or BOARD}
        suite = tests.suite(file.stem, properties)
        write_ci_outputs(arguments, "cfepy rostest", suite, list(tests.findings()), _KINDS)
    if interrupts.asked:
        return INTERRUPTED
    return ENDED_WELL if tests.passed else FOUND_PROBLEMS


def _placed(results: TestResults, test: PlannedTest) -> TestResults:
    """Add the line of its <test> to each result of a test."""
    results.cases = [replace(case, place=FindingPlace(test.file.absolute(), test.line)) for case in results.cases]
    return results


class _Runner:
    """Runs the tests of one file.

    Args:
        file: the launch file.
        plan: its contents (`rospy_shim.roslaunch.launch_plan.LaunchPlan`).
        built: its nodes in C++.
        build: builds tests in C++.
        arguments: the command line.
        interrupts: reports whether the user pressed Ctrl-C.
    """

    def __init__(
        self,
        file: Path,
        plan: LaunchPlan,
        built: Mapping[str, BuiltProgram],
        build: NodeBuilder,
        arguments: argparse.Namespace,
        interrupts: Interrupts,
    ) -> None:
        self._file = file
        self._built = built
        self._build = build
        self._plan = plan
        self._arguments = arguments
        self._interrupts = interrupts

    def run(self, test: PlannedTest) -> TestResults:
        """Run a test (`rospy_shim.roslaunch.launch_plan.PlannedTest`), and retry it as often as it permits while it
        fails.
        """
        results = self._once(test)
        for number in range(1, test.retry + 1):
            if results.passed or self._interrupts.asked:
                break
            test.results.unlink(missing_ok=True)
            results = self._once(test, number)
        return results

    def _once(self, test: PlannedTest, number: int = 0) -> TestResults:
        """Run a test once. A retry gets another seed, because the same seed would repeat the same run."""
        suite = f"{test.package}.{test.test_name}"
        nodes, built = dict(self._plan.nodes), dict(self._built)
        if test.compiled is not None:
            try:
                built[test.compiled.app] = self._program(test.compiled)
            except UsageError as error:
                return broken(suite, "can_run_here", f"the test cannot be built: {error}")
            node = built[test.compiled.app].config
        elif test.node is not None:
            node = nodes[test.node.app] = test.node
        else:
            return broken(suite, "can_run_here", test.problem)
        seconds = test.time_limit_ns / NS_PER_S
        run = replace(run_plan_of(self._arguments, [str(self._file)], LAUNCH), seconds=seconds)
        run = replace(run, seed=run.seed + number)
        spec = run.with_played_bag(replace(spec_of(self._file, nodes, self._plan.params, (), built), board=BOARD))
        written = SavedRunFiles(Path("/"), os.path.realpath(test.results.parent))
        with WatchedHost(self._interrupts, self._display) as host:
            flown = fly(run, spec=spec, attachments=[written], console=host.console, host=host)
        if test.compiled is not None:
            _keep_results(test, flown)
        results = self._judged(test, node, suite, flown)
        numbers = flown.results
        tell([*numbers.never_happened, *(() if results.passed else numbers.loose_ends), *numbers.traps])
        return results

    def _program(self, node: CppNode) -> BuiltProgram:
        """Build a test in C++.

        Raises:
            UsageError: it cannot be built.
        """
        others = [f"/{each.name}" for each in self._plan.nodes.values()] + [each.name for each in self._built.values()]
        return BuiltProgram(node.full_name, *self._build(node, self._plan.params, others, CppNodesConfig()), node)

    def _display(self, seconds: float) -> Display:
        return NodesDisplay(PlainDisplay(sys.stdout)) if self._arguments.text else SilentDisplay()

    def _judged(self, test: PlannedTest, node: NodeConfig, suite: str, flown: Flown) -> TestResults:
        """Return the results of the test, or why it wrote none. If it passed, add other problems of its run."""
        results = self._own_results(test, node, suite, flown)
        if results.passed:
            for problem in flown.problems:
                if not is_reported(problem):  # such as ROS_ERROR of a node in C++, which is not a failure in rostest
                    results.add(broken(suite, "nodes", problem.text))
        return results

    def _own_results(self, test: PlannedTest, node: NodeConfig, suite: str, flown: Flown) -> TestResults:
        """Return the results of the test itself."""
        ros = flown.mission.ros
        died = [each for each in flown.results.problems if each.startswith(f"{node.app} died")]
        if died:  # a node in C++; one in Python ends with an exit status
            return broken(suite, "test_ran", f"{died[0]}{_last_lines(node, flown)}")
        if ros is None or node.app not in ros.monitor.statuses:
            limit = f"{test.time_limit_ns / NS_PER_S:g} virtual seconds"
            text = f"did not end within its {limit}; raise time-limit, or find out why it hangs"
            return broken(suite, "time_limit", f"{text}{_last_lines(node, flown)}", FAILURE)
        try:
            return read_results(test.results, suite)
        except (OSError, ValueError) as error:
            why = "wrote no results" if isinstance(error, OSError) else f"wrote results that cannot be read: {error}"
            status = ros.monitor.statuses[node.app]
            return broken(suite, "test_ran", f"the test node {why}, exit status {status}{_last_lines(node, flown)}")


def _keep_results(test: PlannedTest, flown: Flown) -> None:
    """Copy the results of a test in C++ from the mission's own files to their place on the host."""
    assert test.compiled is not None
    file = flown.mission.files.find(TEST_RESULTS)
    if file is not None:
        test.results.write_bytes(file.data)


def _last_lines(node: NodeConfig, flown: Flown) -> str:
    """Return the last lines that the test node printed."""
    begins = (f"[{node.name}] ", f"[/{node.name}] ")  # of a node in C++
    lines = [line.partition("] ")[2] for line in flown.mission.console.lines if line.startswith(begins)]
    return "".join(f"\n| {line}" for line in lines[-LAST_LINES:])
