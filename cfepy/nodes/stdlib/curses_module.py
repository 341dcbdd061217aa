"""`_curses` of a node: the screen library on the node's terminal, used by the standard library's own `curses`.

Constants are the host's. A node draws into windows, grids of characters with a cursor; `refresh` prints the screen rows
that changed as lines of the node, so a log shows the same as the terminal. Attributes and colours are accepted and
ignored. A key is one number, although a terminal sends several bytes for some keys.
"""

from __future__ import annotations

import _curses
import termios
from types import ModuleType
from typing import TYPE_CHECKING, Any, Protocol

from cfepy.nodes.made_modules import proxy
from cfepy.nodes.stdlib.streams import COLUMNS, ROWS
from cfepy.nodes.stdlib.terminal import LFLAG, Terminal

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe

_ESCAPE = 0x1B
_PAUSE_S = 0.025  # after an escape: later bytes are a separate key
_LETTERS = {"A": "KEY_UP", "B": "KEY_DOWN", "C": "KEY_RIGHT", "D": "KEY_LEFT", "H": "KEY_HOME", "F": "KEY_END"}
_NUMBERS = {"1": "KEY_HOME", "2": "KEY_IC", "3": "KEY_DC", "4": "KEY_END", "5": "KEY_PPAGE", "6": "KEY_NPAGE"}
_FUNCTION = {"15": 5, "17": 6, "18": 7, "19": 8, "20": 9, "21": 10, "23": 11, "24": 12}
_KEY_NAMES = {number: name for name, number in vars(_curses).items() if name.startswith("KEY_")}
# fmt: off
_WITHOUT_EFFECT_ON_WINDOWS = frozenset({
    "attroff", "attron", "attrset", "bkgd", "bkgdset", "chgat", "clearok", "cursyncup", "idcok", "idlok", "immedok",
    "leaveok", "notimeout", "redrawln", "redrawwin", "scroll", "scrollok", "setscrreg", "standend", "standout",
    "syncdown", "syncok", "syncup", "touchline", "touchwin", "untouchwin",
})
# fmt: on
_NO_KEY = -1
_BLANK = " "
_CHAR_BITS = 0x1FFFFF  # of a character with its attributes
# fmt: off
_NO_EFFECT = (
    "beep", "can_change_color", "def_prog_mode", "def_shell_mode", "delay_output", "echo", "filter", "flash",
    "init_color", "init_pair", "intrflush", "meta", "mouseinterval", "mousemask", "nl", "noecho", "nonl", "noqiflush",
    "qiflush", "reset_prog_mode", "reset_shell_mode", "resetty", "resize_term", "resizeterm", "savetty",
    "set_escdelay", "set_tabsize", "setsyx", "setupterm", "start_color", "typeahead", "update_lines_cols",
    "use_default_colors", "use_env",
)
_ACS = {
    "BLOCK": "#", "BOARD": "#", "BTEE": "+", "BULLET": "o", "CKBOARD": ":", "DARROW": "v", "DEGREE": "'",
    "DIAMOND": "+", "HLINE": "-", "LANTERN": "#", "LARROW": "<", "LLCORNER": "+", "LRCORNER": "+", "LTEE": "+",
    "PLMINUS": "#", "PLUS": "+", "RARROW": ">", "RTEE": "+", "S1": "-", "S9": "_", "TTEE": "+", "UARROW": "^",
    "ULCORNER": "+", "URCORNER": "+", "VLINE": "|",
}
# fmt: on
_PAIR_SHIFT = 8  # where the number of a colour pair is in an attribute


def _sequences() -> dict[bytes, int]:
    found = {f"\x1b{lead}{letter}": name for lead in "[O" for letter, name in _LETTERS.items()}
    found |= {f"\x1b[{number}~": name for number, name in _NUMBERS.items()}
    found |= {f"\x1bO{letter}": f"KEY_F{number}" for number, letter in enumerate("PQRS", 1)}
    found |= {f"\x1b[{code}~": f"KEY_F{number}" for code, number in _FUNCTION.items()}
    numbers = {text.encode(): int(getattr(_curses, name)) for text, name in found.items()}
    return {**numbers, b"\x7f": _curses.KEY_BACKSPACE}


_SEQUENCES = _sequences()


def key_name(key: int) -> bytes:
    """`curses.keyname`: KEY_UP, KEY_F(1), ^C, a."""
    name = _KEY_NAMES.get(key)
    if name is None:
        return b"^" + bytes((key + 0x40,)) if key < ord(" ") else bytes((key,))
    is_function = name.startswith("KEY_F") and name[5:].isdigit()
    return f"KEY_F({name[5:]})".encode() if is_function else name.encode()


