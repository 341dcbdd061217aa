"""The declaration of functions of POSIX, which give -1 and set errno where Python raises `OSError`."""

from __future__ import annotations

import errno
from collections.abc import Callable
from functools import wraps
from typing import TYPE_CHECKING

from cfepy.extra.c.arena import PAGE

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

FAILED = -1


class PosixCalls:
    """Adds functions to the API.

    Args:
        api: receives them.
        c: the C side of the processor.
    """

    def __init__(self, api: Declarations, c: CRuntime) -> None:
        self._api = api
        self._c = c

    def add(self, names: str, signature: str, function: Callable[..., object], failed: int = FAILED) -> None:
        """Declare a function.

        Args:
            names: its names, separated by spaces.
            signature: as for `Declarations.add`.
            function: may raise OSError.
            failed: the result after an error, and for a NULL pointer where it is not allowed (EFAULT).
        """

        @wraps(function)
        def call(*arguments: object) -> object:
            try:
                return function(*arguments)
            except OSError as error:
                self.set_errno(error.errno or errno.EIO)
                return failed

        for name in names.split():
            self._api.add(name, signature, call, failed, self._on_null)

    def set_errno(self, number: int) -> None:
        """Set errno of the current task."""
        self._c.memory.put_u32(self._c.thread_locals.errno(), number)

    def _on_null(self, *arguments: int) -> None:
        self.set_errno(errno.EFAULT)


class Slots:
    """Blocks of one size in the arena, whose addresses are the same in each run.

    Args:
        c: the C side of the processor.
        size: bytes of a block; a divisor of a page.
    """

    def __init__(self, c: CRuntime, size: int) -> None:
        self._c = c
        self._size = size
        self._free: list[int] = []

    def take(self) -> int:
        """Return the address of a block of zeros."""
        if not self._free:
            page = self._c.arena.map(PAGE)
            self._free.extend(range(page + PAGE - self._size, page - 1, -self._size))
        address = self._free.pop()
        self._c.memory.poke(address, bytes(self._size))
        return address

    def give(self, address: int) -> None:
        """Take a block back."""
        self._free.append(address)
