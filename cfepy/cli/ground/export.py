"""`cfepy export`: values over time as CSV or Parquet; descriptions of a mission's packets, as XTCE or ROS messages."""

from __future__ import annotations

import argparse
import os
import re
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TextIO

from cfepy.cli.csv_cells import write_rows
from cfepy.cli.json_output import STDOUT, write_text
from cfepy.cli.main import ENDED_WELL
from cfepy.cli.user_notes import check_writable, writing
from cfepy.cli.viewed_runs import look_at_series
from cfepy.ground import Dictionary, Series, dictionary_of, surveyed_topics
from cfepy.mission import MissionSpec, read_mission
from cfepy.msg import Telemetry
from cfepy.pilot import booting
from cfepy.plugins import Hook
from cfepy.psp import load_profile
from cfepy.reading.contained_files import write_contained
from cfepy.status import UsageError
from cfepy.units import NS_PER_S

if TYPE_CHECKING:
    from numpy.typing import NDArray

TIME, STAMP = "time", "stamp"
"""Columns of every table: virtual time of sending and time on board, in s."""

TELEMETRY_PACKAGE: Hook[Callable[[Sequence[Telemetry], str], Mapping[str, str]]] = Hook("telemetry_package")
"""Makes the files of a catkin package of telemetry. Arguments: the packets, the mission's name. Returns texts by path.
"""


DICTIONARY_FORMATS: Hook[Mapping[str, Callable[[MissionSpec, Dictionary], str | Mapping[str, str]]]] = Hook(
    "dictionary_formats"
)
"""Writers of a mission's packets by the name of their format; each makes one text, or the texts of files by name."""


COSMOS_PLUGIN: Hook[Callable[[MissionSpec, str, str | None, Dictionary], Mapping[str, str]]] = Hook("cosmos_plugin")
"""Makes the files of a plugin folder for COSMOS. Arguments: the mission, its packets as text, a mission script or None,
its dictionary. Returns texts by path.
"""


def run(arguments: argparse.Namespace) -> int:
    """Export the data that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: there is no such run, mission, message or field, it cannot boot, or a file cannot be written.
    """
    formats = {"xtce": _xtce, "ros": _ros, "cosmos": _cosmos, "python": _text_of_dictionary}
    formats["ctf"] = _files_of_dictionary
    return formats.get(arguments.format, _values)(arguments)


def _xtce(arguments: argparse.Namespace) -> int:
    from cfepy.ground.xtce import xtce_of

    spec, dictionary = _known(arguments)
    with booting(spec.script):
        dictionary.learn(surveyed_topics(spec))
    document = xtce_of(spec.name, dictionary, spec.zero_s(spec.config(load_profile(spec.board))))
    write_text(arguments.output, document, "--output", arguments)
    return ENDED_WELL


def _known(arguments: argparse.Namespace) -> tuple[MissionSpec, Dictionary]:
    """Return the mission and its dictionary, and print the problems of the dictionary."""
    spec = read_mission(arguments.mission)
    dictionary = dictionary_of(spec)
    for problem in dictionary.problems:
        print(f"cfepy: {problem}", file=sys.stderr)
    return spec, dictionary


def _cosmos(arguments: argparse.Namespace) -> int:
    if arguments.script is None and not arguments.output.endswith("/"):
        return _text_of_dictionary(arguments)
    if arguments.output == STDOUT:
        raise UsageError("a plugin is a folder; give one", field="--output")
    spec, dictionary = _known(arguments)
    text = DICTIONARY_FORMATS.need("the format cosmos")["cosmos"](spec, dictionary)
    assert isinstance(text, str)
    files = COSMOS_PLUGIN.need("a plugin folder for COSMOS")(spec, text, arguments.script, dictionary)
    _write_files(files, arguments)
    print(f"{arguments.output}: {len(files)} files")
    return ENDED_WELL


def _text_of_dictionary(arguments: argparse.Namespace) -> int:
    text = DICTIONARY_FORMATS.need(f"the format {arguments.format}")[arguments.format](*_known(arguments))
    assert isinstance(text, str)
    write_text(arguments.output, text, "--output", arguments)
    return ENDED_WELL


def _files_of_dictionary(arguments: argparse.Namespace) -> int:
    files = DICTIONARY_FORMATS.need(f"the format {arguments.format}")[arguments.format](*_known(arguments))
    assert not isinstance(files, str)
    _write_files(files, arguments)
    print(f"{arguments.output}: {len(files)} files")
    return ENDED_WELL


def _write_files(files: Mapping[str, str], arguments: argparse.Namespace) -> None:
    for name, text in files.items():
        path = Path(arguments.output) / name
        with writing(str(path), "--output"):
            path.parent.mkdir(parents=True, exist_ok=True)
            write_contained(Path(arguments.output), f"/{name}", text.encode())


def _ros(arguments: argparse.Namespace) -> int:
    make = TELEMETRY_PACKAGE.need("the format ros")
    spec, dictionary = _known(arguments)
    declared = [each for each in dictionary.telemetry.values() if isinstance(each, Telemetry)]
    files = make(declared, spec.name)
    _write_files(files, arguments)
    print(f"{arguments.output}: {len(files) - 2} message types of {len(declared)} packets")
    return ENDED_WELL


# -- values over time --------------------------------------------------------------------------------------------------


