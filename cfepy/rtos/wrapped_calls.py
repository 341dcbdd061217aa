"""Kernel classes with wrapped calls, for attachments that observe or disturb a run.

A kernel's class is derived from the classes of all attachments, one from another. A run without attachments has the
plain class and pays nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from cfepy.rtos.kernel import Kernel

Call = Callable[..., Any]
"""A method of a kernel; its first argument is the kernel."""


def wrapping(base: type[Kernel], wraps: Mapping[str, Callable[[Call], Call]]) -> type[Kernel]:
    """Return a kernel class with wrapped calls.

    Args:
        base: the class to derive from.
        wraps: for each call name, a function that gets the method of `base` and returns the new one.
    """
    return type("WrappingKernel", (base,), {name: wrap(getattr(base, name)) for name, wrap in wraps.items()})
