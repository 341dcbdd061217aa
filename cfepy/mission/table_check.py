"""Everything that is wrong with a table file, before a spacecraft says so: each fault with its offset and field.

Where `take_apart` stops at the first error, this goes on as far as the file lets it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from cfepy.fs import CONTENT_ID, HEADER_SIZE, TABLE_HEADER_SIZE, TableHeader, read_header, read_table_header
from cfepy.fs.header import DESCRIPTION_SIZE, SUBTYPE_TBL_IMG, TABLE_NAME_SIZE
from cfepy.mission.table_file import Find
from cfepy.tbl import TableType
from cfepy.tbl.image import is_intact, mark_for

LENGTH_AT = 8
DESCRIPTION_AT = HEADER_SIZE - DESCRIPTION_SIZE
NUMBERS_AT = HEADER_SIZE  # reserved, offset and size, four bytes each
NAME_AT = HEADER_SIZE + TABLE_HEADER_SIZE - TABLE_NAME_SIZE
IMAGE_AT = HEADER_SIZE + TABLE_HEADER_SIZE


class Fault(NamedTuple):
    """Something wrong: `offset` counts bytes of the file from 0, `field` is the field there."""

    offset: int
    field: str
    text: str


def faults(data: bytes, find: Find) -> Iterator[Fault]:
    """What is wrong with a table file, in the order of the file.

    Args:
        data: its bytes.
        find: knows the types of tables.
    """
    if len(data) < HEADER_SIZE:
        yield Fault(len(data), "file header", f"the file ends here, the header has {HEADER_SIZE} bytes")
        return
    found = list(_file_header(data))
    yield from found
    if any(fault.offset < LENGTH_AT for fault in found):
        return  # some other kind of file, and what follows means something else
    if len(data) < IMAGE_AT:
        yield Fault(len(data), "table header", f"the file ends here, the headers have {IMAGE_AT} bytes")
        return
    table = read_table_header(data)
    kind = find(table.table_name)
    yield from _table_header(data, table, kind)
    yield from _image(data, table)


def _file_header(data: bytes) -> Iterator[Fault]:
    header = read_header(data)
    for offset, field, value, right, meaning in (
        (0, "content type", header.content_type, CONTENT_ID, '"cFE1"'),
        (4, "subtype", header.subtype, SUBTYPE_TBL_IMG, "a table image"),
        (LENGTH_AT, "length", header.length, HEADER_SIZE, "of the file header"),
    ):
        if value != right:
            yield Fault(offset, field, f"is 0x{value:08X}, it must be 0x{right:08X}, {meaning}")
    yield from _text(data, DESCRIPTION_AT, DESCRIPTION_SIZE, "description")


def _text(data: bytes, at: int, size: int, field: str) -> Iterator[Fault]:
    """A text must end in its field, and nothing may come after its end."""
    end = data.find(b"\0", at, at + size)
    if end < 0:
        yield Fault(at + size - 1, field, f"has no NUL in its {size} bytes; shorten the text")
    elif any(data[end : at + size]):
        yield Fault(end + 1, field, "has bytes behind the end of its text; they should be 0")


def _table_header(data: bytes, table: TableHeader, kind: TableType | None) -> Iterator[Fault]:
    if not is_intact(data):
        right = f"0x{mark_for(data):08X} or 0 for no mark; the file was damaged, or changed after it was marked"
        yield Fault(NUMBERS_AT, "integrity mark", f"is 0x{table.reserved:08X}, it must be {right}")
    if kind is not None and table.offset >= kind.size:
        text = f"is {table.offset}, the table {kind.name} has only {kind.size} bytes"
        yield Fault(NUMBERS_AT + 4, "offset", text)
    elif kind is not None and table.offset + table.num_bytes > kind.size:
        text = f"is {table.num_bytes} from byte {table.offset} on, the table {kind.name} has {kind.size} bytes"
        yield Fault(NUMBERS_AT + 8, "number of bytes", text)
    if not table.num_bytes:
        yield Fault(NUMBERS_AT + 8, "number of bytes", "is 0, cFE refuses a load of nothing")
    if not all(table.table_name.partition(".")[::2]):
        yield Fault(NAME_AT, "table name", f"is {table.table_name!r}, it must be APP.Table")
    yield from _text(data, NAME_AT, TABLE_NAME_SIZE, "table name")


def _image(data: bytes, table: TableHeader) -> Iterator[Fault]:
    there = len(data) - IMAGE_AT
    if there < table.num_bytes:
        yield Fault(len(data), "data", f"the file ends after {there} of {table.num_bytes} bytes")
    elif there > table.num_bytes:
        text = f"{there - table.num_bytes} bytes more than the header says, cFE refuses the file"
        yield Fault(IMAGE_AT + table.num_bytes, "data", text)
