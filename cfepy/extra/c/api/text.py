"""OS_printf, printf and related functions: printing onto the console of the mission."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.extra.c.api.streams import STDOUT
from cfepy.reading.texts import to_bytes

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime


def declare(api: Declarations, c: CRuntime) -> None:
    def write(text: str) -> int:
        return c.streams.write(STDOUT, to_bytes(text))

    def put_character(code: int) -> int:
        c.streams.write(STDOUT, bytes([code & 0xFF]))
        return code & 0xFF

    api.add("OS_printf", "f", c.handle.os.printf_piece)
    api.add("OS_printf_disable", "", c.handle.os.printf_disable)
    api.add("OS_printf_enable", "", c.handle.os.printf_enable)
    api.add("printf", "f", write)
    api.add("__printf_chk", "-f", write)
    api.add("puts", "S", lambda text: write(text + "\n"))
    api.add("putchar", "i", put_character)
