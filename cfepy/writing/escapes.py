"""Control characters as visible text: `\\x1b` in place of the character ESC.

A name or a text from a file, a mission or a peer may have characters that move the cursor, set the title of a window,
hide nearby text or reverse its order. All output of cfepy is escaped here. `safe_output` replaces standard output and
standard error with a `SafeStream`, and `rich_console` makes consoles of rich. Output that must bypass them, such as
data for another program, uses `raw` or `for_data`; tests/test_layers.py lists these places.

The only exception is colour in lines that nodes print, as in roslaunch (`console_line`).
"""

from __future__ import annotations

import contextlib
import re
import sys
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any, TextIO, cast

if TYPE_CHECKING:
    from rich.console import Console as RichConsole

_ALWAYS = "\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f"  # C0, DEL and C1, except tab, newline and carriage return
_ORDER = "\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069"  # these change the direction of text (UAX 9)
_BREAKS = "\u2028\u2029"  # some programs end lines and paragraphs there
_BYTES = "\ud800-\udfff"  # Python's form of bytes that are not text, in file names (PEP 383)
_IN_TEXT = re.compile(f"[{_ALWAYS}{_ORDER}{_BREAKS}{_BYTES}]|\r(?!\n)")
_IN_LINE = re.compile(f"[{_ALWAYS}{_ORDER}{_BREAKS}{_BYTES}\t\n\r]")
_SHORT = {"\t": "\\t", "\n": "\\n", "\r": "\\r"}
_COLOUR = re.compile(r"\x1b\[[\d;]*m")  # Select Graphic Rendition (ECMA-48)
_ENDS_COLOUR = re.compile(r"\x1b\[0*m")
_OF_NODE = re.compile(r"(?:[^\s:]+: )?\[[\w/]+\] ")  # the beginning of a node's line, after the name of another mission


def _written(found: re.Match[str]) -> str:
    code = ord(found[0])
    code -= 0xDC00 if 0xDC80 <= code <= 0xDCFF else 0
    return _SHORT.get(found[0]) or (f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}")


def visible(text: str) -> str:
    """Return a text of one or several lines, with each control character as an escape such as `\\x1b`."""
    return _IN_TEXT.sub(_written, text)


def visible_line(text: object) -> str:
    """Return the text of a single line, such as a name, with newlines and tabs escaped too."""
    return _IN_LINE.sub(_written, str(text))


def node_text(text: str, colours: bool) -> str:
    """Return a line of a node as `visible` shows it, except for its colours.

    Args:
        text: the line, without the name of its node.
        colours: keep colours and reset them at the end of the line; False removes them, if the output is not a
            terminal.
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
    """Return a line of a mission's console in printable form; only lines of nodes may have colours.

    Args:
        line: the line, without its end.
        colours: see `node_text`.
    """
    line = line.removesuffix("\r")
    return node_text(line, colours) if _OF_NODE.match(line) else visible(line)


class SafeStream:
    """A stream of text that writes control characters as escapes.

    Args:
        stream: the stream to write to.

    Attributes:
        raw: the stream itself, which writes text unchanged.
    """

    def __init__(self, stream: TextIO) -> None:
        self.raw = stream

    def write(self, text: str) -> int:
        """Write a text with control characters escaped; return its length."""
        self.raw.write(visible(text))
        return len(text)

    def writelines(self, lines: Iterable[str]) -> None:
        """Write several texts."""
        for line in lines:
            self.write(line)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.raw, name)


def safe(stream: TextIO) -> TextIO:
    """Return the streamor a wrapper that writes control characters as escapes."""
    return stream if isinstance(stream, SafeStream) else cast("TextIO", SafeStream(stream))


def raw(stream: TextIO) -> TextIO:
    """Return the stream behind a safe stream, or the stream itself."""
    return stream.raw if isinstance(stream, SafeStream) else stream


def for_data(stream: TextIO) -> TextIO:
    """Return the stream for data that another program reads: unescaped, unless the stream is a terminal."""
    return stream if stream.isatty() else raw(stream)


def keep_output_safe() -> None:
    """Make standard output and standard error safe again, for example after a rich progress bar has replaced them."""
    sys.stdout, sys.stderr = safe(sys.stdout), safe(sys.stderr)


@contextlib.contextmanager
def safe_output() -> Iterator[None]:
    """Escape control characters in the output of a command; a context manager."""
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
    """Return a console of rich on a stream; it keeps rich's own control sequences and escapes those in texts."""
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
