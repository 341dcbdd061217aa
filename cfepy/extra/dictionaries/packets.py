"""Declarations of a source of a dictionary: packets and tables with their layouts and places."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from cfepy.msg import TLM_HEADER_SIZE, Layout
from cfepy.status import UsageError

if TYPE_CHECKING:
    from cfepy.extra.dictionaries.placed_types import Struct


@dataclass(frozen=True, slots=True)
class DeclaredPacket:
    """A command or a telemetry packet of a source.

    Attributes:
        name: its name in ground tools.
        msg_id: its MsgId.
        payload: the layout of everything after the header, in the memory of the flight computer.
        is_command: whether it is a command.
        file: where it is declared.
        line: the line there.
        code: the function code of a command; None without one.
        text: description.
        whole: the type with its header as it is on the wire, if the source describes it.
        lines: the lines of fields, by path without indices.
        structs: names that its struct may have in C.
        library: the shared object, for debug data.
        header_size: bytes of the header of telemetry.
    """

    name: str
    msg_id: int
    payload: Layout
    is_command: bool
    file: Path
    line: int
    code: int | None = None
    text: str = ""
    whole: Struct | None = None
    lines: Mapping[str, int] = field(default_factory=dict)
    structs: tuple[str, ...] = ()
    library: Path | None = None
    header_size: int = TLM_HEADER_SIZE


@dataclass(frozen=True, slots=True)
class DeclaredTable:
    """A table of a source: full name, layout of a row, number of rows, where, description, and names in C of a row."""

    name: str
    row: Layout
    rows: int
    file: Path
    line: int
    text: str = ""
    lines: Mapping[str, int] = field(default_factory=dict)
    structs: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class SourceProblem:
    """An error of a source: file, line (0 for the whole file), and text."""

    file: Path
    line: int
    text: str

    def __str__(self) -> str:
        """Return the error with its place."""
        place = f"{self.file}:{self.line}" if self.line else str(self.file)
        return f"{place}: {self.text}"


def no_layout(name: str) -> Layout | None:
    """Return None, as a source without structs."""
    return None


@dataclass(slots=True)
class SourceContent:
    """Everything that a source declares, with a problem for each thing that it could not read.

    Attributes:
        kind: the kind of source, such as "EDS".
        packets: its packets.
        tables: its tables.
        names: names of MsgIds.
        problems: its problems.
        layout: returns a struct by its name in C, or None.
    """

    kind: str
    packets: list[DeclaredPacket] = field(default_factory=list)
    tables: list[DeclaredTable] = field(default_factory=list)
    names: dict[int, str] = field(default_factory=dict)
    problems: list[SourceProblem] = field(default_factory=list)
    layout: Callable[[str], Layout | None] = no_layout

    def add_problem(self, error: UsageError, file: Path) -> None:
        """Add an error, once.

        Args:
            error: the error.
            file: the file that was read, for an error without one.
        """
        text = error.text if error.field is None else f"{error.field}: {error.text}"
        problem = SourceProblem(Path(error.file or file), error.line or 0, text)
        if problem not in self.problems:
            self.problems.append(problem)
