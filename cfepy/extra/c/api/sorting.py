"""qsort, qsort_r and bsearch of libc, with a comparison in C.

Items do not move during the comparisons; they are put in order afterwards. Equal items keep their order, as with
glibc's merge sort.
"""

from __future__ import annotations

from functools import cmp_to_key
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime


def declare(api: Declarations, c: CRuntime) -> None:
    memory = c.memory

    def sort(base: int, count: int, size: int, compare: int, *more: int) -> None:
        if count < 2 or size == 0:
            return

        def order_of(first: int, second: int) -> int:
            return c.status(compare, first, second, *more)

        order = sorted(range(base, base + count * size, size), key=cmp_to_key(order_of))
        items = memory.peek(base, count * size)
        memory.poke(base, b"".join(items[at - base : at - base + size] for at in order))

    def search(key: int, base: int, count: int, size: int, compare: int) -> int:
        low, high = 0, count
        while low < high:
            middle = (low + high) // 2
            at = base + middle * size
            order = c.status(compare, key, at)
            if order == 0:
                return at
            low, high = (low, middle) if order < 0 else (middle + 1, high)
        return 0

    api.add("qsort", "pQQp", sort)
    api.add("qsort_r", "pQQpp", sort)
    api.add("bsearch", "ppQQp", search)
