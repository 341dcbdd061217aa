"""Parameters in table files: reading a dump, changing a parameter in a file, and files for the ground to load.

For tools; it does not run in a mission.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

from cfepy.fs import FileHeader, TableHeader, read_table_file
from cfepy.status import CfeError, UsageError
from cfepy.tbl import PROCESSOR_ID, SPACECRAFT_ID, TableImage, build
from rospy_shim.parameters import table
from rospy_shim.parameters.rows import ParameterRows, ParametersFull
from rospy_shim.parameters.tree import ParameterTree

_NAME = re.compile(rf"{table.APP_NAME}\.Params(\d\d)")


class _File(NamedTuple):
    number: int
    header: FileHeader
    table: TableHeader
    rows: list[table.Row]


def read(files: Mapping[str, bytes], problems: list[str]) -> dict[str, Any]:
    """Return the parameters in table files, in the order of their tables.

    Args:
        files: contents, by the files' names.
        problems: receives a line for each parameter that cannot be read.

    Raises:
        UsageError: a file is not a parameter table, or is the same one as another.
    """
    return table.tree_of(_rows(_in_order(files)), problems)[0]


def change(files: Mapping[str, bytes], parameter: str, value: Any) -> dict[str, bytes]:
    """Change one parameter, or namespace, in table files.

    Args:
        files: contents, by the files' names; all files that its parameters extend into.
        parameter: full name.
        value: a value that XML-RPC can carry; None removes the parameter.

    Returns:
        The files that changed.

    Raises:
        UsageError: a file is not a parameter table, they have no room, there is no such parameter to remove, or a
            parameter begins or ends in a missing file.
    """
    found = _in_order(files)
    _check_whole(found)
    before = _rows(found)
    root, good = table.tree_of(before, [])
    rows, tree = ParameterRows(before, good), ParameterTree(root)
    first = next(iter(found))
    try:
        tree.keep_in(rows, bool, root)
        tree.delete(parameter) if value is None else tree.set(parameter, value)
    except KeyError:
        raise UsageError(f"unknown parameter {parameter}", file=first) from None
    except (ParametersFull, TypeError) as error:
        raise UsageError(str(error), file=first) from None
    changed: dict[str, bytes] = {}
    at = 0
    for name, file in found.items():
        own = rows.rows[at : at + len(file.rows)]
        at += len(own)
        if own != file.rows:
            header = replace(file.header, description=_description(file.number))
            changed[name] = _pack(header, file.table.table_name, own)
    return changed


def _in_order(files: Mapping[str, bytes]) -> dict[str, _File]:
    """Return the files by name, in the order of their tables."""
    found = {name: _take_apart(name, data) for name, data in files.items()}
    ordered = dict(sorted(found.items(), key=lambda item: item[1].number))
    numbers: dict[int, str] = {}
    for name, file in ordered.items():
        if numbers.setdefault(file.number, name) != name:
            raise UsageError(f"has the same table {file.table.table_name} as {numbers[file.number]}", file=name)
    return ordered


def _rows(files: Mapping[str, _File]) -> list[table.Row]:
    return [row for file in files.values() for row in file.rows]


def _check_whole(files: Mapping[str, _File]) -> None:
    numbers = {file.number for file in files.values()}
    for name, file in files.items():
        begins = file.number - 1 in numbers or not file.rows[0][0].startswith(table.MORE)
        ends = file.number + 1 in numbers or file.rows[-1] == table.FREE
        if not (begins and ends):
            text = "may contain part of a parameter of another table; give a folder with the files of all tables"
            raise UsageError(text, file=name)


def make(tree: Mapping[str, Any], row_count: int) -> dict[str, bytes]:
    """Make table files for a whole tree.

    Args:
        tree: the parameters.
        row_count: rows of each table.

    Returns:
        The files' contents by the tables' own names.

    Raises:
        UsageError: there are too many.
    """
    rows = ParameterRows([table.FREE] * (row_count * table.MOST_TABLES), {})
    try:
        rows.replace("", dict(tree), {})
    except ParametersFull as error:
        raise UsageError(str(error)) from None
    used = len(rows.rows) - rows.free
    tables = range(max(1, -(-used // row_count)))
    return {
        table.table_name(number): _pack(
            FileHeader(_description(number), spacecraft_id=SPACECRAFT_ID, processor_id=PROCESSOR_ID),
            f"{table.APP_NAME}.{table.table_name(number)}",
            rows.rows[number * row_count : (number + 1) * row_count],
        )
        for number in tables
    }


def is_parameters(data: bytes) -> bool:
    """Return True if a file is a parameter table."""
    try:
        _take_apart("", data)
    except UsageError:
        return False
    return True


def _take_apart(name: str, data: bytes) -> _File:
    try:
        header, head, image = read_table_file(data)
    except CfeError as error:
        raise UsageError(f"is not a table file: {error.text}", file=name) from None
    match = _NAME.fullmatch(head.table_name)
    if match is None or head.offset or len(image) % table.ROW_BYTES:
        what = f"the table {head.table_name}, not a complete table of ROS parameters (ROS.Params01 and so on)"
        raise UsageError(f"is {what}", file=name)
    return _File(int(match[1]) - 1, header, head, table.unpack(image))


def _description(number: int) -> str:
    return f"ROS parameters {number + 1}"


def _pack(header: FileHeader, table_name: str, rows: list[table.Row]) -> bytes:
    return build(
        TableImage(
            table_name,
            b"".join(map(table.pack, rows)),
            header.description,
            spacecraft_id=header.spacecraft_id,
            processor_id=header.processor_id,
        )
    )
