"""Typed lines, for a loop that has other tasks."""

from __future__ import annotations

import io
import os

from cfepy.io import TypedLines

LONG_S = 60.0


def test_lines_come_in_order_and_then_no_more() -> None:
    lines = TypedLines(io.StringIO("one\r\ntwo\nthree"))
    assert [lines.next(LONG_S) for _ in range(3)] == ["one", "two", "three"]
    assert not lines.at_end
    assert lines.next(LONG_S) is None
    assert lines.at_end
    assert lines.next(LONG_S) is None


def test_nobody_has_typed_yet() -> None:
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


def test_a_stream_that_cannot_be_read() -> None:
    with open(os.devnull, "w", encoding="utf-8") as stream:
        lines = TypedLines(stream)
        assert lines.next(LONG_S) is None
        assert lines.at_end
