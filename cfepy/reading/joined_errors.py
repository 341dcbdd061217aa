"""Several errors in one `UsageError`: the first one, with the further ones in `others`."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy

from cfepy.status import UsageError


def together(errors: Sequence[UsageError]) -> UsageError:
    """Return one error for several mistakes: the first one with the others in it.

    Args:
        errors: the mistakes, at least one. In each file they are sorted by line.
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
