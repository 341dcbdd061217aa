"""What a terminal would obey, as text: `\\x1b` in place of the character ESC.

A name or a text of a file, a mission or a peer may hold characters that move the cursor, set the title of a window,
hide what stands beside them or turn its order round. All that cfepy prints comes through here: `safe_output` puts a
`SafeStream` in the place of standard output and standard error, and `rich_console` makes consoles of rich. What goes
past them, such as data for another program, takes `raw` or `for_data`; tests/test_layers.py has the list of the places.

Colours are the one exception, and only for the lines that nodes print, as roslaunch shows them (`console_line`).
"""

from __future__ import annotations

import contextlib
import re
import sys
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any, TextIO, cast

if TYPE_CHECKING:
    from rich.console import Console as RichConsole

_ALWAYS = "\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f"  # C0, DEL and C1 but for tab, newline and carriage return
_ORDER = "\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069"  # turn the order of text round (UAX 9)
_BREAKS = "\u2028\u2029"  # lines and paragraphs end there, for some
_BYTES = "\ud800-\udfff"  # no characters: Python's form of bytes that are not text, in the name of a file (PEP 383)
_IN_TEXT = re.compile(f"[{_ALWAYS}{_ORDER}{_BREAKS}{_BYTES}]|\r(?!\n)")
_IN_LINE = re.compile(f"[{_ALWAYS}{_ORDER}{_BREAKS}{_BYTES}\t\n\r]")
_SHORT = {"\t": "\\t", "\n": "\\n", "\r": "\\r"}
_COLOUR = re.compile(r"\x1b\[[\d;]*m")  # Select Graphic Rendition (ECMA-48)
_ENDS_COLOUR = re.compile(r"\x1b\[0*m")
_OF_NODE = re.compile(r"(?:[^\s:]+: )?\[[\w/]+\] ")  # how lines of nodes begin, after the name of another mission


def _written(found: re.Match[str]) -> str:
    code = ord(found[0])
    code -= 0xDC00 if 0xDC80 <= code <= 0xDCFF else 0
    return _SHORT.get(found[0]) or (f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}")


def visible(text: str) -> str:
    """A text of one or several lines, with each control character as an escape such as `\\x1b`."""
    return _IN_TEXT.sub(_written, text)


def visible_line(text: object) -> str:
    """What is one line, such as a name: newlines and tabs are escapes, too."""
    return _IN_LINE.sub(_written, str(text))


def node_text(text: str, colours: bool) -> str:
    """A line of a node as `visible` shows it, except for its colours.

    Args:
        text: the line, without the name of its node.
        colours: keep them, and end them with the line; False leaves them out, for what is no terminal.
    """
    if "\x1b" not in text:
        return visible(text)
    last = ""
    pieces, at = [], 0
    for found in _COLOUR.finditer(text):
        pieces.append(visible(text[at : found.start()]))
        if colours:
            last = found[0]
            pieces.append(last)
        at = found.end()
    pieces.append(visible(text[at:]))
    if last and not _ENDS_COLOUR.fullmatch(last):
        pieces.append("\x1b[0m")
    return "".join(pieces)


def console_line(line: str, colours: bool) -> str:
    """A line of a mission's console, as it is shown; only what nodes print may have colours.

    Args:
        line: the line, without its end.
        colours: see `node_text`.
    """
    line = line.removesuffix("\r")
    return node_text(line, colours) if _OF_NODE.match(line) else visible(line)


class SafeStream:
    """A stream of text that writes control characters as escapes.

    Args:
        stream: where to.

    Attributes:
        raw: the stream itself, which writes all as it comes.
    """

    def __init__(self, stream: TextIO) -> None:
        self.raw = stream

    def write(self, text: str) -> int:
        """Write a text; how long it was."""
        self.raw.write(visible(text))
        return len(text)

    def writelines(self, lines: Iterable[str]) -> None:
        """Write texts."""
        for line in lines:
            self.write(line)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.raw, name)


def safe(stream: TextIO) -> TextIO:
    """The stream, such that it writes control characters as escapes."""
    return stream if isinstance(stream, SafeStream) else cast("TextIO", SafeStream(stream))


def raw(stream: TextIO) -> TextIO:
    """The stream behind a safe one; any other one as it is."""
    return stream.raw if isinstance(stream, SafeStream) else stream


def for_data(stream: TextIO) -> TextIO:
    """The stream for data that another program reads: as it is, unless it is a terminal."""
    return stream if stream.isatty() else raw(stream)


def keep_output_safe() -> None:
    """Make standard output and standard error safe again, after something such as a bar of rich has replaced them."""
    sys.stdout, sys.stderr = safe(sys.stdout), safe(sys.stderr)


@contextlib.contextmanager
def safe_output() -> Iterator[None]:
    """Around a command: what it prints on standard output and standard error has no control characters."""
    before = sys.stdout, sys.stderr
    keep_output_safe()
    mine = sys.stdout, sys.stderr
    try:
        yield
    finally:
        if sys.stdout is mine[0]:
            sys.stdout = before[0]
        if sys.stderr is mine[1]:
            sys.stderr = before[1]


def rich_console(stream: TextIO, **options: Any) -> RichConsole:
    """A console of rich on a stream: its own colours and movements pass, control characters in texts do not."""
    from rich.console import Console, ConsoleOptions, RenderableType
    from rich.segment import Segment

    class SafeConsole(Console):
        def render(self, renderable: RenderableType, options: ConsoleOptions | None = None) -> Iterable[Segment]:
            for each in super().render(renderable, options):
                if each.control is None and _IN_TEXT.search(each.text):
                    yield Segment(visible(each.text), each.style)
                else:
                    yield each

    return SafeConsole(file=raw(stream), **options)
