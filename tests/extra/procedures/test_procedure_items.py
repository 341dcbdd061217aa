"""`pytest --procedures`: each test of a suite is a test item."""

from __future__ import annotations

import shutil
from importlib import import_module
from pathlib import Path

import pytest

from cfepy.extra.procedures import explore_procedures
from tests.extra.procedures.demo import PLUGIN, SUITE, fly, settings


@pytest.fixture(scope="module", autouse=True)
def loaded(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Load every module that a flight needs, because pytester unloads those that a suite imports."""
    import_module("cfepy.extra.procedures.procedure_items")
    fly(PLUGIN, tests=("test_noop",), journals=tmp_path_factory.mktemp("journals"))
    explore_procedures([SUITE], settings(tests=("test_noop",)), 2)


def run(pytester: pytest.Pytester, *options: str) -> pytest.RunResult:
    """Run pytest with the procedures of a copy of the plugin folder."""
    folder = shutil.copytree(PLUGIN, pytester.path / "plugin")
    return pytester.runpytest_inprocess("-p", "no:cacheprovider", "--procedures", str(folder), *options)


def test_suite_is_a_list_of_test_items(pytester: pytest.Pytester, tmp_path: Path) -> None:
    page, journals = tmp_path / "matrix.html", tmp_path / "journals"
    result = run(pytester, "-v", "--matrix-html", str(page), "--cfepy-record", str(journals))
    result.assert_outcomes(passed=2, failed=1, skipped=1)
    result.stdout.fnmatch_lines(
        [
            "*es_suite.py::demo_suite::es_group::test_noop PASSED*",
            "*CHECK: DEMO CFE_ES_HK COMMAND_ERROR_COUNTER == 9 failed with value == 0*",
            "*at *es_group.py:28",
            "console:",
            "journal: *demo_suite.cfepy",
            "to reproduce: cfepy procedures *",
        ]
    )
    assert [each.name for each in journals.iterdir()] == ["es_suite-demo_suite.cfepy"]
    assert '<tr class="F"><td>cES1003</td>' in page.read_text(encoding="utf-8")


def test_selected_test_runs_with_its_setups(pytester: pytest.Pytester) -> None:
    result = run(pytester, "-k", "test_processor_reset")
    result.assert_outcomes(passed=1, deselected=3)


def test_explored_suite_reports_tests_that_fail(pytester: pytest.Pytester) -> None:
    result = run(pytester, "--explore", "2", "-k", "test_noop or test_wrong")
    result.assert_outcomes(passed=1, failed=1, deselected=2)
    result.stdout.fnmatch_lines(["*always failed: 0 passed, 2 failed*"])


def test_folder_without_procedures_is_bad_usage(pytester: pytest.Pytester) -> None:
    (pytester.path / "empty").mkdir()
    result = pytester.runpytest_inprocess("--procedures", "empty")
    assert result.ret == pytest.ExitCode.USAGE_ERROR
    result.stderr.fnmatch_lines(["ERROR: *empty: has no suite*"])
