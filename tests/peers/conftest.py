"""Tests of public test files run only with their sources. Without them, the summary of the test run says so."""

from __future__ import annotations

import os

import pytest

from dev.peers.__main__ import ENVIRONMENT
from dev.peers.peers import read_peers

HOW = f"{len(read_peers().files)} public test files were NOT run: `python -m dev.peers fetch FOLDER`, then set "
HOW += ENVIRONMENT


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Make one test for each file, or one that reports the missing sources."""
    if "peer_name" in metafunc.fixturenames:
        names = list(read_peers().files)
        absent = [pytest.param("", marks=pytest.mark.skip(reason=HOW), id="no-sources")]
        metafunc.parametrize("peer_name", names if ENVIRONMENT in os.environ else absent)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Report the tests that did not run."""
    skipped = terminalreporter.stats.get("skipped", [])
    if any(HOW in str(report.longrepr) for report in skipped):
        terminalreporter.write_line(HOW, yellow=True)
