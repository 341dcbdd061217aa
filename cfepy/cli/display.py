"""Display of a running mission: console lines, and on a terminal a status line below them.

Console lines arrive from inside the simulation. On a terminal they are kept until the host has the CPU again, a few
dozen milliseconds later, and shown together, so that drawing slows the run very little.
"""

from __future__ import annotations

import contextlib
import sys
from typing import TYPE_CHECKING, Protocol, TextIO

from cfepy.cli.options import LONGEST_S
from cfepy.cli.user_notes import tell
from cfepy.rtos import Stopwatch
from cfepy.units import NS_PER_S
from cfepy.writing.escapes import console_line, raw, rich_console

if TYPE_CHECKING:
    from rich.text import Text

    from cfepy.mission import Mission

REFRESH_NS = NS_PER_S // 10


class Display(Protocol):
    """Interface of a display of a run."""

    def line(self, text: str) -> None:
        """Show a line of the mission's console; called from inside the simulation."""

    def tell(self, text: str) -> None:
        """Show a message about the host computer, such as the address of an open port; called by the host."""

    def update(self, mission: Mission) -> None:
        """Refresh the display; called by the host repeatedly during the run."""

    def close(self) -> None:
        """End the display at the end of the run; only finished lines stay on the screen."""


class PlainDisplay:
    """Prints lines only, for files and pipes.

    Args:
        stream: the output.
    """

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._colours = stream.isatty()
        self._broken: OSError | None = None

    def line(self, text: str) -> None:
        """Write a line; keep a write error for `update`, so that it does not look like an error of the app that
        printed.
        """
        if self._broken is None:
            try:
                raw(self._stream).write(console_line(text, self._colours) + "\n")
            except OSError as error:
                self._broken = error
            except ValueError as error:  # an app closed it
                self._broken = BrokenPipeError(str(error))

    def tell(self, text: str) -> None:
        """Write a line and flush it, because the reader of a pipe may wait for it."""
        self.line(text)
        with contextlib.suppress(OSError, ValueError):  # `line` has kept the error, or will meet it
            self._stream.flush()

    def update(self, mission: Mission) -> None:
        """Raise the write error that `line` has kept, if there is one.

        Raises:
            OSError: the reader of the output is gone, or the disk is full.
        """
        if self._broken is not None:
            raise self._broken

    def close(self) -> None:
        """Do nothing: there is nothing to close."""


class SilentDisplay:
    """Shows nothing of the run."""

    def line(self, text: str) -> None:
        """Ignore the line."""

    def tell(self, text: str) -> None:
        """Print the message to standard error: it is not part of the run, and must not disturb a piped report."""
        tell([text])

    def update(self, mission: Mission) -> None:
        """Do nothing."""

    def close(self) -> None:
        """Do nothing: there is nothing to close."""


class LiveDisplay:
    """Prints lines, and a status line below them that is redrawn at most ten times a second.

    Args:
        stream: a terminal.
        seconds: virtual time that the run will take.
    """

    def __init__(self, stream: TextIO, seconds: float) -> None:
        from rich.live import Live

        self._console = rich_console(stream, soft_wrap=True)
        self._live = Live(
            console=self._console, auto_refresh=False, transient=True, redirect_stdout=False, redirect_stderr=False
        )
        self._of = "" if seconds >= LONGEST_S else f" of {seconds:g}"
        self._lines: list[str] = []
        self._watch = Stopwatch()
        self._drawn_ns = -REFRESH_NS
        self._virtual_ns = self._messages = 0
        self._live.start()

    def line(self, text: str) -> None:
        self._lines.append(text)

    tell = line

    def update(self, mission: Mission) -> None:
        wall_ns = self._watch.elapsed_ns()
        since_ns = wall_ns - self._drawn_ns
        if since_ns < REFRESH_NS:
            return
        self._show_lines()
        now, messages = mission.kernel.now, _messages(mission)
        speed = (now - self._virtual_ns) / since_ns
        rate = (messages - self._messages) * NS_PER_S / since_ns
        text = f" {now / NS_PER_S:.2f}{self._of} s   {speed:.1f} x real time   {rate:,.0f} messages/s"
        self._live.update(_status(text), refresh=True)
        self._drawn_ns, self._virtual_ns, self._messages = wall_ns, now, messages

    def close(self) -> None:
        self._show_lines()
        self._live.stop()

    def _show_lines(self) -> None:
        if self._lines:
            lines, self._lines = self._lines, []
            text = "\n".join(console_line(line, colours=True) for line in lines)
            shown = _coloured(text) if "\x1b" in text else text
            self._console.print(shown, markup=False, highlight=False, emoji=False)


def make_display(quiet: bool, seconds: float) -> Display:
    """Make the display for this process's standard output.

    Args:
        quiet: show nothing while the mission runs.
        seconds: virtual time that the run will take.
    """
    if quiet:
        return SilentDisplay()
    return LiveDisplay(sys.stdout, seconds) if sys.stdout.isatty() else PlainDisplay(sys.stdout)


def _messages(mission: Mission) -> int:
    return sum(route.sequence + route.relayed for route in mission.cfe.sb.routes.values())


def _coloured(text: str) -> Text:
    """Convert a text with the terminal colours of nodes to a rich text."""
    from rich.text import Text

    return Text.from_ansi(text)


def _status(text: str) -> Text:
    from rich.text import Text

    return Text(text, style="reverse", no_wrap=True, overflow="ellipsis")
