"""The page of requirements: true, complete, and nine tenths of it covered by tests."""

from __future__ import annotations

from dev.pages.not_covered import NOT_COVERED
from dev.pages.requirements import PAGE, evidence, ids, page
from dev.pages.segments import missing, segments


def test_page_is_up_to_date() -> None:
    assert PAGE.read_text(encoding="utf-8") == page(), "run python -m dev.pages.requirements"


def test_every_id_has_a_test_or_a_reason() -> None:
    known, covered = set(ids()), set(evidence())
    assert len(known) == 413
    assert covered <= known, f"no such requirement: {sorted(covered - known)}"
    assert known - covered == set(NOT_COVERED), "not_covered.py must say why these have no test, and only these"


def test_nine_tenths_of_the_ids_have_tests() -> None:
    covered = set(evidence())
    for part in ("cES", "cEVS", "cSB", "cTBL", "cTIME", "HK"):
        members = [each for each in ids() if each.startswith(part)]
        assert sum(each in covered for each in members) >= 0.9 * len(members), part


def test_every_functional_segment_of_nasa_has_a_test() -> None:
    assert len(segments()) == 102
    assert missing() == []
