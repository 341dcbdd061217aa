"""The page about guidance by coverage is that of what was measured."""

from __future__ import annotations

import json

import pytest

from cfepy.exploration.search import GREYBOX
from dev.quality.bugs import by_name, reference_trial
from dev.quality.coverage_report import MEASURED, PAGE, first, median, page


def test_the_page_shows_what_was_measured() -> None:
    assert page(json.loads(MEASURED.read_text(encoding="utf-8"))) == PAGE.read_text(encoding="utf-8")


def test_a_median_counts_what_found_nothing() -> None:
    assert median([5, None, 3]) == 5
    assert median([None, 3, None]) is None


@pytest.mark.slow
def test_the_first_failing_schedule_is_counted_from_one() -> None:
    assert first(reference_trial(by_name("lost_update").folder), GREYBOX, 0, 2) == 1
