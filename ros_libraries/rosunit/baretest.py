"""Readable summaries of tests (rosunit.baretest)."""

from __future__ import annotations

import unittest
from collections.abc import Iterable
from typing import Any

from rosunit.junitxml import Result


def print_unittest_summary(result: unittest.TestResult) -> None:
    """Print how many tests there were, and which of them failed."""
    print("-" * 61)
    print(f"SUMMARY:\n * RESULT: {'SUCCESS' if result.wasSuccessful() else 'FAIL'}")
    print(f" * TESTS: {result.testsRun}")
    print(f" * ERRORS: {len(result.errors)} [{', '.join(_names(result.errors))}]")
    print(f" * FAILURES: {len(result.failures)} [{', '.join(_names(result.failures))}]\n")


def print_runner_summary(
    runner_results: unittest.TestResult, junit_results: Result, runner_name: str = "ROSUNIT"
) -> None:
    """Print the results of test programs and of their tests.

    Args:
        runner_results: whether the programs ran correctly.
        junit_results: their written results.
        runner_name: name of the tool that ran them.
    """
    errors = junit_results.num_errors + len(runner_results.errors)
    failures = junit_results.num_failures + len(runner_results.failures)
    print(f"[{runner_name}]{'-' * 71}\n")
    print("".join(case.description for case in junit_results.test_case_results))
    ran_well = runner_results.wasSuccessful() and not errors and not failures
    print(f"SUMMARY\n * RESULT: {'SUCCESS' if ran_well else 'FAIL'}")
    print(f" * TESTS: {junit_results.num_tests}\n * ERRORS: {errors}\n * FAILURES: {failures}\n")
    if runner_results.failures:
        print("ERROR: The following tests failed to run:")
        print("".join(f" * {name}\n" for name in _names(runner_results.failures)))


def _names(problems: Iterable[tuple[Any, str]]) -> list[str]:
    """Return names of tests. An object without a name, such as a failed import, gives its description."""
    return [getattr(test, "_testMethodName", None) or f"{getattr(test, 'description', test)}" for test, _ in problems]
