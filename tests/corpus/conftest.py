"""Tests of public nodes run only with their sources. Without them, the summary of the test run says so."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from dev.corpus.scenarios import read_corpus
from dev.corpus.sources import ENVIRONMENT, FETCH

HOW = f"{len(read_corpus().scenarios)} scenarios with public ROS nodes were NOT run: `{FETCH}`, then set {ENVIRONMENT}"


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Make one test for each scenario, or one that reports the missing sources."""
    if "scenario_id" in metafunc.fixturenames:
        ids = list(read_corpus().scenarios)
        absent = [pytest.param("", marks=pytest.mark.skip(reason=HOW), id="no-sources")]
        metafunc.parametrize("scenario_id", ids if ENVIRONMENT in os.environ else absent)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Report the tests that did not run."""
    skipped = terminalreporter.stats.get("skipped", [])
    if any(HOW in str(report.longrepr) for report in skipped):
        terminalreporter.write_line(HOW, yellow=True)


@pytest.fixture
def sources_folder() -> Path:
    """Where the sources are."""
    return Path(os.environ[ENVIRONMENT])