def read_key(terminal: Terminal, keypad: bool) -> int:
    """Return the next key of a terminal that has one ready.

    Args:
        terminal: the terminal.
        keypad: whether the sequences of special keys become one number.

    Returns:
        A byte, or one of curses.KEY_*.
    """
    typed = terminal.read(1)
    if not keypad or (typed[0] != _ESCAPE and typed not in _SEQUENCES):
        return typed[0]
    while typed not in _SEQUENCES:
        if not any(sequence.startswith(typed) for sequence in _SEQUENCES) or not terminal.wait(_PAUSE_S):
            terminal.put_back(typed[1:])
            return typed[0]
        typed += terminal.read(1)
    return _SEQUENCES[typed]


class Shown(Protocol):
    """Methods of a screen for its windows; see `cfepy.nodes.stdlib.curses_module.Screen`."""

    @property
    def terminal(self) -> Terminal: ...

    half_delay: float | None
    pushed_back: list[int]

    def put(self, top: int, left: int, rows: list[str]) -> None: ...

    def update(self) -> None: ...


class CursesWindow:
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
        self._wait: float | None = None  # seconds that getch waits, None without limit
        self.encoding = "utf-8"

    def __getattr__(self, name: str) -> Any:
        if name in _WITHOUT_EFFECT_ON_WINDOWS:
            return lambda *args: None
        raise AttributeError(f"'_curses.window' object has no attribute {name!r}")

    # -- place -------------------------------------------------------------------------------------------------------

    def getmaxyx(self) -> tuple[int, int]:
        """Height and width."""
        return len(self._cells), self._columns

    def getbegyx(self) -> tuple[int, int]:
        """Return its first row and column on the screen."""
        return self._top, self._left

    def getyx(self) -> tuple[int, int]:
        """Return where the cursor is."""
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
        """Resize the window; the part in both sizes stays."""
        rows = [[*row[:columns], *[_BLANK] * (columns - len(row))] for row in self._cells[:lines]]
        self._cells = rows + [[_BLANK] * columns for _ in range(lines - len(rows))]
        self._columns = columns

    def derwin(self, *place: int) -> CursesWindow:
        """Return a window inside this one, at `[lines, columns,] top, left` relative to this one."""
        *size, y, x = place
        lines, columns = size or (0, 0)
        inner = (lines or len(self._cells) - y, columns or self._columns - x)
        return CursesWindow(self._screen, *inner, self._top + y, self._left + x)

    def subwin(self, *place: int) -> CursesWindow:
        """As `derwin`, with the place relative to the screen."""
        *size, y, x = place
        return self.derwin(*size, y - self._top, x - self._left)

    # -- writing -----------------------------------------------------------------------------------------------------

    def addstr(self, *args: Any) -> None:
        """Write text: `[y, x,] text [, attributes]`.

        Raises:
            _curses.error: if the text does not fit; the part that fits is written, as in curses.
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
        """Insert text; the following text moves to the right."""
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
        """Return the character at `[y, x]`."""
        y, x = place or (self._y, self._x)
        return ord(self._cells[y][x])

    def instr(self, *place: int) -> bytes:
        """Return the text from the cursor on: `[y, x] [, n]`."""
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
        """Move to `y, x` if they are given; returns the text to write and the remaining arguments."""
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
        """Set whether special keys come as one number each."""
        self._keypad = bool(flag)

    def nodelay(self, flag: bool) -> None:
        """Set whether `getch` does not wait."""
        self._wait = 0.0 if flag else None

    def timeout(self, milliseconds: int) -> None:
        """Set how long `getch` waits; negative for no limit."""
        self._wait = None if milliseconds < 0 else milliseconds / 1e3

    def getch(self, *place: int) -> int:
        """Return the next key, or -1 if none comes in time. Written text is shown first."""
        screen = self._screen
        self.refresh()
        if screen.pushed_back:
            return screen.pushed_back.pop()
        if not screen.terminal.wait(self._wait if self._wait is not None else screen.half_delay):
            return _NO_KEY
        return read_key(screen.terminal, self._keypad)

    def getkey(self, *place: int) -> str:
        """Return the next key's name or character.

        Raises:
            _curses.error: none came in time.
        """
        key = self.getch(*place)
        if key == _NO_KEY:
            raise _curses.error("no input")
        return chr(key) if key < _curses.KEY_MIN else key_name(key).decode()

    def get_wch(self, *place: int) -> int | str:
        """Return the next character, or the number of a special key.

        Raises:
            _curses.error: if no key comes in time.
        """
        key = self.getch(*place)
        if key == _NO_KEY:
            raise _curses.error("no input")
        return chr(key) if key < _curses.KEY_MIN else key

    def getstr(self, *args: int) -> bytes:
        """Return the text typed up to the end of a line."""
        typed = bytearray()
        while (key := self.getch()) not in (ord("\n"), ord("\r"), _NO_KEY):
            if key < _curses.KEY_MIN:
                typed.append(key)
        return bytes(typed)


def _text_of(char: Any) -> str:
    """Return a character, however it is given."""
    if isinstance(char, int):
        return chr(char & _CHAR_BITS)
    return char.decode() if isinstance(char, bytes) else str(char)


class Screen:
    """The screen of one node, and the curses functions outside of windows.

    Args:
        universe: universe of the node.
    """

    def __init__(self, universe: Universe) -> None:
        self._universe = universe
        self._begun = self._ended = False
        self._cooked = universe.terminal.attributes() if universe.terminal is not None else []
        self._rows = [" " * COLUMNS] * ROWS
        self._shown = list(self._rows)
        self.half_delay: float | None = None
        self.pushed_back: list[int] = []

    def begin(self) -> CursesWindow:
        """`initscr`.

        Raises:
            _curses.error: the node has no terminal.
        """
        if self._universe.terminal is None:
            raise _curses.error("could not find terminal")
        self._begun = True
        return self.window(ROWS, COLUMNS)

    @property
    def terminal(self) -> Terminal:
        """Where keys come from.

        Raises:
            _curses.error: before `initscr`.
        """
        if not self._begun or self._universe.terminal is None:
            raise _curses.error("must call initscr() first")
        return self._universe.terminal

    def window(self, nlines: int, ncols: int, begin_y: int = 0, begin_x: int = 0) -> CursesWindow:
        """`newwin` and `newpad`."""
        return CursesWindow(self, nlines or ROWS - begin_y, ncols or COLUMNS - begin_x, begin_y, begin_x)

    def put(self, top: int, left: int, rows: list[str]) -> None:
        """Lay a window's rows over the screen, to be shown by the next `update`."""
        for at, row in enumerate(rows, top):
            if 0 <= at < ROWS:
                under = self._rows[at]
                self._rows[at] = (under[:left] + row + under[left + len(row) :])[:COLUMNS]

    def update(self) -> None:
        """`doupdate`: print the rows that changed since they were last printed."""
        for row, shown in zip(self._rows, self._shown, strict=True):
            if row != shown:
                self._universe.stdout.write(f"{row.rstrip()}\n")
        self._shown = list(self._rows)
        self._universe.charge()

    def cbreak(self, flag: bool = True) -> None:
        """Make each key readable at once; Ctrl-C is still a signal."""
        self._set_mode(not flag, signals=True)

    def raw(self, flag: bool = True) -> None:
        """Make each key readable at once, including Ctrl-C."""
        self._set_mode(not flag, signals=not flag)

    def half_delay_of(self, tenths: int) -> None:
        """`halfdelay`: as `cbreak`, with a limit for `getch` in tenths of a second."""
        self.half_delay = tenths / 10
        self.cbreak()

    def cooked(self) -> None:
        """`nocbreak` and `noraw`."""
        self.half_delay = None
        self._set_mode(canonical=True, signals=True)

    def end(self) -> None:
        """`endwin`: the terminal is as it was."""
        self._ended = True
        self.terminal.set_attributes(self._cooked)

    def is_ended(self) -> bool:
        """`isendwin`."""
        return self._ended

    def unget(self, key: int | str) -> None:
        """`ungetch`: the next `getch` gives this key."""
        self.pushed_back.append(key if isinstance(key, int) else ord(key))

    def _set_mode(self, canonical: bool, signals: bool) -> None:
        attributes = self.terminal.attributes()
        wanted = (termios.ICANON if canonical else 0) | (termios.ISIG if signals else 0)
        attributes[LFLAG] = attributes[LFLAG] & ~(termios.ICANON | termios.ISIG) | wanted
        self.terminal.set_attributes(attributes)


