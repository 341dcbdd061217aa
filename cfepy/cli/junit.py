"""What came of tests: read from the JUnit XML that they write, added up, shown, written as one file.

Stands for rosunit.junitxml on the side of the tool; a node has its own in the library rosunit.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree

FAILURE, ERROR = "failure", "error"


@dataclass(frozen=True, slots=True)
class Problem:
    """Why a test did not pass: `kind` is FAILURE or ERROR, `text` what it says."""

    kind: str
    text: str


@dataclass(frozen=True, slots=True)
class Case:
    """One test; `seconds` is virtual time."""

    suite: str
    name: str
    seconds: float = 0.0
    problems: tuple[Problem, ...] = ()


@dataclass(slots=True)
class TestResults:
    """What came of one or more suites; the counts are those that the suites give."""

    tests: int = 0
    errors: int = 0
    failures: int = 0
    cases: list[Case] = field(default_factory=list)

    @property
    def passed(self) -> bool:
        """Whether nothing went wrong."""
        return not self.errors and not self.failures

    def add(self, other: TestResults) -> None:
        """Count another one's tests too."""
        self.tests += other.tests
        self.errors += other.errors
        self.failures += other.failures
        self.cases += other.cases

    def text(self) -> str:
        """A line for each test with what went wrong, and a summary as rostest has it."""
        lines = [line for case in self.cases for line in _case_lines(case)]
        verdict = "SUCCESS" if self.passed else "FAIL"
        counts = [f" * TESTS: {self.tests}", f" * ERRORS: {self.errors}", f" * FAILURES: {self.failures}"]
        return "\n".join([f"[ROSTEST]{'-' * 71}", "", *lines, "", "SUMMARY", f" * RESULT: {verdict}", *counts])

    def xml(self, name: str) -> bytes:
        """All of it as one JUnit suite called `name`."""
        counts = {"tests": str(self.tests), "errors": str(self.errors), "failures": str(self.failures)}
        suite = ElementTree.Element("testsuite", {"name": name, **counts})
        for case in self.cases:
            seconds = f"{case.seconds:.3f}"
            tag = ElementTree.SubElement(suite, "testcase", classname=case.suite, name=case.name, time=seconds)
            for problem in case.problems:
                ElementTree.SubElement(tag, problem.kind, message=problem.text)
        text: bytes = ElementTree.tostring(suite, encoding="utf-8", xml_declaration=True)
        return text


def broken(suite: str, name: str, text: str, kind: str = ERROR) -> TestResults:
    """The result of a test program that did not run as it should."""
    case = Case(suite, name, problems=(Problem(kind, text),))
    return TestResults(1, int(kind == ERROR), int(kind == FAILURE), [case])


def read_results(file: Path, suite: str) -> TestResults:
    """The results that a test program wrote.

    Args:
        file: the XML file.
        suite: package and name of the test.

    Raises:
        OSError: there is no such file.
        ValueError: it is no XML, or has no suite.
    """
    try:
        root = ElementTree.parse(file).getroot()
    except ElementTree.ParseError as error:
        raise ValueError(f"is not XML: {error}") from None
    results = TestResults()
    suites = [tag for tag in root.iter("testsuite") if tag.find("testcase") is not None or tag is root]
    if not suites and root.tag != "testsuites":
        raise ValueError(f"has <{root.tag}> where <testsuite> should be")
    for tag in suites:
        tests, errors, failures = (int(tag.get(name, 0)) for name in ("tests", "errors", "failures"))
        results.add(TestResults(tests, errors, failures, list(_cases(tag, suite))))
    return results


def _cases(tag: ElementTree.Element, suite: str) -> Iterable[Case]:
    for each in tag.findall("testcase"):
        problems = [Problem(kind, _said(found)) for kind in (ERROR, FAILURE) for found in each.findall(kind)]
        name = f"{each.get('classname', '')}/{each.get('name', '')}".lstrip("/")
        yield Case(suite, name, float(each.get("time") or 0), tuple(problems))


def _said(tag: ElementTree.Element) -> str:
    return tag.get("message") or (tag.text or "").strip()


def _case_lines(case: Case) -> Iterable[str]:
    name = f"[{case.suite}.{case.name}]"
    if not case.problems:
        yield f"{name}[passed]"
    for problem in case.problems:
        yield f"{name}[{problem.kind.upper()}]"
        yield from (f"    {line}" for line in problem.text.splitlines())
