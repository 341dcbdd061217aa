"""Collecting the mistakes in a file or a command, so that its user sees all of them at once.

A reader gets a `Mistakes`, adds each mistake that does not keep it from reading on, and returns the rest of the file.
`cfepy check` lists the collected mistakes. A run uses `collected`, which raises them together: a `UsageError` for the
first one with all further ones in `others`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import TypeVar

from cfepy.reading.marked_yaml import Marked
from cfepy.status import UsageError, alone, together

T = TypeVar("T")


class Mistakes:
    """Collector of the mistakes in a file or a command.

    Attributes:
        errors: the mistakes, each alone.
    """

    def __init__(self) -> None:
        self.errors: list[UsageError] = []

    def add(self, error: UsageError) -> None:
        """Add a mistake, with the further ones in it."""
        self.errors += alone(error)

    def attempt(self, read: Callable[[], T]) -> T | None:
        """Return the result of `read`, or None if it fails, and add its mistake."""
        try:
            return read()
        except UsageError as error:
            self.add(error)
            return None

    def whole(self, read: Callable[[Mistakes], T]) -> T | None:
        """Return the result of `read`, or None if it adds or raises a mistake.

        Args:
            read: reads one entry. It adds mistakes of independent parts, and raises one that keeps it from reading on.
        """
        inner = Mistakes()
        found = inner.attempt(lambda: read(inner))
        for error in inner.errors:
            self.add(error)
        return None if inner.errors else found

    def mapping(self, entry: Marked) -> dict[str, Marked]:
        """Return a value as a mapping with any keys, or an empty one if it is not a mapping, and add that mistake."""
        return self.attempt(entry.mapping) or {}

    def fields(self, entry: Marked, known: Iterable[str]) -> Iterator[tuple[str, Marked]]:
        """Yield the known keys of a mapping with their values, and add unknown keys as mistakes."""
        allowed = tuple(known)
        for name, item in self.mapping(entry).items():
            if name in allowed:
                yield name, item
            else:
                self.add(item.unknown(name, allowed))

    def items(self, entry: Marked) -> list[Marked]:
        """Return a value as a list, or an empty one if it is not a list, and add that mistake."""
        return self.attempt(entry.items) or []


class FirstMistake(Mistakes):
    """Ends the reading at the first mistake, as roslaunch does: `add` raises it."""

    def add(self, error: UsageError) -> None:
        """Raise a mistake."""
        raise error


def collected(read: Callable[[Mistakes], T]) -> T:
    """Return the result of a reader that collects mistakes.

    Args:
        read: the reader.

    Raises:
        UsageError: all its mistakes together, sorted by line in each file.
    """
    mistakes = Mistakes()
    try:
        found = read(mistakes)
    except UsageError as error:
        mistakes.add(error)
        raise together(mistakes.errors) from None
    if mistakes.errors:
        raise together(mistakes.errors)
    return found


def each_of(reads: Iterable[Callable[[], T]]) -> list[T]:
    """Return the results of readers of independent parts.

    Args:
        reads: the readers.

    Raises:
        UsageError: all their mistakes together.
    """

    def collect(mistakes: Mistakes) -> list[T]:
        found: list[T] = []
        for read in reads:
            try:
                found.append(read())
            except UsageError as error:
                mistakes.add(error)
        return found

    return collected(collect)
