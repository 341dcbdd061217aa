"""The table of the tests that need add-ons: each line names existing tests and add-ons."""

from __future__ import annotations

import re

import pytest

from tests import add_ons
from tests.add_ons import EVERY, NEEDS, ROOT, lacks_add_on, needed


@pytest.mark.parametrize("test", NEEDS)
def test_line_names_existing_tests_and_add_ons(test: str) -> None:
    file, _, function = test.partition("::")
    path = ROOT / "tests" / file
    assert path.exists()
    assert not function or re.search(rf"^def {function}\(", path.read_text(encoding="utf-8"), re.MULTILINE)
    assert set(NEEDS[test].split()) <= set(EVERY.split())


def test_needs_of_folders_files_and_functions_add_up() -> None:
    assert set(needed("roscfe/test_heap.py")) == {"c", "convert", "ros_libraries"}
    assert set(needed("extra/convert/test_check.py::test_it")) == {"c", "convert"}
    assert set(needed("cli/test_board.py")) == set()
    assert set(needed("cli/test_board.py::test_a_report")) == {"reports"}


def test_only_tests_of_a_missing_add_on_are_excluded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(add_ons, "MISSING", frozenset({"reports"}))
    tests = ("cli/test_board.py", "cli/test_board.py::test_a_report", "extra/reports", "extra/viewers")
    assert [lacks_add_on(test) for test in tests] == [False, True, True, False]
