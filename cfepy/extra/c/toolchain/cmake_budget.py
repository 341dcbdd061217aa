"""Limits for the files of CMake's language, which may come from any source, and the search for files within them."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from fnmatch import fnmatchcase
from pathlib import Path

from cfepy.reading.input_limits import CMAKE_CHARACTERS, CMAKE_COMMANDS, CMAKE_DEPTH, CMAKE_FILES
from cfepy.status import UsageError

_DEEP = "**"  # any number of folders, in a pattern
_MOST_PARTS = 40  # of a pattern
_LONGEST_PART = 255  # characters of a file's name


class CMakeBudget:
    """Limits for the files of a package, including subfolders.

    Args:
        file: the outermost one, for errors.
    """

    def __init__(self, file: Path) -> None:
        self._file = file
        self._commands = CMAKE_COMMANDS
        self._characters = CMAKE_CHARACTERS
        self._files = CMAKE_FILES
        self._depth = 0

    def command(self) -> None:
        """Count a command. It raises the errors of `spend`."""
        self._commands -= 1
        if self._commands < 0:
            raise self._error(f"executes more than {CMAKE_COMMANDS:,} commands, loops included")

    def turns(self, count: int) -> None:
        """Count the turns of a loop, each as a command. It raises the errors of `spend`."""
        self._commands -= count
        if self._commands < 0:
            raise self._error(f"has a loop of {count:,} iterations, more than {CMAKE_COMMANDS:,} commands")

    def spend(self, characters: int) -> None:
        """Count characters of words that are read or made.

        Raises:
            UsageError: they are too many.
        """
        self._characters -= characters
        if self._characters < 0:
            raise self._error(f"makes words of more than {CMAKE_CHARACTERS:,} characters")

    def look(self) -> None:
        """Count a file or folder that a pattern examines. It raises the errors of `spend`."""
        self._files -= 1
        if self._files < 0:
            raise self._error(f"has patterns that match more than {CMAKE_FILES:,} files")

    @contextmanager
    def inside(self) -> Iterator[None]:
        """Count a nested block, call or subfolder in this context. It raises the errors of `spend`."""
        self.descend()
        try:
            yield
        finally:
            self.ascend()

    def descend(self) -> None:
        """Begin a nested block, call, subfolder or bracket. It raises the errors of `spend`."""
        self._depth += 1
        if self._depth > CMAKE_DEPTH:
            raise self._error(f"has more than {CMAKE_DEPTH} nested blocks, calls and subfolders")

    def ascend(self) -> None:
        """End the innermost of them."""
        self._depth -= 1

    def _error(self, what: str) -> UsageError:
        return UsageError(f"{what}, the limit; simplify it", file=self._file)


# -- files of a pattern: links can form cycles, which the budget ends --------------------------------------------------


def matching_files(folder: Path, pattern: str, look: Callable[[], object]) -> list[str]:
    """Find the files and folders of a pattern.

    Args:
        folder: folder in which the search begins.
        pattern: a path with `*`, `?` and `[...]` in its parts; `**` stands for any number of folders, and follows no
            symbolic links.
        look: called for each file or folder that is examined; may raise.

    Returns:
        Paths relative to the folder, sorted; empty for an absolute pattern.
    """
    parts = [each for each in pattern.split("/") if each not in ("", ".")]
    is_strange = any((_DEEP in each and each != _DEEP) or len(each) > _LONGEST_PART or "\0" in each for each in parts)
    if not parts or pattern.startswith("/") or is_strange or len(parts) > _MOST_PARTS:
        return []
    return sorted(set(_below(folder, "", parts, look)))


def _below(folder: Path, inner: str, parts: Sequence[str], look: Callable[[], object]) -> Iterator[str]:
    """Yield paths in an inner folder that match the parts."""
    part, *rest = parts
    if part == _DEEP:
        for place in _folders(folder, inner, look):
            yield from _below(folder, place, rest, look) if rest else [place] if place else []
    elif any(mark in part for mark in "*?["):
        for entry in _entries(folder, inner, look):
            if fnmatchcase(entry.name, part) and (not rest or os.path.isdir(entry.path)):
                found = f"{inner}{entry.name}"
                yield from _below(folder, f"{found}/", rest, look) if rest else [found]
    else:
        look()
        found = f"{inner}{part}"
        if os.path.exists(folder / found):
            yield from _below(folder, f"{found}/", rest, look) if rest else [found]


def _folders(folder: Path, inner: str, look: Callable[[], object]) -> Iterator[str]:
    """Yield an inner folder and all folders in it, each with a slash at its end."""
    waiting = [inner]
    while waiting:
        place = waiting.pop()
        yield place
        inside = (each for each in _entries(folder, place, look) if each.is_dir(follow_symlinks=False))
        waiting += [f"{place}{each.name}/" for each in inside]


def _entries(folder: Path, inner: str, look: Callable[[], object]) -> Iterator[os.DirEntry[str]]:
    try:
        with os.scandir(folder / inner) as found:
            for entry in found:
                look()
                yield entry
    except OSError:
        return
