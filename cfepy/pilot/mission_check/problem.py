"""`MissionProblem`: something wrong with a mission, as all that check one tell it."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from cfepy.status import UsageError


class MissionProblem(NamedTuple):
    """Something wrong with a mission.

    Attributes:
        file: where it is.
        line: in the file, from 1; 0 stands for the whole file.
        text: what is wrong and what to do.
        is_warning: the mission runs as it is, but hardly as its author means it to.
    """

    file: Path
    line: int
    text: str
    is_warning: bool = False


def problem_of(error: UsageError, file: Path, is_warning: bool = False) -> MissionProblem:
    """An error as a problem.

    Args:
        error: the error.
        file: what was read, for an error that names none.
        is_warning: as of `MissionProblem`.
    """
    return MissionProblem(Path(error.file or file), error.line or 0, with_field(error), is_warning)


def with_field(error: UsageError) -> str:
    """The text of an error, with the field that is wrong."""
    return f"{error.field}: {error.text}" if error.field else error.text
