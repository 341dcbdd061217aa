"""Typed lines, for a loop that has other tasks."""

from __future__ import annotations

import io
import os

from cfepy.io import TypedLines

LONG_S = 60.0


def test_lines_are_read_in_order_until_the_end() -> None:
    lines = TypedLines(io.StringIO("one\r\ntwo\nthree"))
    assert [lines.next(LONG_S) for _ in range(3)] == ["one", "two", "three"]
    assert not lines.at_end
    assert lines.next(LONG_S) is None
    assert lines.at_end
    assert lines.next(LONG_S) is None


def test_next_returns_none_before_a_line_is_typed() -> None:
    reading, writing = os.pipe()
    with os.fdopen(reading) as stream, os.fdopen(writing, "w") as typist:
        lines = TypedLines(stream)
        assert lines.next(0.0) is None
        assert not lines.at_end
        typist.write("hello\n")
        typist.flush()
        assert lines.next(LONG_S) == "hello"
        typist.close()
        assert lines.next(LONG_S) is None


def test_unreadable_stream_is_at_its_end() -> None:
    with open(os.devnull, "w", encoding="utf-8") as stream:
        lines = TypedLines(stream)
        assert lines.next(LONG_S) is None
        assert lines.at_end
