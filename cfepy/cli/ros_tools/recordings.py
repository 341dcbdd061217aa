"""`cfepy rosbag verify`, `recover` and `convert`: bags and MCAP files, damaged ones too; and `info` of MCAP files."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

from cfepy.cli.json_output import check_json, write_json
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.cli.text_table import Table, show_tables
from cfepy.cli.user_notes import tell
from cfepy.ground import RecordingSummary, rewrite, summary_of
from cfepy.status import UsageError
from cfepy.units import NS_PER_S

_OTHER = {".bag": ".mcap", ".mcap": ".bag"}
MOST_TOLD = 20


def run(arguments: argparse.Namespace) -> int:
    """Carry out the action that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: there is no such recording, or a file cannot be written or exists already.
    """
    if arguments.action == "info":
        return max(map(_show_one, arguments.words))
    check_json(arguments)
    if arguments.action == "verify":
        found = summary_of(arguments.file)
        write_json(arguments, found.to_dict())
        _show(found)
        return _tell_damage(found)
    strict = arguments.action == "convert"
    output = arguments.output or _output_of(arguments.file, strict)
    _spare(arguments.file, output, is_named=arguments.output is not None, is_conversion=strict)
    found = rewrite(arguments.file, output, arguments.compression, strict)
    write_json(arguments, found.to_dict())
    left_out = sum(each.left_out for each in found.topics)
    _show(found)
    print(f"\n{output}: {found.messages - left_out:,} messages")
    if left_out:
        names = ", ".join(each.topic for each in found.topics if each.left_out)
        tell([f"left out {left_out:,} messages of {names}: a bag can hold only messages of ROS 1"])
    return _tell_damage(found)


def _show_one(file: str) -> int:
    """Show the contents and the damage of a recording. Returns the exit status."""
    found = summary_of(file)
    _show(found)
    return _tell_damage(found)


def _output_of(file: str, is_conversion: bool) -> str:
    """Return the default output file, next to the input file."""
    path = Path(file)
    if not is_conversion:
        return str(path.with_suffix(f".recovered{path.suffix if path.suffix in _OTHER else '.bag'}"))
    if path.suffix not in _OTHER:
        raise UsageError("must end with .bag or .mcap; name the output file with -o", file=file)
    return str(path.with_suffix(_OTHER[path.suffix]))


def _spare(file: str, output: str, *, is_named: bool, is_conversion: bool) -> None:
    """Check that no recording is overwritten without a request; a damaged one, the only evidence, never is."""
    if not os.path.exists(output):
        return
    if not is_named:
        raise UsageError("already exists; name another output file with -o", file=output)
    if not is_conversion and os.path.exists(file) and os.path.samefile(file, output):
        raise UsageError("must not be the damaged recording itself; give another name", file=output, field="-o")


def _tell_damage(found: RecordingSummary) -> int:
    lines = list(found.damage())
    more = [f"{len(lines) - MOST_TOLD:,} more; --json has them all"] if len(lines) > MOST_TOLD else []
    sys.stdout.flush()
    tell([f"{found.file}: {line}" for line in (*lines[:MOST_TOLD], *more)])
    return ENDED_WELL if found.is_whole else FOUND_PROBLEMS


def _show(found: RecordingSummary) -> None:
    has_losses = any(each.lost for each in found.topics)
    columns = ["topic", "type", "encoding", "connections", "messages", "bytes", "Hz", *(["lost"] if has_losses else [])]
    table = Table(_headline(found), columns, right=(3, 4, 5, 6, 7), least=(3, 2, 5))
    length_s = ((found.end_ns or 0) - (found.start_ns or 0)) / NS_PER_S
    for each in found.topics:
        rate = f"{(each.messages - 1) / length_s:.1f}" if length_s and each.messages > 1 else ""
        cells = (each.topic, each.type, each.encoding, each.connections, each.messages, each.bytes, rate)
        table.add(*cells, *([each.lost or 0] if has_losses else []))
    for name, values in found.metadata.items():
        table.note += f"{name}: {', '.join(f'{key} {value}' for key, value in values.items())}  "
    show_tables([table], sys.stdout)


def _headline(found: RecordingSummary) -> str:
    kind = "MCAP file" if found.format == ".mcap" else "bag"
    chunks = ", ".join(f"{count:,} ({name})" for name, count in sorted(found.chunks.items())) or "none"
    times = ""
    if found.start_ns is not None and found.end_ns is not None:
        start_s, end_s = found.start_ns / NS_PER_S, found.end_ns / NS_PER_S
        times = f", {end_s - start_s:.3f} s from {start_s:.6f} to {end_s:.6f}"
    return f"{found.file}: {kind}, {found.size:,} bytes, {found.messages:,} messages{times}; chunks: {chunks}"
