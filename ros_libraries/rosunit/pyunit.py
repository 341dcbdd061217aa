"""`unitrun`, the main routine of a test that needs no ROS graph (rosunit.pyunit)."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

from ros_tools.suites import run_suite


def unitrun(
    package: str,
    test_name: str,
    test: Any,
    sysargs: Sequence[str] | None = None,
    coverage_packages: Sequence[str] | None = None,
) -> None:
    """Run unit tests and write their results as XML. Ends the program if one fails.

    Args:
        package: package of the test.
        test_name: its name.
        test: a TestCase class, or a dotted name.
        sysargs: command line instead of sys.argv.
        coverage_packages: accepted; no coverage is measured.

    Raises:
        SystemExit: a test failed.
    """
    result = run_suite(package, test_name, test, sys.argv if sysargs is None else sysargs)
    if not result.wasSuccessful():
        sys.exit(1)
