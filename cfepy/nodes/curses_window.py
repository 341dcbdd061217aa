"""A window of curses: characters in a grid, a cursor, and the keys that are read through it.

Attributes and colours are accepted and not kept. Stands for the class `window` of `_curses`.
"""

from __future__ import annotations

import _curses
from typing import Any, Protocol

from cfepy.nodes.curses_keys import key_name, read_key
from cfepy.nodes.terminal import Terminal

# fmt: off
_NO_EFFECT = frozenset({
    "attroff", "attron", "attrset", "bkgd", "bkgdset", "chgat", "clearok", "cursyncup", "idcok", "idlok", "immedok",
    "leaveok", "notimeout", "redrawln", "redrawwin", "scroll", "scrollok", "setscrreg", "standend", "standout",
    "syncdown", "syncok", "syncup", "touchline", "touchwin", "untouchwin",
})
# fmt: on
_NO_KEY = -1
_BLANK = " "
_CHAR_BITS = 0x1FFFFF  # of a character with its attributes


class Shown(Protocol):
    """What a window needs of its screen; see `cfepy.nodes.curses_module.Screen`."""

    @property
    def terminal(self) -> Terminal: ...

    half_delay: float | None
    pushed_back: list[int]

    def put(self, top: int, left: int, rows: list[str]) -> None: ...

    def update(self) -> None: ...


