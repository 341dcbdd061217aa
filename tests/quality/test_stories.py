"""The reported cause of each planted bug is the reviewed one."""

from __future__ import annotations

import pytest

from dev.quality.bugs import BUGS, Bug
from dev.quality.stories import read, told

QUICK = ("lock_order", "parameter_update")


@pytest.mark.parametrize(
    "bug", [pytest.param(bug, marks=[] if bug.name in QUICK else [pytest.mark.slow], id=bug.name) for bug in BUGS]
)
def test_reported_cause_is_the_reviewed_one(bug: Bug) -> None:
    recorded = read()[bug.name]
    story = told(bug, recorded.schedule)
    assert story is not None, f"{recorded.schedule} does not show {bug.name}"
    assert story.cause == recorded.cause
