"""Wrong calls of ROS's API end as on ROS: with the same result, exception and text, or not at all.

`python3 -m dev.record.wrong_calls` made the calls and recorded ROS's answers.
"""

from __future__ import annotations

import json
import lzma
import sys
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import pytest

from tests.rospy_shim.missions import run_nodes

ROOT = Path(__file__).parents[3]
PROGRAM = ROOT / "tests" / "data" / "calls_in_node.py"
RECORD: dict[str, tuple[list[str], list[Any]]] = json.loads(
    lzma.decompress((ROOT / "tests" / "data" / "wrong_calls.json.xz").read_bytes())
)
METHOD = "a TypeError about the number of arguments names the method, such as Life.spin()"
EXPLAINED = {"rospy.spin(?*)": METHOD}
"""Calls that end otherwise, with the reasons; docs/reference/differences.md has them, too."""


def without_texts(outcome: Any) -> Any:
    """Return an outcome with only the types of exceptions, whose texts change with the version of Python."""
    if isinstance(outcome, dict):
        return list(outcome)
    return [without_texts(each) for each in outcome] if isinstance(outcome, list) else outcome


@pytest.mark.slow
@pytest.mark.parametrize("situation", RECORD)
def test_outcomes_equal_the_record_of_ros(situation: str, tmp_path: Path) -> None:
    calls, expected = RECORD[situation]
    (tmp_path / "calls.json").write_text(json.dumps([situation, calls]), encoding="utf-8")
    run = run_nodes(tmp_path, {"PROBE": PROGRAM}, seconds=200)
    outcomes = tmp_path / "outcomes.json"
    assert outcomes.is_file(), "\n".join(run.lines)
    rows = zip(calls, expected, json.loads(outcomes.read_text(encoding="utf-8")), strict=True)
    if sys.version_info[:2] != (3, 11):
        rows = ((call, without_texts(theirs), without_texts(ours)) for call, theirs, ours in rows)  # type: ignore[assignment]
    different = [row for row in rows if row[1] != row[2] and not any(fnmatchcase(row[0], each) for each in EXPLAINED)]
    assert different == []
