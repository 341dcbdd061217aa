"""The segments of NASA's functional tests, and those that have a test here.

tests/data/functional_segments.txt has a line for each: "es_cds: Test CDS Name" is the segment of that name in
es_cds_test.c; the test for it is test_es_cds.py::test_cds_name.
"""

from __future__ import annotations

import ast
import re
from pathlib import Path

HERE = Path(__file__).parents[2] / "tests/functional"
LIST = HERE.parent / "data" / "functional_segments.txt"


def segments() -> list[str]:
    """Return all segments, as in the list."""
    return LIST.read_text(encoding="utf-8").splitlines()


def test_of(segment: str) -> str:
    """Where the test of a segment has to be: "test_es_cds.py::test_cds_name"."""
    file, _, name = segment.partition(": ")
    apart = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name.removeprefix("Test "))
    words = re.sub(r"\W+", "_", apart).lower().removeprefix("test_")
    return f"test_{file}.py::test_{words}"


def missing() -> list[str]:
    """Return the segments without a test."""
    present = {
        f"{file.name}::{node.name}"
        for file in HERE.glob("test_*.py")
        for node in ast.parse(file.read_text(encoding="utf-8")).body
        if isinstance(node, ast.FunctionDef)
    }
    return [segment for segment in segments() if test_of(segment) not in present]
