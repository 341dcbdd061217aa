"""Stacks for C code, each with an inaccessible page below."""

from __future__ import annotations

from cfepy.extra.c.arena import PAGE, Arena, pages
from cfepy.extra.c.engine import engine

LEAST = 16384
"""PTHREAD_STACK_MIN: the smallest stack that OSAL on Linux gives a task."""


class Stacks:
    """Stacks of an arena. A returned stack is zeroed, so that a task finds the same contents each time.

    Args:
        arena: memory for them.
        poison: a byte that they are filled with before use; none for zeros.
    """

    def __init__(self, arena: Arena, poison: bytes = b"") -> None:
        self._arena = arena
        self._poison = poison
        self._free: dict[int, list[int]] = {}

    def take(self, size: int) -> tuple[int, int]:
        """Return a stack of at least `size` bytes: lowest address, bytes."""
        room = pages(max(size, LEAST))
        free = self._free.setdefault(room, [])
        if free:
            stack = free.pop()
        else:
            below = self._arena.map(room + PAGE)
            engine().protect(below, PAGE, 0)
            stack = below + PAGE
        if self._poison:
            engine().poke(stack, self._poison * room)
        return stack, room

    def used(self, stack: int, size: int) -> int:
        """Return how many bytes of a stack were written, from its top down, as a painted stack shows on a board.

        Args:
            stack: its lowest address.
            size: its bytes, as `take` gave them.
        """
        return len(engine().peek(stack, size).lstrip(self._poison or b"\0"))

    def give(self, stack: int, size: int) -> None:
        """Give a stack back."""
        engine().clear(stack, size)
        self._free[size].append(stack)
