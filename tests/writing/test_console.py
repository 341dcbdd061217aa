"""The console keeps, shows and forwards lines."""

from __future__ import annotations

import io

from cfepy.writing.console import Console


def test_lines_are_kept_and_shown() -> None:
    stream = io.StringIO()
    console = Console(stream)
    console.write("one")
    console.write("two\nthree\n")
    assert console.lines == ["one", "two", "three"]
    assert stream.getvalue() == "one\ntwo\nthree\n"


def test_quiet_console_keeps_lines_and_shows_nothing() -> None:
    stream = io.StringIO()
    console = Console(stream, quiet=True)
    console.write("one")
    assert (console.lines, stream.getvalue()) == (["one"], "")


def test_sink_gets_the_lines_instead_of_the_stream() -> None:
    stream, seen = io.StringIO(), list[str]()
    Console(stream, quiet=True, sink=seen.append).write("one")
    assert (seen, stream.getvalue()) == (["one"], "")
