"""`_curses` of a node: the screen library on the node's terminal, below the standard library's own `curses`.

Constants are the host's. What a node draws is kept in windows; `refresh` prints the rows of the screen that changed as
lines of the node, so that a log shows what somebody at the terminal would have seen.
"""

from __future__ import annotations

import _curses
import termios
from types import ModuleType
from typing import TYPE_CHECKING, Any

from cfepy.nodes.curses_keys import key_name
from cfepy.nodes.curses_window import Window
from cfepy.nodes.streams import COLUMNS, ROWS
from cfepy.nodes.synth import proxy
from cfepy.nodes.terminal import LFLAG, Terminal

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe

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


class Screen:
    """The screen of one node, and the functions of curses that are not a window's.

    Args:
        universe: the node's.
    """

    def __init__(self, universe: Universe) -> None:
        self._universe = universe
        self._begun = self._ended = False
        self._cooked = universe.terminal.attributes() if universe.terminal is not None else []
        self._rows = [" " * COLUMNS] * ROWS
        self._shown = list(self._rows)
        self.half_delay: float | None = None
        self.pushed_back: list[int] = []

    def begin(self) -> Window:
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

    def window(self, nlines: int, ncols: int, begin_y: int = 0, begin_x: int = 0) -> Window:
        """`newwin` and `newpad`."""
        return Window(self, nlines or ROWS - begin_y, ncols or COLUMNS - begin_x, begin_y, begin_x)

    def put(self, top: int, left: int, rows: list[str]) -> None:
        """Lay a window's rows over the screen, to be shown by the next `update`."""
        for at, row in enumerate(rows, top):
            if 0 <= at < ROWS:
                under = self._rows[at]
                self._rows[at] = (under[:left] + row + under[left + len(row) :])[:COLUMNS]

    def update(self) -> None:
        """`doupdate`: print the rows that have changed since they were last printed."""
        for row, shown in zip(self._rows, self._shown, strict=True):
            if row != shown:
                self._universe.stdout.write(f"{row.rstrip()}\n")
        self._shown = list(self._rows)
        self._universe.charge()

    def cbreak(self, flag: bool = True) -> None:
        """Each key can be read at once; Ctrl-C still is a signal."""
        self._set_mode(not flag, signals=True)

    def raw(self, flag: bool = True) -> None:
        """Each key can be read at once, Ctrl-C as well."""
        self._set_mode(not flag, signals=not flag)

    def half_delay_of(self, tenths: int) -> None:
        """`halfdelay`: as `cbreak`, and `getch` gives up after so many tenths of a second."""
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
    """The module `_curses` of a universe."""
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
        window=Window,
    )


def _nothing(*args: Any, **options: Any) -> None:
    """What changes nothing that can be seen here."""
