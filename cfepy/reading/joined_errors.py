"""Several errors in one `UsageError`: the first one, with the further ones in `others`."""

from __future__ import annotations

from collections.abc import Sequence

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
    return _with_others(first, tuple(others))


def alone(error: UsageError) -> tuple[UsageError, ...]:
    """Return an error and its further ones, each without the others."""
    if not error.others:
        return (error,)
    return (_with_others(error, ()), *error.others)


def _with_others(error: UsageError, others: tuple[UsageError, ...]) -> UsageError:
    """Return a copy of an error with other further ones.

    `copy.copy` is not used: libraries such as tblib, which Dask loads, change it for exceptions.
    """
    found = type(error).__new__(type(error), *error.args)
    found.__dict__.update(error.__dict__)
    found.others = others
    return found


def placed(error: UsageError, *, file: object | None = None, line: int | None = None) -> UsageError:
    """Return an error, and its further ones, with a place in a file.

    Args:
        error: the error; its own file and lines are replaced.
        file: the file.
        line: the line, from 1.
    """
    return together([UsageError(each.text, file=file, line=line, field=each.field) for each in error.each])
