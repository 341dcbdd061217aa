"""`cfepy tbl`: make table files from YAML, show them, compare two, and find defects in them."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from cfepy.cli.json_output import write_json, write_text
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.cli.text_table import Table, show_tables
from cfepy.cli.user_notes import writing
from cfepy.ground import struct_layout, table_types
from cfepy.ground.cfe_files import table_yaml
from cfepy.ground.cfe_files.table_file import (
    HEADER_FIELDS,
    Find,
    KnownTables,
    Leaf,
    TableContents,
    defects_of,
    document,
    is_zero,
    take_apart,
)
from cfepy.mission import is_mission_folder
from cfepy.msg import Layout
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import TABLE_BYTES
from cfepy.reading.marked_yaml import load
from cfepy.status import UsageError
from cfepy.tbl import TableType

YAML_SUFFIXES = (".yaml", ".yml")
ABSENT = "(not there)"


def run(arguments: argparse.Namespace) -> int:
    """Carry out the action on tables that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: a file cannot be read or written, or is not a table.
    """
    action: Callable[[argparse.Namespace, Find], int] = ACTIONS[arguments.action]
    return action(arguments, _find(arguments))


def _find(arguments: argparse.Namespace) -> Find:
    """Make the lookup of table types of the mission, of shipped apps, and of `--layout`."""
    problems: list[str] = []
    mission = arguments.mission or _mission_around(arguments)
    known = table_types(mission, problems)
    for problem in problems:
        print(f"cfepy: {problem}", file=sys.stderr)
    struct = partial(struct_layout, mission)
    if arguments.layout is not None:
        own = _own_type(Path(arguments.layout), struct)
        known[own.name] = own
    return KnownTables(known, struct)


def _mission_around(arguments: argparse.Namespace) -> str | None:
    """Return the mission in whose folder one of the command's files lies; None if there is none."""
    given = vars(arguments)
    files = [*given.get("files", ()), *(given.get(name) for name in ("file", "other", "output"))]
    folders = (Path(file).parent for file in files if file)
    return next((str(folder) for folder in folders if is_mission_folder(folder)), None)


def _own_type(path: Path, struct: Callable[[str], Layout | None]) -> TableType:
    root = load(path, handed=True)
    said = root.mapping()
    own = table_yaml.own_type(said, struct) if "table" in said else None
    if own is None:
        raise root.fail("missing layout; add `table` and `layout`, and `count` for more than one row")
    return own


# -- build and show ----------------------------------------------------------------------------------------------------


def _build(arguments: argparse.Namespace, find: Find) -> int:
    path = Path(arguments.file)
    target = Path(arguments.output) if arguments.output else path.with_suffix(".tbl")
    file = table_yaml.read(path, find)
    with writing(target, "--output"):
        target.write_bytes(file.pack())
    print(f"{target}: {file.table.table_name}, {_extent(file)}")
    return ENDED_WELL


def _show(arguments: argparse.Namespace, find: Find) -> int:
    file = _read(arguments.file, find)
    if arguments.yaml is not None:
        values = document(file)
        if file.kind is not None and arguments.layout is not None:
            said: dict[str, Any] = load(Path(arguments.layout), handed=True).plain()
            own: dict[str, Any] = {name: said[name] for name in ("layout", "count") if name in said}
            values = {"table": values.pop("table"), **own, **values}
        write_text(arguments.yaml, table_yaml.write(values), "--yaml", arguments)
    write_json(arguments, {**document(file), "crc": file.crc})
    _show_text(file)
    return ENDED_WELL


def _show_text(file: TableContents) -> None:
    header = file.header
    time = f"{header.time_seconds + header.time_subseconds / 2**32:.5f} s"
    ids = f"spacecraft {header.spacecraft_id}, processor {header.processor_id}, application {header.application_id}"
    head = f"{file.table.table_name}: {header.description}\n  {ids}, time {time}\n  {_extent(file)}\n"
    rows = file.rows()
    if rows is None or len(rows) == 1 or file.kind is None:
        table = Table("Fields", ("field", "value"))
        for leaf in file.leaves():
            if rows is None or not is_zero(leaf.value):
                table.add(leaf.path.removeprefix("rows[0]."), _value(leaf))
    else:
        table = Table("Rows", ("row", *file.kind.row.fields), right=(0,))
        for number, row in enumerate(rows):
            if not is_zero(row):
                table.add(number, *(table_yaml.flow(value, name) for name, value in row.items()))
        table.note = "rows that are all 0 are left out"
    sys.stdout.write(head)
    show_tables([table], sys.stdout)


def _extent(file: TableContents) -> str:
    where = "" if file.is_whole else f" from byte {file.table.offset} on"
    mark = ", marked" if file.is_marked else ""
    return f"{len(file.image)} bytes{where}, CRC 0x{file.crc:04X}{mark}"


def _value(leaf: Leaf) -> str:
    name = leaf.path.rpartition(".")[2].partition("[")[0]
    return leaf.value if name == "data" else table_yaml.flow(leaf.value, name)


def _read(name: str, find: Find) -> TableContents:
    """Read a table file, or build the table that a YAML file describes."""
    path = Path(name)
    if path.suffix in YAML_SUFFIXES:
        return table_yaml.read(path, find)
    return take_apart(_bytes(path), find, name)


def _bytes(path: Path) -> bytes:
    try:
        return read_limited(path, TABLE_BYTES, handed=True)
    except OSError as error:
        raise UsageError(f"cannot be read: {error.strerror}", file=path) from None


# -- diff and verify ---------------------------------------------------------------------------------------------------


def _diff(arguments: argparse.Namespace, find: Find) -> int:
    before, after = (_fields(_read(name, find)) for name in (arguments.file, arguments.other))
    changed = [path for path in dict.fromkeys([*before, *after]) if before.get(path) != after.get(path)]
    for path in changed:
        print(f"{path}: {before.get(path, ABSENT)} -> {after.get(path, ABSENT)}")
    return FOUND_PROBLEMS if changed else ENDED_WELL


def _fields(file: TableContents) -> dict[str, str]:
    """Return every field of a file as text, by its path."""
    fields = {"table": file.table.table_name, "offset": str(file.table.offset), "bytes": str(len(file.image))}
    fields["mark"] = f"0x{file.table.reserved:08X}"
    fields |= {name: table_yaml.flow(getattr(file.header, name)) for name in HEADER_FIELDS}
    return fields | {leaf.path: _value(leaf) for leaf in file.leaves()}


def _verify(arguments: argparse.Namespace, find: Find) -> int:
    count = 0
    for name in arguments.files:
        data = _bytes(Path(name))
        found = list(defects_of(data, find))
        for defect in found:
            print(f"{name}: byte {defect.offset}: {defect.field}: {defect.text}")
        if not found:
            file = take_apart(data, find, name)
            unknown = "" if file.kind is not None else "; its layout is not known, so its size was not compared"
            print(f"{name}: {file.table.table_name}, {_extent(file)}, good{unknown}")
        count += len(found)
    return FOUND_PROBLEMS if count else ENDED_WELL


ACTIONS = {"build": _build, "show": _show, "diff": _diff, "verify": _verify}
