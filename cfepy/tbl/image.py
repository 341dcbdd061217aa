"""Table files for users and tools: headers and image in one, from field values (the job of elf2cfetbl).

A mission describes its tables as Python values and a layout. This module converts them into the bytes that CFE_TBL_Load
accepts.

cFE's table files have no check value. Here a file can have one, an integrity mark: the reserved word of its table
header then has "CR" and the CRC of the whole file. The word is 0 in all other files, and NASA's cFE ignores it. The CRC
is the one of CFE_ES_CalculateCRC, so flight software can check it too. A marked file with a wrong bit is never loaded.
A file without a mark loads as usual.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from cfepy.fs import HEADER_SIZE, TABLE_HEADER_SIZE, FileHeader, crc16, read_table_file, write_table_file
from cfepy.msg import Layout
from cfepy.status import UsageError
from cfepy.tbl.packets import FULL_NAME_SIZE

SPACECRAFT_ID = 66
PROCESSOR_ID = 1

MARK_TAG = 0x43520000
"""The upper half of an integrity mark: "CR"."""

_MARK = slice(HEADER_SIZE, HEADER_SIZE + 4)


class TableImage(NamedTuple):
    """The content of a table file: `data` belongs at byte `offset` of the table `name` ("APP.Table")."""

    name: str
    data: bytes
    description: str = ""
    offset: int = 0
    spacecraft_id: int = SPACECRAFT_ID
    processor_id: int = PROCESSOR_ID
    time: tuple[int, int] = (0, 0)


def build(image: TableImage) -> bytes:
    """Return the table file of an image.

    Raises:
        UsageError: if the name is empty, has no dot, or is longer than 39 characters; or there is no data.
    """
    if "." not in image.name or not 0 < len(image.name) < FULL_NAME_SIZE:
        text = f"invalid table name {image.name!r}; expected APP.Table with at most {FULL_NAME_SIZE - 1} characters"
        raise UsageError(text, field="name")
    if not image.data:
        raise UsageError("must have at least one byte", field="data")
    header = FileHeader(
        description=image.description,
        spacecraft_id=image.spacecraft_id,
        processor_id=image.processor_id,
        time_seconds=image.time[0],
        time_subseconds=image.time[1],
    )
    return write_table_file(header, image.name, image.data, image.offset)


def read(data: bytes) -> TableImage:
    """Return the image in a table file.

    Raises:
        CfeError: if the file is not a table file or is too short; with the statuses of CFE_TBL_Load.
    """
    header, table, image = read_table_file(data)
    ids = header.spacecraft_id, header.processor_id
    time = header.time_seconds, header.time_subseconds
    return TableImage(table.table_name, image[: table.num_bytes], header.description, table.offset, *ids, time)


def mark_for(data: bytes) -> int:
    """Return the correct integrity mark of a table file: MARK_TAG and the CRC of the file with a mark of 0.

    Args:
        data: the whole file, whether or not it has a mark.
    """
    return MARK_TAG | crc16(data[HEADER_SIZE + 4 :], crc16(bytes(4), crc16(data[:HEADER_SIZE])))


def mark_in(data: bytes) -> int:
    """Return the integrity mark in a table file; 0 for none."""
    return int.from_bytes(data[_MARK], "big")


def with_mark(data: bytes) -> bytes:
    """Return a table file with its integrity mark.

    Raises:
        UsageError: if it is too short for a table file.
    """
    if len(data) < HEADER_SIZE + TABLE_HEADER_SIZE:
        raise UsageError(f"a table file must have at least {HEADER_SIZE + TABLE_HEADER_SIZE} bytes, not {len(data)}")
    return data[:HEADER_SIZE] + mark_for(data).to_bytes(4, "big") + data[HEADER_SIZE + 4 :]


def is_intact(data: bytes) -> bool:
    """Return whether a table file has no integrity mark or a correct one."""
    mark = mark_in(data)
    return mark == 0 or mark == mark_for(data)


def pack_rows(row: Layout, rows: Sequence[Mapping[str, Any]], capacity: int) -> bytes:
    """Return a table that is an array of `capacity` equal structs, padded with zeros after the given rows.

    Raises:
        UsageError: for too many rows, or a value that does not fit; `field` has its path.
    """
    if len(rows) > capacity:
        raise UsageError(f"must have at most {capacity} rows of {row.name}, not {len(rows)}", field="rows")
    return Layout(f"{row.name}[{capacity}]", [("rows", (row, capacity))]).pack(rows=rows)


def unpack_rows(row: Layout, data: bytes | bytearray | memoryview) -> list[dict[str, Any]]:
    """Return the rows of such a table, including zero rows."""
    return [row.unpack(data, at) for at in range(0, len(data) - row.size + 1, row.size)]


def write_beside(definition: str, image: TableImage) -> Path:
    """Write the table file of a definition: "x.py" makes "x.tbl" in the same directory.

    Args:
        definition: path of the definition, usually its `__file__`.
        image: its image.

    Returns:
        The path of the file.
    """
    path = Path(definition).with_suffix(".tbl")
    path.write_bytes(build(image))
    return path
