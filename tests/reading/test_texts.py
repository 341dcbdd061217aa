"""Texts are bytes in C: bytes that are not UTF-8 pass through unchanged."""

from __future__ import annotations

import pytest

from cfepy.reading.texts import from_bytes, shown, to_bytes


@pytest.mark.parametrize("data", [b"", b"plain", "grüß".encode(), b"\xff\xfe", b"A\x80\xe9B"])
def test_bytes_come_out_as_they_went_in(data: bytes) -> None:
    assert to_bytes(from_bytes(data)) == data


def test_a_text_ends_at_its_nul() -> None:
    assert from_bytes(b"ab\0cd") == "ab"


def test_a_surrogate_that_is_no_byte_becomes_a_question_mark() -> None:
    assert to_bytes("a\ud800b\udcffc") == b"a?b\xffc"


def test_people_see_a_replacement_character() -> None:
    assert shown(from_bytes(b"a\xffb")) == "a\ufffdb"
