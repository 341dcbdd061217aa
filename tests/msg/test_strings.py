"""Text in fixed-size fields."""

from __future__ import annotations

import pytest

from cfepy import msg
from cfepy.status import CfeError


def test_set_cuts_and_fills() -> None:
    assert msg.message_string_set("ab", 4) == b"ab\0\0"
    assert msg.message_string_set("abcdef", 4) == b"abcd"
    assert msg.message_string_set("", 0) == b""


def test_get_ends_at_nul_field_or_buffer() -> None:
    assert msg.message_string_get(b"ab\0cd", 20) == "ab"
    assert msg.message_string_get(b"abcd", 20) == "abcd"
    assert msg.message_string_get(b"abcd", 3) == "ab"


def test_get_falls_back() -> None:
    assert msg.message_string_get(b"\0\0", 20, "default") == "default"
    assert msg.message_string_get(b"", 4, "default") == "def"
    assert msg.message_string_get(b"\0", 20) == ""


def test_invalid_sizes_are_refused() -> None:
    with pytest.raises(CfeError, match="CFE_SB_BAD_ARGUMENT"):
        msg.message_string_set("x", -1)
    with pytest.raises(CfeError, match="CFE_SB_BAD_ARGUMENT"):
        msg.message_string_get(b"x", 0)
