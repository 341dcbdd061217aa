"""A decoded table file: its headers, its image as rows of named fields, and all its errors.

`document` returns the contents of a file as plain values, without zeros that can be left out;
`cfepy.ground.cfe_files.table_yaml` converts it into an editable file, and back. `take_apart` stops at the first error;
`defects_of` continues as far as possible and finds each defect, with its offset and field, before a spacecraft refuses
the file.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from cfepy.fs import (
    CONTENT_ID,
    DESCRIPTION_SIZE,
    HEADER_SIZE,
    SUBTYPE_TBL_IMG,
    TABLE_HEADER_SIZE,
    TABLE_NAME_SIZE,
    FileHeader,
    TableHeader,
    crc16,
    read_header,
    read_table_file,
    read_table_header,
)
from cfepy.msg import Layout
from cfepy.status import CfeError, UsageError
from cfepy.tbl import TableType, is_intact, mark_for, mark_in

Find = Callable[[str], TableType | None]


@dataclass(frozen=True, slots=True)
class KnownTables:
    """Finds the types of tables by full name; an error about an unknown table suggests one of them.

    Attributes:
        types: the types by full name.
        struct: returns a struct of the mission's applications by its name in C.
    """

    types: Mapping[str, TableType]
    struct: Callable[[str], Layout | None] = lambda name: None

    def __call__(self, name: str) -> TableType | None:
        return self.types.get(name)


"""Returns the type of a table by its full name; None if it is not declared."""
ROW = "row"
"""Key for the number of a row after empty rows that are left out; not possible if fields have this name."""
HEADER_FIELDS = (
    "description",
    "spacecraft_id",
    "processor_id",
    "application_id",
    "time_seconds",
    "time_subseconds",
)
LENGTH_AT = 8
DESCRIPTION_AT = HEADER_SIZE - DESCRIPTION_SIZE
NUMBERS_AT = HEADER_SIZE  # reserved, offset and size, four bytes each
NAME_AT = HEADER_SIZE + TABLE_HEADER_SIZE - TABLE_NAME_SIZE
IMAGE_AT = HEADER_SIZE + TABLE_HEADER_SIZE


class Leaf(NamedTuple):
    """A field of a table: its path, "rows[3].InputMid", and its value."""

    path: str
    value: Any


@dataclass(frozen=True, slots=True)
class TableContents:
    """Headers, image, data after the image, and the table's type if it is known."""

    header: FileHeader
    table: TableHeader
    image: bytes
    after: bytes = b""
    kind: TableType | None = None

    @property
    def crc(self) -> int:
        """CRC-16 of the image, as in cFE's telemetry after the whole table was loaded."""
        return crc16(self.image)

    @property
    def is_whole(self) -> bool:
        """Whether the image is the whole table; if the type is unknown, whether it starts at offset 0."""
        return self.table.offset == 0 and (self.kind is None or len(self.image) == self.kind.size)

    def pack(self) -> bytes:
        """Return the file's bytes."""
        return self.header.pack() + self.table.pack() + self.image + self.after

    @property
    def is_marked(self) -> bool:
        """Return whether it has its integrity mark (`cfepy.tbl.image`)."""
        data = self.pack()
        return mark_in(data) == mark_for(data)

    def marked(self) -> TableContents:
        """Return this file with its integrity mark."""
        return replace(self, table=replace(self.table, reserved=mark_for(self.pack())))

    def rows(self) -> list[dict[str, Any]] | None:
        """Return all rows of the table, with zeros outside of a partial image; None if they cannot represent
        the image.
        """
        kind, offset = self.kind, self.table.offset
        if kind is None or offset + len(self.image) > kind.size:
            return None
        image = bytes(offset) + self.image + bytes(kind.size - offset - len(self.image))
        rows: list[dict[str, Any]] = one_nan(kind.unpack(image))
        return rows if cut(kind.pack(rows), offset, len(self.image)) == self.image else None

    def leaves(self) -> Iterator[Leaf]:
        """Yield every field of every row; without rows, hexadecimal bytes, sixteen at a time."""
        rows = self.rows()
        if rows is not None:
            yield from leaves_of(rows, "rows")
            return
        for at in range(0, len(self.image), 16):
            yield Leaf(f"data[0x{self.table.offset + at:04X}]", self.image[at : at + 16].hex(" "))


