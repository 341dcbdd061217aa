"""`MissionProblem`: a problem of a mission, in the form that all checks use."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from cfepy.status import UsageError


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


def problem_of(error: UsageError, file: Path, is_warning: bool = False) -> MissionProblem:
    """Return an error as a problem.

    Args:
        error: the error.
        file: the file that was read, for an error without one.
        is_warning: see `MissionProblem`.
    """
    return MissionProblem(Path(error.file or file), error.line or 0, with_field(error), is_warning)


def with_field(error: UsageError) -> str:
    """Return the text of an error, with the wrong field."""
    return f"{error.field}: {error.text}" if error.field else error.text
