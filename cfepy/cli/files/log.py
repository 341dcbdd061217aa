"""`cfepy log`: show what is in the files that cFE wrote."""

from __future__ import annotations

import argparse
import dataclasses
import sys
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TextIO

from cfepy.cli.json_output import write_json
from cfepy.cli.main import BAD_USAGE, ENDED_WELL
from cfepy.cli.text_table import Table, show_tables
from cfepy.cli.user_notes import tell, writing
from cfepy.ground.cfe_files.dump_files import DumpFile, read_dump, timings, value_at
from cfepy.ground.cfe_files.table_file import is_zero
from cfepy.plugins import Hook
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import TABLE_BYTES
from cfepy.status import UsageError
from cfepy.time import print_ as time_text

PERF_LOG: Hook[Callable[[TextIO, Sequence[Mapping[str, Any]], Mapping[str, Any]], None]] = Hook("perf_log")
"""Writes performance data for Perfetto. Arguments: the open file, the entries, and facts about the data by name."""
PERF_FACTS = ("State", "Mode", "TriggerCount", "DataCount", "InvalidMarkerReported")


def run(arguments: argparse.Namespace) -> int:
    """Show the files that the command line names. A file that cannot be read does not stop the others.

    Returns:
        The exit status.

    Raises:
        UsageError: `--perfetto` without exactly one file of performance data, or its output cannot be written.
    """
    if arguments.perfetto is not None:
        return _draw(arguments)
    shown: list[dict[str, Any]] = []
    status = ENDED_WELL
    for name in arguments.files:
        try:
            dump = read_dump(_bytes(name), name)
            if arguments.json is not None:
                shown.append(_plain(dump, name))
            _show(dump, name)
            if dump.problem:
                raise UsageError(dump.problem, file=name)
        except UsageError as error:
            sys.stdout.flush()
            print(f"cfepy: {error}", file=sys.stderr)
            status = BAD_USAGE
    write_json(arguments, shown)
    return status


def _draw(arguments: argparse.Namespace) -> int:
    """Write performance data for Perfetto."""
    if len(arguments.files) != 1:
        raise UsageError(f"takes one file, not {len(arguments.files)}", field="--perfetto")
    if arguments.json is not None:
        raise UsageError("cannot be combined with --perfetto; leave it out", field="--json")
    (name,) = arguments.files
    dump = read_dump(_bytes(name), name)
    if not dump.about:
        raise UsageError(f"requires performance data; this file is the {dump.kind}", file=name, field="--perfetto")
    write = PERF_LOG.need("--perfetto")
    path = arguments.perfetto
    about = {"file": name, **{key: dump.about[key] for key in PERF_FACTS}}
    with writing(path, "--perfetto"), open(path, "w", encoding="utf-8") as file:
        write(file, dump.records, about)
    print(f"{path}: {len(dump.records):,} entries; open it in https://ui.perfetto.dev")
    tell([f"{name}: {dump.problem}"] if dump.problem else [])
    return BAD_USAGE if dump.problem else ENDED_WELL


def _bytes(name: str) -> bytes:
    try:
        return read_limited(name, TABLE_BYTES, handed=True)
    except OSError as error:
        raise UsageError(f"cannot be read: {error.strerror}", file=name) from None


def _plain(dump: DumpFile, name: str) -> dict[str, Any]:
    plain: dict[str, Any] = {"file": name, "kind": dump.kind, "header": dataclasses.asdict(dump.header)}
    if dump.lines:
        return {**plain, "lines": dump.lines}
    return {**plain, **({"about": dump.about} if dump.about else {}), "records": dump.records}


def _show(dump: DumpFile, name: str) -> None:
    header = dump.header
    when = time_text((header.time_seconds, header.time_subseconds))
    print(f"{name}: {dump.kind}, {header.description!r}")
    print(f"  written {when} on {header.spacecraft_id}/{header.processor_id} by 0x{header.application_id:08X}")
    for line in dump.lines:
        print(line)
    if dump.about:
        show_tables([_perf_entries(dump), _perf_timings(dump)], sys.stdout)
    elif dump.columns:
        show_tables([_records(dump)], sys.stdout)


def _records(dump: DumpFile) -> Table:
    numbers = [at for at, column in enumerate(dump.columns) if column.text is str and _is_number(dump, column.path)]
    table = Table(f"{len(dump.records)} records", [column.title for column in dump.columns], right=numbers)
    used = [record for record in dump.records if not is_zero(record)]
    if len(used) < len(dump.records):
        table.note = f"{len(dump.records) - len(used)} empty ones are left out"
    for record in used:
        table.add(*(column.text(value_at(record, column.path)) for column in dump.columns))
    return table


def _is_number(dump: DumpFile, path: str) -> bool:
    return bool(dump.records) and isinstance(value_at(dump.records[0], path), int)


def _perf_entries(dump: DumpFile) -> Table:
    table = Table(f"{len(dump.records)} entries", ("us", "since last", "id", "what"), right=(0, 1, 2))
    first = last = dump.records[0]["TimeUs"] if dump.records else 0.0
    for record in dump.records:
        time = record["TimeUs"]
        what = "left" if record["IsExit"] else "entered"
        table.add(f"{time - first:.1f}", f"{time - last:.1f}", str(record["Id"]), what)
        last = time
    return table


def _perf_timings(dump: DumpFile) -> Table:
    columns = ("id", "times", "least us", "mean us", "most us", "total us", "still inside", "left unseen")
    table = Table("From entry to exit", columns, right=range(len(columns)))
    for number, timing in timings(dump.records).items():
        taken = timing.taken_us
        numbers = (min(taken), sum(taken) / len(taken), max(taken), sum(taken)) if taken else ()
        texts = [f"{value:.1f}" for value in numbers] or ["-"] * 4
        table.add(str(number), len(taken), *texts, len(timing.open), timing.unpaired)
    return table
