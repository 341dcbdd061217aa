"""Hypothesis strategies for what goes over the Software Bus and into tables: packets by name, payloads, rows."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from hypothesis import strategies as st

from cfepy.mission.dictionary import Dictionary, dictionary_of
from cfepy.mission.spec import read_mission
from cfepy.mission.topics import Topic
from cfepy.msg import CMD_HEADER_SIZE, HIGHEST_VALID_MSG_ID, Command, Layout, Telemetry, command, telemetry
from cfepy.msg.layout import Cell
from cfepy.status import UsageError
from cfepy.testing.table_types import table_type

LONGEST_PAYLOAD = 64
MOST_ROWS = 4  # that are not all zero; more would only make examples longer
COMMAND_BIT = 0x1000
HAS_TIME_OR_CODE = 0x0800
TELEMETRY_IDS, COMMAND_IDS = (0x0801, 0x0FFF), (0x1801, 0x1FFF)
SIZE_BYTES = slice(4, 6)
CODE_BYTE = 6
UNKNOWN_CODE = 0x7F

Mission = str | os.PathLike[str] | None
Fields = Mapping[str, st.SearchStrategy[Any]]


def cell_values(cell: Cell) -> st.SearchStrategy[Any]:
    """All values that one field of a struct can have; text without the NUL that would end it."""
    if cell.type.startswith("char"):
        printable = st.characters(min_codepoint=32, max_codepoint=126)
        return st.text(printable, max_size=max(0, cell.size - 1))
    if cell.type == "bool":
        return st.booleans()
    bits = 8 * cell.size
    if cell.type.startswith("f"):
        return st.floats(width=32 if bits == 32 else 64)
    signed = cell.type.startswith("i")
    return st.integers(-(2 ** (bits - 1)), 2 ** (bits - 1) - 1) if signed else st.integers(0, 2**bits - 1)


def fields_of(layout: Layout, given: Fields, owner: str) -> st.SearchStrategy[dict[str, Any]]:
    """Values of a struct by path: {"PacketID.AppName": "HK", "Counts[0]": 1}.

    Args:
        layout: the struct.
        given: strategies in place of those that the type alone suggests, by path.
        owner: of the fields, for the error.

    Raises:
        UsageError: there is no such field.
    """
    cells = {cell.path: cell_values(cell) for cell in layout.cells()}
    for path in given:
        if path not in cells:
            raise UsageError(f"{owner} has no such field; it has {', '.join(cells) or 'none'}", field=path)
    return st.fixed_dictionaries({**cells, **given})


def packed(layout: Layout, values: Mapping[str, Any]) -> bytes:
    """The bytes of a struct from values by path; those that are not given are zero."""
    data = bytearray(layout.size)
    for cell in layout.cells():
        if cell.path in values:
            one = Layout(cell.path, [("value", cell.type)]).pack(value=values[cell.path])
            data[cell.offset : cell.offset + cell.size] = one
    return bytes(data)


def packets(
    name: str | int | Command | Telemetry | None = None,
    *,
    mission: Mission = None,
    malformed: bool = False,
    fields: Fields | None = None,
) -> st.SearchStrategy[bytes]:
    """CCSDS packets as they go over the Software Bus.

    Args:
        name: a command or telemetry packet of the dictionary, such as "SAMPLE_APP_DISPLAY_PARAM", with valid fields;
            a declaration itself; a MsgId, with any payload; None for any MsgId.
        mission: whose dictionary it is; without one, that of the applications that cfepy brings along.
        malformed: the packet has a mistake that its receiver has to find, since the bus takes it: it is too short or
            too long for what it is, or has a function code that nobody knows.
        fields: strategies in place of those of single fields, by path.

    Raises:
        UsageError: there is no such packet, field or mission.
    """
    good = _packets(name, mission, fields or {})
    return good.flatmap(_with_mistake) if malformed else good


def _packets(
    name: str | int | Command | Telemetry | None, mission: Mission, fields: Fields
) -> st.SearchStrategy[bytes]:
    if name is None:
        return (st.integers(*TELEMETRY_IDS) | st.integers(*COMMAND_IDS)).flatmap(_any_payload)
    if isinstance(name, int):
        if not 0 < name <= HIGHEST_VALID_MSG_ID or not name & HAS_TIME_OR_CODE:
            raise UsageError(f"0x{name:04X} is no MsgId of cFE's: these are 0x0801 to 0x0FFF and 0x1801 to 0x1FFF")
        return _any_payload(name)
    entry = name if isinstance(name, Command | Telemetry) else _entry(name, mission)
    values = fields_of(entry.payload, fields, entry.name)
    if isinstance(entry, Command):
        return values.map(lambda each: bytes(command(entry.msg_id, entry.code or 0, packed(entry.payload, each))))
    return values.map(lambda each: bytes(telemetry(entry.msg_id, packed(entry.payload, each))))


def _entry(name: str, mission: Mission) -> Command | Telemetry:
    known = dictionary_of(None if mission is None else read_mission(os.fspath(mission)))
    if name in known.telemetry:
        entry = known.telemetry[name]
        if isinstance(entry, Topic):
            raise UsageError(f"{name} is a ROS topic; its messages come from messages(TYPE)")
        return entry
    return _command(known, name)


def _command(known: Dictionary, name: str) -> Command:
    try:
        return known.command(name)
    except UsageError as error:
        raise UsageError(error.text.replace("command", "command or telemetry packet", 1)) from None


def _any_payload(msg_id: int) -> st.SearchStrategy[bytes]:
    payload = st.binary(max_size=LONGEST_PAYLOAD)
    if msg_id & COMMAND_BIT:
        return st.builds(lambda code, data: bytes(command(msg_id, code, data)), st.integers(0, 127), payload)
    return payload.map(lambda data: bytes(telemetry(msg_id, data)))


def _with_mistake(packet: bytes) -> st.SearchStrategy[bytes]:
    """One of the mistakes that a packet can have; the shortest one first."""
    mistakes = [
        st.integers(CMD_HEADER_SIZE - 1, len(packet) - 1).map(lambda size: _resized(packet[:size])),
        st.binary(min_size=1, max_size=LONGEST_PAYLOAD).map(lambda more: _resized(packet + more)),
    ]
    if packet[0] & COMMAND_BIT >> 8:
        mistakes.append(st.just(packet[:CODE_BYTE] + bytes([UNKNOWN_CODE]) + packet[CODE_BYTE + 1 :]))
    return st.one_of(mistakes)


def _resized(packet: bytes) -> bytes:
    """With the length in the header that its bytes have."""
    return packet[: SIZE_BYTES.start] + (len(packet) - 7).to_bytes(2, "big") + packet[SIZE_BYTES.stop :]


def tables(
    name: str, *, mission: Mission = None, fields: Fields | None = None
) -> st.SearchStrategy[list[dict[str, Any]]]:
    """Contents of a table: its rows, each with its fields, as `Flight.load_table` takes them.

    Args:
        name: full name, such as "HK.CopyTable", or the table's own name if no other one has it.
        mission: whose applications declare it; those that cfepy brings along are always known.
        fields: strategies in place of those of single fields, by path within a row.

    Raises:
        UsageError: there is no such table, field or mission.
    """
    kind = table_type(name, None if mission is None else os.fspath(mission))
    row = fields_of(kind.row, fields or {}, kind.name).map(lambda values: kind.row.unpack(packed(kind.row, values)))
    if kind.rows == 1:
        return st.lists(row, min_size=1, max_size=1)
    return st.lists(row, max_size=min(kind.rows, MOST_ROWS))
