"""Keys as curses tells them: one number for an arrow or function key, though a terminal sends several bytes for it."""

from __future__ import annotations

import _curses

from cfepy.nodes.terminal import Terminal

_ESCAPE = 0x1B
_PAUSE_S = 0.025  # after an escape: what follows later is a key of its own

_LETTERS = {"A": "KEY_UP", "B": "KEY_DOWN", "C": "KEY_RIGHT", "D": "KEY_LEFT", "H": "KEY_HOME", "F": "KEY_END"}
_NUMBERS = {"1": "KEY_HOME", "2": "KEY_IC", "3": "KEY_DC", "4": "KEY_END", "5": "KEY_PPAGE", "6": "KEY_NPAGE"}
_FUNCTION = {"15": 5, "17": 6, "18": 7, "19": 8, "20": 9, "21": 10, "23": 11, "24": 12}


def _sequences() -> dict[bytes, int]:
    found = {f"\x1b{lead}{letter}": name for lead in "[O" for letter, name in _LETTERS.items()}
    found |= {f"\x1b[{number}~": name for number, name in _NUMBERS.items()}
    found |= {f"\x1bO{letter}": f"KEY_F{number}" for number, letter in enumerate("PQRS", 1)}
    found |= {f"\x1b[{code}~": f"KEY_F{number}" for code, number in _FUNCTION.items()}
    numbers = {text.encode(): int(getattr(_curses, name)) for text, name in found.items()}
    return {**numbers, b"\x7f": _curses.KEY_BACKSPACE}


_SEQUENCES = _sequences()
_KEY_NAMES = {number: name for name, number in vars(_curses).items() if name.startswith("KEY_")}


def key_name(key: int) -> bytes:
    """`curses.keyname`: KEY_UP, KEY_F(1), ^C, a."""
    name = _KEY_NAMES.get(key)
    if name is None:
        return b"^" + bytes((key + 0x40,)) if key < ord(" ") else bytes((key,))
    is_function = name.startswith("KEY_F") and name[5:].isdigit()
    return f"KEY_F({name[5:]})".encode() if is_function else name.encode()


def read_key(terminal: Terminal, keypad: bool) -> int:
    """The next key of a terminal that has one ready.

    Args:
        terminal: where it is typed.
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
