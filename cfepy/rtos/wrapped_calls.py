"""Classes of kernel with calls that are wrapped, for what looks on at a run or disturbs it.

A kernel is made of the class that all who look on at its run have derived, one from another; a run that nobody looks on
at has the plain class, and pays nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from cfepy.rtos.kernel import Kernel

Call = Callable[..., Any]
"""A method of a kernel, which it gets as the first argument."""


def wrapping(base: type[Kernel], wraps: Mapping[str, Callable[[Call], Call]]) -> type[Kernel]:
    """A class of kernel with calls that are wrapped.

    Args:
        base: the class to start from.
        wraps: by the name of a call, what makes the new one; it gets that of `base`.
    """
    return type("WrappingKernel", (base,), {name: wrap(getattr(base, name)) for name, wrap in wraps.items()})
