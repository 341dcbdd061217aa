"""Lists whose items are decoded when they are read, so that a look at the last message of a long run decodes only that.

`DecodingList` remembers the items of a growing list. A caller gets `OnDemand`: the items that existed at its
request, which compares as a list does.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any, Generic, TypeVar, overload

T = TypeVar("T")


class DecodingList(Generic[T]):
    """The items of a growing list, each decoded at most once.

    Args:
        raw: the list, which others extend.
        read: decodes one of its items.
    """

    __slots__ = ("_first", "_read", "_single", "raw")

    def __init__(self, raw: Sequence[Any], read: Callable[[Any], T]) -> None:
        self.raw = raw
        self._read = read
        self._first: list[T] = []  # all items up to an index
        self._single: dict[int, T] = {}  # items after it

    def at(self, index: int) -> T:
        """Return an item, counted from 0."""
        first = self._first
        if index < len(first):
            return first[index]
        found = self._single[index] if index in self._single else self._read(self.raw[index])
        if index == len(first):
            first.append(found)
            self._single.pop(index, None)
        else:
            self._single[index] = found
        return found

    def present(self) -> OnDemand[T]:
        """Return the items that exist now."""
        return OnDemand(self, len(self.raw))


class OnDemand(Sequence[T]):
    """The first items of a growing list, decoded when they are read; a slice of it is a list.

    Args:
        decoded: the growing list.
        count: number of the items.
    """

    __slots__ = ("_count", "_decoded")
    __hash__ = None  # type: ignore[assignment]  # it compares by its items, as a list

    def __init__(self, decoded: DecodingList[T], count: int) -> None:
        self._decoded, self._count = decoded, count

    def __len__(self) -> int:
        return self._count

    @overload
    def __getitem__(self, index: int) -> T: ...
    @overload
    def __getitem__(self, index: slice) -> list[T]: ...
    def __getitem__(self, index: int | slice) -> T | list[T]:
        if isinstance(index, slice):
            return [self._decoded.at(each) for each in range(*index.indices(self._count))]
        at = index + self._count if index < 0 else index
        if not 0 <= at < self._count:
            raise IndexError(f"index {index} is outside of {self._count} items")
        return self._decoded.at(at)

    def __iter__(self) -> Iterator[T]:
        return map(self._decoded.at, range(self._count))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, list | tuple | OnDemand):
            return NotImplemented
        return len(self) == len(other) and all(ours == theirs for ours, theirs in zip(self, other, strict=True))

    def __add__(self, other: Sequence[T]) -> list[T]:
        return [*self, *other]

    def __radd__(self, other: Sequence[T]) -> list[T]:
        return [*other, *self]

    def __repr__(self) -> str:
        return repr(list(self))
