"""The console as plain text: it reads lines one by one and prints the output. It needs no terminal.

It takes a line when the one before it is done: its run is over, or its expectation is decided. So a session that is
piped in is as deterministic as a script.
"""

from __future__ import annotations

from typing import Protocol, TextIO

from cfepy.cli.ground.console.pages import Row
from cfepy.cli.ground.console.session import BAD, TYPED_LINE, ConsoleSession, Entry

WIDTH = 100
WAIT_S = 0.05


class LineSource(Protocol):
    """Interface of a source of lines."""

    at_end: bool

    def next(self, timeout_s: float) -> str | None:
        """Return the next line, or None if none arrived in time or the source is at its end."""


class PlainConsole:
    """Reads lines and prints the output.

    Args:
        session: carries out the lines.
        lines: the source of the lines.
        out: the output.
    """

    def __init__(self, session: ConsoleSession, lines: LineSource, out: TextIO) -> None:
        self._session = session
        self._lines = lines
        self._out = out
        self._page = session.board.page

    def run(self) -> None:
        """Run until the lines or the session end."""
        session = self._session
        while not session.is_over and not session.is_landed:
            if session.go_on():
                self.print()
            if session.is_busy or session.is_over:
                continue
            line = self._lines.next(0.0 if session.moves else WAIT_S)
            if line is not None:
                self._take(line)
            elif self._lines.at_end:
                session.is_over = True
        self.print()

    def print(self) -> None:
        """Print the entries of the session since the last call."""
        for entry in self._session.take_entries():
            if entry.event is None or self._session.is_shown(entry.event):
                self._out.write(f"{_mark(entry)}{entry.text}\n")
        self._out.flush()

    def _take(self, line: str) -> None:
        self._session.take(line)
        self.print()
        if line.split()[:1] == ["page"]:
            self._out.writelines(f"{text_of_row(row)}\n" for row in self._session.board.rows(WIDTH))
            self._out.flush()


def _mark(entry: Entry) -> str:
    return {TYPED_LINE: "> ", BAD: "FAILED "}.get(entry.kind, "")


def text_of_row(row: Row) -> str:
    """Return the text of a row without its styles."""
    return "".join(piece.text for piece in row).rstrip()