def cut(data: bytes, offset: int, size: int) -> bytes:
    """Part of a table's bytes."""
    return data[offset : offset + size]


def leaves_of(value: Any, path: str) -> Iterator[Leaf]:
    """Yield the scalars in nested dicts and lists."""
    if isinstance(value, dict):
        for name, item in value.items():
            yield from leaves_of(item, f"{path}.{name}")
    elif isinstance(value, list):
        for number, item in enumerate(value):
            yield from leaves_of(item, f"{path}[{number}]")
    else:
        yield Leaf(path, value)


def take_apart(data: bytes, find: Find, file: str) -> TableContents:
    """Read a table file.

    Args:
        data: its bytes.
        find: finds the types of tables.
        file: its name, for errors.

    Raises:
        UsageError: if it is not a table file.
    """
    try:
        header, table, image = read_table_file(data)
    except CfeError as error:
        text = f"is not a table file: {error.text}; give a file that cFE or `cfepy tbl build` wrote"
        raise UsageError(text, file=file) from None
    size = table.num_bytes
    return TableContents(header, table, image[:size], image[size:], find(table.table_name))


def document(file: TableContents) -> dict[str, Any]:
    """Return the contents of a table file as plain values, in reading order."""
    values: dict[str, Any] = {"table": file.table.table_name}
    values.update((name, getattr(file.header, name)) for name in HEADER_FIELDS)
    if file.table.reserved and not file.is_marked:
        values["reserved"] = file.table.reserved
    else:
        values["mark"] = file.is_marked
    if not file.is_whole:
        values["offset"] = file.table.offset
        values["bytes"] = len(file.image)
    rows = file.rows()
    if rows is None or file.kind is None:
        values["data"] = file.image.hex()
    else:
        values["rows"] = _used(rows, ROW not in file.kind.row.fields)
    if file.after:
        values["after"] = file.after.hex()
    return values


def _used(rows: list[dict[str, Any]], may_number: bool) -> list[dict[str, Any]]:
    """Return the rows that are not all zero; if `may_number` is false, empty ones between them stay."""
    used: list[dict[str, Any]] = []
    following = 0
    for number, row in enumerate(rows):
        if is_zero(row):
            continue
        if number > following and may_number:
            used.append({ROW: number, **_trimmed(row)})
        else:
            used += [{} for _ in range(following, number)] + [_trimmed(row)]
        following = number + 1
    return used


def _trimmed(value: Any) -> Any:
    """Return a value without zeros at the ends of lists; an empty struct between others is {}."""
    if isinstance(value, dict):
        return {name: _trimmed(item) for name, item in value.items()}
    if not isinstance(value, list):
        return value
    last = max((number for number, item in enumerate(value) if not is_zero(item)), default=-1)
    return [{} if isinstance(item, dict) and is_zero(item) else _trimmed(item) for item in value[: last + 1]]


def one_nan(value: Any) -> Any:
    """Return a value with all kinds of NaN replaced by a single one, because YAML has only one."""
    if isinstance(value, dict):
        return {name: one_nan(item) for name, item in value.items()}
    if isinstance(value, list):
        return [one_nan(item) for item in value]
    return math.nan if isinstance(value, float) and math.isnan(value) else value


def is_zero(value: Any) -> bool:
    """Return whether a value equals that of a missing field."""
    if isinstance(value, dict):
        return all(is_zero(item) for item in value.values())
    if isinstance(value, list):
        return all(is_zero(item) for item in value)
    return not value and not (isinstance(value, float) and math.copysign(1, value) < 0)


class TableDefect(NamedTuple):
    """An error: `offset` counts bytes of the file from 0, `field` is the field there."""

    offset: int
    field: str
    text: str


