"""ROS's parameter tables as the ground sees them: rows of a name and a value, and the packets of the application ROS.

The tables are ROS.Params01, ROS.Params02 and so on, as many as the platform has room for, and are read one after the
other. A row with the name "+" continues the value of the row above, "+xyz" its name too.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

from cfepy.config.platform import PlatformConfig
from cfepy.msg import Command, Layout, Telemetry
from cfepy.tbl import TableType
from rospy_shim.parameters.values import parts_of, value_of

APP_NAME = "ROS"
NAME_BYTES, VALUE_BYTES = 48, 80
MORE = "+"
MOST_TABLES = 64
MOST_ROWS = 127
"""Rows of a table, so that with the CDS's header it fits into a block of 16384 bytes."""

ROW = Layout("ROS_Parameter_t", [("Name", f"char[{NAME_BYTES}]"), ("Value", f"char[{VALUE_BYTES}]")])
CMD_MID, SEND_HK_MID, WAKEUP_MID, HK_TLM_MID = 0x18FD, 0x18FE, 0x18FF, 0x08FE
MASTER_MID, MASTER_TLM_MID = 0x18FC, 0x08FC
"""Requests of compiled nodes, and the answers, in the form of service packets (`rospy_shim.graph.compiled`)."""

_HK = Layout(
    "ROS_HkTlm_Payload_t",
    [
        ("CommandCounter", "u8"),
        ("CommandErrorCounter", "u8"),
        ("Tables", "u16"),
        ("Parameters", "u32"),
        ("RowsUsed", "u16"),
        ("RowsFree", "u16"),
    ],
)

NOOP = Command("ROS_NOOP", CMD_MID, 0, text="Answer with an event.")
RESET_COUNTERS = Command("ROS_RESET_COUNTERS", CMD_MID, 1, text="Set the counters to 0.")
SEND_HK = Command("ROS_SEND_HK", SEND_HK_MID, text="Send the housekeeping packet.")
WAKEUP = Command("ROS_WAKEUP", WAKEUP_MID, text="Write the values that nodes have set, and manage the tables.")
HK_TLM = Telemetry("ROS_HK_TLM", HK_TLM_MID, _HK)

COMMANDS = (NOOP, RESET_COUNTERS, SEND_HK, WAKEUP)
TELEMETRY = (HK_TLM,)

_ROW = struct.Struct(f"{NAME_BYTES}s{VALUE_BYTES}s")
ROW_BYTES = _ROW.size
_GROWN = NAME_BYTES - len(MORE)

Row = tuple[str, str]
FREE: Row = ("", "")
_LARGEST_BLOCK = 16_384
_BLOCK_HEADER = 24
_CDS_HEADER = 4
_CDS_RECORD = 72  # of the CDS's registry, for each possible block
_CRITICAL_RECORD = 256  # of the registry of critical tables, which takes a block of twice its size in the worst case