class Window:
    """A window.

    Args:
        screen: where it appears.
        lines: its height in rows.
        columns: its width in characters.
        top: the screen's row of its first row.
        left: the screen's column of its first column.
    """

    def __init__(self, screen: Shown, lines: int, columns: int, top: int, left: int) -> None:
        self._screen = screen
        self._top, self._left = top, left
        self._cells = [[_BLANK] * columns for _ in range(lines)]
        self._columns = columns
        self._y = self._x = 0
        self._keypad = False
        self._wait: float | None = None  # seconds that getch waits, None for ever
        self.encoding = "utf-8"

    def __getattr__(self, name: str) -> Any:
        if name in _NO_EFFECT:
            return lambda *args: None
        raise AttributeError(f"'_curses.window' object has no attribute {name!r}")

    # -- place -------------------------------------------------------------------------------------------------------

    def getmaxyx(self) -> tuple[int, int]:
        """Height and width."""
        return len(self._cells), self._columns

    def getbegyx(self) -> tuple[int, int]:
        """Its first row and column on the screen."""
        return self._top, self._left

    def getyx(self) -> tuple[int, int]:
        """Where the cursor is."""
        return self._y, self._x

    def move(self, y: int, x: int) -> None:
        """Put the cursor somewhere.

        Raises:
            _curses.error: that is outside the window.
        """
        if not (0 <= y < len(self._cells) and 0 <= x < self._columns):
            raise _curses.error("wmove() returned ERR")
        self._y, self._x = y, x

    def mvwin(self, y: int, x: int) -> None:
        """Move the window on the screen."""
        self._top, self._left = y, x

    def resize(self, lines: int, columns: int) -> None:
        """Give the window another size; what is in both stays."""
        rows = [[*row[:columns], *[_BLANK] * (columns - len(row))] for row in self._cells[:lines]]
        self._cells = rows + [[_BLANK] * columns for _ in range(lines - len(rows))]
        self._columns = columns

    def derwin(self, *place: int) -> Window:
        """A window in this one; place is `[lines, columns,] top, left`, seen from this one."""
        *size, y, x = place
        lines, columns = size or (0, 0)
        inner = (lines or len(self._cells) - y, columns or self._columns - x)
        return Window(self._screen, *inner, self._top + y, self._left + x)

    def subwin(self, *place: int) -> Window:
        """As `derwin`, with the place seen from the screen."""
        *size, y, x = place
        return self.derwin(*size, y - self._top, x - self._left)

    # -- writing -----------------------------------------------------------------------------------------------------

    def addstr(self, *args: Any) -> None:
        """Write text: `[y, x,] text [, attributes]`.

        Raises:
            _curses.error: it does not fit; what fits is written, as curses does.
        """
        text, _ = self._place(args)
        self._write(text.decode() if isinstance(text, bytes) else str(text))

    def addnstr(self, *args: Any) -> None:
        """Write at most n characters: `[y, x,] text, n [, attributes]`."""
        text, rest = self._place(args)
        self._write(text[: rest[0]])

    def addch(self, *args: Any) -> None:
        """Write a character: `[y, x,] character [, attributes]`."""
        char, _ = self._place(args)
        self._write(_text_of(char))

    echochar = addch

    def insstr(self, *args: Any) -> None:
        """Write text and push what is there to the right."""
        text, _ = self._place(args)
        row = self._cells[self._y]
        row[self._x : self._x] = list(str(text))
        del row[self._columns :]

    def hline(self, *args: Any) -> None:
        """A line to the right: `[y, x,] character, n`."""
        char, rest = self._place(args)
        count = min(rest[0], self._columns - self._x)
        self._cells[self._y][self._x : self._x + count] = [_text_of(char)] * count

    def vline(self, *args: Any) -> None:
        """A line downwards: `[y, x,] character, n`."""
        char, rest = self._place(args)
        for row in self._cells[self._y : self._y + rest[0]]:
            row[self._x] = _text_of(char)

    def border(self, *chars: Any) -> None:
        """A frame of plain characters."""
        for row in (self._cells[0], self._cells[-1]):
            row[:] = ["+", *["-"] * (self._columns - 2), "+"]
        for row in self._cells[1:-1]:
            row[0] = row[-1] = "|"

    box = border

    def erase(self) -> None:
        """Make the window blank."""
        for row in self._cells:
            row[:] = [_BLANK] * self._columns
        self._y = self._x = 0

    clear = erase

    def clrtoeol(self) -> None:
        """Make the rest of the row blank."""
        self._cells[self._y][self._x :] = [_BLANK] * (self._columns - self._x)

    def clrtobot(self) -> None:
        """Make everything from the cursor on blank."""
        self.clrtoeol()
        for row in self._cells[self._y + 1 :]:
            row[:] = [_BLANK] * self._columns

    def deleteln(self) -> None:
        """Take the cursor's row out."""
        del self._cells[self._y]
        self._cells.append([_BLANK] * self._columns)

    def insertln(self) -> None:
        """Put a blank row above the cursor's."""
        self._cells.insert(self._y, [_BLANK] * self._columns)
        del self._cells[-1]

    def inch(self, *place: int) -> int:
        """The character at `[y, x]`."""
        y, x = place or (self._y, self._x)
        return ord(self._cells[y][x])

    def instr(self, *place: int) -> bytes:
        """What is written from the cursor on: `[y, x] [, n]`."""
        if len(place) >= 2:
            self.move(place[0], place[1])
        count = place[-1] if len(place) % 2 else self._columns
        return "".join(self._cells[self._y][self._x : self._x + count]).encode()

    def refresh(self, *area: int) -> None:
        """Show the window."""
        self.noutrefresh()
        self._screen.update()

    def noutrefresh(self, *area: int) -> None:
        """Have the window shown by the next `doupdate`."""
        self._screen.put(self._top, self._left, ["".join(row) for row in self._cells])

    def _place(self, args: tuple[Any, ...]) -> tuple[Any, tuple[Any, ...]]:
        """Go to `y, x` if they are given; what is written there, and what follows that."""
        if len(args) >= 3 and isinstance(args[1], int) and isinstance(args[0], int):
            self.move(args[0], args[1])
            args = args[2:]
        return args[0], args[1:]

    def _write(self, text: str) -> None:
        for char in text:
            if char == "\n":
                self.clrtoeol()
            else:
                self._cells[self._y][self._x] = char
                self._x += 1
            if char == "\n" or self._x == self._columns:
                self._next_row()

    def _next_row(self) -> None:
        if self._y + 1 == len(self._cells):
            self._x = min(self._x, self._columns - 1)
            raise _curses.error("addwstr() returned ERR")
        self._y, self._x = self._y + 1, 0

    # -- keys --------------------------------------------------------------------------------------------------------

    def keypad(self, flag: bool) -> None:
        """Whether special keys come as one number each."""
        self._keypad = bool(flag)

    def nodelay(self, flag: bool) -> None:
        """Whether `getch` does not wait."""
        self._wait = 0.0 if flag else None

    def timeout(self, milliseconds: int) -> None:
        """How long `getch` waits; negative is for ever."""
        self._wait = None if milliseconds < 0 else milliseconds / 1e3

    def getch(self, *place: int) -> int:
        """The next key, -1 when none comes in time. What was written is shown first."""
        screen = self._screen
        self.refresh()
        if screen.pushed_back:
            return screen.pushed_back.pop()
        if not screen.terminal.wait(self._wait if self._wait is not None else screen.half_delay):
            return _NO_KEY
        return read_key(screen.terminal, self._keypad)

    def getkey(self, *place: int) -> str:
        """The next key's name or character.

        Raises:
            _curses.error: none came in time.
        """
        key = self.getch(*place)
        if key == _NO_KEY:
            raise _curses.error("no input")
        return chr(key) if key < _curses.KEY_MIN else key_name(key).decode()

    def get_wch(self, *place: int) -> int | str:
        """The next character, or a special key's number.

        Raises:
            _curses.error: none came in time.
        """
        key = self.getch(*place)
        if key == _NO_KEY:
            raise _curses.error("no input")
        return chr(key) if key < _curses.KEY_MIN else key

    def getstr(self, *args: int) -> bytes:
        """What is typed up to the end of a line."""
        typed = bytearray()
        while (key := self.getch()) not in (ord("\n"), ord("\r"), _NO_KEY):
            if key < _curses.KEY_MIN:
                typed.append(key)
        return bytes(typed)


def _text_of(char: Any) -> str:
    """A character, however it is given."""
    if isinstance(char, int):
        return chr(char & _CHAR_BITS)
    return char.decode() if isinstance(char, bytes) else str(char)
