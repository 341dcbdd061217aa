"""Runs the tests of a suite as rosunit and rostest do; separate from both, because ROS sources may replace them."""

from __future__ import annotations

import unittest
from collections.abc import Sequence
from typing import Any

from rosunit.baretest import print_unittest_summary
from rosunit.core import XML_OUTPUT_FLAG, create_xml_runner


def suite_of(test: Any) -> unittest.TestSuite:
    """Return the tests of a TestCase class, or of the class or suite behind a dotted name."""
    loader = unittest.TestLoader()
    return loader.loadTestsFromName(test) if isinstance(test, str) else loader.loadTestsFromTestCase(test)


def run_suite(package: str, test_name: str, test: Any, sysargs: Sequence[str]) -> unittest.TestResult:
    """Run tests with a command line: `--text` shows them, `--gtest_output=xml:FILE` names the file for the results.

    Args:
        package: package of the test.
        test_name: its name.
        test: a TestCase class, or a dotted name.
        sysargs: the command line.
    """
    files = [argument[len(XML_OUTPUT_FLAG) :] for argument in sysargs if argument.startswith(XML_OUTPUT_FLAG)]
    suite = suite_of(test)
    result: unittest.TestResult
    if "--text" in sysargs:
        result = unittest.TextTestRunner(verbosity=2).run(suite)
    else:
        result = create_xml_runner(package, test_name, files[-1] if files else None).run(suite)
    print_unittest_summary(result)
    return result
