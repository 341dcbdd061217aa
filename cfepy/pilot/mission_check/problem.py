"""`MissionProblem`: a problem of a mission, in the form that all checks use."""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

from cfepy.status import UsageError
from cfepy.writing.escapes import visible_line


class MissionProblem(NamedTuple):
    """A problem of a mission.

    Attributes:
        file: the file.
        line: the line in the file, from 1; 0 for the whole file.
        text: the mistake and the remedy.
        is_warning: whether the mission runs anyway, but probably not as its author intended.
        package: a package that `pip install` needs to solve it; "" for other problems.
    """

    file: Path
    line: int
    text: str
    is_warning: bool = False
    package: str = ""

    @property
    def message(self) -> str:
        """The mistake and the remedy, with paths relative to the working directory."""
        return self.text.replace(f"{Path.cwd()}{os.sep}", "")

    def __str__(self) -> str:
        """Return the problem as a line, with its file relative to the working directory."""
        place = visible_line(shown_file(self.file))
        text = ("warning: " if self.is_warning else "") + self.message
        return f"{place}:{self.line}: {visible_line(text)}" if self.line else f"{place}: {visible_line(text)}"


def shown_file(path: Path) -> str:
    """Return a path in its shortest form relative to the working directory."""
    try:
        return os.path.relpath(path) if path.is_relative_to(Path.cwd()) else str(path)
    except OSError:
        return str(path)


def problem_of(error: UsageError, file: Path, is_warning: bool = False) -> MissionProblem:
    """Return an error as a problem.

    Args:
        error: the error.
        file: the file that was read, for an error without one.
        is_warning: see `MissionProblem`.
    """
    return MissionProblem(Path(error.file or file), error.line or 0, with_field(error), is_warning)


def problems_of(error: UsageError, file: Path, is_warning: bool = False) -> list[MissionProblem]:
    """Return an error, and the further ones in it, as problems; see `problem_of`."""
    return [problem_of(each, file, is_warning) for each in error.each]


def with_field(error: UsageError) -> str:
    """Return the text of an error, with the wrong field."""
    return f"{error.field}: {error.text}" if error.field else error.text
