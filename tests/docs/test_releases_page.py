"""docs/reference/generated/releases.md: the page has the data that the simulator uses."""

from __future__ import annotations

from cfepy.config.versions import RELEASES, Release
from dev.pages import releases


def test_page_is_up_to_date() -> None:
    assert releases.PAGE.read_text(encoding="utf-8") == releases.page(), "run python -m dev.pages.releases"


def test_each_fact_of_a_release_has_a_meaning() -> None:
    assert set(releases.meanings()) == set(Release.__annotations__)


def test_page_names_each_release_and_each_difference() -> None:
    text = releases.page()
    assert f"| fact | meaning | {' | '.join(RELEASES)} |" in text
    first, _, last = text.partition("## The same in all releases")
    for fact in Release.__annotations__:
        values = {str(getattr(each, fact)) for each in RELEASES.values()}
        assert (f"| `{fact}` |" in first) == (len(values) > 1)
        assert (f"| `{fact}` |" in last) == (len(values) == 1)
