"""The example package of a user: its tests run as a user runs them."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PROBE = ROOT / "examples" / "probe"


@pytest.mark.parametrize("tasks", [pytest.param(each, marks=pytest.mark.slow) for each in ("thread", "greenlet")])
def test_tests_of_the_example_package_pass(pytester: pytest.Pytester, loaded: None, tasks: str) -> None:
    shutil.copytree(PROBE, pytester.path / "probe", ignore=shutil.ignore_patterns("__pycache__", ".*"))
    result = pytester.runpytest_inprocess("-p", "cfepy.testing.plugin", "--cfepy-tasks", tasks, "probe")
    outcomes = result.parseoutcomes()
    assert outcomes.pop("passed") >= 15
    assert outcomes == {}
