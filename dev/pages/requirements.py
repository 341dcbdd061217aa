"""Write docs/reference/generated/requirements.md: every requirement id of cFE and HK 7.0.0, and the tests that show it.

    python -m dev.pages.requirements

The ids are in tests/data/requirement_ids.txt. The tests' sources name the ids that they cover: a test's name has its
first id, its decorator `covers` all of them. An id without a test has a reason in `not_covered.py`.
"""

from __future__ import annotations

import argparse
import ast
import re
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path

from dev.pages.not_covered import NOT_COVERED
from dev.pages.segments import missing, segments

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "reference" / "generated" / "requirements.md"
IDS = ROOT / "tests" / "data" / "requirement_ids.txt"
IN_NAME = re.compile(r"test_((?:c[A-Z]+|HK)\d{4}(?:_\d+)*)(?=_|$)")
TITLES = {
    "cES": "Executive Services",
    "cEVS": "Event Services",
    "cSB": "Software Bus",
    "cTBL": "Table Services",
    "cTIME": "Time Services",
    "HK": "HK",
}
HEAD = """\
# Requirements

This page lists the functional requirements of cFE and HK 7.0.0 by their public ids, with the tests of each. The texts
of the requirements are in NASA's repositories. The tests are in `tests/requirements`. Most of them fly a mission and
use commands and telemetry like a ground system. `python -m dev.pages.requirements` writes this page. A test fails if
the page is out of date.
"""


def ids() -> list[str]:
    """Return all ids, in the order of NASA's lists."""
    return IDS.read_text(encoding="utf-8").split()


def evidence() -> dict[str, list[str]]:
    """Id to its tests, as "test_es.py::test_cES1000_..."."""
    found: dict[str, list[str]] = {}
    for file in sorted((ROOT / "tests/requirements").glob("test_*.py")):
        for test in _tests(ast.parse(file.read_text(encoding="utf-8"))):
            for each in _ids_of(test):
                found.setdefault(each, []).append(f"{file.name}::{test.name}")
    return found


def _tests(tree: ast.Module) -> Iterator[ast.FunctionDef]:
    return (node for node in tree.body if isinstance(node, ast.FunctionDef) and node.name.startswith("test_"))


def _ids_of(test: ast.FunctionDef) -> list[str]:
    named = IN_NAME.match(test.name)
    found = [named[1].replace("_", ".")] if named else []
    for decorator in test.decorator_list:
        if isinstance(decorator, ast.Call) and isinstance(decorator.func, ast.Name) and decorator.func.id == "covers":
            found += [argument.value for argument in decorator.args if isinstance(argument, ast.Constant)]
    return list(dict.fromkeys(found))


def prefix(requirement: str) -> str:
    """Return the service that an id belongs to: "cES" of "cES1000"."""
    return requirement.rstrip("0123456789.")


def page() -> str:
    """Return the text of docs/reference/generated/requirements.md."""
    tests, lines = evidence(), [HEAD, "| part | ids | with tests | |", "|---|---|---|---|"]
    parts = [(name, list(group)) for name, group in groupby(ids(), prefix)]
    for name, members in [*parts, ("all", ids())]:
        covered = sum(each in tests for each in members)
        lines.append(f"| {TITLES.get(name, name)} | {len(members)} | {covered} | {covered / len(members):.1%} |")
    lines += ["", "## Functional tests", "", _functional_tests()]
    for name, members in parts:
        lines += ["", f"## {TITLES[name]}", "", "| id | tests | status |", "|---|---|---|"]
        lines += [f"| {each} | {_names(tests.get(each, []))} | {_status(each, tests)} |" for each in members]
    return "\n".join(lines) + "\n"


def _functional_tests() -> str:
    """How much of NASA's functional tests there is here."""
    every, absent = segments(), missing()
    text = f"NASA's functional tests, cfe_testcase 7.0.0, have {len(every)} segments; {len(every) - len(absent)} have a"
    listed = f" These have none: {', '.join(absent)}." if absent else ""
    return f"{text} counterpart in `tests/functional`.{listed}"


def _names(tests: list[str]) -> str:
    return "<br>".join(f"`{test}`" for test in tests)


def _status(requirement: str, tests: dict[str, list[str]]) -> str:
    return "tested" if requirement in tests else f"not tested: {NOT_COVERED.get(requirement, '?')}"


if __name__ == "__main__":
    argparse.ArgumentParser(prog="python -m dev.pages.requirements", description=__doc__).parse_args()
    PAGE.write_text(page(), encoding="utf-8")
    print(f"wrote {PAGE.relative_to(ROOT)}")
