# ruff: noqa: PT028  # names of ROS that begin with test_, not tests
"""JUnit XML: reads and adds up results of tests (rosunit.junitxml)."""

from __future__ import annotations

from xml.etree import ElementTree
from xml.sax.saxutils import escape, quoteattr


class TestInfo:
    """The failure of a test.

    Args:
        type_: type of the exception.
        text: its text.
    """

    _kind = "failure"

    def __init__(self, type_: str, text: str) -> None:
        self.type = type_
        self.text = text

    def _xml(self) -> str:
        """Return the tag, as text."""
        return f"<{self._kind} type={quoteattr(self.type)}>{escape(self.text)}</{self._kind}>"


class TestError(TestInfo):
    """An exception that the test did not expect."""

    _kind = "error"
    xml = TestInfo._xml


class TestFailure(TestInfo):
    """An assertion that did not hold."""

    xml = TestInfo._xml


class TestCaseResult:
    """Result of one test.

    Args:
        name: classname and method.
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self.failures: list[TestFailure] = []
        self.errors: list[TestError] = []
        self.time = 0.0
        self.classname = ""

    @property
    def passed(self) -> bool:
        """Whether nothing went wrong."""
        return not self.failures and not self.errors

    @property
    def description(self) -> str:
        """The test in a line, and its failures below it."""
        if self.passed:
            return f"[{self.name}][passed]\n"
        problems = [(info, "ERROR" if info in self.errors else "FAILURE") for info in (*self.errors, *self.failures)]
        texts = (f"[{self.name}][{word}]{'-' * 40}\n{info.text}\n{'-' * 80}\n\n" for info, word in problems)
        return "".join(texts)

    def add_failure(self, failure: TestFailure) -> None:
        """Add an assertion that did not hold."""
        self.failures.append(failure)

    def add_error(self, error: TestError) -> None:
        """Add an exception."""
        self.errors.append(error)

    def xml(self) -> str:
        """Return the tag, as text."""
        inner = "".join(info._xml() for info in (*self.failures, *self.errors))
        names = f"classname={quoteattr(self.classname)} name={quoteattr(self.name)}"
        return f'<testcase {names} time="{self.time}">{inner}</testcase>'


class Result:
    """Results of a suite.

    Args:
        name: name of the suite.
        num_errors, num_failures, num_tests: how many.
    """

    def __init__(self, name: str, num_errors: int = 0, num_failures: int = 0, num_tests: int = 0) -> None:
        self.name = name
        self.num_errors = num_errors
        self.num_failures = num_failures
        self.num_tests = num_tests
        self.test_case_results: list[TestCaseResult] = []
        self.system_out = ""
        self.system_err = ""
        self.time = 0.0

    def accumulate(self, r: Result) -> None:
        """Add the results of another suite."""
        self.num_errors += r.num_errors
        self.num_failures += r.num_failures
        self.num_tests += r.num_tests
        self.time += r.time
        self.test_case_results += r.test_case_results
        self.system_out = "\n".join(filter(None, (self.system_out, r.system_out)))
        self.system_err = "\n".join(filter(None, (self.system_err, r.system_err)))

    def add_test_case_result(self, r: TestCaseResult) -> None:
        """Add one test, without counting it."""
        self.test_case_results.append(r)

    def _xml(self) -> str:
        """Return the suite, as text."""
        counts = (
            f'tests="{self.num_tests}" failures="{self.num_failures}" time="{self.time}" errors="{self.num_errors}"'
        )
        cases = "".join(case.xml() for case in self.test_case_results)
        return f"<testsuite {counts} name={quoteattr(self.name)}>{cases}</testsuite>"


def read(test_file: str, test_name: str) -> Result:
    """Return the results in a file: an error if it is not XML, none if it has no suite.

    Args:
        test_file: its path.
        test_name: name of the results.
    """
    result = Result(test_name)
    try:
        with open(test_file, "rb") as stream:
            root = ElementTree.parse(stream).getroot()
    except ElementTree.ParseError as error:
        result.num_errors = 1
        case = TestCaseResult(f"{test_name}/xml_is_readable")
        case.add_error(TestError("ParseError", f"{test_file}: {error}"))
        result.add_test_case_result(case)
        return result
    for suite in root.iter("testsuite"):
        result.accumulate(_of_suite(suite, test_name))
    return result


def _of_suite(suite: ElementTree.Element, test_name: str) -> Result:
    counts = (int(suite.get(name, 0)) for name in ("errors", "failures", "tests"))
    result = Result(test_name, *counts)
    result.time = float(suite.get("time", 0.0))
    result.system_out, result.system_err = suite.findtext("system-out", ""), suite.findtext("system-err", "")
    for tag in suite.findall("testcase"):
        case = TestCaseResult(f"{test_name}.{tag.get('classname', '')}/{tag.get('name', '')}")
        case.classname, case.time = tag.get("classname", ""), float(tag.get("time", 0.0))
        case.failures += [TestFailure(each.get("type", ""), _said(each)) for each in tag.findall("failure")]
        case.errors += [TestError(each.get("type", ""), _said(each)) for each in tag.findall("error")]
        result.add_test_case_result(case)
    return result


def _said(tag: ElementTree.Element) -> str:
    return tag.get("message") or (tag.text or "").strip()


def test_failure_junit_xml(
    test_name: str,
    message: str,
    stdout: str | None = None,
    class_name: str = "Results",
    testcase_name: str = "test_ran",
) -> str:
    """Return the text of a file that reports a failed test program."""
    out = "" if stdout is None else f"<system-out>{escape(stdout)}</system-out>"
    return (
        f'<?xml version="1.0" encoding="UTF-8"?>\n<testsuite tests="1" failures="1" time="1" errors="0" '
        f'name={quoteattr(test_name)}><testcase name={quoteattr(testcase_name)} status="run" time="1" '
        f'classname={quoteattr(class_name)}><failure message={quoteattr(message)} type=""/></testcase>{out}</testsuite>'
    )


def test_success_junit_xml(test_name: str, class_name: str = "Results", testcase_name: str = "test_ran") -> str:
    """Return the text of a file that reports a successful test program."""
    return (
        f'<?xml version="1.0" encoding="UTF-8"?>\n<testsuite tests="1" failures="0" time="1" errors="0" '
        f'name={quoteattr(test_name)}><testcase name={quoteattr(testcase_name)} status="run" time="1" '
        f"classname={quoteattr(class_name)}></testcase></testsuite>"
    )


def print_summary(junit_results: Result, runner_name: str = "ROSUNIT") -> None:
    """Print the results of a suite."""
    fine = not junit_results.num_errors and not junit_results.num_failures
    print(f"[{runner_name}]{'-' * 71}\n")
    print("".join(case.description for case in junit_results.test_case_results))
    print(f"SUMMARY\n * RESULT: {'SUCCESS' if fine else 'FAIL'}\n * TESTS: {junit_results.num_tests}")
    print(f" * ERRORS: {junit_results.num_errors}\n * FAILURES: {junit_results.num_failures}\n")
