"""The end of an error text about an unknown word."""

from __future__ import annotations

import pytest

from cfepy.reading.suggestions import expected, listed

MANY = [f"sb_max_{name}" for name in ("pipes", "msg_ids", "dest", "depth", "subscribers", "buffers", "zones")]


@pytest.mark.parametrize(
    ("name", "known", "said"),
    [
        ("pol", ("host", "pool", "strict"), "did you mean pool? (expected host, pool or strict)"),
        ("xyz", ("host", "pool", "strict"), "expected host, pool or strict"),
        ("xyz", ("host", "pool"), "expected host or pool"),
        ("xyz", ("host",), "expected host"),
        ("xyz", (), "expected none"),
        ("SB_MAX_PIPE", MANY, "did you mean sb_max_pipes?"),
        ("xyz", MANY, "expected sb_max_pipes, sb_max_msg_ids, sb_max_dest, sb_max_depth, sb_max_subscribers or 2 more"),
        ("q", "abcdefgh", "expected a, b, c, d, e, f, g or h"),
    ],
)
def test_expected_suggests_the_nearest_word_and_lists_few_choices(name: str, known: list[str], said: str) -> None:
    assert expected(name, known) == said


def test_expected_takes_another_subject() -> None:
    assert expected("x", ["a", "b"], subject="T has", last="and") == "T has a and b"


def test_a_long_name_does_not_hide_the_count() -> None:
    assert listed(["a" * 200, *MANY]) == f"{'a' * 200} or 7 more"
