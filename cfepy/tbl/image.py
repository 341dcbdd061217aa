"""Table files made and read by people and tools: headers and image in one, from field values (elf2cfetbl's job).

A mission describes its tables as Python values and a layout; this turns them into the bytes that CFE_TBL_Load accepts.

cFE's table files carry no check value. A file may be given one here, an integrity mark: the reserved word of its table
header, which is 0 in all others and which NASA's cFE does not look at, then says "CR" and the CRC of the whole file. It
is the CRC of CFE_ES_CalculateCRC, so that flight software can check it too. A marked file of which a bit is wrong is
never loaded; a file without mark loads as ever.
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
    """What a table file holds: `data` belongs at byte `offset` of the table called `name` ("APP.Table")."""

    name: str
    data: bytes
    description: str = ""
    offset: int = 0
    spacecraft_id: int = SPACECRAFT_ID
    processor_id: int = PROCESSOR_ID
    time: tuple[int, int] = (0, 0)


def build(image: TableImage) -> bytes:
    """The table file of an image.

    Raises:
        UsageError: the name is empty, has no dot, or is longer than 39 characters; or there is no data.
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
    """The image in a table file.

    Raises:
        CfeError: the file is no table file or is too short; the statuses are those of CFE_TBL_Load.
    """
    header, table, image = read_table_file(data)
    ids = header.spacecraft_id, header.processor_id
    time = header.time_seconds, header.time_subseconds
    return TableImage(table.table_name, image[: table.num_bytes], header.description, table.offset, *ids, time)


def mark_for(data: bytes) -> int:
    """The integrity mark that belongs into a table file: MARK_TAG and the CRC of the file with a mark of 0.

    Args:
        data: the whole file, whether or not it has a mark.
    """
    return MARK_TAG | crc16(data[HEADER_SIZE + 4 :], crc16(bytes(4), crc16(data[:HEADER_SIZE])))


def mark_in(data: bytes) -> int:
    """The integrity mark that a table file has; 0 for none."""
    return int.from_bytes(data[_MARK], "big")


def with_mark(data: bytes) -> bytes:
    """A table file with its integrity mark.

    Raises:
        UsageError: it is too short for a table file.
    """
    if len(data) < HEADER_SIZE + TABLE_HEADER_SIZE:
        raise UsageError(f"a table file must have at least {HEADER_SIZE + TABLE_HEADER_SIZE} bytes, not {len(data)}")
    return data[:HEADER_SIZE] + mark_for(data).to_bytes(4, "big") + data[HEADER_SIZE + 4 :]


def is_intact(data: bytes) -> bool:
    """Whether a table file has no integrity mark, or the one that belongs to it."""
    mark = mark_in(data)
    return mark == 0 or mark == mark_for(data)


def pack_rows(row: Layout, rows: Sequence[Mapping[str, Any]], capacity: int) -> bytes:
    """A table that is an array of `capacity` equal structs, filled up with zeros after the given rows.

    Raises:
        UsageError: too many rows, or a value that does not fit; `field` says which row and field.
    """
    if len(rows) > capacity:
        raise UsageError(f"must have at most {capacity} rows of {row.name}, not {len(rows)}", field="rows")
    return Layout(f"{row.name}[{capacity}]", [("rows", (row, capacity))]).pack(rows=rows)


def unpack_rows(row: Layout, data: bytes | bytearray | memoryview) -> list[dict[str, Any]]:
    """The rows of such a table, zero rows included."""
    return [row.unpack(data, at) for at in range(0, len(data) - row.size + 1, row.size)]


def write_beside(definition: str, image: TableImage) -> Path:
    """Write the table file that a definition describes: "x.py" makes "x.tbl" in the same directory.

    Args:
        definition: path of the definition, usually its `__file__`.
        image: what it describes.

    Returns:
        The path written.
    """
    path = Path(definition).with_suffix(".tbl")
    path.write_bytes(build(image))
    return path