def defects_of(data: bytes, find: Find) -> Iterator[TableDefect]:
    """Yield the errors of a table file, in the order of the file.

    Args:
        data: its bytes.
        find: finds the types of tables.
    """
    if len(data) < HEADER_SIZE:
        yield TableDefect(len(data), "file header", f"the file ends here, the header has {HEADER_SIZE} bytes")
        return
    found = list(_file_header(data))
    yield from found
    if any(defect.offset < LENGTH_AT for defect in found):
        return  # another kind of file, with other data after the header
    if len(data) < IMAGE_AT:
        yield TableDefect(len(data), "table header", f"the file ends here, the headers have {IMAGE_AT} bytes")
        return
    table = read_table_header(data)
    kind = find(table.table_name)
    yield from _table_header(data, table, kind)
    yield from _image(data, table)
    yield from _content(data[IMAGE_AT:], table, kind)


def _file_header(data: bytes) -> Iterator[TableDefect]:
    header = read_header(data)
    for offset, field, value, right, meaning in (
        (0, "content type", header.content_type, CONTENT_ID, '"cFE1"'),
        (4, "subtype", header.subtype, SUBTYPE_TBL_IMG, "a table image"),
        (LENGTH_AT, "length", header.length, HEADER_SIZE, "of the file header"),
    ):
        if value != right:
            yield TableDefect(offset, field, f"is 0x{value:08X}, it must be 0x{right:08X}, {meaning}")
    yield from _text_field(data, DESCRIPTION_AT, DESCRIPTION_SIZE, "description")


def _text_field(data: bytes, at: int, size: int, field: str) -> Iterator[TableDefect]:
    """Check a text: it must end inside its field, with nothing after its end."""
    end = data.find(b"\0", at, at + size)
    if end < 0:
        yield TableDefect(at + size - 1, field, f"has no NUL in its {size} bytes; shorten the text")
    elif any(data[end : at + size]):
        yield TableDefect(end + 1, field, "has bytes behind the end of its text; they should be 0")


def _table_header(data: bytes, table: TableHeader, kind: TableType | None) -> Iterator[TableDefect]:
    if not is_intact(data):
        right = f"0x{mark_for(data):08X} or 0 for no mark; the file was damaged, or changed after it was marked"
        yield TableDefect(NUMBERS_AT, "integrity mark", f"must be {right}, not 0x{table.reserved:08X}")
    if kind is not None and table.offset >= kind.size:
        text = f"is {table.offset}, but the table {kind.name} has only {kind.size} bytes"
        yield TableDefect(NUMBERS_AT + 4, "offset", text)
    elif kind is not None and table.offset + table.num_bytes > kind.size:
        text = f"is {table.num_bytes} from byte {table.offset} on, but the table {kind.name} has only {kind.size} bytes"
        yield TableDefect(NUMBERS_AT + 8, "number of bytes", text)
    if not table.num_bytes:
        yield TableDefect(NUMBERS_AT + 8, "number of bytes", "must be greater than 0; cFE refuses an empty load")
    if not all(table.table_name.partition(".")[::2]):
        yield TableDefect(NAME_AT, "table name", f"must be APP.Table, not {table.table_name!r}")
    yield from _text_field(data, NAME_AT, TABLE_NAME_SIZE, "table name")


def _content(image: bytes, table: TableHeader, kind: TableType | None) -> Iterator[TableDefect]:
    """Check a whole image with the application's own validation, which does not work for a part of a table."""
    if kind is None or kind.fault is None or table.offset or table.num_bytes != kind.size or len(image) != kind.size:
        return
    fault = kind.fault(image)
    if fault is not None:
        yield TableDefect(IMAGE_AT, "data", f"the application refuses it: {fault}")


def _image(data: bytes, table: TableHeader) -> Iterator[TableDefect]:
    there = len(data) - IMAGE_AT
    if there < table.num_bytes:
        yield TableDefect(len(data), "data", f"the file ends after {there} of {table.num_bytes} bytes")
    elif there > table.num_bytes:
        text = f"{there - table.num_bytes} bytes more than the header specifies; cFE refuses the file"
        yield TableDefect(IMAGE_AT + table.num_bytes, "data", text)