class ValueTable(NamedTuple):
    """The rows of a file: a name, times in ns, times on board in ns, and columns of the same length by their names."""

    name: str
    times_ns: NDArray[Any]
    stamps_ns: NDArray[Any]
    columns: dict[str, NDArray[Any]]


def _values(arguments: argparse.Namespace) -> int:
    write = _write_csv if arguments.format == "csv" else _write_parquet
    output = arguments.output
    folder = Path(output) if output.endswith("/") or os.path.isdir(output) else None
    if arguments.format == "parquet":
        _parquet()  # fail before a long run if it is not installed
    if folder is None and output != STDOUT:
        check_writable(output, "--output")
    series, status = look_at_series(arguments, arguments.names)
    chosen: dict[str, tuple[Series, list[str]]] = {}
    for found, field in chain.from_iterable(series.matching(word) for word in arguments.names):
        chosen.setdefault(found.name, (found, []))[1].append(field)
    tables = [_table(found, fields, arguments.from_s or 0.0) for found, fields in chosen.values()]
    if folder is None:
        write(output, _joined(tables), arguments)
    else:
        with writing(folder, "--output"):
            folder.mkdir(parents=True, exist_ok=True)
        for table in tables:
            write(str(folder / f"{file_name(table.name)}.{arguments.format}"), table, arguments)
    return status


def file_name(name: str) -> str:
    """Make a file name from the name of a topic; a bag allows any text as a topic."""
    return re.sub(r"[^\w.~-]", "_", name.strip("/").replace("/", "."))


def _table(series: Series, fields: Sequence[str], from_s: float) -> ValueTable:
    """Make the table of one series."""
    columns = series.columns() if "" in fields else series.columns(*fields)
    wanted = series.times_ns >= from_s * NS_PER_S
    named = {f"{series.name}.{name}" if name in (TIME, STAMP) else name: each for name, each in columns.items()}
    return ValueTable(
        series.name,
        series.times_ns[wanted],
        series.stamps_ns[wanted],
        {name: column[wanted] for name, column in named.items()},
    )


def _joined(tables: Sequence[ValueTable]) -> ValueTable:
    """Join all tables by time. A row has values only in its table's columns, whose names begin with the table's."""
    import numpy

    if len(tables) == 1:
        return tables[0]
    times = numpy.concatenate([table.times_ns for table in tables])
    order = numpy.argsort(times, kind="stable")
    columns: dict[str, NDArray[Any]] = {}
    start = 0
    for table in tables:
        rows = slice(start, start + len(table.times_ns))
        start = rows.stop
        for name, column in table.columns.items():
            cells = numpy.empty(len(times), object)
            cells[rows] = column.tolist()
            columns[name if name.startswith(f"{table.name}.") else f"{table.name}.{name}"] = cells[order]
    stamps = numpy.concatenate([table.stamps_ns for table in tables])
    return ValueTable("", times[order], stamps[order], columns)


def _write_csv(file: str, table: ValueTable, arguments: argparse.Namespace) -> None:
    if file == STDOUT:
        _put_csv(arguments.stdout, table, arguments.quote_formulas)
        return
    with writing(file, "--output"), open(file, "w", encoding="utf-8", errors="backslashreplace", newline="") as stream:
        _put_csv(stream, table, arguments.quote_formulas)


def _put_csv(stream: TextIO, table: ValueTable, quotes: bool) -> None:
    times = map(_exact, table.times_ns.tolist())
    stamps = (_exact(stamp) if stamp else "" for stamp in table.stamps_ns.tolist())
    rows = zip(times, stamps, *map(_cells, table.columns.values()), strict=True)
    write_rows(stream, chain([(TIME, STAMP, *table.columns)], rows), quotes)


def _exact(time_ns: int) -> str:
    """Format a time in s, with all its digits."""
    return f"{time_ns // NS_PER_S}.{time_ns % NS_PER_S:09d}"


def _cells(column: NDArray[Any]) -> Iterable[Any]:
    """Format a column: an empty text for a missing value, 0 and 1 for booleans, hexadecimal digits for bytes."""
    return map(_cell, column.tolist()) if column.dtype.kind in "Ofb" else column.tolist()


def _cell(value: Any) -> Any:
    if value is None or value != value:  # a missing number is a NaN
        return ""
    if isinstance(value, bool):
        return int(value)
    return value.hex() if isinstance(value, bytes) else value


def _parquet() -> Any:
    """Return the library's module for the format.

    Raises:
        UsageError: it is not installed.
    """
    try:
        from pyarrow import parquet
    except ImportError:
        raise UsageError("Parquet requires the library pyarrow: pip install 'cfepy[parquet]'") from None
    return parquet


def _write_parquet(file: str, table: ValueTable, arguments: argparse.Namespace) -> None:
    parquet = _parquet()
    import pyarrow

    if file == STDOUT:
        raise UsageError("Parquet cannot be written to standard output; name a file", field="--output")
    stamps = [stamp / NS_PER_S if stamp else None for stamp in table.stamps_ns.tolist()]
    columns: dict[str, Any] = {TIME: table.times_ns / NS_PER_S, STAMP: pyarrow.array(stamps, pyarrow.float64())}
    columns |= {name: pyarrow.array(column.tolist()) for name, column in table.columns.items()}
    with writing(file, "--output"):
        parquet.write_table(pyarrow.table(columns), file)
