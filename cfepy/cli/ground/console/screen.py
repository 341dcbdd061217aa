"""The console on a terminal: telemetry, events, replies, and an input line with completion and history.

The session, and with it the mission, runs in a thread of its own. So the screen responds while the simulation is busy,
or while a task does not give up the processor. Between two steps that thread updates the screen and waits for it, so
the session does not change while it is drawn.
"""

from __future__ import annotations

import os
import queue
from collections import deque
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import ClassVar

from rich.text import Text
from textual.app import App, ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Container, VerticalScroll
from textual.events import Key, Paste, Print
from textual.suggester import Suggester
from textual.widgets import Input, RichLog, Static

from cfepy.cli.ground.console import pages
from cfepy.cli.ground.console.completion import Completer, Completion
from cfepy.cli.ground.console.session import BAD, CONSOLE, EVENT, GOOD, REPLY, TYPED_LINE, ConsoleSession, Entry
from cfepy.cli.main import INTERRUPTED
from cfepy.cli.watched_host import PATIENCE_NS, STDERR
from cfepy.ground import EVENT_TYPES
from cfepy.msg import RED, YELLOW
from cfepy.rtos import Stopwatch
from cfepy.units import NS_PER_S
from cfepy.writing.escapes import visible, visible_line

OpenSession = Callable[[Callable[[str], object]], AbstractContextManager[ConsoleSession]]

REFRESH_NS = NS_PER_S // 5  # wall time between two drawings while time advances
IDLE_S = 0.1
MOST_LINES = 2000
MOST_HISTORY = 500
KEYS = "F1 help  F2 page  F3 events  F5 run/pause  Tab completes  Ctrl-C pause  Ctrl-Q quit"
QUIT = "quit"
NOTHING_FITS = "no matching name"
ENTRY_STYLES = {CONSOLE: "dim", TYPED_LINE: "bold", REPLY: "", GOOD: "green", BAD: "bold red"}
EVENT_STYLES = {"DEBUG": "dim", "INFORMATION": "cyan", "ERROR": "bold red", "CRITICAL": "bold white on red"}
ACTIONS = {key: each.action for each in Input.BINDINGS if isinstance(each, Binding) for key in each.key.split(",")}
"""Editing keys of a line, such as backspace."""

PIECE_STYLES = {
    pages.TITLE: "bold cyan",
    pages.NAME: "",
    pages.VALUE: "",
    pages.CHANGED: "bold cyan",
    YELLOW: "bold yellow",
    RED: "bold white on red",
}


class LineInput(Input):
    """The input line.

    Args:
        enter: receives each line.

    Attributes:
        completer: completes the line; None as long as there is no session.
    """

    def __init__(self, enter: Callable[[str], object]) -> None:
        super().__init__(id="line", placeholder="a command by its name, a step of a script, or help", disabled=True)
        self._enter = enter
        self.completer: Completer | None = None
        self._history: list[str] = []
        self._at = 0

    def submit(self) -> None:
        """Enter the typed line."""
        line, self.value = self.value.strip(), ""
        if line and self._history[-1:] != [line]:
            self._history = [*self._history[-MOST_HISTORY:], line]
        self._at = len(self._history)
        if line:
            self._enter(line)

    async def _on_key(self, event: Key) -> None:
        """Handle keys here, in the order in which they were pressed: bindings would run after the letters."""
        if event.key == "enter":
            self.submit()
        elif event.key in ACTIONS:
            await self.run_action(ACTIONS[event.key])
        elif event.key == "tab":
            self._complete()
        elif event.key in ("up", "down"):
            self._turn(-1 if event.key == "up" else 1)
        else:
            await super()._on_key(event)
            return
        event.stop()
        event.prevent_default()

    def _on_paste(self, event: Paste) -> None:
        """Enter several pasted lines one by one, such as lines of a script."""
        *whole, rest = event.text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
        for text in whole:
            self.insert_text_at_cursor(text)
            self.submit()
        self.insert_text_at_cursor(rest)
        event.stop()
        event.prevent_default()

    def _turn(self, step: int) -> None:
        """Go to an earlier line (-1) or a later one (1)."""
        self._at = max(0, min(len(self._history), self._at + step))
        self.value = self._history[self._at] if self._at < len(self._history) else ""
        self.cursor_position = len(self.value)

    def _complete(self) -> None:
        """Complete the line as far as it is unambiguous."""
        if self.completer is not None:
            self.value = self.completer.complete(self.value).extended(self.value)
            self.cursor_position = len(self.value)


class FirstChoice(Suggester):
    """Suggests the first word that fits; the right arrow takes it."""

    def __init__(self, completer: Completer) -> None:
        super().__init__(use_cache=False, case_sensitive=True)
        self._completer = completer

    async def get_suggestion(self, value: str) -> str | None:
        start, candidates = self._completer.complete(value)
        word = value[start:]
        if not word or not candidates or not candidates[0].text.startswith(word):
            return None
        return value[:start] + candidates[0].text


