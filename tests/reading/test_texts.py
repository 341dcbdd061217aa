"""Texts are bytes in C: bytes that are not UTF-8 pass through unchanged."""

from __future__ import annotations

import pytest

from cfepy.reading.texts import from_bytes, shown, to_bytes


@pytest.mark.parametrize("data", [b"", b"plain", "grüß".encode(), b"\xff\xfe", b"A\x80\xe9B"])
def test_bytes_survive_conversion_to_text_and_back(data: bytes) -> None:
    assert to_bytes(from_bytes(data)) == data


def test_a_text_ends_at_its_nul() -> None:
    assert from_bytes(b"ab\0cd") == "ab"


def test_surrogate_that_is_not_a_byte_becomes_a_question_mark() -> None:
    assert to_bytes("a\ud800b\udcffc") == b"a?b\xffc"


def test_invalid_bytes_are_shown_as_a_replacement_character() -> None:
    assert shown(from_bytes(b"a\xffb")) == "a\ufffdb"
