"""What C code prints: OS_printf, printf and their kin, onto the console of the mission."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from cfepy.texts import to_bytes

if TYPE_CHECKING:
    from cfepy.c.calls import Declarations
    from cfepy.c.runtime import CRuntime


class Printer:
    """The standard output of C code: lines are shown when they are whole.

    Args:
        show: gets them.
    """

    def __init__(self, show: Callable[[str], object]) -> None:
        self._show = show
        self._rest = ""

    def write(self, text: str) -> int:
        """Print a text (printf); its bytes."""
        *lines, self._rest = (self._rest + text).split("\n")
        for line in lines:
            self._show(line)
        return len(to_bytes(text))

    def put_line(self, text: str) -> int:
        """Print a text and a newline (puts)."""
        return self.write(text + "\n")

    def put_character(self, code: int) -> int:
        """Print a character (putchar)."""
        self.write(bytes([code & 0xFF]).decode("utf-8", "surrogateescape"))
        return code & 0xFF


def declare(api: Declarations, c: CRuntime) -> None:
    """Add the functions; see `cfepy.c.api`."""
    printer = Printer(c.console.write)
    api.add("OS_printf", "f", c.handle.os.printf_piece)
    api.add("OS_printf_disable", "", c.handle.os.printf_disable)
    api.add("OS_printf_enable", "", c.handle.os.printf_enable)
    api.add("printf", "f", printer.write)
    api.add("__printf_chk", "-f", printer.write)
    api.add("puts", "S", printer.put_line)
    api.add("putchar", "i", printer.put_character)
