"""Collecting the mistakes of a file or a command, so that its user sees all of them at once.

A reader gets a `Mistakes`, adds each mistake that does not keep it from reading on, and returns what it could read.
`cfepy check` lists the collected mistakes. A run uses `collected`, which raises them together: a `UsageError` for the
first one with all further ones in `others`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from copy import copy
from typing import TYPE_CHECKING, TypeVar

from cfepy.status import UsageError

if TYPE_CHECKING:
    from cfepy.reading.marked_yaml import Marked

T = TypeVar("T")


class Mistakes:
    """Mistakes of what is being read.

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
        self.errors += inner.errors
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
        UsageError: all its mistakes together, those of one file by line.
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
    return collected(lambda mistakes: [mistakes.attempt(read) for read in reads])  # type: ignore[misc]  # or it raises


def together(errors: Sequence[UsageError]) -> UsageError:
    """Return one error for several mistakes: the first one with the others in it.

    Args:
        errors: the mistakes, at least one. Those of one file are sorted by line.
    """
    apart = [each for error in errors for each in alone(error)]
    if len(apart) == 1:
        return apart[0]
    files = list(dict.fromkeys(each.file for each in apart))
    first, *others = sorted(apart, key=lambda each: (files.index(each.file), each.line or 0))
    found = copy(first)  # of its own class
    found.others = tuple(others)
    return found


def alone(error: UsageError) -> tuple[UsageError, ...]:
    """Return an error and its further ones, each without the others."""
    if not error.others:
        return (error,)
    first = copy(error)
    first.others = ()
    return (first, *error.others)


def placed(error: UsageError, *, file: object | None = None, line: int | None = None) -> UsageError:
    """Return an error, and its further ones, with a place in a file.

    Args:
        error: the error; its own file and lines are replaced.
        file: the file.
        line: the line, from 1.
    """
    return together([UsageError(each.text, file=file, line=line, field=each.field) for each in error.each])
