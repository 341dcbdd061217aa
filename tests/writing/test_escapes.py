"""Control characters as text: sequences that a terminal would execute are shown, and colours of nodes stay."""

from __future__ import annotations

import io
import os
import re
import sys
from typing import TextIO

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cfepy.flight.run import ExpectationError
from cfepy.status import StallError, UsageError
from cfepy.writing.console import Console
from cfepy.writing.escapes import (
    console_line,
    for_data,
    keep_output_safe,
    node_text,
    raw,
    rich_console,
    safe,
    safe_output,
    visible,
    visible_line,
)

TITLE = "\x1b]0;title\a"


class Terminal(io.StringIO):
    """A stream that is a terminal."""

    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        (TITLE, r"\x1b]0;title\x07"),
        ("\x9b31m", r"\x9b31m"),
        ("\x7f\0\b\x85", r"\x7f\x00\x08\x85"),
        ("user\u202e gpj.exe", r"user\u202e gpj.exe"),
        ("\u2066\u2069\u200f\u061c\u2028", r"\u2066\u2069\u200f\u061c\u2028"),
        ("100 %\rnothing found", r"100 %\rnothing found"),
        ("two\r\nlines\t\n", "two\r\nlines\t\n"),
        ("ä ☃ 𝄞 👩\u200d🚀", "ä ☃ 𝄞 👩\u200d🚀"),
    ],
)
def test_visible_shows_control_characters_as_escapes(text: str, shown: str) -> None:
    assert visible(text) == shown


def test_visible_line_is_one_line() -> None:
    assert visible_line("/a\n/b\t\r\nc") == r"/a\n/b\t\r\nc"


@given(st.text(st.characters(categories=["Cc", "Cf", "Zl", "Zp", "Lu"])))
def test_visible_text_has_no_controls_and_is_idempotent(text: str) -> None:
    shown = visible(text)
    assert not re.search("[\x00-\x08\x0b-\x0c\x0e-\x1f\x7f-\x9f]", shown)
    assert "\r" not in shown.replace("\r\n", "")
    assert visible(shown) == shown
    assert len(visible_line(text).splitlines()) <= 1


@pytest.mark.parametrize(
    ("line", "coloured", "plain"),
    [
        ("[/n] \x1b[1;31mred\x1b[0m", "[/n] \x1b[1;31mred\x1b[0m", "[/n] red"),
        ("[/n] \x1b[31mred", "[/n] \x1b[31mred\x1b[0m", "[/n] red"),
        ("pair: [n] \x1b[31mred\x1b[m", "pair: [n] \x1b[31mred\x1b[m", "pair: [n] red"),
        (f"[/n] {TITLE}\x1b[2J", r"[/n] \x1b]0;title\x07\x1b[2J", r"[/n] \x1b]0;title\x07\x1b[2J"),
        ("EVS Port1 66/1/A 1: \x1b[31m", r"EVS Port1 66/1/A 1: \x1b[31m", r"EVS Port1 66/1/A 1: \x1b[31m"),
        ("[/n] ends\r", "[/n] ends", "[/n] ends"),
    ],
)
def test_console_line_keeps_colours_of_nodes_only_on_a_terminal(line: str, coloured: str, plain: str) -> None:
    assert console_line(line, colours=True) == coloured
    assert console_line(line, colours=False) == plain


def test_node_text_without_escapes_is_visible() -> None:
    assert node_text("a\x07", colours=True) == r"a\x07"


def test_safe_stream_escapes_writes_and_forwards_other_calls() -> None:
    stream = io.StringIO()
    kept = safe(stream)
    print("a\x1b", file=kept)
    kept.writelines(["b\x1b", "\n"])
    assert stream.getvalue() == "a\\x1b\nb\\x1b\n"
    assert safe(kept) is kept
    assert raw(kept) is stream
    assert raw(stream) is stream
    assert not kept.isatty()


def test_data_is_unchanged_for_a_pipe_and_escaped_for_a_terminal() -> None:
    pipe, terminal = io.StringIO(), Terminal()
    for_data(safe(pipe)).write("\x1b")
    for_data(safe(terminal)).write("\x1b")
    assert (pipe.getvalue(), terminal.getvalue()) == ("\x1b", r"\x1b")


def test_safe_output_restores_the_streams(capsys: pytest.CaptureFixture[str]) -> None:
    before = sys.stdout, sys.stderr
    with safe_output():
        with safe_output():
            print("a\x1b")
        print("b\x1b", file=sys.stderr)
    assert (sys.stdout, sys.stderr) == before
    assert capsys.readouterr() == ("a\\x1b\n", "b\\x1b\n")


def test_safe_output_keeps_a_stream_set_by_others(monkeypatch: pytest.MonkeyPatch) -> None:
    other: TextIO = io.StringIO()
    monkeypatch.setattr(sys, "stdout", sys.stdout)
    with safe_output():
        sys.stdout = other
    assert sys.stdout is other


def test_rich_escapes_texts_and_keeps_its_own_colours() -> None:
    from rich.panel import Panel
    from rich.text import Text

    stream = Terminal()
    console = rich_console(safe(stream), width=40, force_terminal=True, color_system="standard")
    console.print(Panel(Text(f"x{TITLE}\x1b[31m", style="green"), title=Text("t\x9b")))
    out = stream.getvalue()
    assert TITLE not in out
    assert "\x1b[31m" not in out
    assert "\x9b" not in out
    assert r"\x1b[31m" in out.replace("\n", "")
    assert "\x1b[32m" in out


def test_progress_bar_of_rich_leaves_the_output_safe(monkeypatch: pytest.MonkeyPatch) -> None:
    from rich.progress import Progress

    stream = Terminal()
    monkeypatch.setattr(sys, "stdout", stream)
    with safe_output(), Progress(console=rich_console(stream, force_terminal=True), auto_refresh=False):
        keep_output_safe()
        print(f"{TITLE}\x1b]8;;http://x\x1b\\link")
    assert r"\x1b]0;title\x07\x1b]8;;http://x\x1b\link" in stream.getvalue()
    assert sys.stdout is stream


def test_console_keeps_lines_unchanged_and_shows_escapes() -> None:
    stream = io.StringIO()
    console = Console(stream)
    console.write(f"a{TITLE}\n[/n] \x1b[31mred")
    assert console.lines == [f"a{TITLE}", "[/n] \x1b[31mred"]
    assert stream.getvalue() == "a\\x1b]0;title\\x07\n[/n] red\n"


def test_errors_as_strings_have_no_control_characters() -> None:
    error = UsageError(f"bad {TITLE}", file=f"/a\n{TITLE}", line=3, field="f\x1b")
    assert str(error) == r"/a\n\x1b]0;title\x07:3: f\x1b: bad \x1b]0;title\x07"
    assert (error.file, error.field, error.text) == (f"/a\n{TITLE}", "f\x1b", f"bad {TITLE}")
    assert str(StallError("s\x1b", ("l\x9b",))) == "s\\x1b\n  l\\x9b"
    assert str(ExpectationError("no \x1b")) == r"no \x1b"


def test_byte_of_a_name_that_is_not_text_is_visible() -> None:
    assert visible(os.fsdecode(b"a\xff")) == "a\\xff"
    assert visible("\ud800") == "\\ud800"
