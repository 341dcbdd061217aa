"""The marks `quick` and `slow` by cost: which tests of the table of costs a run has.

`tests/costs.tsv` has the tests that are not quick; `python -m dev.costs` measures and writes it. `-m quick` runs all
other tests: use it after each change. A new test is quick until it is measured.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path

import pytest

from dev.costs.table import ROOT, Table, file_of, function_of

TABLE = Table.read()
QUICK, SLOW = "quick", "slow"
_ALL_SLOW = re.compile(r"^pytestmark = (\[\s*)?([\w.]+,\s*)*pytest\.mark\.slow\b", re.MULTILINE)
STALE = pytest.StashKey[list[str]]()
"""Lines of the table that name no test of the default suite, of the files that were collected whole."""


def is_dear(path: Path) -> bool:
    """Return whether no test of a file is in the quick loop, so that the file need not be read."""
    return _name_of(path) in TABLE.costs


def _name_of(path: Path) -> str:
    return path.relative_to(ROOT).as_posix() if path.is_relative_to(ROOT) else ""


def is_read_in_vain(path: Path, marks: str) -> bool:
    """Return whether a run of tests with `-m QUICKS` needs no test of a file.

    Importing all files would take ten seconds.
    """
    if marks == QUICK and is_dear(path):
        return True
    if marks not in (QUICK, SLOW, f"not {SLOW}") or not path.name.startswith("test_") or not path.is_file():
        return False
    text = path.read_text(encoding="utf-8")
    if marks == SLOW:
        return SLOW not in text and _name_of(path) not in TABLE.slow_files
    return _ALL_SLOW.search(text) is not None


def slow_ones(tests: Iterable[pytest.Item]) -> Iterator[pytest.Item]:
    """Yield the tests that are slow because of their costs."""
    return (test for test in tests if TABLE.is_slow(test.nodeid))


def quick_ones(tests: Iterable[pytest.Item]) -> Iterator[pytest.Item]:
    """Return the tests of the quick loop."""
    return (test for test in tests if not test.get_closest_marker("slow") and test.nodeid not in TABLE)


def stale_lines(tests: Iterable[pytest.Item]) -> list[str]:
    """Return the lines of the table that stand for none of the tests, which are all of their files."""
    names = [test.nodeid for test in tests if not test.get_closest_marker("slow")]
    known = {name for test in names for name in (test, function_of(test), file_of(test))}
    files = {file_of(name) for name in names}
    return sorted(line for line in TABLE.costs.keys() - known if file_of(line) in files)
