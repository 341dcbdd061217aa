"""strerror, perror and related functions: the texts of errno, in the locale C."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.extra.c.api.streams import STDERR
from cfepy.extra.c.engine import engine

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

LONGEST = 64
"""Bytes of the longest text, with its NUL."""


def declare(api: Declarations, c: CRuntime) -> None:
    rooms: list[int] = []

    def text_of(number: int) -> int:
        """Return the address of a text; the text of an unknown error stays until the next one."""
        text, is_known = engine().error_text(number)
        if is_known:
            return c.constants.text(text)
        rooms[:] = rooms or [c.arena.map(LONGEST)]
        c.memory.put_text(rooms[0], text, LONGEST)
        return rooms[0]

    def text_or_copy(number: int, to: int, size: int) -> int:
        """Return the address of a text, or, for an unknown error, copy the text (GNU's strerror_r)."""
        text, is_known = engine().error_text(number)
        if is_known:
            return c.constants.text(text)
        if size:
            c.memory.poke(to, text.encode()[: size - 1] + b"\0")
        return to

    def print_error(what: str | None) -> None:
        text, _ = engine().error_text(c.memory.u32(c.thread_locals.errno()))
        c.streams.write(STDERR, f"{what + ': ' if what else ''}{text}\n".encode(errors="surrogateescape"))

    api.add("strerror", "i", text_of)
    api.add("strerror_l", "i-", text_of)
    api.add("strerror_r", "ipQ", text_or_copy)
    api.add("perror", "s", print_error)