def extent(config: PlatformConfig) -> tuple[int, int]:
    """Return the number of tables under a platform's limits, and the number of rows of each.

    Each takes a block of the CDS and two of the table memory. A quarter of both, and half of the critical tables, are
    left to others.
    """
    registries = config.es_cds_max_num_entries * _CDS_RECORD + config.tbl_max_critical_tables * _CRITICAL_RECORD
    room = min(config.es_cds_size - registries, config.tbl_buf_memory_bytes // 2) * 3 // 4
    block = _LARGEST_BLOCK
    while block > min(room, config.tbl_max_dbl_table_size) and block > ROW_BYTES:
        block //= 2
    count = min(MOST_TABLES, config.tbl_max_critical_tables // 2, room // (block + _BLOCK_HEADER))
    return count, (block - _CDS_HEADER) // ROW_BYTES


class Record(NamedTuple):
    """One parameter in the tables: its name, the text of its value, its first row, and its number of rows."""

    name: str
    text: str
    first: int
    length: int


def table_name(number: int) -> str:
    """Return a table's own name, by its number from 0."""
    return f"Params{number + 1:02}"


TABLES = tuple(
    TableType(
        f"{APP_NAME}.{table_name(number)}",
        ROW,
        rows=MOST_ROWS,
        description=f"ROS parameters {number + 1}",
        fault=lambda image: fault(unpack(image)),
    )
    for number in range(MOST_TABLES)
)


def rows_for(name: str, text: str) -> list[Row]:
    """Return the rows of one parameter."""
    rows = [(name[:NAME_BYTES], text[:VALUE_BYTES])]
    for row in range(1, count_rows(name, text)):
        part = name[NAME_BYTES + (row - 1) * _GROWN : NAME_BYTES + row * _GROWN]
        rows.append((MORE + part, text[row * VALUE_BYTES : (row + 1) * VALUE_BYTES]))
    return rows


def count_rows(name: str, text: str) -> int:
    """Return the number of rows of a parameter."""
    return max(1, -(-len(text) // VALUE_BYTES), 1 - (NAME_BYTES - len(name)) // _GROWN)


def pack(row: Row) -> bytes:
    """Return a row's bytes; bytes that are not part of a parameter stay as `unpack` found them."""
    return _ROW.pack(row[0].encode("latin-1"), row[1].encode("latin-1"))


def unpack(image: bytes | memoryview) -> list[Row]:
    """Return the rows of an image; bytes that are not ASCII are kept and make no parameter."""
    data = bytes(image)
    if data == bytes(len(data)):  # as most tables at the boot of a mission
        return [FREE] * (len(data) // ROW_BYTES)
    return [(_text(name), _text(value)) for name, value in _ROW.iter_unpack(data)]


def records(rows: Iterable[Row]) -> Iterator[Record]:
    """Yield the parameters in rows; continuation rows without a beginning are left out."""
    begun: Record | None = None
    for index, (name, text) in enumerate(rows):
        if begun is not None and name.startswith(MORE):
            begun = Record(begun.name + name[len(MORE) :], begun.text + text, begun.first, begun.length + 1)
            continue
        if begun is not None:
            yield begun
        begun = Record(name, text, index, 1) if name and not name.startswith(MORE) else None
    if begun is not None:
        yield begun


def fault(rows: Sequence[Row]) -> str | None:
    """Return the error in one table's rows, which may begin and end within a parameter; None if there is no error."""
    seen: dict[str, int] = {}
    found = list(records(rows))
    for record in found:
        is_last = record.first + record.length == len(rows)
        try:
            parts_of(record.name)
            if not is_last:
                value_of(record.text)
        except ValueError as error:
            return f"row {record.first}: {error}"
        if record.name in seen:
            return f"row {record.first}: {record.name} is in row {seen[record.name]} too"
        seen[record.name] = record.first
    return None


def tree_of(rows: Iterable[Row], problems: list[str]) -> tuple[dict[str, Any], dict[str, Record]]:
    """Make the tree from the rows of all tables.

    Args:
        rows: rows of the first table, then of the second, and so on.
        problems: receives a line for each parameter that cannot be read.

    Returns:
        The tree, and the records that it was made of, by name.
    """
    tree: dict[str, Any] = {}
    good: dict[str, Record] = {}
    for record in records(rows):
        try:
            if record.name in good:
                raise ValueError("the name is given twice")
            _insert(tree, parts_of(record.name), value_of(record.text))
        except ValueError as error:
            problems.append(f"row {record.first}: {record.name}: {error}")
        else:
            good[record.name] = record
    return tree, good


def _insert(tree: dict[str, Any], parts: list[str], value: Any) -> None:
    for part in parts[:-1]:
        inner = tree.setdefault(part, {})
        if type(inner) is not dict:
            raise ValueError(f"{part} has a value, so it cannot be a namespace")
        tree = inner
    if tree.get(parts[-1], value) != value:
        raise ValueError("is a namespace, so it cannot have a value")
    tree[parts[-1]] = value


def _text(field: bytes) -> str:
    return field.partition(b"\0")[0].decode("latin-1")
