"""The progress of long work is a line on a terminal, lines at intervals in a test, and nothing elsewhere."""

from __future__ import annotations

import io

import pytest

from cfepy.units import NS_PER_S
from cfepy.writing.work_progress import ERASE_LINE, WorkProgress, progress_lines


class Terminal(io.StringIO):
    """A terminal that keeps its output."""

    def isatty(self) -> bool:
        return True


class Clock:
    """A clock that the test sets, in s."""

    now = 0.0

    def __call__(self) -> int:
        return round(self.now * NS_PER_S)


@pytest.fixture
def clock() -> Clock:
    return Clock()


def test_terminal_shows_the_last_text_in_one_line_and_clears_it(clock: Clock) -> None:
    terminal = Terminal()
    with WorkProgress(clock, terminal) as progress:
        for clock.now, text in ((1.0, "compiling 1 of 2"), (2.5, "compiling 2 of 2")):
            progress.show(text)
    assert terminal.getvalue() == (
        f"{ERASE_LINE}compiling 1 of 2 (1 s so far){ERASE_LINE}compiling 2 of 2 (2 s so far){ERASE_LINE}"
    )


def test_short_work_shows_nothing_on_a_terminal(clock: Clock) -> None:
    terminal = Terminal()
    with WorkProgress(clock, terminal) as progress:
        clock.now = 0.4
        progress.show("compiling 1 of 1")
    assert terminal.getvalue() == ""


def test_line_is_shortened_to_the_width_of_the_terminal(clock: Clock, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "20")
    terminal = Terminal()
    progress = WorkProgress(clock, terminal)
    clock.now = 1.0
    progress.show("x" * 100)
    assert terminal.getvalue() == ERASE_LINE + "x" * 19


def test_control_characters_of_a_file_name_do_not_reach_the_terminal(clock: Clock) -> None:
    terminal = Terminal()
    progress = WorkProgress(clock, terminal)
    clock.now = 1.0
    progress.show("compiling \x1b[31m\nx")
    assert terminal.getvalue().count("\x1b") == 1
    assert "\n" not in terminal.getvalue()


def test_stream_that_is_no_terminal_gets_nothing(clock: Clock) -> None:
    stream = io.StringIO()
    with WorkProgress(clock, stream) as progress:
        clock.now = 100.0
        progress.show("compiling 1 of 2")
    assert stream.getvalue() == ""


def test_test_runner_gets_a_line_every_five_seconds(clock: Clock) -> None:
    lines: list[str] = []
    with progress_lines(lines.append), WorkProgress(clock) as progress:
        progress.show("shrinking")
        for second in range(1, 13):
            clock.now = second
            progress.refresh()
    assert lines == ["cfepy: shrinking (5 s so far)", "cfepy: shrinking (10 s so far)"]


def test_inner_context_gets_the_lines(clock: Clock) -> None:
    outer: list[str] = []
    inner: list[str] = []
    clock.now = 9.0
    with progress_lines(outer.append):
        with progress_lines(inner.append):
            WorkProgress(clock).show("compiling")
        WorkProgress(clock).show("linking")
    assert (inner, outer) == (["cfepy: compiling (9 s so far)"], ["cfepy: linking (9 s so far)"])