class ConsoleScreen(App[None]):
    """The screen of a console.

    Args:
        open_session: opens the session in the thread that advances time. Its argument receives messages for the user.

    Attributes:
        is_idle: time stands still, and all typed lines are done and shown.
    """

    CSS = """
    #status { height: 1; background: $primary; color: $text; text-style: bold; }
    #panes { layout: grid; grid-size: 1 3; grid-rows: 1fr 1fr 1fr; }
    .-wide #panes { grid-size: 2 2; grid-columns: 1fr 1fr; grid-rows: 1fr 1fr; }
    .-wide #telemetry { row-span: 2; }
    #telemetry, #events, #log { border-top: solid $primary; border-title-style: bold; height: 100%; }
    #telemetry, #events, #log { scrollbar-size-vertical: 1; background: $background; }
    #page { width: 100%; height: auto; }
    #hint { height: 1; color: $text-muted; }
    #line, #line:focus { border: none; height: 1; padding: 0; background: $surface; }
    """
    HORIZONTAL_BREAKPOINTS = [(0, "-narrow"), (100, "-wide")]  # noqa: RUF012  # as its base class has it
    ENABLE_COMMAND_PALETTE = False
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("f1", "say('help')", show=False),
        Binding("f2", "say('page')", show=False),
        Binding("f3", "next_events", show=False),
        Binding("f5", "run_or_pause", show=False),
        Binding("pageup", "scroll_page(-1)", show=False, priority=True),
        Binding("pagedown", "scroll_page(1)", show=False, priority=True),
        Binding("ctrl+c", "say('pause')", show=False, priority=True),
        Binding("ctrl+q", "leave", show=False, priority=True),
    ]

    def __init__(self, open_session: OpenSession) -> None:
        super().__init__()
        self.title = "cfepy console"
        self.is_idle = False
        self._open_session = open_session
        self._session: ConsoleSession | None = None
        self._typed: queue.SimpleQueue[str] = queue.SimpleQueue()
        self._events: deque[Entry] = deque(maxlen=MOST_LINES)
        self._filter: tuple[int, str | None] = (0, None)
        self._rows: list[pages.Row] = []
        self._notes: list[str] = []
        self._error: BaseException | None = None
        self._leaving: Stopwatch | None = None

    def show(self) -> None:
        """Show the screen until the session is over.

        Raises:
            BaseException: the error that ended the session, if there was one.
        """
        self.run()
        self.tell_error()

    def tell_error(self) -> None:
        """Raise the error that ended the session, if there was one."""
        if self._error is not None:
            raise self._error

    def compose(self) -> ComposeResult:
        yield Static("", id="status")
        with Container(id="panes"):
            with VerticalScroll(id="telemetry", can_focus=False):
                yield Static("", id="page")
            yield RichLog(id="events", wrap=True, min_width=1, max_lines=MOST_LINES)
            yield RichLog(id="log", wrap=True, min_width=1, max_lines=MOST_LINES)
        yield Static(KEYS, id="hint")
        yield LineInput(self.enter)

    def on_mount(self) -> None:
        for name, title in (("telemetry", "telemetry"), ("events", "events"), ("log", "console")):
            self.query_one(f"#{name}").border_title = title
            self.query_one(f"#{name}").can_focus = False
        self.begin_capture_print(self)
        self.run_worker(self._fly, thread=True)

    # -- the session, in a thread of its own ---------------------------------------------------------------------------

    def _fly(self) -> None:
        try:
            with self._open_session(self._notes.append) as session:
                self.call_from_thread(self._begin, session)
                self._go_on(session)
        except BaseException as error:  # reported when the screen is closed
            self._error = error
        self.call_from_thread(self.exit)

    def _go_on(self, session: ConsoleSession) -> None:
        drawn: Stopwatch | None = None
        while not session.is_over:
            took = self._take(session, 0.0 if session.moves else IDLE_S)
            moved = session.go_on()
            if took or not moved or drawn is None or drawn.elapsed_ns() >= REFRESH_NS:
                self.call_from_thread(self._draw, session)
                drawn = Stopwatch()

    def _take(self, session: ConsoleSession, timeout_s: float) -> bool:
        """Carry out a typed line. Returns False if there was none."""
        try:
            line = self._typed.get(timeout=timeout_s) if timeout_s else self._typed.get_nowait()
        except queue.Empty:
            return False
        session.take(line)
        return True

    def enter(self, line: str) -> None:
        """Queue a typed line for the session."""
        self.is_idle = False
        self._typed.put(line)

    # -- drawing; the session's thread waits meanwhile -----------------------------------------------------------------

    def _begin(self, session: ConsoleSession) -> None:
        self._session = session
        self.title = f"cfepy console {session.craft.name}"
        line = self.query_one(LineInput)
        line.completer = Completer(session)
        line.suggester = FirstChoice(line.completer)
        line.disabled = False
        line.focus()
        for note in self._notes:
            session.say(REPLY, note)
        session.say(REPLY, f"{session.craft.name}: type help for the list of commands")

    def _draw(self, session: ConsoleSession) -> None:
        log = self.query_one("#log", RichLog)
        for entry in session.take_entries():
            if entry.kind == EVENT:
                self._events.append(entry)
                self._write_event(session, entry)
            else:
                mark = "> " if entry.kind == TYPED_LINE else ""
                log.write(Text(mark + entry.text, style=ENTRY_STYLES[entry.kind]))
        self.is_idle = not session.moves and self._typed.empty()
        if self._filter != (session.least_type, session.only_app):
            self._refilter(session)
        self.query_one("#status", Static).update(Text(session.status(), no_wrap=True, overflow="ellipsis"))
        self._draw_page(session)

    def _draw_page(self, session: ConsoleSession) -> None:
        pane, page = self.query_one("#telemetry"), self.query_one("#page", Static)
        pane.border_title = f"telemetry: {' '.join(session.board.page)}"
        rows = session.board.rows(max(1, pane.size.width - 1))
        if rows != self._rows:
            page.update(Text("\n").join(_row_text(row) for row in rows), layout=len(rows) != len(self._rows))
            self._rows = rows

    def _write_event(self, session: ConsoleSession, entry: Entry) -> None:
        event = entry.event
        if event is not None and session.is_shown(event):
            style = EVENT_STYLES.get(event.type_name, "")
            self.query_one("#events", RichLog).write(Text(entry.text, style=style))

    def _refilter(self, session: ConsoleSession) -> None:
        self._filter = session.least_type, session.only_app
        self.query_one("#events", RichLog).clear()
        least = next((name for name, number in EVENT_TYPES.items() if number == session.least_type), "")
        self.query_one("#events").border_title = f"events {session.only_app or ''} {least}".rstrip()
        for entry in self._events:
            self._write_event(session, entry)

    # -- keys ----------------------------------------------------------------------------------------------------------

    def on_input_changed(self, message: Input.Changed) -> None:
        """Show how the line may go on."""
        completer = self.query_one(LineInput).completer
        hint = KEYS if completer is None or not message.value else hint_of(completer.complete(message.value))
        self.query_one("#hint", Static).update(Text(hint, no_wrap=True, overflow="ellipsis"))

    def action_say(self, line: str) -> None:
        """Enter a line as if the user had typed it."""
        self.enter(line)

    def action_leave(self) -> None:
        """End the session. If a task never gives up the processor, a second call ends the process some time later."""
        if self._leaving is not None and self._leaving.elapsed_ns() > PATIENCE_NS:
            with self.suspend():
                os.write(STDERR, b"cfepy: a task does not end; the process exits\n")
                os._exit(INTERRUPTED)
        self._leaving = self._leaving or Stopwatch()
        self.query_one("#hint", Static).update("the session ends; if it does not, Ctrl-Q once more ends the process")
        self.enter(QUIT)

    def on_print(self, message: Print) -> None:
        """Show output of this process, such as a report of a stuck task; see `App.begin_capture_print`."""
        text = message.text.rstrip("\n")
        if text:
            self.query_one("#log", RichLog).write(Text(visible(text), style=ENTRY_STYLES[BAD]))

    def action_run_or_pause(self) -> None:
        """Start or pause time."""
        if self._session is not None:
            self.enter("pause" if self._session.moves else "run")

    def action_next_events(self) -> None:
        """Show only errors, or all events again."""
        if self._session is not None:
            self.enter("events all" if self._session.least_type else "events ERROR")

    def action_scroll_page(self, step: int) -> None:
        """Scroll the telemetry by a page."""
        pane = self.query_one("#telemetry")
        pane.scroll_relative(y=step * max(1, pane.size.height - 1), animate=False)


def hint_of(completion: Completion) -> str:
    """Return the candidates on one line; a single one with its hint."""
    candidates = completion.choices
    if not candidates:
        return NOTHING_FITS
    if len(candidates) == 1:
        return visible_line(f"{candidates[0].text}  {candidates[0].hint}".rstrip())
    texts = (f"{each.text}{each.hint}" if each.text.endswith("=") else each.text for each in candidates)
    return visible_line("  ".join(texts))


def _row_text(row: pages.Row) -> Text:
    text = Text(no_wrap=True, overflow="ellipsis")
    for piece in row:
        text.append(piece.text, style=PIECE_STYLES[piece.style])
    return text