def curses_module(universe: Universe) -> ModuleType:
    """Return the module `_curses` of a universe."""
    screen = Screen(universe)
    names: dict[str, Any] = {name: _nothing for name in _NO_EFFECT if hasattr(_curses, name)}
    names.update({f"ACS_{name}": ord(char) for name, char in _ACS.items()})
    return proxy(
        _curses,
        **names,
        COLORS=8,
        COLOR_PAIRS=64,
        COLS=COLUMNS,
        LINES=ROWS,
        cbreak=screen.cbreak,
        color_pair=lambda number: number << _PAIR_SHIFT,
        curs_set=lambda visible: 1,
        doupdate=screen.update,
        endwin=screen.end,
        flushinp=lambda: screen.terminal.flush(),
        halfdelay=screen.half_delay_of,
        has_colors=lambda: True,
        initscr=screen.begin,
        isendwin=screen.is_ended,
        keyname=key_name,
        longname=lambda: b"a terminal of cfepy",
        napms=lambda milliseconds: universe.clock.wait(milliseconds / 1e3),
        newpad=screen.window,
        newwin=screen.window,
        nocbreak=screen.cooked,
        noraw=screen.cooked,
        pair_number=lambda attribute: attribute >> _PAIR_SHIFT & 0xFF,
        raw=screen.raw,
        termname=lambda: b"cfepy",
        ungetch=screen.unget,
        window=CursesWindow,
    )


def _nothing(*args: Any, **options: Any) -> None:
    """Accept the call without visible effect."""
