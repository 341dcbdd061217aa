"""Table files as YAML for editing: `write` creates the text, `read` the table file from it.

    table: HK.CopyTable
    description: HK Copy Tbl
    rows:
    - {InputMid: 0x0801, InputOffset: 16, OutputMid: 0x089C, OutputOffset: 16, NumBytes: 4}

See docs/how_to/tables_and_parameters.md for the format. Errors give file, line and field.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

from cfepy.fs import DESCRIPTION_SIZE, SUBTYPE_TBL_IMG, FileHeader, TableHeader
from cfepy.ground.cfe_files.table_file import HEADER_FIELDS, ROW, Find, KnownTables, TableContents, cut, one_nan
from cfepy.msg import Layout
from cfepy.reading.marked_yaml import Marked, load
from cfepy.reading.mistakes import Mistakes, collected, each_of
from cfepy.reading.suggestions import did_you_mean
from cfepy.status import UsageError
from cfepy.tbl import PROCESSOR_ID, SPACECRAFT_ID, TableType
from cfepy.tbl.packets import FULL_NAME_SIZE

KEYS = ("table", *HEADER_FIELDS, "mark", "reserved", "offset", "bytes", "layout", "count", "rows", "data", "after")
U32 = 0xFFFFFFFF
WIDTH = 110
HEX_LINE = 64
HEXADECIMAL = re.compile(r"(mid|msg_?id|message_?id|mask|group|groupdata|buffer)$", re.IGNORECASE)
"""Names of fields shown in hexadecimal."""


# -- writing -----------------------------------------------------------------------------------------------------------


def write(values: dict[str, Any]) -> str:
    """Return the YAML text of a document, with one line for each row that fits."""
    return "\n".join(_block(values, "")) + "\n"


def flow(value: Any, name: str = "") -> str:
    """Return a value on one line, in YAML form; numbers in hexadecimal according to the name of their field."""
    import yaml

    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {flow(item, key)}" for key, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(flow(item, name) for item in value) + "]"
    if isinstance(value, int) and not isinstance(value, bool) and value > 0 and HEXADECIMAL.search(name):
        return f"0x{value:02X}" if name.lower().endswith("buffer") else f"0x{value:04X}"
    line: str = yaml.safe_dump([value], default_flow_style=True, width=10**9)
    return line.strip()[1:-1]


def _block(value: Any, indent: str) -> Iterator[str]:
    """Yield the lines of a mapping or list: each item on one line if it fits, else as a block below."""
    if isinstance(value, list):
        for item in value:
            first, *others = _block(item, indent + "  ") if _wants_block("", item, len(indent)) else [flow(item)]
            yield f"{indent}- {first.strip()}"
            yield from others
        return
    for name, item in value.items():
        if name in ("data", "after") and isinstance(item, str):
            yield f"{indent}{name}: |"
            yield from (indent + "  " + item[at : at + HEX_LINE] for at in range(0, len(item), HEX_LINE))
        elif _wants_block(name, item, len(indent)):
            yield f"{indent}{name}:"
            yield from _block(item, indent + "  ")
        else:
            yield f"{indent}{name}: {flow(item, name)}"


def _wants_block(name: str, item: Any, before: int) -> bool:
    if not isinstance(item, dict | list) or not item:
        return False
    return name == "rows" or before + len(name) + len(flow(item, name)) > WIDTH


# -- reading -----------------------------------------------------------------------------------------------------------


def read(path: Path, find: Find) -> TableContents:
    """Return the table file for a YAML file.

    Args:
        path: the YAML file.
        find: finds the types of tables; a layout in the file has precedence.

    Raises:
        UsageError: if it has an error, with file, line and field.
    """
    return collected(partial(_table, load(path, handed=True), find))


def _table(root: Marked, find: Find, mistakes: Mistakes) -> TableContents:
    said = dict(mistakes.fields(root, KEYS))
    header = mistakes.attempt(partial(_header, said)) or FileHeader()
    offset, reserved = (mistakes.attempt(partial(_number, said, name)) for name in ("offset", "reserved"))
    after = mistakes.attempt(partial(_hex, said.get("after"))) or b""
    wants_mark = mistakes.attempt(partial(_wants_mark, said))
    if mistakes.errors and not ("table" in said and {"data", "rows"} & said.keys()):
        raise mistakes.errors.pop()  # a missing key is perhaps the misspelt one, which has its error already
    if "table" not in said:
        raise root.fail("missing table; write `table: APP.Table`")
    name = said["table"].text()
    if "." not in name or not 0 < len(name) < FULL_NAME_SIZE:
        raise said["table"].fail(f"must be APP.Table with at most {FULL_NAME_SIZE - 1} characters, not {name!r}")
    kind = own_type(said, find.struct if isinstance(find, KnownTables) else _no_struct) or find(name)
    image = _image(said, kind, offset or 0, find.types if isinstance(find, KnownTables) else ())
    table = TableHeader(name, len(image), offset or 0, reserved or 0)
    file = TableContents(header, table, image, after, kind)
    return file.marked() if wants_mark else file


def _no_struct(name: str) -> Layout | None:
    return None


def own_type(said: dict[str, Marked], struct: Callable[[str], Layout | None] = _no_struct) -> TableType | None:
    """Return the table's type declared in the file itself; None if there is none.

    Args:
        said: the fields of the file.
        struct: returns a struct of the mission's applications by its name in C, which `layout` may be.
    """
    if "layout" not in said:
        if "count" in said:
            raise said["count"].fail("requires a `layout`; add one, or remove this")
        return None
    count = said["count"].integer(1) if "count" in said else 1
    layout = said["layout"]
    if isinstance(layout.value, str):
        known = struct(layout.value)
        if known is None:
            what = "give the fields, or the name of a struct in the mission's dictionary or compiled code"
            raise layout.fail(f"unknown struct {layout.value}; {what}")
        return TableType(said["table"].plain(), known, count)
    return TableType(said["table"].plain(), _layout(layout, "row"), count)


def _layout(marked: Marked, name: str) -> Layout:
    parts = marked.mapping()
    types = each_of(partial(_checked_type, kind, field) for field, kind in parts.items())
    fields = list(zip(parts, types, strict=True))
    if not fields:
        raise marked.fail("has no fields; add at least one, such as `Name: u16`")
    try:
        return Layout(name, fields)
    except UsageError as error:
        wrong = marked.value.get((error.field or "").rpartition(".")[2], marked)
        raise wrong.fail(error.text) from None


def _checked_type(marked: Marked, name: str) -> Any:
    """Return the type of one field of a layout."""
    kind = _field_type(marked, name)
    try:
        Layout(name, [(name, kind)])
    except UsageError as error:
        raise marked.fail(error.text) from None
    return kind


def _field_type(marked: Marked, name: str) -> Any:
    if isinstance(marked.value, dict):
        return _layout(marked, name)
    if isinstance(marked.value, list):
        if len(marked.value) != 2:
            raise marked.fail("must be a list of two items, [{fields of a struct}, count]")
        inner, count = marked.value
        return _layout(inner, name), count.integer(1)
    return marked.text()


def _header(said: dict[str, Marked]) -> FileHeader:
    description = said["description"].text() if "description" in said else ""
    if len(description.encode("latin-1", "replace")) >= DESCRIPTION_SIZE:
        raise said["description"].fail(f"has more than {DESCRIPTION_SIZE - 1} characters; shorten it")
    return FileHeader(
        description,
        SUBTYPE_TBL_IMG,
        spacecraft_id=_number(said, "spacecraft_id", SPACECRAFT_ID),
        processor_id=_number(said, "processor_id", PROCESSOR_ID),
        application_id=_number(said, "application_id"),
        time_seconds=_number(said, "time_seconds"),
        time_subseconds=_number(said, "time_subseconds"),
    )


def _number(said: dict[str, Marked], name: str, default: int = 0) -> int:
    return said[name].integer(0, U32) if name in said else default


def _wants_mark(said: dict[str, Marked]) -> bool:
    """Return whether to add an integrity mark: always, unless the file excludes it or uses that place."""
    if "mark" not in said:
        return "reserved" not in said
    return said["mark"].flag()


def _hex(marked: Marked | None) -> bytes:
    if marked is None:
        return b""
    try:
        return bytes.fromhex(str(marked.value))
    except ValueError:
        raise marked.fail("must be hexadecimal digits, two for each byte") from None


def _image(said: dict[str, Marked], kind: TableType | None, offset: int, known: Iterable[str]) -> bytes:
    if "data" in said:
        if "rows" in said:
            raise said["data"].fail("cannot be combined with `rows`; remove one of them")
        image = _hex(said["data"])
    elif kind is None:
        name = said["table"].value
        hint = did_you_mean(name, known, before="; ")
        remedy = f"{' Otherwise' if hint else ';'} name its mission with --mission, or add a `layout`"
        raise said["table"].fail(f"unknown table {name}{hint}{remedy}")
    else:
        size = _number(said, "bytes", max(0, kind.size - offset))
        image = cut(_packed(said.get("rows"), kind), offset, size)
        if len(image) != size:
            raise said["bytes"].fail(f"reaches past the end of the table, which has {kind.size} bytes")
    if not image:
        raise said["table"].fail("has no data, so cFE cannot load the file; add `rows` or `data`")
    return image


def _packed(rows: Marked | None, kind: TableType) -> bytes:
    """Return all bytes of a table from its rows."""
    return bytes(collected(partial(_packed_rows, rows, kind)))


def _packed_rows(rows: Marked | None, kind: TableType, mistakes: Mistakes) -> bytearray:
    image = bytearray(kind.size)
    number = -1
    for row in rows.items() if rows is not None else ():
        fields = mistakes.mapping(row)
        numbered = ROW in fields and ROW not in kind.row.fields
        said = mistakes.attempt(fields[ROW].integer) if numbered else None
        if said is not None and said <= number:
            mistakes.add(fields[ROW].fail(f"is {said}, but follows row {number}; sort the rows"))
        number = number + 1 if said is None else said
        if number >= kind.rows:
            raise row.fail(f"row {number} (counted from 0) is out of range; {kind.name} has {kind.rows} rows")
        given = {name: one_nan(value.plain()) for name, value in fields.items() if name != ROW or not numbered}
        try:
            image[number * kind.row.size : (number + 1) * kind.row.size] = kind.row.pack(given)
        except UsageError as error:
            wrong = [*_wrong_fields(kind.row, given)] or [error]
            mistakes.errors += [_place(row, each.field or "").fail(each.text) for each in wrong]
    return image


def _wrong_fields(layout: Layout, given: dict[str, Any]) -> Iterator[UsageError]:
    """Yield the errors of the fields of a row, each packed without the others."""
    for name, value in given.items():
        try:
            layout.pack({name: value})
        except UsageError as error:
            yield error


def _place(row: Marked, path: str) -> Marked:
    """Return the part of a row at a path, "Config[2].FcnCode", or the nearest one around it."""
    place = row
    for name, index in re.findall(r"(\w+)|\[(\d+)\]", path):
        if isinstance(place.value, dict) and name in place.value:
            place = place.value[name]
        elif isinstance(place.value, list) and index and int(index) < len(place.value):
            place = place.value[int(index)]
    return place
