"""What a source of a dictionary declares: packets and tables with their types, and where."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from cfepy.extra.dictionaries.types import Struct
from cfepy.status import UsageError


@dataclass(frozen=True, slots=True)
class DeclaredPacket:
    """A command or a telemetry packet of a source.

    Attributes:
        name: its name in ground tools.
        msg_id: its MsgId.
        payload: the type of everything after the header.
        whole: the type with its header, if the source describes it.
        code: the function code of a command; None without one.
        is_command: whether it is a command.
        text: description.
        file: where it is declared.
        line: the line there.
        structs: names that its struct may have in C.
    """

    name: str
    msg_id: int
    payload: Struct
    is_command: bool
    file: Path
    line: int
    code: int | None = None
    text: str = ""
    whole: Struct | None = None
    structs: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class DeclaredTable:
    """A table of a source: full name, row type, number of rows, and where."""

    name: str
    row: Struct
    rows: int
    file: Path
    line: int
    text: str = ""
    structs: tuple[str, ...] = ()


@dataclass(slots=True)
class SourceContent:
    """Everything that a source declares, with a text for each thing that it could not read.

    Attributes:
        kind: "EDS", "COSMOS", "XTCE" or "debug data".
        names: names of MsgIds.
    """

    kind: str
    packets: list[DeclaredPacket] = field(default_factory=list)
    tables: list[DeclaredTable] = field(default_factory=list)
    names: dict[int, str] = field(default_factory=dict)
    problems: list[Problem] = field(default_factory=list)

    def add_problem(self, error: UsageError, file: Path) -> None:
        """Add an error, once.

        Args:
            error: the error.
            file: the file that was read, for an error without one.
        """
        text = error.text if error.field is None else f"{error.field}: {error.text}"
        problem = Problem(Path(error.file or file), error.line or 0, text)
        if problem not in self.problems:
            self.problems.append(problem)


@dataclass(frozen=True, slots=True)
class Problem:
    """An error of a source: file, line (0 for the whole file), and text."""

    file: Path
    line: int
    text: str

    def __str__(self) -> str:
        place = f"{self.file}:{self.line}" if self.line else str(self.file)
        return f"{place}: {self.text}"
