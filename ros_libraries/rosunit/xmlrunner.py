"""A runner for unittest that writes its results as JUnit XML (rosunit.xmlrunner)."""

from __future__ import annotations

import io
import os
import re
import sys
import time
import traceback
import unittest
from typing import Any, TextIO
from xml.etree import ElementTree

_NOT_IN_XML = re.compile("[^\t\n\r\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufdcf\ufde0-\ufffd]")


def printable(text: str) -> str:
    """Return a text with characters that XML cannot hold written as numbers."""
    return _NOT_IN_XML.sub(lambda match: f"&#x{ord(match[0]):04X};", text)


class XMLTestResult(unittest.TestResult):
    """Results of the tests of one suite.

    Args:
        classname: class name of the suite.
    """

    def __init__(self, classname: str) -> None:
        super().__init__()
        self._classname = classname
        self._cases: list[tuple[ElementTree.Element, str]] = []
        self._problems: list[tuple[str, Any]] = []
        self._began = 0.0

    def startTest(self, test: unittest.TestCase) -> None:
        super().startTest(test)
        self._problems = []
        self._began = time.time()

    def stopTest(self, test: unittest.TestCase) -> None:
        super().stopTest(test)
        classname, _, method = test.id().rpartition(".")
        seconds = f"{time.time() - self._began:.4f}"
        case = ElementTree.Element("testcase", classname=classname or self._classname, name=method, time=seconds)
        text = f"[Testcase: {method}]"
        for kind, error in self._problems[-1:]:
            trace = "".join(traceback.format_tb(error[2]))
            ElementTree.SubElement(case, kind, type=error[0].__name__).text = printable(f"{error[1]}\n{trace}")
            text += f" ... {kind.upper()}!\n{kind.upper()}: {error[1]}\n{trace}"
        self._cases.append((case, text if self._problems else f"{text} ... ok\n"))

    def addError(self, test: Any, err: Any) -> None:
        super().addError(test, err)
        self._problems.append(("error", err))

    def addFailure(self, test: Any, err: Any) -> None:
        super().addFailure(test, err)
        self._problems.append(("failure", err))

    def xml(self, time_taken: float, out: str, err: str) -> ElementTree.ElementTree[ElementTree.Element]:
        """Return the results as a <testsuite>.

        Args:
            time_taken: in s.
            out: text of standard output.
            err: text of standard error.
        """
        suite = ElementTree.Element(
            "testsuite",
            errors=str(len(self.errors)),
            failures=str(len(self.failures)),
            name=self._classname,
            tests=str(self.testsRun),
            time=f"{time_taken:.3f}",
        )
        suite.extend(case for case, _ in self._cases)
        ElementTree.SubElement(suite, "system-out").text = printable(out)
        ElementTree.SubElement(suite, "system-err").text = printable(err)
        return ElementTree.ElementTree(suite)

    def print_report(self, stream: TextIO, time_taken: float, out: str, err: str) -> None:
        """Write `xml` to a stream."""
        stream.write(ElementTree.tostring(self.xml(time_taken, out, err).getroot(), encoding="unicode"))

    def print_report_text(self, stream: TextIO, time_taken: float, out: str, err: str) -> None:
        """Write a line for each test, and the tracebacks of failed ones."""
        for _, text in self._cases:
            stream.write(text)


class XMLTestRunner:
    """Runs tests and writes their results.

    Args:
        stream: the stream to write to; None makes a file TEST-<module>.<class>.xml in `path`.
    """

    def __init__(self, stream: TextIO | None = None) -> None:
        self._stream = stream
        self.path = "."

    def run(self, test: Any) -> XMLTestResult:
        """Run a test or a suite. Its output becomes part of the results."""
        classname = f"{type(test).__module__}.{type(test).__name__}"
        result = XMLTestResult(classname)
        began = time.time()
        kept = sys.stdout, sys.stderr
        sys.stdout, sys.stderr = out, err = io.StringIO(), io.StringIO()
        try:
            test(result)
        finally:
            sys.stdout, sys.stderr = kept
        taken = time.time() - began
        if self._stream is None:
            file = os.path.join(self.path, f"TEST-{classname}.xml")
            self._stream = open(file, "w", encoding="utf-8")  # noqa: SIM115  # open as long as the runner is there
            self._stream.write('<?xml version="1.0" encoding="utf-8"?>\n')
        result.print_report(self._stream, taken, out.getvalue(), err.getvalue())
        self._stream.flush()
        result.print_report_text(sys.stdout, taken, out.getvalue(), err.getvalue())
        return result
